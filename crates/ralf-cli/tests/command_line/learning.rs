//! `ralf learn`, and labels by what it writes.

use crate::support::{Dataset, Ran, program, ralf, schema, without_timings};
use ralf_corrections::{FILE, ScanEdit, Store, Stroke, Who};
use std::fs;
use std::path::Path;

/// Two simulated recordings.
fn simulated(dataset: &Dataset) -> [String; 2] {
    ["town", "yard"].map(|name| {
        let made = dataset.beside(name);
        let seed = name.len().to_string();
        ralf(["simulate", "-o", &made, "--preset", "tiny", "--scans", "3", "--seed", &seed, "-q"]).exits(0);
        made
    })
}

#[test]
fn what_is_learned_labels_and_is_the_same_to_the_byte_whatever_the_number_of_jobs() {
    let dataset = Dataset::new();
    let [town, yard] = simulated(&dataset);
    let models = ["1", "3"].map(|jobs| {
        let model = dataset.beside(&format!("model{jobs}"));
        let trees = ["--rounds", "15", "--leaves", "6"];
        let [a, b, c, d] = trees;
        let done = ralf(["learn", &town, &yard, "-o", &model, a, b, c, d, "--jobs", jobs]);
        done.exits(0).prints(["town", "yard", "mean"]);
        model
    });
    let text = fs::read_to_string(&models[0]).unwrap();
    assert_eq!(text, fs::read_to_string(&models[1]).unwrap());
    let end = format!("\nend {}", text.lines().count() - 1);
    assert!(text.starts_with("ralf model 1\nprogram ") && text.contains("\nforest ") && text.contains(&end));
    assert!(text.contains(" --leaves 6 --seed 0\n") && text.contains("\nnet "), "{:.300}", text);
    let outs = ["1", "2"].map(|jobs| {
        let out = dataset.beside(&format!("out{jobs}"));
        let method = ["--method", "learned", "--model", &models[0]];
        let [a, b, c, d] = method;
        ralf(["label", &town, "-o", &out, a, b, c, d, "--jobs", jobs, "--no-check"]).exits(0);
        out
    });
    assert!(without_timings(&outs[0]) == without_timings(&outs[1]));
    let columns = schema(format!("{}/sequences/tiny/plausibility.parquet", outs[0]));
    for name in ["novelty", "reason_doppler", "reason_neighbours", "reason", "cause"] {
        assert!(columns.iter().any(|column| column.starts_with(&format!("{name}:"))), "{name}");
    }
    let lacking = dataset.beside("lacking");
    let (before, _) = text.rsplit_once("\ntree ").unwrap();
    fs::write(&lacking, format!("{before}{end}\n")).unwrap();
    ralf(["label", &town, "-o", &dataset.beside("none"), "--method", "learned", "--model", &lacking])
        .exits(1)
        .says(["lacking: model: line ", "so many lines are before it"]);
    ralf(["evaluate", &outs[0], "--truth", &town]).exits(0);
    ralf(["report", &town, &outs[0], "-o", &dataset.beside("report.html")]).exits(0);
    ralf(["export", &town, &outs[0], "--to", "npz", "-o", &dataset.beside("npz")]).exits(0);
    // Another model is another result.
    ralf(["label", &town, "-o", &outs[0], "--method", "learned", "--model", &models[0], "--no-check"])
        .exits(0)
        .says(["nothing to do"]);
    let model_of_run = || {
        let record = fs::read(format!("{}/run.json", outs[0])).unwrap();
        serde_json::from_slice::<serde_json::Value>(&record).unwrap()["model"].as_str().unwrap().to_owned()
    };
    let before = model_of_run();
    // Changed by hand it has no checksum.
    let (by_hand, _) = text.rsplit_once("\nend ").unwrap();
    fs::write(&models[1], by_hand.replacen("seed 0", "seed 1", 1) + "\nend\n").unwrap();
    ralf(["label", &town, "-o", &outs[0], "--method", "learned", "--model", &models[1], "--no-check"])
        .exits(0);
    assert_ne!(model_of_run(), before);
}

#[test]
fn worlds_are_simulated_on_the_way_and_each_family_is_one() {
    let dataset = Dataset::new();
    let model = dataset.beside("model");
    let left_out = "city,survey,motorway,imaging,country,anything,quay,ring,gardens";
    let [a, b, c] = ["--preset=worlds", &format!("--without={left_out}"), "--seeds=2"];
    let few = ["--scans=8", "--every=4", "--rounds=8", "--leaves=4", "--no-neighbours"];
    let [d, e, f, g, h] = few;
    ralf(["learn", a, b, c, d, e, f, g, h, "-o", &model]).exits(0).prints(["carpark", "yard", "lane"]);
    let text = fs::read_to_string(&model).unwrap();
    let told = format!("--preset worlds --seeds 2 --scans 8 --every 4 --without {left_out}");
    assert!(text.contains(&told), "{:?}", text.lines().nth(2));
    assert!(text.contains(" --leaves 4 --no-neighbours --seed 0\n") && !text.contains("\nnet "));
    assert_eq!(text.lines().filter(|line| line.starts_with("world ")).count(), 3);
}

