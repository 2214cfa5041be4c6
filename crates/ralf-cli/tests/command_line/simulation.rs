//! `ralf demo`, and its steps: `ralf simulate`, `label`, `evaluate`, and the report about it.

use crate::support::{Dataset, ralf, tree};
use ralf_data::judge::QueueCurve;
use ralf_data::{Comparison, GroundTruth};
use std::fs;

#[test]
fn the_demonstration_shows_its_commands_a_table_and_a_page() {
    // What is told can be typed, though the name has a space.
    let folder = Dataset::new().beside("d m");
    let labelled = format!("$ ralf label '{folder}/recording' -o '{folder}/labels'");
    let first = ralf(["demo", &folder]).exits(0).says(["$ ralf simulate", &labelled, "$ ralf report"]);
    let plotted = format!("ralf plot '{folder}/recording' '{folder}/labels' --scan 6");
    first.prints(["F1 plausible", "report.html in a browser", &plotted]);
    let page = fs::read_to_string(format!("{folder}/report.html")).unwrap();
    for told in [
        "Labels of",
        "What the model tells",
        "<th scope=\"row\">road</th>",
        "What weighs most",
        "LiDAR rays ",
    ] {
        assert!(page.contains(told), "{told}");
    }
    ralf(["demo", &folder]).exits(0).says(["is there already", "nothing to do"]);
}

fn queue_of(dataset: &str, out: &str) -> QueueCurve {
    let truth = GroundTruth::open(dataset.as_ref()).unwrap();
    QueueCurve::of_run(out.as_ref(), &Comparison::new(out.as_ref(), &truth).unwrap()).unwrap()
}

#[test]
fn a_simulated_recording_is_labelled_evaluated_and_reported() {
    // Only for a folder of its own.
    let dataset = Dataset::new();
    let [made, again, out, page] =
        ["made", "again", "labels", "report.html"].map(|name| dataset.beside(name));
    ralf(["simulate", "-o", &made, "--preset", "tiny", "--scans", "4"]).exits(0).prints_nothing();
    ralf(["simulate", "-o", &again, "--preset", "tiny", "--scans", "4"]).exits(0);
    assert_eq!(tree(&made), tree(&again), "the same seed gives the same bytes");
    ralf(["simulate", "-o", &made, "--preset", "tiny"]).exits(1).says(["sequences", "another one"]);
    let other_seed = ["simulate", "-o", &made, "--preset", "tiny", "--scans", "4", "--seed", "1"];
    ralf(other_seed).exits(1).says(["sequences", "another one"]);

    ralf(["label", &made, "-o", &out]).exits(0).prints(["radar_front", "camera_front"]);
    let scores = ralf(["evaluate", &out, "--truth", &made, "--json"]).exits(0).json();
    let accuracy = scores["overall"]["pooled"]["accuracy"].as_f64().unwrap();
    assert!((0.6..0.999).contains(&accuracy), "neither hopeless nor trivial: {accuracy}");

    ralf(["evaluate", &out, "--truth", &made, "--queue"]).exits(0).prints(["at best", "wrong labels in"]);

    ralf(["report", &made, &out, "-o", &page, "--scans-per-sequence", "1"]).exits(0);
    let html = fs::read_to_string(&page).unwrap();
    for part in ["Labels of", "side lobe", "inside building", "double bounce"] {
        assert!(html.contains(part), "the page lacks {part}");
    }
}

#[test]
fn the_first_half_of_the_queue_has_nearly_all_that_any_half_of_the_scans_can_have() {
    let dataset = Dataset::new();
    let [made, out] = ["made", "labels"].map(|name| dataset.beside(name));
    let street =
        ["simulate", "-o", &made, "--preset", "paper", "--sequence", "00", "--scans", "110", "--no-images"];
    ralf(street).exits(0);
    ralf(["label", &made, "-o", &out]).exits(0);
    let curve = queue_of(&made, &out);
    assert!(curve.scans == 40 && curve.correlation.unwrap() > 0.5, "{curve:?}");
    assert!(curve.found[4] > 0.95 * curve.ideal[4] && curve.found[4] > 0.53, "{curve:?}");
}

