//! What people corrected counts in the next evaluation and tuning.

use crate::support::{Dataset, Shape, ralf};
use ralf_corrections::{Mark, Outcome, ScanEdit, ScanKey, Store, Stroke, Who};
use ralf_data::result::read_record;
use ralf_data::team::Assignment;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const SEQUENCES: [&str; 2] = ["00", "01"];
const RADAR: &str = "radar_front";

fn labelled() -> Dataset {
    let dataset = Dataset::of(&Shape { sequences: &SEQUENCES, ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    dataset
}

fn who() -> Who {
    Who::named("ada")
}

fn store(out: &str) -> Store {
    Store::open(&Path::new(out).join("corrections.sqlite")).unwrap()
}

/// The ids of a `.label` file.
fn ids(file: &Path) -> Vec<u16> {
    let bytes = fs::read(file).unwrap();
    bytes.as_chunks::<4>().0.iter().map(|[low, high, ..]| u16::from_le_bytes([*low, *high])).collect()
}

/// Marks the front radar's scans as reviewed, as if the machine had said what is true, and takes the truth away.
fn review_everything(dataset: &Dataset) {
    let mut store = store(&dataset.out);
    for sequence in SEQUENCES {
        let truth = Path::new(&dataset.path).join("sequences").join(sequence).join("ground_truth");
        for scan in 0..8 {
            let machine = ids(&truth.join(RADAR).join(format!("{scan:06}.label")));
            let key = ScanKey { sequence: sequence.into(), radar: RADAR.into(), scan };
            let mark = Mark { key, content: None, base: 0, machine, reviewed: true };
            assert!(matches!(store.mark(&mark, &who()).unwrap(), Outcome::Done(_)));
        }
        fs::remove_dir_all(&truth).unwrap();
    }
}

fn evaluation<const N: usize>(arguments: [&str; N]) -> Value {
    ralf(arguments).exits(0).says(["corrected detections"]).json()["overall"]["pooled"].clone()
}

#[test]
fn a_correction_stands_above_the_datasets_truth() {
    let dataset = labelled();
    let asked = ["evaluate", &dataset.out, "--truth", &dataset.path, "--json"];
    let before = ralf(asked).exits(0).says_nothing().json()["overall"]["pooled"].clone();
    let machine = ids(&Path::new(&dataset.out).join("sequences/00").join(RADAR).join("000000.label"));
    let artifact = machine.iter().position(|id| *id == 1).unwrap() as u32;
    let detections = machine.len() as u32;
    let points = vec![artifact];
    let edit = ScanEdit { radar: RADAR.into(), scan: 0, detections, content: None, base: 0, points };
    let stroke =
        Stroke { tool: "click".into(), label: Some(10), scans: vec![edit], ..Stroke::of_sequence("00") };
    store(&dataset.out).apply(&stroke, &who()).unwrap();
    let after = evaluation(asked);
    // The machine says artifact, the person a car.
    let number = |metrics: &Value, name: &str| metrics[name].as_u64().unwrap();
    assert_eq!(number(&after, "fn"), number(&before, "fn") + 1);
    assert_eq!(
        number(&after, "tn") + number(&after, "fp") + 1,
        number(&before, "tn") + number(&before, "fp")
    );
    // Another run is judged by the same corrections where these are named.
    let other = format!("{}-other", dataset.out);
    ralf(["label", &dataset.path, "-o", &other]).exits(0);
    let named = ["evaluate", &other, "--truth", &dataset.path, "--corrections", &dataset.out, "--json"];
    assert_eq!(evaluation(named), after);
    let none = ["evaluate", &dataset.out, "--truth", &dataset.path, "--corrections", &other];
    ralf(none).exits(1).says(["-other/corrections.sqlite: file: expected corrections, found no such file"]);
    let nowhere = format!("{other}s");
    let [command, out, truth, path, corrections, _] = none;
    let found = format!("{nowhere}: file: expected corrections, found no such file");
    ralf([command, out, truth, path, corrections, &nowhere]).exits(1).says([found.as_str()]);
}

#[test]
fn corrections_are_enough_to_evaluate_and_to_tune() {
    let dataset = labelled();
    review_everything(&dataset);
    let found = evaluation(["evaluate", &dataset.out, "--truth", &dataset.path, "--json"]);
    assert!(found["accuracy"].as_f64().unwrap() > 0.5 && found["tp"].as_u64().unwrap() > 0, "{found}");
    let file = format!("{}.toml", dataset.out);
    let tune = |more: &[&str]| {
        let asked =
            ["tune", &dataset.path, "-o", &file, "--train", "00", "--test", "01", "--trials", "3", "-q"];
        let mut program = crate::support::program();
        crate::support::Ran::of(&program.args(asked).args(more).output().unwrap())
    };
    tune(&[]).exits(1).says(["expected files of corrected labels, found none"]);
    tune(&["--corrections", &dataset.out]).exits(0).says(["16 reviewed scans are merged into the truth"]);
    assert!(fs::read_to_string(&file).unwrap().contains("--corrections"));
}

/// Says these labels of the first detections of the front radar's first scan.
fn say(out: &str, detections: u32, labels: &[u16]) {
    let mut store = store(out);
    for (base, label) in labels.iter().enumerate() {
        let (radar, points) = (RADAR.to_owned(), vec![base as u32]);
        let edit = ScanEdit { radar, scan: 0, detections, content: None, base: base as u64, points };
        let stroke = Stroke { label: Some(*label), scans: vec![edit], ..Stroke::of_sequence("00") };
        assert!(matches!(store.apply(&stroke, &who()).unwrap(), Outcome::Done(_)));
    }
}

/// They agree on three of four; by chance they would on two: of the first's labels half are plausible, of the second's
/// three quarters. A car is what both call one once, and the second alone once.
#[test]
fn two_people_agree_as_far_as_it_is_by_hand() {
    let dataset = labelled();
    let detections =
        ids(&Path::new(&dataset.out).join("sequences/00").join(RADAR).join("000000.label")).len();
    let other = dataset.beside("other");
    fs::create_dir(&other).unwrap();
    say(&dataset.out, detections as u32, &[1, 1, 10, 99]);
    let asked = ["evaluate", &dataset.out, "--truth", &dataset.path, "--agreement", &other];
    ralf(asked).exits(1).says(["other/corrections.sqlite: file: expected corrections, found no such file"]);
    drop(store(&other));
    ralf(asked).exits(1).says(["expected detections of which both say something, found none"]);
    say(&other, detections as u32, &[1, 10, 10, 99, 99]);
    ralf(asked).exits(0).prints(["They disagree in 1 scan,", "00/radar_front/000000: 1 of 4", "car"]);
    let [command, out, truth, path, agreement, _] = asked;
    let file = format!("{other}/corrections.sqlite");
    let found = ralf([command, out, truth, path, agreement, &file, "--json"]).exits(0).json();
    let all = json!({ "labelled_by_both": 4, "both_plausible": 2, "both_artifact": 1, "disagree": 1, "kappa": 0.5 });
    assert_eq!((&found["overall"], &found["sequences"]["00"], &found["radars"][RADAR]), (&all, &all, &all));
    let car = json!({ "both": 1, "first_alone": 0, "second_alone": 1, "kappa": 0.5 });
    assert_eq!(found["classes"]["car"], car);
    let scan = json!([{ "sequence": "00", "radar": RADAR, "scan": 0, "labelled_by_both": 4, "disagree": 1 }]);
    assert_eq!(found["disagreements"], scan);
    // It is people's word, whatever is labelled at the moment.
    ralf(["label", path, "-o", out, "--sequence", "01", "--set", "fusion.threshold=0.6"]).exits(0);
    assert_eq!(ralf([command, out, truth, path, agreement, &file, "--json"]).exits(0).json(), found);
    ralf([command, out, truth, path]).exits(3).says(["sequence 00", "4 corrected detections"]);
}

/// A stroke over a thing reaches scans that nobody drew, too.
#[test]
fn agreement_is_of_the_scans_alone_that_were_dealt() {
    let dataset = labelled();
    let detections =
        ids(&Path::new(&dataset.out).join("sequences/00").join(RADAR).join("000000.label")).len();
    say(&dataset.out, detections as u32, &[1, 99]);
    let second = dataset.beside("second");
    fs::create_dir(&second).unwrap();
    say(&second, detections as u32, &[1, 99]);
    let folder = Path::new(&dataset.out).join("second");
    fs::create_dir(&folder).unwrap();
    let file = folder.join("bob.sqlite");
    fs::copy(Path::new(&second).join("corrections.sqlite"), &file).unwrap();
    let file = file.to_str().unwrap();
    let asked = ["evaluate", &dataset.out, "--truth", &dataset.path, "--agreement", file];
    let deal = |team: String| fs::write(Path::new(&dataset.out).join("team.toml"), team).unwrap();
    ralf(asked).exits(0).prints(["labelled by both"]);
    deal(format!("[bob]\ntwice = [\"00/{RADAR}/000000\"]"));
    ralf(asked).exits(0).prints(["labelled by both"]);
    // Of a sequence that isn't labelled at the moment nothing is lost.
    deal(format!(
        "[bob]\ntwice = [\"00/{RADAR}/000000\", \"07/{RADAR}/000000\"]\n[ada]\nsequences = [\"08\"]"
    ));
    let waiting = "team.toml: not labelled at the moment, and nobody is asked for it: 07, 08";
    ralf(asked).exits(0).prints(["labelled by both"]).says([waiting]);
    deal(format!("[bob]\ntwice = [\"00/{RADAR}/000001\"]"));
    ralf(asked)
        .exits(1)
        .says(["1 scan not dealt to bob: left out", "of which both say something, found none"]);
    deal("[bob]\nsequences = [\"00\"]".to_owned());
    ralf(asked).exits(1).says(["1 scan not dealt to bob: left out"]);
    let typo = file.replace("bob.", "bobb.");
    let [command, out, truth, path, agreement, _] = asked;
    let found = format!("{typo}: file: expected corrections, found no such file");
    ralf([command, out, truth, path, agreement, &typo]).exits(1).says([found.as_str()]);
}

#[test]
fn work_is_dealt_once_and_what_people_did_is_told() {
    let dataset = labelled();
    let deal = |people: &str, twice: &str| ralf(["assign", &dataset.out, "--to", people, "--twice", twice]);
    deal("ada", "0.5").exits(2).says(["--twice: expected two people or more"]);
    deal("ada,ada", "0").exits(2).says(["--to: expected each name once"]);
    deal("ada,Ada", "0").exits(2).says(["whatever the case, found `ada` and `Ada`"]);
    deal(&format!("ada,{}", "b".repeat(65)), "0").exits(2).says(["one of more than 64 characters"]);
    deal("ada,b/b", "0").exits(2).says(["one with a separator"]);
    deal("ada,bob", "2").exits(2).says(["expected a number from 0 to 1"]);
    // Two sequences of two radars with eight scans each: one for each person, and a quarter of the other's.
    deal("ada, bob", "0.25").exits(0).prints(["ada", "bob", "team.toml"]);
    let labelled = read_record(Path::new(&dataset.out)).unwrap().sequences;
    let dealt = Assignment::open(Path::new(&dataset.out), &labelled).unwrap().unwrap();
    for (name, own, other) in [("ada", "00", "01"), ("bob", "01", "00")] {
        let share = &dealt.0[name];
        assert_eq!(share.sequences, [own]);
        assert!(share.twice.len() == 4 && share.twice.iter().all(|scan| scan.sequence == other));
    }
    deal("ada,bob", "0.25").exits(1).says(["team.toml: file: expected none, for people may have begun"]);

    let asked = ["evaluate", &dataset.out, "--progress"];
    ralf(asked).exits(0).says_nothing().prints(["nobody has corrected anything yet"]);
    let none = ralf(["evaluate", &dataset.out, "--progress", "--json"]).exits(0).says_nothing().json();
    assert_eq!(none, json!([]));
    ralf(["evaluate", "nowhere", "--progress", "--json"]).exits(1).says(["nowhere: expected corrections"]);
    let told = ["run.json: expected the record of a finished `ralf label`"];
    ralf(["evaluate", &dataset.path, "--progress"]).exits(1).prints_nothing().ends_with_error(told);
    let begun = dataset.beside("begun");
    let kept = format!("{begun}/.ralf-run/0123");
    fs::create_dir_all(&kept).unwrap();
    fs::write(format!("{kept}/inputs.json"), "").unwrap();
    assert_eq!(ralf(["evaluate", &begun, "--progress", "--json"]).exits(0).json(), json!([]));
    say(&dataset.out, 9, &[1, 99, 10]);
    store(&dataset.out).undo("00", &who()).unwrap();
    let second = Path::new(&dataset.out).join("second");
    fs::create_dir(&second).unwrap();
    let bob = Store::open(&second.join("bob.sqlite")).unwrap();
    drop(bob);
    ralf(asked).exits(0).prints(["detections/h", "ada"]);
    let [command, out, progress] = asked;
    let days = ralf([command, out, progress, "--json"]).exits(0).json();
    let days = days.as_array().unwrap();
    assert!(days.iter().all(|day| day["author"] == "ada" && day["second"] == false));
    // It may be midnight.
    let sum = |name: &str| days.iter().map(|day| day[name].as_u64().unwrap()).sum::<u64>();
    assert_eq!((sum("edits"), sum("detections"), sum("scans")), (4, 2, 0));
}

#[test]
fn labelling_again_keeps_what_people_said() {
    let dataset = labelled();
    review_everything(&dataset);
    let file = Path::new(&dataset.out).join("corrections.sqlite");
    let before = fs::read(&file).unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out, "--set", "fusion.alpha=1.0"]).exits(0);
    assert_eq!(fs::read(&file).unwrap(), before);
}

