//! `ralf plot --camera`.

use crate::support::{Dataset, Ran, Shape, program, ralf};
use std::fs;

fn labelled() -> Dataset {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() }).with_camera(3);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    dataset
}

/// Plots scan 1 with these further arguments.
fn plot(dataset: &Dataset, picture: &str, what: &[&str]) -> Ran {
    let fixed = ["plot", &dataset.path, &dataset.out, "--scan", "1", "-o", picture, "--changed-recording"];
    Ran::of(&program().args(fixed).args(what).output().unwrap())
}

#[test]
fn a_camera_is_drawn_with_depth_and_without() {
    let dataset = labelled();
    let picture = dataset.beside("camera.png");
    let drawn = |what: &[&str]| {
        plot(&dataset, &picture, what).exits(0).prints_nothing().says([&picture]);
        fs::read(&picture).unwrap()
    };
    let all = drawn(&["--camera", "camera_front"]);
    assert_eq!(all[16..20], 2400_u32.to_be_bytes());
    assert!(drawn(&["--camera", "camera_front", "--view", "0"]) == all, "the only view");
    assert!(drawn(&["--camera", "camera_front", "--radar", "radar_left"]) != all);
    fs::remove_dir_all(dataset.file("camera_front/depth")).unwrap();
    assert!(drawn(&["--camera", "camera_front"]) != all, "without depth");
}

#[test]
fn what_is_not_there_is_named() {
    let dataset = labelled();
    let picture = dataset.beside("camera.png");
    let refused = |what: &[&str]| plot(&dataset, &picture, what).exits(1);
    refused(&["--camera", "back"]).says(["expected the only camera, camera_front, found back"]);
    refused(&["--camera", "camera_front", "--view", "1"])
        .says(["expected view 0, the only one of camera_front, found 1"]);
    for network in ["a", "b"] {
        let folder = format!("{}/depth/{network}", dataset.out);
        fs::create_dir_all(&folder).unwrap();
        fs::write(format!("{folder}/depth.toml"), "output = \"depth\"\nnetwork = \"n\"\n").unwrap();
    }
    refused(&["--camera", "camera_front"]).says(["found 2", "--depth"]);
    plot(&dataset, &picture, &["--view", "0"]).exits(2);
    assert!(!fs::exists(&picture).unwrap());
}
