//! The review page, by its own tests and in a real browser: there, a recording is simulated and labelled, errors are
//! planted into the labels, and `crates/ralf-review/web/tests/browser` does what a person would do. Needs Node.js, npm
//! and Chromium.

use ralf::label::{ARTIFACT, PLAUSIBLE};
use ralf_data::result::{
    FileRecord, PlausibilityReader, PlausibilityWriter, RadarScanKey, Schema, Table, Values,
};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

const PROGRAM: &str = env!("CARGO_BIN_EXE_ralf");
const WEB: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../ralf-review/web");
/// Every so many scans of a radar hold a planted error.
const EVERY: usize = 2;
/// A click must mean one detection alone, m.
const ALONE: f32 = 1.5;
/// The bird's eye shows this much to each side, m.
const SEEN: f32 = 38.0;

#[test]
fn the_page_has_types_and_unit_tests_that_hold() {
    let Some(page) = installed_page() else { return };
    for script in ["check", "test"] {
        succeeds(Command::new("npm").args(["run", script]).current_dir(page));
    }
}

#[test]
fn people_correct_labels_in_a_browser() {
    let Some(chromium) = chromium() else { return println!("skipped: no Chromium was found") };
    let Some(page) = installed_page() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [dataset, out] = ["recording", "labels"].map(|name| folder.path().join(name));
    let [recording, labels] = [&dataset, &out].map(|path| path.to_str().unwrap());
    ralf(&["simulate", "-o", recording, "--preset", "tiny", "--scans", "4", "--quiet"]);
    ralf(&["label", recording, "-o", labels, "--quiet"]);
    let planted = folder.path().join("planted.json");
    fs::write(&planted, Value::from(plant(&dataset, &out)).to_string()).unwrap();
    let mut tests = Command::new("node");
    tests
        .args(["--test", "--test-concurrency=1", "--test-reporter=tap", "tests/browser"])
        .current_dir(page)
        .env("RALF_PROGRAM", PROGRAM)
        .env("RALF_DATASET", &dataset)
        .env("RALF_OUT", &out)
        .env("RALF_PLANTED", &planted)
        .env("RALF_CHROMIUM", chromium);
    succeeds(&mut tests);
}

#[track_caller]
fn succeeds(command: &mut Command) {
    let ran = command.output().unwrap();
    let said = String::from_utf8_lossy(&ran.stdout);
    println!("{said}");
    assert!(ran.status.success(), "{said}{}", String::from_utf8_lossy(&ran.stderr));
}

fn ralf(arguments: &[&str]) {
    succeeds(Command::new(PROGRAM).args(arguments));
}

fn chromium() -> Option<PathBuf> {
    // That without windows is the same engine and takes a third less time.
    let names =
        ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|file| file.is_file())
}

fn runs(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|ran| ran.status.success())
}

/// The page's sources and tests with their packages, beside the build's outputs. Says why it was skipped where it's
/// `None`.
fn installed_page() -> Option<&'static Path> {
    static PAGE: OnceLock<Result<PathBuf, String>> = OnceLock::new();
    match PAGE.get_or_init(install) {
        Ok(folder) => Some(folder),
        Err(missing) => {
            println!("skipped: {missing}");
            None
        }
    }
}

fn install() -> Result<PathBuf, String> {
    if !runs("node") || !runs("npm") {
        return Err("Node.js with npm was not found".into());
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("review-page");
    for part in ["src", "tests"] {
        let _absent_at_first = fs::remove_dir_all(folder.join(part));
    }
    copy(Path::new(WEB), &folder);
    let lock = fs::read(folder.join("package-lock.json")).unwrap();
    let done = folder.join("installed-lock.json");
    if fs::read(&done).ok().as_ref() == Some(&lock) {
        return Ok(folder);
    }
    let npm = ["ci", "--no-audit", "--no-fund", "--ignore-scripts"];
    let ran = Command::new("npm").args(npm).current_dir(&folder).output().unwrap();
    if !ran.status.success() {
        return Err(format!("`npm ci` failed: {}", String::from_utf8_lossy(&ran.stderr)));
    }
    fs::write(done, lock).unwrap();
    Ok(folder)
}

/// Copies the page without what npm and builds leave there.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name();
        if ["node_modules", "dist", "dist-tests"].iter().any(|made| name == *made) {
            continue;
        }
        if entry.path().is_dir() {
            copy(&entry.path(), &to.join(name));
        } else {
            fs::copy(entry.path(), to.join(name)).unwrap();
        }
    }
}

/// Flips labels in OUT, each of a detection that lies alone, and says where, with the right labels.
fn plant(dataset: &Path, out: &Path) -> Vec<Value> {
    let recording = ralf_data::open(dataset, None).unwrap();
    let mut planted = Vec::new();
    for reader in &recording.sequences {
        let sequence = reader.sequence();
        let schema = Schema::of(&sequence.rig, &[]).unwrap();
        let file = out.join("sequences").join(&sequence.name).join("plausibility.parquet");
        let tables = all_tables(&PlausibilityReader::open(&file, &schema).unwrap());
        let mut writer = PlausibilityWriter::create(&file, &schema.into()).unwrap();
        for (key, table) in tables {
            let mut labels = table.get::<u8>("label").unwrap().to_vec();
            if key.scan % EVERY == 0 {
                for point in lonely(&table) {
                    let right = if labels[point] == 1 { PLAUSIBLE } else { ARTIFACT };
                    labels[point] ^= 1;
                    let radar = key.radar.as_ref();
                    planted.push(json!({"radar": radar, "scan": key.scan, "point": point, "label": right}));
                }
            }
            writer.append(&key, &with_labels(&table, labels)).unwrap();
        }
        record(out, &sequence.name, &writer.finish().unwrap());
    }
    planted
}

/// The same table with other labels.
fn with_labels(table: &Table, labels: Vec<u8>) -> Table {
    let values = table.columns().map(|(column, values)| match column.name.as_ref() {
        "label" => Values::U8(labels.clone()),
        _ => values.clone(),
    });
    Table::new(table.schema().clone(), values.collect()).unwrap()
}

/// Tells run.json of the table that a sequence has now.
fn record(out: &Path, sequence: &str, table: &FileRecord) {
    let file = out.join("run.json");
    let mut run: Value = serde_json::from_slice(&fs::read(&file).unwrap()).unwrap();
    let sequences = run["sequences"].as_array_mut().unwrap();
    let found = sequences.iter_mut().find(|found| found["name"] == sequence).unwrap();
    found["table"] = json!({ "bytes": table.bytes, "blake3": table.blake3 });
    fs::write(&file, run.to_string()).unwrap();
}

fn all_tables(reader: &PlausibilityReader) -> BTreeMap<RadarScanKey, Table> {
    (0..reader.groups()).flat_map(|group| reader.tables(group).unwrap()).collect()
}

/// Two detections in sight that no other of the scan is near.
fn lonely(table: &Table) -> Vec<usize> {
    let (x, y) = (table.get::<f32>("x").unwrap(), table.get::<f32>("y").unwrap());
    let alone = |point: usize| {
        (0..table.len())
            .all(|other| other == point || (x[point] - x[other]).hypot(y[point] - y[other]) > ALONE)
    };
    (0..table.len())
        .filter(|point| x[*point].abs() < SEEN && y[*point].abs() < SEEN && alone(*point))
        .take(2)
        .collect()
}
