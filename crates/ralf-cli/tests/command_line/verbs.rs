//! Every verb on every kind of recording.

use crate::support::{Dataset, ROS_TOPICS, Shape, nuscenes, program, ralf, view_of_delft};
use ralf_corrections::{Mark, ScanKey, Store, Who};
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::Stdio;
use tempfile::TempDir;

/// A recording, and where results go.
struct Format {
    place: TempDir,
    dataset: String,
    sequence: &'static str,
    radar: &'static str,
}

impl Format {
    fn new(dataset: impl FnOnce(&Path) -> String, sequence: &'static str, radar: &'static str) -> Self {
        let place = tempfile::tempdir().unwrap();
        fs::write(place.path().join("topics.toml"), ROS_TOPICS).unwrap();
        let dataset = dataset(place.path());
        Self { place, dataset, sequence, radar }
    }

    fn ros(name: &'static str) -> Self {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/ros").join(name);
        let copied = move |place: &Path| {
            let to = place.join(name);
            if file.is_dir() {
                fs::create_dir(&to).unwrap();
                for entry in fs::read_dir(&file).unwrap() {
                    let entry = entry.unwrap();
                    fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
                }
            } else {
                fs::copy(&file, &to).unwrap();
            }
            to.to_str().unwrap().to_owned()
        };
        Self::new(copied, name.split('.').next().unwrap(), "radar")
    }

    fn beside(&self, name: &str) -> String {
        self.place.path().join(name).to_str().unwrap().to_owned()
    }

    /// Runs a verb: `DATASET`, `OUT`, `TOPICS` and `NEW/...` stand for places.
    fn run(&self, line: &str) -> Result<(), String> {
        let words = line.split(' ').map(|word| match word {
            "DATASET" => self.dataset.clone(),
            "OUT" => self.beside("out"),
            "TOPICS" => self.beside("topics.toml"),
            word => word.strip_prefix("NEW/").map_or_else(|| word.to_owned(), |name| self.beside(name)),
        });
        let ran = program().args(words).output().unwrap();
        let told = String::from_utf8_lossy(&ran.stderr).into_owned();
        if ran.status.success() { Ok(()) } else { Err(told) }
    }

    /// Accepts the machine's labels, so that there is something to compare with.
    fn review(&self) {
        let out = self.beside("out");
        let mut store = Store::open(&Path::new(&out).join("corrections.sqlite")).unwrap();
        let who = Who::named("ada");
        for scan in 0..3 {
            let file = Path::new(&out).join("sequences").join(self.sequence).join(self.radar);
            let bytes = fs::read(file.join(format!("{scan:06}.label"))).unwrap();
            let machine =
                bytes.as_chunks::<4>().0.iter().map(|[low, high, ..]| u16::from_le_bytes([*low, *high]));
            let key = ScanKey { sequence: self.sequence.into(), radar: self.radar.into(), scan };
            let mark = Mark { key, content: None, base: 0, machine: machine.collect(), reviewed: true };
            store.mark(&mark, &who).unwrap();
        }
    }

    /// Starts the review page, and ends it.
    fn serve(&self) -> Result<(), String> {
        let mut command = program();
        command.args(["review", &self.dataset, &self.beside("out"), "--port", "0"]);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut url = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut url).unwrap();
        if url.starts_with("http://") {
            child.kill().unwrap();
            child.wait().unwrap();
            return Ok(());
        }
        let ended = child.wait_with_output().unwrap();
        Err(String::from_utf8_lossy(&ended.stderr).into_owned())
    }
}

fn own(place: &Path) -> String {
    let made = Dataset::of(&Shape::default());
    let to = place.join("own");
    fs::rename(&made.path, &to).unwrap();
    to.to_str().unwrap().to_owned()
}

/// In the order of a first day with a recording. What tunes wants two sequences, and a bag is one.
const VERBS: [&str; 15] = [
    "inspect DATASET --topics TOPICS",
    "check DATASET --topics TOPICS",
    "label DATASET -o OUT --topics TOPICS -q",
    "inspect OUT",
    "evaluate OUT",
    "evaluate OUT --truth DATASET",
    "plot DATASET OUT --scan 1 -o NEW/scan.png",
    "report DATASET OUT -o NEW/report.html",
    "export DATASET OUT --to parquet -o NEW/parquet",
    "export DATASET OUT --to pcd --sensors -o NEW/pcd",
    "export DATASET OUT --to mcap --sensors -o NEW/mcap",
    "export DATASET OUT --to rosbag1 -o NEW/bags",
    "convert DATASET --topics TOPICS -o NEW/converted",
    "convert DATASET --topics TOPICS -o NEW/t.mcap",
    "convert DATASET --topics TOPICS -o NEW/t.bag",
];

#[test]
fn every_verb_works_on_every_kind_of_recording() {
    let made = |make: fn(&Path)| {
        move |place: &Path| {
            make(&place.join("made"));
            place.join("made").to_str().unwrap().to_owned()
        }
    };
    let formats = [
        Format::new(own, "00", "radar_front"),
        Format::new(made(nuscenes), "scene-0001", "RADAR_FRONT"),
        Format::new(made(view_of_delft), "training", "radar"),
        Format::ros("plain.bag"),
        Format::ros("zstd.mcap"),
        Format::ros("db3"),
        Format::ros("folder"),
    ];
    let mut failures = String::new();
    for format in &formats {
        for verb in VERBS {
            if let Err(told) = format.run(verb) {
                failures += &format!("{}: ralf {verb}\n{told}\n", format.dataset);
            }
            if verb.starts_with("label") {
                format.review();
                if let Err(told) = format.serve() {
                    failures += &format!("{}: ralf review\n{told}\n", format.dataset);
                }
            }
        }
    }
    assert!(failures.is_empty(), "{failures}");
}

#[test]
fn what_is_converted_to_two_files_of_one_name_has_settings_for_each() {
    let dataset = Dataset::new();
    let folder = Path::new(&dataset.path).parent().unwrap();
    for name in ["t.mcap", "t.bag"] {
        ralf(["convert", &dataset.path, "-o", &dataset.beside(name)]).exits(0);
    }
    ralf([
        "label",
        &dataset.beside("t.bag"),
        "-o",
        &dataset.out,
        "--config",
        &dataset.beside("t.bag.toml"),
        "-q",
    ])
    .exits(0);
    assert!(folder.join("t.toml").is_file());
    ralf(["convert", &dataset.path, "-o", &dataset.beside("t.bag")]).exits(1).says(["none of this name yet"]);
}

/// Between the two files a conversion may be killed.
#[test]
fn settings_that_a_killed_conversion_left_are_taken_over() {
    let dataset = Dataset::new();
    let convert = || ralf(["convert", "-q", &dataset.path, "-o", &dataset.beside("q.mcap")]).exits(0);
    convert();
    std::fs::remove_file(dataset.beside("q.mcap")).unwrap();
    convert();
    assert!(Path::new(&dataset.beside("q.toml")).is_file());
    assert!(!Path::new(&dataset.beside("q.mcap.toml")).exists());
}

#[cfg(unix)]
#[test]
fn a_pipe_in_the_place_of_settings_is_left_alone() {
    let dataset = Dataset::new();
    let pipe = dataset.beside("q.toml");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    ralf(["convert", "-q", &dataset.path, "-o", &dataset.beside("q.mcap")]).exits(0);
    assert!(Path::new(&dataset.beside("q.mcap.toml")).is_file());
    assert!(!Path::new(&pipe).is_file());
}
