//! Messages of ROS recordings that can't be read, and files of nuScenes that are missing: each is named and costs
//! itself alone.

use crate::support::{Dataset, Ran, nuscenes, program, ralf, rows, without_timings};
use std::fs;
use std::path::{Path, PathBuf};

/// A small recording as a bag, with the settings by which it is read back.
struct Bag {
    dataset: Dataset,
    file: String,
    settings: String,
}

impl Bag {
    fn new() -> Self {
        let dataset = Dataset::new().with_camera(3);
        let (file, settings) = (dataset.beside("drive.bag"), dataset.beside("drive.toml"));
        ralf(["convert", &dataset.path, "-o", &file, "-q"]).exits(0);
        Self { dataset, file, settings }
    }

    /// Makes the frame of some messages of a sensor longer than all of it: their beginning can't be read any more.
    fn damage(&self, frame: &str, which: &[usize]) {
        let mut bytes = fs::read(&self.file).unwrap();
        // Behind the name, the height of a cloud or an image, or the kind of a compressed one.
        let name = [&(frame.len() as u32).to_le_bytes(), frame.as_bytes()].concat();
        let is_one = |at: &usize| {
            let rest = &bytes[*at..];
            rest.starts_with(&name)
                && [1, 3, 4].contains(&rest[name.len()])
                && rest[name.len() + 1..].starts_with(&[0; 3])
        };
        let found: Vec<usize> = (0..bytes.len() - name.len() - 4).filter(is_one).collect();
        which.iter().for_each(|number| bytes[found[*number] + 3] = 0xff);
        fs::write(&self.file, bytes).unwrap();
    }

    fn label(&self, out: &str, jobs: &str) -> Ran {
        let out = self.dataset.beside(out);
        ralf(["label", &self.file, "-o", &out, "--config", &self.settings, "-q", "--jobs", jobs])
    }

    fn convert(&self, name: &str) -> Ran {
        let output = self.dataset.beside(name);
        ralf(["convert", &self.file, "-o", &output, "--topics", &self.settings, "-q"])
    }

    fn inspect(&self) -> Ran {
        ralf(["inspect", &self.file, "--topics", &self.settings, "--json"])
    }

    fn result(&self, out: &str, name: &str) -> PathBuf {
        Path::new(&self.dataset.beside(out)).join(name)
    }
}

#[test]
fn a_radar_message_that_can_not_be_read_is_the_only_scan_left_out() {
    let bag = Bag::new();
    bag.label("whole", "1").exits(0);
    bag.damage("radar_front", &[3]);
    let ran = bag.label("out", "1").exits(3);
    let named = ran.not_labelled();
    let [only] = named.as_slice() else { panic!("{named:?}") };
    let name = Path::new(&bag.file).file_name().unwrap().display();
    assert!(only.starts_with(&format!("drive radar_front scan 3: {name}: /radar_front/points ")), "{only}");
    assert!(only.contains("expected a list that fits into"), "{only}");
    let count = |out: &str| rows(bag.result(out, "sequences/drive/plausibility.parquet")).len();
    assert_eq!(count("whole") - count("out"), 26);
    assert!(!bag.result("out", "sequences/drive/radar_front/000003.label").exists());
    assert!(bag.result("out", "sequences/drive/radar_front/000007.label").exists());
    // Asked again it says so again, and another number of threads gives the same bytes.
    assert_eq!(bag.label("out", "1").exits(3).says(["nothing to do"]).not_labelled(), [*only]);
    bag.label("other", "3").exits(3);
    let [out, other] = ["out", "other"].map(|out| without_timings(bag.dataset.beside(out)));
    assert_eq!(out, other);
    assert_eq!(bag.inspect().exits(0).json()["sequences"][0]["unreadable"][0]["scan"], 3);
}

#[test]
fn what_can_not_be_read_is_never_left_out_of_a_copy() {
    for sensor in ["radar_front", "lidar_top", "camera_front"] {
        let bag = Bag::new();
        bag.damage(sensor, &[1]);
        bag.convert("copy")
            .exits(1)
            .prints_nothing()
            .says([&format!("error: {sensor}, measurement 1: "), &bag.file]);
        assert!(!fs::exists(bag.dataset.beside("copy/sequences/drive")).unwrap());
    }
}

