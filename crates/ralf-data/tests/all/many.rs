//! Recordings that several machines label in parts: nothing tells their results from one machine's.

use ralf_data::many::{Job, Task, assemble, folders, label_one, plan, planned};
use ralf_data::run::{Earlier, Observer, Unwatched};
use ralf_data::{DataError, Settings, write_sequence};
use std::collections::BTreeMap;
use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

const ONE: NonZeroUsize = NonZeroUsize::MIN;

/// Wants the work to end after so many scans.
struct Impatient(AtomicUsize);

impl Observer for Impatient {
    fn advance(&self, _: u64, detections: u64) {
        if detections > 0 {
            let _ = self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1));
        }
    }
    fn stopped(&self) -> bool {
        self.0.load(Ordering::Relaxed) == 0
    }
}

/// A simulated recording of one short sequence, on disk.
fn recording(folder: &Path, seed: u64) -> PathBuf {
    let sequence = ralf_sim::presets::find("tiny").unwrap().sequences[0].simulate(seed, 3).unwrap();
    let dataset = folder.join(format!("drive-{seed}"));
    write_sequence(&sequence, &dataset, &|_| ()).unwrap();
    dataset
}

fn job(recording: &Path, out: &Path) -> Job {
    Job { check: false, ..Job::new(recording, out) }
}

fn scans(count: usize) -> NonZeroUsize {
    NonZeroUsize::new(count).unwrap()
}

#[test]
fn a_model_is_refused_where_none_is_asked() {
    let folder = tempfile::tempdir().unwrap();
    let (dataset, out) = (recording(folder.path(), 1), folder.path().join("out"));
    let job = Job { model: Some("nosuch.txt".into()), ..job(&dataset, &out) };
    let error = job.label(ONE, &Unwatched).unwrap_err().to_string();
    let told =
        "nosuch.txt: model: expected the method that asks a model (method = \"learned\"), found the paper's";
    assert_eq!(error, told);
    assert!(!out.exists());
}

/// Wants the work to end once it knows what became of earlier results.
#[derive(Default)]
struct Shocked(Mutex<Vec<String>>);

impl Observer for Shocked {
    fn found(&self, earlier: &Earlier) {
        self.0.lock().unwrap().extend(earlier.told(Earlier::NOW));
    }
    fn stopped(&self) -> bool {
        !self.0.lock().unwrap().is_empty()
    }
}

#[test]
fn labels_that_are_gone_are_told_of_before_anything_is_labelled() {
    let folder = tempfile::tempdir().unwrap();
    let (dataset, out) = (recording(folder.path(), 1), folder.path().join("out"));
    let mut job = job(&dataset, &out);
    job.label(ONE, &Unwatched).unwrap();
    job.settings.method.fusion.threshold = 0.9;
    let shocked = Shocked::default();
    let error = job.label(ONE, &shocked).unwrap_err();
    assert!(matches!(error, DataError::Stopped), "{error}");
    let told = shocked.0.into_inner().unwrap();
    assert!(told.len() == 1 && told[0].contains("for they were made by another version"), "{told:?}");
}

/// All files below a folder; of `run.json` all but the timings, and not the plan.
fn content(out: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![out.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path.strip_prefix(out).unwrap().to_owned();
            let mut bytes = fs::read(&path).unwrap();
            if name == Path::new("run.json") {
                let mut record: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
                record.as_object_mut().unwrap().remove("timings").unwrap();
                bytes = record.to_string().into_bytes();
            }
            found.insert(name, bytes);
        }
    }
    found.remove(Path::new("plan.json"));
    found
}

