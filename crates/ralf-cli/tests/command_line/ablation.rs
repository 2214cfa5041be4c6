//! `ralf ablate`: its first row is what `ralf tune` reaches with the paper's settings, and every other is told beside
//! it.

use crate::support::{Dataset, Ran, Shape, program, ralf};
use serde_json::Value;

fn ablate(dataset: &Dataset, jobs: &str) -> Value {
    let path = &dataset.path;
    ralf(["ablate", path, "--train", "00", "--test", "01", "--trials", "25", "--jobs", jobs, "--json"])
        .exits(0)
        .says_nothing()
        .json()
}

#[test]
fn variants_are_tuned_and_judged_alike() {
    let dataset = Dataset::of(&Shape { sequences: &["00", "01"], ..Shape::default() });
    let found = ablate(&dataset, "1");
    assert_eq!(found, ablate(&dataset, "4"));
    let variants = found["variants"].as_array().unwrap();
    let file = dataset.beside("paper.toml");
    let papers =
        "[ground]\nradar_sigmas = 0\nclimbs = 0\n[lidar]\nmax_mismatch = 1e6\n[camera]\nmax_mismatch = 1e6\n";
    let settings = dataset.beside("papers.toml");
    std::fs::write(&settings, papers).unwrap();
    let tune = ["tune", &dataset.path, "-o", &file, "--config", &settings, "--trials", "25", "--json"];
    let paper = Ran::of(&program().args(tune).args(["--train", "00", "--test", "01"]).output().unwrap());
    let paper = paper.exits(0).json();
    assert_eq!(variants[0]["name"], "paper");
    assert_eq!(variants[0]["settings"], paper["settings"]["tuned"]);
    assert_eq!(variants[0]["test"], paper["test"]["tuned"]["pooled"]);
    let f1 = |variant: &Value| variant["test"]["f1_plausible"].as_f64().unwrap();
    for variant in variants {
        let to_paper = variant["f1_plausible_to_paper"].as_f64().unwrap();
        assert_eq!(to_paper, f1(variant) - f1(&variants[0]), "{}", variant["name"]);
    }
    let arguments = ["ablate", &dataset.path, "--train", "00", "--test", "01", "--trials", "2", "--quiet"];
    ralf(arguments).exits(0).prints([
        "Variant",
        "without LiDAR",
        "tracking alone",
        "ground.model=polar",
        "+0.000",
    ]);
    ralf(["ablate", &dataset.path, "--train", "00", "--test", "00"]).exits(2).says(["both name 00"]);
    ralf(["ablate", &dataset.path, "--train", "00"]).exits(2).says(["--test"]);
}

#[test]
fn without_a_camera_nothing_is_told_of_cameras() {
    let dataset = Dataset::of(&Shape { sequences: &["00", "01"], ..Shape::default() });
    let names = |found: &Value| -> Vec<String> {
        let variants = found["variants"].as_array().unwrap();
        variants.iter().map(|variant| variant["name"].as_str().unwrap().to_owned()).collect()
    };
    let without = names(&ablate(&dataset, "2"));
    assert!(without.iter().all(|name| !name.contains("camera")), "{without:?}");
    let arguments = ["ablate", &dataset.path, "--train", "00", "--test", "01", "--trials", "2", "--quiet"];
    ralf(arguments).exits(0).prints(["No camera has depth"]);
    let with = names(&ablate(&dataset.with_camera(3), "2"));
    assert_eq!(with.len(), without.len() + 4, "{with:?}");
}

#[test]
fn without_a_lidar_nothing_is_told_of_lidars() {
    let dataset = Dataset::of(&Shape { sequences: &["00", "01"], ..Shape::default() }).with_camera(3);
    for sequence in ["00", "01"] {
        let folder = format!("{}/sequences/{sequence}", dataset.path);
        let toml = std::fs::read_to_string(format!("{folder}/sequence.toml")).unwrap();
        let (before, after) = toml.split_once("[[lidar]]").unwrap();
        let after = after.find("[[camera]]").map_or("", |at| &after[at..]);
        std::fs::write(format!("{folder}/sequence.toml"), format!("{before}{after}")).unwrap();
        std::fs::remove_dir_all(format!("{folder}/lidar_top")).unwrap();
    }
    let asked = ["ablate", &dataset.path, "--train", "00", "--test", "01", "--trials", "2", "--quiet"];
    ralf(asked).exits(0).prints(["No LiDAR: nothing is told of LiDARs", "paper", "tracking.sources=all"]);
    let found = ablate(&dataset, "2");
    let names: Vec<&str> = found["variants"]
        .as_array()
        .unwrap()
        .iter()
        .map(|variant| variant["name"].as_str().unwrap())
        .collect();
    let told =
        ["paper", "without tracking", "tracking.sources=all", "tracking.dynamic=true", "ground.model=flat"];
    assert_eq!(names, told);
}