#[test]
fn a_radar_of_which_nothing_can_be_read_is_named_as_a_whole() {
    let bag = Bag::new();
    bag.damage("radar_left", &[0, 1, 2, 3, 4, 5, 6, 7]);
    let ran = bag.label("out", "1").exits(3);
    let [only] = ran.not_labelled()[..] else { panic!("{}", ran.stderr) };
    assert!(only.starts_with("drive: radar_left: none of its 8 messages can be read; the first: "), "{only}");
    let again = bag.label("out", "1").exits(3).says(["nothing to do"]);
    assert_eq!(again.not_labelled(), [only]);
    assert_eq!(rows(bag.result("out", "sequences/drive/plausibility.parquet")).len(), 8 * 26);
    bag.convert("copy.mcap").exits(1).says(["error: drive: content: radar_left: none of its 8 messages"]);
    assert!(!fs::exists(bag.dataset.beside("copy.mcap")).unwrap());
}

#[test]
fn lidar_scans_images_and_calibrations_that_can_not_be_read_cost_no_radar_scan() {
    let bag = Bag::new();
    bag.damage("lidar_top", &[0]);
    bag.damage("camera_front", &[0]);
    let told = ["labelled without: drive lidar_top scan 0: "];
    assert!(bag.label("out", "1").exits(0).says(told).not_labelled().is_empty());
    let looked = bag.inspect().exits(0).json();
    let sensors = looked["sequences"][0]["sensors"].as_array().unwrap();
    assert!(
        sensors.iter().any(|sensor| sensor["name"] == "camera_front" && sensor["count"] == 3),
        "{sensors:?}"
    );
}

/// The tree of frames lies in the only chunk: nothing can be placed without it.
#[test]
fn a_cause_is_told_once_and_json_is_an_object_or_nothing() {
    let dataset = Dataset::new();
    let (file, settings) = (dataset.beside("drive.mcap"), dataset.beside("drive.toml"));
    ralf(["convert", &dataset.path, "-o", &file, "-q"]).exits(0);
    let mut bytes = fs::read(&file).unwrap();
    bytes[2000] ^= 0xff;
    fs::write(&file, bytes).unwrap();
    let out = dataset.beside("out");
    for arguments in [
        vec!["label", &file, "-o", &out, "--config", &settings, "-q"],
        vec!["inspect", &file, "--topics", &settings, "--json"],
    ] {
        let ran = Ran::of(&program().args(arguments).output().unwrap()).exits(1).prints_nothing();
        assert!(
            ran.stderr.matches("chunk 0 (at byte").count() == 1 && ran.stderr.len() < 500,
            "{}",
            ran.stderr
        );
    }
}

#[test]
fn a_radar_file_that_is_missing_beside_others_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let scenes = folder.path().join("scenes");
    nuscenes(&scenes);
    let path = scenes.to_str().unwrap();
    let beside = |name: &str| format!("{path}-{name}");
    let label = || ralf(["label", path, "-o", &beside("out"), "-q", "--no-check"]);
    let radar = |scan: usize| scenes.join(format!("samples/RADAR_FRONT/{scan}.pcd"));
    fs::remove_file(radar(2)).unwrap();
    let ran = label().exits(3);
    let [only] = ran.not_labelled()[..] else { panic!("{}", ran.stderr) };
    let expected = "samples/RADAR_FRONT/2.pcd: expected a regular file, found none of this name";
    assert_eq!(only, format!("scene-0001 RADAR_FRONT scan 2: {expected}"));
    assert_eq!(label().exits(3).says(["nothing to do"]).not_labelled(), [only]);
    ralf(["convert", path, "-o", &beside("copy"), "-q"])
        .exits(1)
        .says(["RADAR_FRONT, measurement 2: ", expected]);
    // What is labelled and the recording still belong together.
    ralf(["plot", path, &beside("out"), "--scan", "1", "-o", &beside("scan.png")]).exits(0);
    // A part of the data set without this radar is what somebody has chosen; here it was the only one.
    (0..5).filter(|scan| *scan != 2).for_each(|scan| fs::remove_file(radar(scan)).unwrap());
    let told = [
        "5 of 5 files of RADAR_FRONT are not there and were left out",
        "radars: expected at least one scan to label, found none",
    ];
    label().exits(1).says(told);
}