#[test]
fn parts_in_any_order_and_twice_make_what_one_machine_makes() {
    let root = tempfile::tempdir().unwrap();
    let drive = recording(root.path(), 1);
    let (whole, parts) = (root.path().join("whole"), root.path().join("parts"));
    job(&drive, &whole).label(ONE, &Unwatched).unwrap();
    let mut tasks = plan(&job(&drive, &parts), scans(5), ONE, &Unwatched).unwrap().tasks;
    assert!(tasks.len() > 1, "{}", tasks.len());
    tasks.reverse();
    // They cross to other machines as text.
    let text = serde_json::to_string(&tasks).unwrap();
    let tasks: Vec<Task> = serde_json::from_str(&text).unwrap();
    std::thread::scope(|scope| {
        for half in [&tasks[..], &tasks[tasks.len() / 2..]] {
            scope.spawn(move || {
                half.iter()
                    .for_each(|task| assert_eq!(label_one(task, ONE, &Unwatched).unwrap().not_labelled, []))
            });
        }
    });
    assert_eq!(planned(root.path()).unwrap(), std::slice::from_ref(&parts));
    let done = assemble(&parts, ONE, &Unwatched).unwrap();
    assert_eq!(done.labelled.len(), 1);
    assert!(content(&parts) == content(&whole));
    // What is done is not planned again, and a task that comes late does nothing.
    assert_eq!(plan(&job(&drive, &parts), scans(5), ONE, &Unwatched).unwrap().tasks, []);
    assert_eq!(label_one(&tasks[0], ONE, &Unwatched).unwrap().not_labelled, []);
    assert!(content(&parts) == content(&whole));
}

#[test]
fn a_part_that_was_lost_is_labelled_when_all_is_put_together() {
    let root = tempfile::tempdir().unwrap();
    let drive = recording(root.path(), 1);
    let (whole, parts) = (root.path().join("whole"), root.path().join("parts"));
    job(&drive, &whole).label(ONE, &Unwatched).unwrap();
    let tasks = plan(&job(&drive, &parts), scans(5), ONE, &Unwatched).unwrap().tasks;
    let stopped = label_one(&tasks[0], ONE, &Impatient(AtomicUsize::new(2))).unwrap_err();
    assert!(matches!(stopped, DataError::Stopped), "{stopped}");
    let kept = content(&parts).into_keys().filter(|name| name.extension().is_some_and(|end| end == "label"));
    assert_eq!(kept.count(), 2);
    assemble(&parts, ONE, &Unwatched).unwrap();
    assert!(content(&parts) == content(&whole));
}

#[test]
fn a_run_that_is_stopped_keeps_what_it_has_done() {
    let root = tempfile::tempdir().unwrap();
    let drive = recording(root.path(), 1);
    let (whole, out) = (root.path().join("whole"), root.path().join("out"));
    job(&drive, &whole).label(ONE, &Unwatched).unwrap();
    let stopped = job(&drive, &out).label(ONE, &Impatient(AtomicUsize::new(3))).unwrap_err();
    assert!(matches!(stopped, DataError::Stopped), "{stopped}");
    assert!(!out.join("run.json").exists());
    job(&drive, &out).label(ONE, &Unwatched).unwrap();
    assert!(content(&out) == content(&whole));
}

/// What changes between plan and result counts as it is then.
#[test]
fn a_recording_that_changes_after_its_plan_is_labelled_as_it_is() {
    let root = tempfile::tempdir().unwrap();
    let drive = recording(root.path(), 1);
    let parts = root.path().join("parts");
    let tasks = plan(&job(&drive, &parts), scans(1000), ONE, &Unwatched).unwrap().tasks;
    label_one(&tasks[0], ONE, &Unwatched).unwrap();
    let file = first_radar_file(&drive);
    let bytes = fs::read(&file).unwrap();
    fs::write(&file, &bytes[..bytes.len() / 2 / 32 * 32]).unwrap();
    assemble(&parts, ONE, &Unwatched).unwrap();
    let whole = root.path().join("whole");
    job(&drive, &whole).label(ONE, &Unwatched).unwrap();
    assert!(content(&parts) == content(&whole));
}

fn first_radar_file(drive: &Path) -> PathBuf {
    let sequence = fs::read_dir(drive.join("sequences")).unwrap().next().unwrap().unwrap().path();
    let radar = fs::read_dir(&sequence).unwrap().map(|entry| entry.unwrap().path());
    let radar =
        radar.filter(|path| path.file_name().unwrap().to_string_lossy().starts_with("radar")).min().unwrap();
    fs::read_dir(radar)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().unwrap() == "bin")
        .min()
        .unwrap()
}

