//! A trajectory is that of one drive: several sequences have one each, or none.

use crate::support::{Dataset, Ran, Shape, program, ralf};
use serde_json::Value;
use std::fs;

fn two() -> Dataset {
    Dataset::of(&Shape { scans: 3, sequences: &["00", "01"], ..Shape::default() })
}

/// Poses of a vehicle that drives so many times 5 m/s straight on.
fn poses(rows: usize, speed: f64) -> String {
    let row = |i: usize| {
        let t = format!("{}.{}", 1_700_000_000 + i / 10, i % 10);
        format!("{t} {} 0 0 0 0 0 1\n", speed * 0.5 * i as f64)
    };
    (0..rows).map(row).collect()
}

#[track_caller]
fn run(command: &str, dataset: &Dataset, more: &[&str]) -> Ran {
    Ran::of(&program().args([command, &dataset.path]).args(more).output().unwrap())
}

#[test]
fn one_file_is_not_the_motion_of_several_sequences() {
    let dataset = two();
    let [tum, kitti, model] = ["poses.tum", "poses.txt", "model"].map(|name| dataset.beside(name));
    fs::write(&tum, poses(9, 1.0)).unwrap();
    fs::write(&kitti, "1 0 0 0 0 1 0 0 0 0 1 0\n".repeat(4)).unwrap();
    let search = ["--train", "00", "--test", "01", "--trials", "1", "--trajectory", &tum];
    let tune = [&["-o", &model][..], &search].concat();
    let label = ["-o", &dataset.out, "--trajectory", &kitti];
    let learn = ["-o", &model, "--trajectory", &tum];
    let several: [(&str, &[&str]); 5] = [
        ("label", &label),
        ("check", &["--trajectory", &tum]),
        ("tune", &tune),
        ("ablate", &search),
        ("learn", &learn),
    ];
    for (command, more) in several {
        let told =
            ["expected one sequence, or a folder with a file for each, such as 00.tum", "found 2 sequences"];
        run(command, &dataset, more).exits(1).prints_nothing().ends_with_error(told);
    }
    // Nor of several recordings, or of simulated worlds.
    let expected = "expected one DATASET, whose motion it tells";
    let other = [&[dataset.path.as_str()][..], &learn].concat();
    run("learn", &dataset, &other).exits(2).ends_with_error([expected, "found 2"]);
    ralf(["learn", "--preset", "worlds", "-o", &model, "--trajectory", &tum])
        .exits(2)
        .ends_with_error([expected, "found simulated worlds alone"]);
    assert!(!fs::exists(&model).unwrap() && !fs::exists(&dataset.out).unwrap());
    let one = [&label[..], &["--sequence", "01"]].concat();
    let told =
        ["poses.txt: sequence 01: expected 3 poses, one per measurement of the first LiDAR, found 4 poses"];
    run("label", &dataset, &one).exits(1).ends_with_error(told);
}

#[test]
fn a_folder_has_a_file_for_each_sequence() {
    let dataset = two();
    let folder = dataset.beside("poses");
    fs::create_dir(&folder).unwrap();
    let label = ["-o", &dataset.out, "-q", "--no-check", "--trajectory", &folder];
    let place = |name: &str| format!("{folder}/{name}");
    fs::write(place("00.tum"), poses(9, 1.0)).unwrap();
    let missing = ["poses: sequence 01: expected its poses in one of the files 01.tum, 01.txt, 01.kitti"];
    run("label", &dataset, &label).exits(1).ends_with_error(missing);
    fs::write(place("01.txt"), "1 0 0 0 0 1 0 0 0 0 1 0\n".repeat(3)).unwrap();
    run("label", &dataset, &label).exits(0);
    let record: Value =
        serde_json::from_slice(&fs::read(format!("{}/run.json", dataset.out)).unwrap()).unwrap();
    let inputs = record["inputs"].as_array().unwrap();
    for (sequence, file) in [("00", "poses/00.tum"), ("01", "poses/01.txt")] {
        let of_poses = |input: &&Value| input["file"].as_str().unwrap().contains("/poses/");
        let own: Vec<_> =
            inputs.iter().filter(|input| input["sequence"] == sequence).filter(of_poses).collect();
        assert!(own.len() == 1 && own[0]["file"].as_str().unwrap().ends_with(file), "{own:?}");
    }
    fs::write(place("01.kitti"), "").unwrap();
    run("label", &dataset, &label).exits(1).ends_with_error(["sequence 01", "found 01.txt and 01.kitti"]);
}

#[test]
fn results_of_one_sequence_are_read_with_its_trajectory() {
    let dataset = two();
    let [tum, page] = ["poses.tum", "page.html"].map(|name| dataset.beside(name));
    fs::write(&tum, poses(9, 1.0)).unwrap();
    let label = ["-o", &dataset.out, "-q", "--no-check", "--sequence", "00", "--trajectory", &tum];
    run("label", &dataset, &label).exits(0);
    let report = ["report", &dataset.path, &dataset.out, "-o", &page];
    ralf(report).exits(3).says(["sequence 01 has no labels: left out"]);
}
