//! What could not be read for a moment is read again by the next run, whoever failed to.

use ralf::sensors::{CameraImage, DepthImage, LidarScan, RadarScan, Sequence, Source, SourceError};
use ralf_data::run::{LabelRun, Outcome, Unwatched};
use ralf_data::{Recording, SequenceReader, Settings, open, write_sequence};
use std::collections::BTreeMap;
use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// What a measurement is of.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Of {
    Radar,
    Lidar,
    Image,
    Depth,
}

/// A sequence of which the first sensor's measurement 1 can't be read for some times.
struct Failing {
    inner: Box<dyn SequenceReader>,
    of: Of,
    left: AtomicUsize,
}

impl Failing {
    fn ask(&self, of: Of, measurement: (usize, usize)) -> Result<(), SourceError> {
        let fails = of == self.of && measurement == (0, 1);
        let less = |left: usize| left.checked_sub(1);
        match fails && self.left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, less).is_ok() {
            true => Err("the medium failed".into()),
            false => Ok(()),
        }
    }
}

impl Source for Failing {
    fn sequence(&self) -> &Sequence {
        self.inner.sequence()
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        self.ask(Of::Radar, (radar, scan))?;
        self.inner.radar_scan(radar, scan)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        self.ask(Of::Lidar, (lidar, scan))?;
        self.inner.lidar_scan(lidar, scan)
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        self.ask(Of::Image, (camera, image))?;
        self.inner.image(camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        self.ask(Of::Depth, (camera, image))?;
        self.inner.depth(camera, image)
    }
}

impl SequenceReader for Failing {
    fn inner(&self) -> Option<&dyn SequenceReader> {
        Some(self.inner.as_ref())
    }
}

/// A recording on disk, and a folder for results beside it.
struct Written(tempfile::TempDir);

impl Written {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let sequence = ralf_sim::presets::find("tiny").unwrap().sequences[0].simulate(1, 2).unwrap();
        write_sequence(&sequence, &folder.path().join("recording"), &|_| ()).unwrap();
        Self(folder)
    }

    fn out(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn whole(&self) -> Recording {
        open(&self.out("recording"), None).unwrap()
    }

    /// The same, of which something can't be read so many times.
    fn failing(&self, of: Of, times: usize) -> Recording {
        let mut recording = self.whole();
        let failing = |inner| {
            let reader: Box<dyn SequenceReader> = Box::new(Failing { inner, of, left: times.into() });
            reader
        };
        recording.sequences = recording.sequences.into_iter().map(failing).collect();
        recording
    }

    fn label(&self, recording: &Recording, out: &str) -> Outcome {
        with_run(recording, &self.out(out), |run| run.execute(&Unwatched).unwrap())
    }
}

fn with_run<T>(recording: &Recording, out: &Path, work: impl FnOnce(&LabelRun) -> T) -> T {
    let settings = Settings::from_toml("", &[]).unwrap();
    work(&LabelRun {
        recording,
        settings: &settings,
        out,
        jobs: 1,
        evidence: false,
        checks: &[],
        model: None,
    })
}

/// All files below a folder; of `run.json` all but the timings.
fn content(out: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let (mut found, mut folders) = (BTreeMap::new(), vec![out.to_owned()]);
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let mut bytes = fs::read(&path).unwrap();
            if path.ends_with("run.json") {
                let mut record: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
                record.as_object_mut().unwrap().remove("timings").unwrap();
                bytes = record.to_string().into_bytes();
            }
            found.insert(path.strip_prefix(out).unwrap().to_owned(), bytes);
        }
    }
    found.remove(Path::new(".ralf-lock"));
    found
}

/// The radar's scan fails once, where it is asked for as a neighbour of the one before, or always.
#[test]
fn a_failure_that_has_passed_leaves_no_trace_and_one_that_stays_costs_nothing() {
    let written = Written::new();
    written.label(&written.whole(), "whole");
    for (of, times) in [
        (Of::Lidar, usize::MAX),
        (Of::Radar, 1),
        (Of::Radar, usize::MAX),
        (Of::Image, usize::MAX),
        (Of::Depth, 1),
    ] {
        let out = format!("{of:?}{times}");
        let first = written.label(&written.failing(of, times), &out).record;
        let told = &first.sequences[0];
        assert_eq!(told.not_read.is_empty(), !told.not_labelled.is_empty(), "{of:?}");
        let named = !told.unreadable.is_empty() || !told.not_labelled.is_empty();
        assert_eq!(named, matches!(of, Of::Radar | Of::Lidar), "{of:?}: {told:?}");
        if times > 1 {
            let second = written.label(&written.failing(of, usize::MAX), &out);
            assert!(second.labelled.is_empty() && second.record.sequences == first.sequences, "{of:?}");
        }
        let third = written.label(&written.whole(), &out);
        assert_eq!((third.labelled.len(), third.earlier.without.len()), (1, 1), "{of:?}");
        assert!(content(&written.out(&out)) == content(&written.out("whole")), "{of:?}");
    }
}

/// A machine that can't read some of the files labels a part of the run.
#[test]
fn what_one_machine_could_not_read_another_one_labels_again() {
    let written = Written::new();
    let (scans, whole) = (NonZeroUsize::new(1000).unwrap(), written.whole());
    written.label(&whole, "whole");
    for (of, times) in [(Of::Lidar, usize::MAX), (Of::Radar, 1), (Of::Depth, usize::MAX)] {
        let out = written.out(&format!("parts {of:?}"));
        let planned = with_run(&whole, &out, |run| run.plan(scans, &Unwatched).unwrap());
        let failing = written.failing(of, times);
        let done =
            with_run(&failing, &out, |run| run.label_stretch(&planned.stretches[0], &Unwatched).unwrap());
        let images = done.cameras.iter().flat_map(|camera| &camera.images);
        let problems = images.filter(|image| image.problem.is_some()).count();
        assert_eq!(
            (done.unreadable.len(), problems),
            if of == Of::Depth { (0, 1) } else { (1, 0) },
            "{of:?}"
        );
        // A label that was damaged since is as long as before.
        let label = out.join("sequences/tiny/radar_front/000000.label");
        let mut bytes = fs::read(&label).unwrap();
        bytes[0] ^= 1;
        fs::write(&label, bytes).unwrap();
        with_run(&whole, &out, |run| run.execute(&Unwatched).unwrap());
        assert!(content(&out) == content(&written.out("whole")), "{of:?}");
    }
}

/// Another street of the same name: nothing but its content tells it from the first.
#[test]
fn what_lies_in_memory_is_labelled_anew() {
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| folder.path().join(name);
    let [first, second] = [1, 2].map(|seed| {
        let sequence = ralf_sim::presets::find("tiny").unwrap().sequences[0].simulate(seed, 2).unwrap();
        Recording::new(Path::new("in memory"), "memory", vec![Box::new(sequence)])
    });
    let label = |recording, name| with_run(recording, &out(name), |run| run.execute(&Unwatched).unwrap());
    label(&second, "second");
    label(&first, "out");
    assert!(content(&out("out")) != content(&out("second")));
    assert_eq!(label(&second, "out").labelled, ["tiny"]);
    assert!(content(&out("out")) == content(&out("second")));
    // Scans that a run has left which isn't over.
    let scans = NonZeroUsize::new(1000).unwrap();
    let planned = with_run(&first, &out("parts"), |run| run.plan(scans, &Unwatched).unwrap());
    for stretch in &planned.stretches {
        with_run(&first, &out("parts"), |run| run.label_stretch(stretch, &Unwatched).unwrap());
    }
    label(&second, "parts");
    assert!(content(&out("parts")) == content(&out("second")));
}