/// A recording whose truth is known, labelled by the shipped model; somebody spoke of 40 detections of two scans.
fn reviewed(dataset: &Dataset) -> [String; 2] {
    let [town, _] = simulated(dataset);
    let out = dataset.beside("reviewed");
    ralf(["label", &town, "-o", &out, "--method", "learned", "--no-check", "-q"]).exits(0);
    let mut store = Store::open(&Path::new(&out).join(FILE)).unwrap();
    for (scan, label) in [(0, 40), (2, 99)] {
        let labels = fs::metadata(format!("{out}/sequences/tiny/radar_front/{scan:06}.label")).unwrap().len();
        let points = (0..20).collect();
        let radar = "radar_front".to_owned();
        let edit = ScanEdit { radar, scan, detections: labels as u32 / 4, points, ..ScanEdit::default() };
        let stroke = Stroke { label: Some(label), scans: vec![edit], ..Stroke::of_sequence("tiny") };
        store.apply(&stroke, &Who::named("ada")).unwrap();
    }
    [town, out]
}

#[test]
fn a_model_is_corrected_by_what_people_said_and_not_by_what_else_is_known() {
    let dataset = Dataset::new();
    let [town, out] = reviewed(&dataset);
    let said = |options: &[&str], model: &str| {
        let ran = program().args(["learn", &town, "-o", model]).args(options).output().unwrap();
        Ran::of(&ran).exits(0).prints(["tiny", "wrong: before", "turned", "after: F1"]);
        let text = fs::read_to_string(model).unwrap();
        let line = text.lines().find(|line| line.starts_with("corrected ")).unwrap();
        line.split(' ').nth(1).unwrap().parse::<usize>().unwrap()
    };
    let [own, again, both, known] =
        ["own", "again", "both", "known"].map(|name| dataset.beside(&format!("{name}.txt")));
    assert_eq!(said(&["--from", &out, "--jobs", "1"], &own), 40);
    assert_eq!(said(&["--from", &out, "--jobs", "3"], &again), 40);
    assert!(fs::read(&own).unwrap() == fs::read(&again).unwrap());
    let all = said(&["--correct"], &known);
    assert!(all > 400 && said(&["--from", &out, "--correct"], &both) == all);
    assert!(fs::read_to_string(&both).unwrap().contains(" --correct --rounds 40 --leaves 12 --seed 0\n"));
    let labelled = ralf(["label", &town, "-o", &out, "--method", "learned", "--model", &own, "--no-check"]);
    labelled.exits(0).says(["other"]);
    ralf(["evaluate", &out, "--truth", &town]).exits(0);
    // What it learned would be learned twice, or lost.
    let model = |model: &str, output: &str| {
        ralf(["learn", &town, "--from", &out, "--model", model, "-o", output, "-q"])
    };
    model(&own, &again).exits(1).ends_with_error(["before it was corrected", "`ralf learn "]);
    model(&own, &own).exits(2).ends_with_error(["--output", "--model"]);
    ralf(["learn", &town, "--model", &own, "-o", &again]).exits(2).ends_with_error(["--from", "--correct"]);
    ralf(["learn", &town, "--from", &out, "--preset", "worlds", "-o", &again]).exits(2);
    ralf(["learn", &town, "--from", &out, "--every", "4", "-o", &again]).exits(2);
    let twice = format!("{town}/.");
    ralf(["learn", &town, &twice, "--from", &out, "-o", &again]).exits(2).ends_with_error(["named twice"]);
    ralf(["learn", "--correct", "-o", &again]).exits(2);
}

#[test]
fn what_somebody_unlabeled_was_not_left_alone() {
    let dataset = Dataset::new();
    let [town, out] = reviewed(&dataset);
    let counts = || {
        let asked = ["learn", &town, "--from", &out, "-o", &dataset.beside("own.txt"), "--json", "-q"];
        let told: serde_json::Value = serde_json::from_str(&ralf(asked).exits(0).stdout).unwrap();
        ["detections", "left_alone"].map(|key| told["corrected"]["tiny"][key].as_u64().unwrap())
    };
    let [said, alone] = counts();
    let detections =
        fs::metadata(format!("{out}/sequences/tiny/radar_front/000000.label")).unwrap().len() / 4;
    let scans = vec![ScanEdit {
        radar: "radar_front".to_owned(),
        scan: 0,
        detections: detections as u32,
        points: (20..30).collect(),
        base: 1,
        ..ScanEdit::default()
    }];
    let stroke = Stroke { label: Some(0), scans, ..Stroke::of_sequence("tiny") };
    let mut store = Store::open(&Path::new(&out).join(FILE)).unwrap();
    store.apply(&stroke, &Who::named("ada")).unwrap();
    assert_eq!(counts(), [said, alone - 10]);
    // What is learned from is read as it was labelled: at this threshold nothing is plausible.
    let record = format!("{out}/run.json");
    let text = fs::read_to_string(&record).unwrap();
    let mut run: serde_json::Value = serde_json::from_str(&text).unwrap();
    run["settings"]["fusion"]["threshold"] = 0.999_99.into();
    fs::write(&record, run.to_string()).unwrap();
    let wrong = |options: &[&str]| {
        let mut learn = program();
        learn.args(["learn", &town, "--from", &out, "-o", &dataset.beside("own.txt"), "--json", "-q"]);
        let told = Ran::of(&learn.args(options).output().unwrap()).exits(0).json();
        told["corrected"]["tiny"]["wrong_before"].as_u64().unwrap()
    };
    assert_eq!(wrong(&[]), 20);
    assert_ne!(wrong(&["--set", "fusion.threshold=0.5"]), 20, "what is typed wins");
}

