//! A program that is killed while it writes: every stroke that it told of is there, and none is there by half.
use ralf_corrections::{
    Outcome, ScanContent, ScanEdit, ScanKey, ScanVersion, Store, Stroke, Who, read_layer,
};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

const CHILD: &str = "RALF_CORRECTIONS_TEST_STORE";
const TOLD: &str = "told ";
const POINTS: u32 = 400;
/// A thing is seen in several scans, and labelled by one stroke.
const SCANS: u32 = 3;
const CHANGED: u64 = (SCANS * POINTS) as u64;

fn who() -> Who {
    Who::named("ada")
}

/// Stroke `n` labels all detections of the `n`-th scans.
fn write_stroke(store: &mut Store, n: u32) {
    let edit = |scan| {
        let points = (0..POINTS).collect();
        ScanEdit { radar: "front".into(), scan, detections: POINTS, content: None, base: 0, points }
    };
    let scans = (n * SCANS..(n + 1) * SCANS).map(edit).collect();
    let stroke = Stroke { tool: "thing".into(), label: Some(99), scans, ..Stroke::of_sequence("00") };
    let outcome = store.apply(&stroke, &who()).unwrap();
    assert!(matches!(outcome, Outcome::Done(done) if done.changed == CHANGED));
}

/// Not a test by itself: what the child does until it is killed.
#[test]
fn child() {
    let Some(file) = std::env::var_os(CHILD).map(PathBuf::from) else { return };
    let mut store = Store::open(&file).unwrap();
    let first = store.history("00", "ada").unwrap().undo_depth as u32;
    for n in first.. {
        write_stroke(&mut store, n);
        let mut out = std::io::stdout().lock();
        writeln!(out, "{TOLD}{n}").and_then(|()| out.flush()).unwrap();
    }
}

fn start(file: &Path) -> Child {
    let mut command = Command::new(std::env::current_exe().unwrap());
    let command = command.args(["--exact", "killed::child", "--nocapture"]).env(CHILD, file);
    command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap()
}

/// Kills a child after it told of so many strokes; returns the last that it told of.
fn kill_after(file: &Path, strokes: usize) -> u32 {
    let mut child = start(file);
    let lines = BufReader::new(child.stdout.take().unwrap()).lines().map(Result::unwrap);
    // The harness writes on the same line before the first stroke.
    let mut told = lines.filter_map(|line| line.split_once(TOLD)?.1.parse().ok());
    let mut last = told.by_ref().take(strokes).last().unwrap();
    child.kill().unwrap();
    // It may have told of more before the signal came.
    last = told.last().unwrap_or(last);
    child.wait().unwrap();
    last
}

#[test]
fn a_stroke_that_was_told_is_there_and_none_by_half() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("corrections.sqlite");
    for strokes in [1, 7, 20] {
        let told = kill_after(&file, strokes);
        let layer = read_layer(&file).unwrap();
        let there = layer.len() as u32 / SCANS;
        assert_eq!(layer.len() as u32 % SCANS, 0, "a stroke of which some scans lack");
        assert!(there == told + 1 || there == told + 2, "told of {told}, found {there} strokes");
        for (n, (key, scans)) in (0..).zip(&layer) {
            assert_eq!((key.scan, scans[0].corrections.len()), (n, POINTS as usize));
        }
        let mut store = Store::open(&file).unwrap();
        assert_eq!(store.history("00", "ada").unwrap().undo_depth, u64::from(there));
        let undone = store.undo("00", &who()).unwrap();
        assert!(matches!(undone, Outcome::Done(edit) if edit.changed == CHANGED));
        let key = ScanKey { sequence: "00".into(), radar: "front".into(), scan: there * SCANS - 1 };
        let last = ScanVersion { key, content: ScanContent { detections: POINTS, hash: None } };
        assert_eq!(store.scan(&last).unwrap().corrections, []);
        assert!(matches!(store.redo("00", &who()).unwrap(), Outcome::Done(edit) if edit.changed == CHANGED));
    }
}