/// What people said of a recording without any other truth: errors first, then all of a scan.
#[test]
fn a_report_tells_where_its_truth_comes_from_and_what_it_is_worth() {
    let dataset = labelled();
    for sequence in SEQUENCES {
        fs::remove_dir_all(format!("{}/sequences/{sequence}/ground_truth", dataset.path)).unwrap();
    }
    let detections =
        ids(&Path::new(&dataset.out).join("sequences/00").join(RADAR).join("000000.label")).len() as u32;
    let edit = ScanEdit { radar: RADAR.into(), detections, points: vec![3], ..ScanEdit::default() };
    let cause = Some("sprayed water".to_owned());
    let stroke = Stroke { label: Some(1), cause, scans: vec![edit], ..Stroke::of_sequence("00") };
    assert!(matches!(store(&dataset.out).apply(&stroke, &who()).unwrap(), Outcome::Done(_)));
    let page = dataset.beside("report.html");
    let report = || ralf(["report", &dataset.path, &dataset.out, "-o", &page]).exits(0);
    let evaluate = || ralf(["evaluate", &dataset.out, "--truth", &dataset.path]).exits(0);
    let merged = "corrections.sqlite: 1 corrected detections and 0 reviewed scans are merged into the truth";
    let partly = "corrections.sqlite: of 1 scan the truth is but what people corrected there";
    report().says([merged, partly]);
    evaluate().says([merged, partly]);
    let picture = dataset.beside("scan.png");
    let plot = ["plot", &dataset.path, &dataset.out, "--sequence", "00", "--scan", "0", "-o", &picture];
    ralf(plot)
        .exits(0)
        .says(["corrections.sqlite: 1 corrected detections and 0 reviewed scans are not drawn"]);
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.contains("They tell of 1 of ") && html.contains("1 corrected detections and 0 reviewed"));
    assert!(html.contains("of 1 scan the truth is but") && html.contains("sprayed water"));
    let machine = ids(&Path::new(&dataset.out).join("sequences/00").join(RADAR).join("000000.label"));
    let key = ScanKey { sequence: "00".into(), radar: RADAR.into(), scan: 0 };
    let mark = Mark { key, content: None, base: 1, machine, reviewed: true };
    assert!(matches!(store(&dataset.out).mark(&mark, &who()).unwrap(), Outcome::Done(_)));
    assert!(!report().stderr.contains("of 1 scan the truth is but"));
    assert!(!evaluate().stderr.contains("of 1 scan the truth is but"));
    assert!(fs::read_to_string(&page).unwrap().contains("1 reviewed scans are merged into the truth"));
}

#[test]
fn nobody_agrees_with_a_copy_of_oneself() {
    let dataset = labelled();
    let detections =
        ids(&Path::new(&dataset.out).join("sequences/00").join(RADAR).join("000000.label")).len();
    say(&dataset.out, detections as u32, &[1, 99]);
    let copy = dataset.beside("copy.sqlite");
    fs::copy(Path::new(&dataset.out).join("corrections.sqlite"), &copy).unwrap();
    for other in [&dataset.out, &copy] {
        let asked = ["evaluate", &dataset.out, "--truth", &dataset.path, "--agreement", other];
        ralf(asked)
            .exits(1)
            .prints_nothing()
            .ends_with_error(["one store of corrections twice, or a copy of it"]);
    }
}