#[test]
fn a_simulated_recording_is_compared_with_another_one() {
    let dataset = Dataset::new();
    let [made, page] = ["made", "realism.html"].map(|name| dataset.beside(name));
    ralf(["simulate", "-o", &made, "--preset", "tiny", "--scans", "5", "--no-images"]).exits(0);
    let same = ["simulate", "--compare", &made, "--with", &made, "-o", &page];
    ralf(same).exits(0).prints(["made beside made (real)", "range, m", "mean KS 0.000"]);
    let html = fs::read_to_string(&page).unwrap();
    for part in ["How real is", "to the next LiDAR point", "Kolmogorov-Smirnov", "</svg>"] {
        assert!(html.contains(part), "the page lacks {part}");
    }
    for loaded in ["src=\"http", "href=\"http", "url(http", "@import"] {
        assert!(!html.contains(loaded), "the page needs a network: {loaded}");
    }

    let other = ["simulate", "--compare", &made, "--preset", "tiny", "--seed", "4", "--scans", "5", "--json"];
    let figures = ralf(other).exits(0).json();
    assert_eq!(figures["simulated"], "tiny, seed 4");
    let distance = figures["realism"]["mean_ks"].as_f64().unwrap();
    assert!((0.005..0.4).contains(&distance), "another seed of the same world: {distance}");
    assert_eq!(figures["realism"]["quantities"][1]["name"], "range");

    let file = format!("{made}/sequences/tiny/sequence.toml");
    let sensors = fs::read_to_string(&file).unwrap();
    fs::write(&file, sensors.replace("\"doppler\"", "\"speed\"")).unwrap();
    let lacking = "made lacks some of: range rates, and the vehicle's motion where they are raw";
    ralf(["simulate", "--compare", &made, "--with", &made]).exits(0).prints([lacking]);
    fs::write(&file, sensors).unwrap();

    let alone = ralf(["inspect", &made, "--distributions", "--json"]).exits(0).json();
    assert_eq!(alone["quantities"][1]["summary"], figures["realism"]["quantities"][1]["real"]);
    ralf(["inspect", &made, "--distributions"]).exits(0).prints(["radar scans", "persistence, share"]);
    ralf(["inspect", &made, "--distributions", "--quick"]).exits(2).says(["--quick"]);

    ralf(["simulate", "--with", &made]).exits(2).says(["--compare"]);
    ralf(["simulate", "--compare", &made, "--with", &made, "--seed", "1"]).exits(2).says(["--seed"]);
    ralf(["simulate", "--compare", "nowhere"]).exits(1).says(["nowhere"]);
    ralf(["simulate"]).exits(2).says(["--output"]);
}

#[test]
fn without_images_or_with_other_numbers_of_jobs_all_other_files_are_the_same() {
    let dataset = Dataset::new();
    let [one, three, bare] = ["one", "three", "bare"].map(|name| dataset.beside(name));
    ralf(["simulate", "-o", &one, "--preset", "tiny", "--scans", "3", "--jobs", "1"]).exits(0);
    ralf(["simulate", "-o", &three, "--preset", "tiny", "--scans", "3", "--jobs", "3"]).exits(0);
    ralf(["simulate", "-o", &bare, "--preset", "tiny", "--scans", "3", "--no-images"]).exits(0);
    let all = tree(&one);
    assert_eq!(all, tree(&three));
    let mut others = all.clone();
    let is_other = |file: &str| !file.contains("camera_") && !file.ends_with("sequence.toml");
    others.retain(|file, _| is_other(file));
    let mut left = tree(&bare);
    left.retain(|file, _| is_other(file));
    assert_eq!(left, others);
    assert!(tree(&bare).keys().all(|file| !file.contains("camera_")));
}

#[test]
fn what_was_simulated_with_segmentations_is_another_recording_than_without() {
    let dataset = Dataset::new();
    let [with, without] = ["with", "without"].map(|name| dataset.beside(name));
    let plain = |to: &str| ralf(["simulate", "-o", to, "--preset", "tiny", "--scans", "2"]);
    let segmented =
        |to: &str| ralf(["simulate", "-o", to, "--preset", "tiny", "--scans", "2", "--segmentation"]);
    segmented(&with).exits(0);
    let before = tree(&with);
    let file = "sequences/tiny/camera_front/segmentation/000000.png";
    plain(&with).exits(1).ends_with_error(["found another one: its", "segmentation/000000.png is no part"]);
    assert!(tree(&with) == before);
    segmented(&with).exits(0).says(["kept as it is"]);
    plain(&without).exits(0);
    segmented(&without).exits(1).ends_with_error(["found another one: its", "differs"]);
    // What a network made later, which `ralf segment` leaves a note of, is nobody else's recording.
    let place = format!("{without}/{file}");
    fs::create_dir(format!("{without}/sequences/tiny/camera_front/segmentation")).unwrap();
    fs::copy(format!("{with}/{file}"), &place).unwrap();
    fs::write(place.replace(".png", ".from"), "of this image\n").unwrap();
    plain(&without).exits(0).says(["kept as it is"]);
}

#[test]
fn worlds_of_both_makes_are_simulated_the_same_again_and_labelled() {
    for (family, radar) in [("carpark", "radar_"), ("quay", "front_left")] {
        simulated_twice_and_labelled(family, radar);
    }
    let dataset = Dataset::new();
    let none = dataset.beside("none");
    for wrong in ["moon", "city+moon+yard", "city+yard", "city+lane+yard"] {
        ralf(["simulate", "-o", &none, "--preset", "worlds", "--family", wrong])
            .exits(2)
            .says(["city", "lane", "A+B+C", wrong]);
    }
    ralf(["simulate", "-o", &none, "--preset", "worlds", "--sequence", "09"])
        .exits(2)
        .says(["expected one of 00"]);
}