#[test]
fn labels_that_say_nothing_or_one_thing_alone_correct_no_model() {
    let dataset = Dataset::new();
    let [town, _] = simulated(&dataset);
    let own = dataset.beside("own.txt");
    for (label, expected) in [(0_u32, "found none"), (99, " and 0")] {
        let radars = ["radar_front", "radar_left", "radar_rear", "radar_right"];
        let folders = radars.map(|radar| format!("{town}/sequences/tiny/ground_truth/{radar}"));
        let files = folders.iter().flat_map(|folder| fs::read_dir(folder).unwrap());
        let files = files.map(|file| file.unwrap().path());
        for file in files.filter(|file| file.extension().is_some_and(|end| end == "label")) {
            let detections = fs::metadata(&file).unwrap().len() as usize / 4;
            fs::write(&file, label.to_le_bytes().repeat(detections)).unwrap();
        }
        ralf(["learn", &town, "--correct", "-o", &own, "-q"]).exits(1).ends_with_error([&town, expected]);
    }
    // Of two files that don't belong together, the damaged one is named.
    let cut = format!("{town}/sequences/tiny/ground_truth/radar_left/000001.label");
    fs::write(&cut, [0; 4]).unwrap();
    ralf(["learn", &town, "--correct", "-o", &own, "-q"]).exits(1).ends_with_error([&cut, "found 1"]);
    assert!(!fs::exists(&own).unwrap());
}

#[test]
fn a_model_of_nothing_is_refused() {
    let dataset = Dataset::new();
    let [town, yard] = simulated(&dataset);
    let model = dataset.beside("model");
    let learn = |groups: &[&str]| {
        let without = groups.iter().flat_map(|group| ["--without-group", group]);
        let asked = ["learn", &town, &yard, "-o", &model, "--rounds", "2", "--leaves", "2", "-q"];
        Ran::of(&program().args(asked).args(without).output().unwrap())
    };
    learn(&ralf::evidence::GROUPS).exits(2).ends_with_error(["no group of evidence is left to learn from"]);
    // The simulated cameras of these recordings are gone, and nothing else is to be read.
    for recording in [&town, &yard] {
        let file = format!("{recording}/sequences/tiny/sequence.toml");
        let text = fs::read_to_string(&file).unwrap();
        fs::write(&file, text.split("[[camera]]").next().unwrap()).unwrap();
    }
    let all_but_camera = ralf::evidence::GROUPS.into_iter().filter(|group| *group != "Camera");
    learn(&all_but_camera.collect::<Vec<_>>())
        .exits(1)
        .ends_with_error(["evidence that was observed", "none"]);
    assert!(!fs::exists(&model).unwrap());
}

#[test]
fn what_cannot_be_learned_or_asked_is_refused_and_nothing_is_written() {
    let dataset = Dataset::new();
    let model = dataset.beside("model");
    // One sequence is one world.
    ralf(["learn", &dataset.path, "-o", &model, "-q"]).exits(1).says(["two worlds"]);
    ralf(["learn", "-o", &model]).exits(2);
    assert!(!fs::exists(&model).unwrap());
    // What people wrote is kept, a model that they changed too.
    let changed = ralf::learned::Model::shipped().unwrap().to_text().replacen("seed 0", "seed 1", 1);
    for text in ["my notes\n", changed.as_str()] {
        fs::write(&model, text).unwrap();
        ralf(["learn", "--preset", "worlds", "-o", &model, "-q"])
            .exits(2)
            .says(["a model as `ralf learn` writes it"]);
        assert_eq!(fs::read_to_string(&model).unwrap(), text);
    }
    for (text, expected) in [
        ("", "ralf model 1"),
        ("ralf model 2\n", "ralf model 1"),
        (
            "ralf model 1\nprogram x\ncommand y\nseed 0\ncalibrated 0 0.5\nforest 0 plausible\nend\n",
            "names no evidence",
        ),
        (
            "ralf model 1\nprogram x\ncommand y\nseed 0\ninput smell 0 1 0 1\ncalibrated 0 0.5\nforest 0 plausible\nend\n",
            "smell",
        ),
    ] {
        fs::write(&model, text).unwrap();
        ralf([
            "label",
            &dataset.path,
            "-o",
            &dataset.out,
            "--method",
            "learned",
            "--model",
            &model,
            "--no-check",
        ])
        .exits(1)
        .says(["model", expected]);
    }
    assert!(!fs::exists(format!("{}/run.json", dataset.out)).unwrap());
}
