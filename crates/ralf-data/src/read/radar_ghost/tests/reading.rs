//! What is read of a good recording, and what is true of it.

use super::hdf5::{Columns, Values};
use super::recording::{FILE, FRAMES, LATER, lidar, radar, write_dataset, write_sequence};
use crate::judge::Comparison;
use crate::read::Recording;
use crate::read::radar_ghost::{open, recognises};
use crate::testing::only;
use crate::truth::{GroundTruth, ScanId};
use crate::{Label, write_labels};

fn dataset() -> (tempfile::TempDir, Recording) {
    let folder = tempfile::tempdir().unwrap();
    write_dataset(folder.path());
    let recording = open(folder.path(), &[]).unwrap();
    (folder, recording)
}

#[test]
fn a_file_a_split_and_the_whole_set_are_recognised() {
    let (folder, _) = dataset();
    for path in [FILE, "original/test", "original", ""] {
        let path = folder.path().join(path);
        assert!(recognises(&path));
        let recording = crate::read::open(&path, None).unwrap();
        assert_eq!((recording.format, recording.sequences.len()), ("radar-ghost", 1));
        assert_eq!(only(&recording).sequence().name, "scenario-01_sequence-01_ped_test");
        assert_eq!(only(&recording).sequence().title, "Radar Ghost, test");
    }
    write_sequence(
        &folder.path().join("virtual/train/scenario-02_sequences-1-2_train.h5"),
        &radar(),
        &lidar(),
    );
    assert_eq!(open(folder.path(), &[]).unwrap().sequences.len(), 2);
    assert!(!recognises(tempfile::tempdir().unwrap().path()));
}

#[test]
fn each_radar_has_a_scan_per_frame_at_its_own_time() {
    let (_folder, recording) = dataset();
    let sequence = only(&recording).sequence();
    let names: Vec<&str> = sequence.rig.radars.iter().map(|radar| radar.name.as_str()).collect();
    assert_eq!(names, ["left", "right"]);
    let times = |after: f64| -> Vec<i64> {
        (0..FRAMES).map(|frame| ((0.06 * frame as f64 + after) * 1e9).round() as i64).collect()
    };
    assert_eq!(sequence.times.radars, [times(0.0), times(LATER)]);
    assert_eq!(sequence.times.lidars, [[-20_000_000, 80_000_000, 180_000_000, 280_000_000]]);
    assert!(sequence.motion.is_known() && only(&recording).warnings().is_empty());
}

#[test]
fn that_the_vehicle_stands_is_doubted_by_nothing() {
    let (_folder, recording) = dataset();
    let check = ralf_check::check(only(&recording));
    assert!(check.doubts().all(|verdict| verdict.subject != "motion"), "{:?}", check.verdicts);
}

#[test]
fn places_in_the_cars_frame_are_where_the_mountings_bring_them() {
    let (_folder, recording) = dataset();
    let reader = only(&recording);
    for (r, radar) in reader.sequence().rig.radars.iter().enumerate() {
        for s in 0..FRAMES {
            let scan = reader.radar_scan(r, s).unwrap();
            assert_eq!(scan.len(), 8, "no detection is dropped");
            let [x, y] = ["x_cc", "y_cc"].map(|name| &scan.columns[radar.column(name).unwrap()]);
            for (row, position) in scan.positions.iter().enumerate() {
                let place = radar.vehicle_from_radar * position;
                let off = (place.x - f64::from(x[row])).hypot(place.y - f64::from(y[row]));
                assert!(off < 1e-4, "{place} is {off} m off");
            }
            let [doppler, amp] = ["doppler", "amp"].map(|name| scan.columns[radar.column(name).unwrap()][0]);
            assert!((-1.5..-1.4).contains(&doppler) && amp == 61.5, "{doppler}");
        }
    }
    let person = reader.lidar_scan(0, 1).unwrap();
    let mounting = reader.sequence().rig.lidars[0].vehicle_from_lidar;
    let last = mounting * ralf::space::Point::from(person.points[person.points.len() - 1].map(f64::from));
    assert!((last.x - 13.88).abs() < 1e-5 && (last.y - 2.0).abs() < 1e-5, "{last}");
    assert_eq!(person.points.len(), 60 * 8 + 40 * 11 + 10);
}

#[test]
fn labels_become_the_truth_and_say_nothing_of_the_background() {
    let (folder, recording) = dataset();
    let truth = only(&recording).truth(1, 2).unwrap().unwrap();
    let label = |id, instance| Label { id, instance };
    let nothing = label(0, 0);
    let expected = [label(30, 1), label(30, 1), label(1, 2), nothing, nothing, nothing, label(1, 0), nothing];
    assert_eq!(truth.labels, expected);
    assert_eq!(truth.causes, [0, 0, 2, 0, 0, 0, 6, 0]);

    let found = GroundTruth::find(folder.path()).unwrap().unwrap();
    assert_eq!(found.scans().len(), 2 * FRAMES);
    let scan = ScanId { sequence: "scenario-01_sequence-01_ped_test".into(), radar: "right".into(), scan: 2 };
    assert_eq!(found.labels(&scan).unwrap(), expected);
    assert!(found.file(&scan).ends_with(FILE));
    let causes = found.causes(&scan.sequence).unwrap().unwrap();
    assert_eq!([&causes.names()[2], &causes.names()[6]], ["mirror", "noise"]);
    assert_eq!(causes.of_scan(&scan, 8).unwrap(), Some(truth.causes));
    assert!(causes.of_scan(&scan, 7).is_err());
}