#[test]
fn what_nobody_planned_is_refused() {
    let root = tempfile::tempdir().unwrap();
    let drive = recording(root.path(), 1);
    let [parts, other] = ["parts", "other"].map(|name| root.path().join(name));
    let tasks = plan(&job(&drive, &parts), scans(5), ONE, &Unwatched).unwrap().tasks;
    let with = |change: &dyn Fn(&mut Task)| {
        let mut task = tasks[0].clone();
        change(&mut task);
        label_one(&task, ONE, &Unwatched).unwrap_err().to_string()
    };
    let elsewhere = with(&|task| task.job.out.clone_from(&other));
    assert!(elsewhere.contains("plan again"), "{elsewhere}");
    let changed = Settings::from_toml("", &["lidar.beta=0.125"]).unwrap();
    let changed = with(&|task| task.job.settings = changed.clone());
    assert!(changed.contains("plan again"), "{changed}");
    let unknown = with(&|task| task.stretch.sequence = "99".into());
    assert!(unknown.contains("no sequence `99`"), "{unknown}");
    let nothing = assemble(&other, ONE, &Unwatched).unwrap_err().to_string();
    assert!(nothing.contains("plan.json"), "{nothing}");
    let beside = plan(&job(&drive, &drive), scans(5), ONE, &Unwatched).unwrap_err().to_string();
    assert!(beside.contains("outside the recording") && !drive.join("plan.json").exists(), "{beside}");
}

/// Plans the same recording with other settings while a part of it is labelled.
struct Meanwhile<'a>(&'a Path, &'a Path);

impl Observer for Meanwhile<'_> {
    fn advance(&self, _: u64, _: u64) {
        let before = fs::read(self.1.join("plan.json")).unwrap();
        let other = Settings::from_toml("", &["lidar.beta=0.125"]).unwrap();
        let job = Job { settings: other, ..job(self.0, self.1) };
        let error = plan(&job, scans(5), ONE, &Unwatched).unwrap_err().to_string();
        assert!(error.contains("another run"), "{error}");
        assert_eq!(fs::read(self.1.join("plan.json")).unwrap(), before);
    }
}

#[test]
fn a_plan_that_is_refused_while_others_work_leaves_theirs_as_it_is() {
    let root = tempfile::tempdir().unwrap();
    let drive = recording(root.path(), 1);
    let out = root.path().join("out");
    let tasks = plan(&job(&drive, &out), scans(5), ONE, &Unwatched).unwrap().tasks;
    assert_eq!(label_one(&tasks[0], ONE, &Meanwhile(&drive, &out)).unwrap().not_labelled, []);
    assert_eq!(assemble(&out, ONE, &Unwatched).unwrap().labelled.len(), 1);
}

/// The reason of a recording that can't be opened is told when it is planned, and again when all is put together.
#[test]
fn a_damaged_recording_is_named() {
    let root = tempfile::tempdir().unwrap();
    let drive = recording(root.path(), 1);
    let out = root.path().join("out");
    fs::write(
        fs::read_dir(drive.join("sequences")).unwrap().next().unwrap().unwrap().path().join("sequence.toml"),
        "[[",
    )
    .unwrap();
    let first = plan(&job(&drive, &out), scans(5), ONE, &Unwatched).unwrap_err().to_string();
    assert!(first.contains("sequence.toml"), "{first}");
    assert_eq!(planned(&out).unwrap(), std::slice::from_ref(&out));
    assert_eq!(assemble(&out, ONE, &Unwatched).unwrap_err().to_string(), first);
}

#[test]
fn every_recording_has_a_folder_of_its_name() {
    let paths = |names: &[&str]| names.iter().map(PathBuf::from).collect::<Vec<_>>();
    let out = Path::new("out");
    assert_eq!(folders(&paths(&["/a/x", "b/y.mcap"]), out).unwrap(), paths(&["out/x", "out/y.mcap"]));
    let twice = folders(&paths(&["/a/x", "/b/x"]), out).unwrap_err().to_string();
    assert!(twice.contains("found /a/x and /b/x"), "{twice}");
    assert!(folders(&paths(&["/a/.."]), out).is_err());
}