fn simulated_twice_and_labelled(family: &str, radar: &str) {
    let dataset = Dataset::new();
    let [made, again, out] = ["world", "world_again", "labels"].map(|name| dataset.beside(name));
    let world = |to: &str, jobs: &str| {
        let which = ["--preset", "worlds", "--family", family, "--seed", "2", "--sequence", "01"];
        let [a, b, c, d, e, f, g, h] = which;
        ralf(["simulate", "-o", to, "--scans", "8", "--jobs", jobs, a, b, c, d, e, f, g, h])
            .exits(0)
            .prints_nothing();
    };
    world(&made, "2");
    world(&again, "1");
    assert_eq!(tree(&made), tree(&again), "the same seed gives the same bytes on any number of threads");
    let causes = fs::read_to_string(format!("{made}/sequences/01/ground_truth/causes.txt")).unwrap();
    assert_eq!(causes.lines().last(), Some("interference"));
    ralf(["label", &made, "-o", &out]).exits(0).prints([radar]);
    let scores = ralf(["evaluate", &out, "--truth", &made, "--json"]).exits(0).json();
    assert!(scores["overall"]["pooled"]["tp"].as_u64().unwrap() > 0);
}

#[test]
fn converting_what_was_simulated_keeps_labels_and_causes() {
    let dataset = Dataset::new();
    let [made, copy, file] = ["made", "copy", "made.mcap"].map(|name| dataset.beside(name));
    ralf(["simulate", "-o", &made, "--preset", "tiny", "--scans", "2", "-q"]).exits(0);
    let made_tree = tree(&made);
    let causes = made_tree.keys().filter(|name| name.ends_with(".cause")).count();
    assert!(causes > 0 && made_tree.contains_key("sequences/tiny/ground_truth/causes.txt"));
    let ran = ralf(["convert", &made, "-o", &copy, "-q"]).exits(0);
    assert!(!ran.stderr.contains("warning: "), "{}", ran.stderr);
    assert_eq!(made_tree, tree(&copy));

    // A cause may stand without a label.
    let bare = dataset.beside("bare");
    let label = "sequences/tiny/ground_truth/radar_front/000000.label";
    fs::remove_file(format!("{made}/{label}")).unwrap();
    ralf(["convert", &made, "-o", &bare, "-q"]).exits(0);
    assert_eq!(tree(&made), tree(&bare));

    ralf(["convert", &made, "-o", &file])
        .exits(0)
        .says(["warning: ", "no place for corrected labels, their causes, depth images"]);
    let plain = dataset.beside("plain.bag");
    fs::remove_dir_all(format!("{}/sequences/00/ground_truth", dataset.path)).unwrap();
    let ran = ralf(["convert", &dataset.path, "-o", &plain]).exits(0);
    assert!(!ran.stderr.contains("warning: "), "{}", ran.stderr);
}

#[test]
fn the_scenario_of_the_documentation_is_simulated() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scenario.md");
    let page = fs::read_to_string(page).unwrap();
    let (_, rest) = page.split_once("```toml\n").unwrap();
    let (text, _) = rest.split_once("```").unwrap();
    let dataset = Dataset::new();
    let [file, made] = ["yard.toml", "made"].map(|name| dataset.beside(name));
    fs::write(&file, text).unwrap();
    ralf(["simulate", "-o", &made, "--scenario", &file, "--scans", "2"]).exits(0).prints_nothing();
    let told = ralf(["inspect", &made, "--quick"]).exits(0);
    told.prints(["A yard with a ramp", "radar_front", "camera_rear"]);
}

#[test]
fn an_edited_scenario_is_not_taken_for_the_one_that_lies_there() {
    let dataset = Dataset::new();
    let [file, made] = ["yard.toml", "made"].map(|name| dataset.beside(name));
    let simulate = |text: &str, scans: &str| {
        fs::write(&file, text).unwrap();
        ralf(["simulate", "-o", &made, "--scenario", &file, "--scans", scans])
    };
    let yard = "title = \"Yard\"\nplausible_share = 0.25\n\
                ego = { start = [-12, 0, 0], speed_kmh = 7, leg = [{ length = 15 }] }\n\
                thing = [{ kind = \"building\", at = [4, 12] }, { kind = \"car\", at = [-8, 5] }]\n";
    let dark = "failure = [{ camera = \"camera_rear\", kind = \"dark\", from_s = 0.2, until_s = 0.3 }]\n";
    simulate(&[yard, dark].concat(), "8").exits(0);
    let before = tree(&made);
    simulate(&[yard, dark].concat(), "8").exits(0).says(["kept as it is"]);
    // What differs is one image, neither the first nor the last; then when measurements end, then the sensors.
    let refused = |text: &str, scans: &str, differs: &str| {
        let told = ["none of this name yet", "found another one: its", differs];
        simulate(text, scans).exits(1).ends_with_error(told);
        assert!(tree(&made) == before);
    };
    refused(yard, "8", "camera_rear/");
    refused(&[yard, dark].concat(), "4", "differs");
    ralf(["simulate", "-o", &made, "--scenario", &file, "--scans", "8", "--no-images"]).exits(1);
    assert!(tree(&made) == before);
}