/// Labels that call everything plausible: of four detections with truth in a scan two are.
#[test]
fn a_run_is_compared_with_what_the_format_knows() {
    let (folder, recording) = dataset();
    let out = tempfile::tempdir().unwrap();
    let found = GroundTruth::open(folder.path()).unwrap();
    for scan in found.scans() {
        write_labels(&scan.label_file(out.path()), &[Label::of_class(99); 8]).unwrap();
    }
    let counts = Comparison::new(out.path(), &found).unwrap().evaluation().overall.pooled.counts;
    assert_eq!((counts.total(), counts.tp, counts.fp), (40, 20, 20));
    // The same truth in the own layout.
    let converted = tempfile::tempdir().unwrap();
    crate::write_sequence(only(&recording), converted.path(), &|_| ()).unwrap();
    let written = GroundTruth::open(converted.path()).unwrap();
    assert_eq!(written.scans(), found.scans());
    for scan in found.scans() {
        assert_eq!(written.labels(scan).unwrap(), found.labels(scan).unwrap());
        let causes = |truth: &GroundTruth| {
            truth.causes(&scan.sequence).unwrap().unwrap().of_scan(scan, 8).unwrap().unwrap()
        };
        assert_eq!(causes(&written), causes(&found));
    }
}

/// Rows of a scan needn't follow each other, times may be in another unit, instances may have names.
#[test]
fn other_orders_units_and_types_are_the_same_recording() {
    let folder = tempfile::tempdir().unwrap();
    let mut rows = radar();
    for (name, values) in &mut rows {
        let changed = match (*name, &*values) {
            ("timestamp", Values::Double(seconds)) => {
                Values::Long(seconds.iter().map(|t| (t * 1e6).round() as i64).collect())
            }
            ("instance_id", Values::Int(numbers)) => {
                let name = |n: &i32| if *n > 0 { format!("obj{n}") } else { String::new() };
                Values::Text(8, numbers.iter().map(name).collect())
            }
            ("label_id", Values::Long(ids)) => Values::Double(ids.iter().map(|id| *id as f64).collect()),
            (_, values) => values.clone(),
        };
        *values = changed.picked(&interleaved(16 * FRAMES));
    }
    rows.retain(|(name, _)| *name != "group" && *name != "mirror");
    write_sequence(&folder.path().join("scenario-01_sequence-01_ped_test.h5"), &rows, &lidar());
    let other = open(folder.path(), &[]).unwrap();
    let (_kept, recording) = dataset();
    assert_eq!(only(&other).sequence().times, only(&recording).sequence().times);
    let text = |recording: &Recording| format!("{:?}", only(recording).radar_scan(0, 3).unwrap());
    assert_eq!(text(&other), text(&recording));
    let labels = only(&other).truth(0, 0).unwrap().unwrap().labels;
    assert_eq!(labels[0], Label { id: 30, instance: 1 });
    assert_eq!(labels[7].id, 30, "without the column nothing is a group");
}

/// Left and right in turn.
fn interleaved(rows: usize) -> Vec<usize> {
    (0..rows).map(|row| row / 16 * 16 + row % 2 * 8 + row % 16 / 2).collect()
}

#[test]
fn a_scan_of_several_times_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let mut rows = radar();
    for (name, values) in &mut rows {
        if let ("timestamp", Values::Double(times)) = (*name, values) {
            times[3] += 0.001;
        }
    }
    write_sequence(&folder.path().join("scenario-01_a.h5"), &rows, &lidar());
    let recording = open(folder.path(), &[]).unwrap();
    assert!(only(&recording).warnings()[0].starts_with("detections of several times in 1 of the scans"));
}

/// The two files that were read last are kept; a third one makes the first forgotten.
#[test]
fn a_file_that_shrinks_while_it_is_read_is_told() {
    let (folder, _) = dataset();
    for name in ["scenario-03_b.h5", "scenario-04_c.h5"] {
        write_sequence(&folder.path().join("original/test").join(name), &radar(), &lidar());
    }
    let recording = open(folder.path(), &[]).unwrap();
    let short = radar().into_iter().map(|(name, values)| (name, values.picked(&[0, 8]))).collect();
    write_sequence(&folder.path().join(FILE), &short, &lidar());
    let error = only(&recording).radar_scan(0, 4).unwrap_err().to_string();
    assert!(
        error.contains("rows: expected as many rows as when the file was opened, found fewer"),
        "{error}"
    );
}

/// The table with times of another unit, and of one moment alone where it is told.
fn rescaled(table: Columns, factor: f64, moment: Option<f64>) -> Columns {
    let change = |(name, values): (&'static str, Values)| match (name, values) {
        ("timestamp", Values::Double(times)) => {
            let time = |t: f64| moment.unwrap_or(t) * factor;
            (name, Values::Double(times.into_iter().map(time).collect()))
        }
        other => other,
    };
    table.into_iter().map(change).collect()
}

#[test]
fn a_single_moment_has_the_unit_of_the_other_table() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scenario-01_a.h5");
    let times = |of_radars: Option<f64>, of_lidar: Option<f64>| {
        write_sequence(&file, &rescaled(radar(), 1e6, of_radars), &rescaled(lidar(), 1e6, of_lidar));
        only(&open(&file, &[]).unwrap()).sequence().times.clone()
    };
    let both = times(None, None);
    let of_radars = times(None, Some(0.15));
    assert_eq!((of_radars.radars, &of_radars.lidars[0][..]), (both.radars, &[150_000_000][..]));
    let of_lidar = times(Some(0.15), None);
    assert_eq!((of_lidar.lidars, of_lidar.radars[0][0]), (both.lidars, 150_000_000));
}
