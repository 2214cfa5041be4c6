//! The review page in a real browser: a recording is simulated and labelled, errors are planted into the labels, and
//! `crates/ralf-review/web/tests/browser` does what a person would do. Needs Node.js, npm and Chromium.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "these are tests")]

use ralf::label::{ARTIFACT, PLAUSIBLE};
use ralf_data::output::{Columns, PlausibilityReader, PlausibilityWriter, ScanTable, ScanTables};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const PROGRAM: &str = env!("CARGO_BIN_EXE_ralf");
const WEB: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../ralf-review/web");
/// Every so many scans of a radar hold a planted error.
const EVERY: usize = 2;
/// A click must mean one detection alone, m.
const ALONE: f32 = 1.5;
/// The bird's eye shows this much to each side, m.
const SEEN: f32 = 38.0;

#[test]
fn people_correct_labels_in_a_browser() {
    let Some(chromium) = chromium() else { return println!("skipped: no Chromium was found") };
    if !runs("node") || !runs("npm") {
        return println!("skipped: Node.js with npm was not found");
    }
    let Some(tests) = installed_tests() else { return println!("skipped: `npm ci` failed, see above") };
    let folder = tempfile::tempdir().unwrap();
    let [dataset, out] = ["recording", "labels"].map(|name| folder.path().join(name));
    let [recording, labels] = [&dataset, &out].map(|path| path.to_str().unwrap());
    ralf(&["simulate", "-o", recording, "--preset", "tiny", "--scans", "4", "--quiet"]);
    ralf(&["label", recording, "-o", labels, "--quiet"]);
    let planted = folder.path().join("planted.json");
    fs::write(&planted, Value::from(plant(&dataset, &out)).to_string()).unwrap();
    let ran = Command::new("node")
        .args(["--test", "--test-concurrency=1", "--test-reporter=tap", "tests/browser"])
        .current_dir(tests)
        .env("RALF_PROGRAM", PROGRAM)
        .env("RALF_DATASET", &dataset)
        .env("RALF_OUT", &out)
        .env("RALF_PLANTED", &planted)
        .env("RALF_CHROMIUM", chromium)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&ran.stdout);
    println!("{said}");
    assert!(ran.status.success(), "{said}{}", String::from_utf8_lossy(&ran.stderr));
}

fn ralf(arguments: &[&str]) {
    let ran = Command::new(PROGRAM).args(arguments).output().unwrap();
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
}

fn chromium() -> Option<PathBuf> {
    let names = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|file| file.is_file())
}

fn runs(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|ran| ran.status.success())
}

/// The browser tests with their packages, beside the build's outputs; `None` where they could not be installed.
fn installed_tests() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("review-page");
    let tests = folder.join("tests/browser");
    fs::create_dir_all(&tests).unwrap();
    let lock = fs::read(Path::new(WEB).join("package-lock.json")).unwrap();
    let done = folder.join("installed-lock.json");
    for name in ["package.json", "package-lock.json"] {
        fs::copy(Path::new(WEB).join(name), folder.join(name)).unwrap();
    }
    for entry in fs::read_dir(Path::new(WEB).join("tests/browser")).unwrap() {
        let entry = entry.unwrap();
        fs::copy(entry.path(), tests.join(entry.file_name())).unwrap();
    }
    if fs::read(&done).ok().as_ref() == Some(&lock) {
        return Some(folder);
    }
    let ran = Command::new("npm")
        .args(["ci", "--no-audit", "--no-fund", "--ignore-scripts"])
        .current_dir(&folder)
        .output()
        .unwrap();
    println!("{}", String::from_utf8_lossy(&ran.stderr));
    ran.status.success().then(|| {
        fs::write(done, lock).unwrap();
        folder
    })
}

/// Flips labels in OUT, each of a detection that lies alone, and says where, with the right labels.
fn plant(dataset: &Path, out: &Path) -> Vec<Value> {
    let recording = ralf_data::open(dataset, None).unwrap();
    let mut planted = Vec::new();
    for reader in &recording.sequences {
        let sequence = reader.sequence();
        let columns = Columns::of(&sequence.rig).unwrap();
        let file = out.join("sequences").join(&sequence.name).join("plausibility.parquet");
        let tables = all_tables(&PlausibilityReader::open(&file, columns.clone()).unwrap());
        let mut writer = PlausibilityWriter::create(&file, &columns).unwrap();
        for ((radar, scan), mut table) in tables {
            if scan % EVERY == 0 {
                for point in lonely(&table) {
                    let right = if table.label[point] == 1 { PLAUSIBLE } else { ARTIFACT };
                    table.label[point] ^= 1;
                    planted.push(json!({"radar": radar, "scan": scan, "point": point, "label": right}));
                }
            }
            writer.append(&radar, scan, &table).unwrap();
        }
        writer.finish().unwrap();
    }
    planted
}

fn all_tables(reader: &PlausibilityReader) -> ScanTables {
    (0..reader.groups()).flat_map(|group| reader.tables(group).unwrap()).collect()
}

/// Two detections in sight that no other of the scan is near. `x`, `y` are the first two decimal columns.
fn lonely(table: &ScanTable) -> Vec<usize> {
    let (x, y) = (&table.decimals[0], &table.decimals[1]);
    let alone = |point: usize| {
        (0..table.len())
            .all(|other| other == point || (x[point] - x[other]).hypot(y[point] - y[other]) > ALONE)
    };
    (0..table.len())
        .filter(|point| x[*point].abs() < SEEN && y[*point].abs() < SEEN && alone(*point))
        .take(2)
        .collect()
}
