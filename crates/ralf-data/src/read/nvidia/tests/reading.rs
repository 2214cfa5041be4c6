//! What is read of good clips.

use super::recording::{
    CLIP, FRONT, REAR, Values, egomotion, extrinsics, radar, write, write_clip, write_compressed,
    write_downloaded, write_unzipped,
};
use crate::read::Recording;
use crate::read::nvidia::{open, recognises};
use crate::testing::only;
use parquet::basic::{Compression, GzipLevel, TimeUnit};
use ralf::sensors::Elevation;
use ralf::space::Point;
use std::fs;

fn unzipped() -> (tempfile::TempDir, Recording) {
    let folder = tempfile::tempdir().unwrap();
    write_unzipped(folder.path());
    let recording = open(folder.path(), &[]).unwrap();
    (folder, recording)
}

fn text(recording: &Recording) -> String {
    let reader = only(recording);
    let scans: Vec<_> = (0..2).map(|radar| reader.radar_scan(radar, 1).unwrap()).collect();
    format!("{:?} {scans:?}", reader.sequence())
}

#[test]
fn unzipped_chunks_and_folders_of_clips_are_the_same() {
    let (folder, recording) = unzipped();
    assert!(recognises(folder.path()));
    assert_eq!(crate::read::open(folder.path(), None).unwrap().format, "nvidia");
    for written in [write_clip, write_downloaded] {
        let clips = tempfile::tempdir().unwrap();
        written(clips.path());
        for path in [clips.path().to_owned(), clips.path().join(CLIP)] {
            assert!(recognises(&path));
            assert_eq!(text(&open(&path, &[]).unwrap()), text(&recording));
        }
    }
    assert!(!recognises(tempfile::tempdir().unwrap().path()));
}

#[test]
fn rows_of_a_scan_index_are_a_scan_and_none_is_dropped() {
    let (_folder, recording) = unzipped();
    let reader = only(&recording);
    let rig = &reader.sequence().rig;
    let names: Vec<&str> = rig.radars.iter().map(|radar| radar.name.as_str()).collect();
    assert_eq!((reader.sequence().name.as_str(), names), (CLIP, vec![FRONT, REAR]));
    assert_eq!(reader.sequence().times.radars, [[-50_000_000, 0, 50_000_000]; 2]);
    let counts: Vec<usize> = (0..3).map(|scan| reader.radar_scan(0, scan).unwrap().len()).collect();
    assert_eq!(counts, [2, 3, 1]);
    let scan = reader.radar_scan(0, 1).unwrap();
    let row: Vec<_> =
        rig.radars[0].fields.iter().zip(&scan.columns).map(|(name, column)| (&**name, column[0])).collect();
    let expected = [
        ("azimuth", 0.0),
        ("elevation", 0.02),
        ("range", 20.0),
        ("doppler", -9.5),
        ("rcs", -3.0),
        ("snr", 14.5),
        ("exist_probb", 99.0),
        ("doppler_ambiguity", 62.5),
    ];
    assert_eq!(row, expected);
    // The last row of this scan has a distance of 0: whatever its angles say, it has no place.
    let placed = scan.positions.iter().map(|place| place.coords.iter().all(|axis| axis.is_finite()));
    assert_eq!(placed.collect::<Vec<_>>(), [true, true, false]);
    assert_eq!(
        rig.radars.iter().map(|radar| radar.elevation).collect::<Vec<_>>(),
        [Elevation::Measured, Elevation::None]
    );
}

#[test]
fn a_scan_is_when_its_rows_were_measured() {
    let (folder, _) = unzipped();
    let times = |after_us: [i64; 6]| {
        let mut rows = radar(true);
        let Values::Long(begin) = &rows[1].1 else { unreachable!() };
        let measured = begin.iter().zip(after_us).map(|(begin, after)| begin + after).collect();
        rows[2].1 = Values::Long(measured);
        write(&folder.path().join(format!("radar/{FRONT}/{CLIP}.{FRONT}.parquet")), &rows);
        let recording = open(folder.path(), &[]).unwrap();
        only(&recording).sequence().times.radars[0].clone()
    };
    let medians = [-48_000_000, 13_000_000, 70_000_000];
    assert_eq!(times([1_000, 2_000, 30_000, 13_000, 12_000, 20_000]), medians);
    let begins = [-50_000_000, 0, 50_000_000];
    assert_eq!(times([1_000, 2_000, 30_000, 13_000, 12_000, 200_000]), begins, "longer than a cycle");
    assert_eq!(times([1_000, -1, 30_000, 13_000, 12_000, 20_000]), begins, "before the cycle");
}

#[test]
fn mountings_found_offline_go_before_what_the_vehicle_knew() {
    let (folder, _) = unzipped();
    let mut offline = extrinsics(CLIP);
    offline
        .iter_mut()
        .filter(|(name, _)| *name == "x")
        .for_each(|(_, x)| *x = Values::Double(vec![3.5, -0.5]));
    write(&folder.path().join("calibration/sensor_extrinsics.offline/chunk_0000.parquet"), &offline);
    let recording = open(folder.path(), &[]).unwrap();
    let radars = &only(&recording).sequence().rig.radars;
    let x: Vec<f64> = radars.iter().map(|radar| radar.vehicle_from_radar.translation.x).collect();
    assert_eq!(x, [3.5, -0.5]);
}

#[test]
fn a_distance_that_is_not_above_zero_is_no_place() {
    let (folder, _) = unzipped();
    let mut rows = radar(true);
    rows[10].1 = Values::Float(vec![20.0, -1.5, f32::NAN, 21.0, 0.0, 19.5]);
    write(&folder.path().join(format!("radar/{FRONT}/{CLIP}.{FRONT}.parquet")), &rows);
    let recording = open(folder.path(), &[]).unwrap();
    let scans = (0..3).map(|scan| only(&recording).radar_scan(0, scan).unwrap());
    let placed = scans.flat_map(|scan| scan.positions).map(|place| place.coords.norm().is_finite());
    assert_eq!(placed.collect::<Vec<_>>(), [true, false, false, true, false, true]);
}

#[test]
fn mountings_and_poses_are_where_they_should_be() {
    let (_folder, recording) = unzipped();
    let sequence = only(&recording).sequence();
    let ahead = Point::new(10.0, 0.0, 0.0);
    let seen = sequence.rig.radars.iter().map(|radar| radar.vehicle_from_radar * ahead);
    let off: f64 = seen
        .zip([Point::new(13.9, 0.0, 0.5), Point::new(-10.8, 0.6, 0.7)])
        .map(|(a, b)| (a - b).norm())
        .sum();
    assert!(off < 1e-9, "{off}");
    let driven = sequence.motion.between(-50_000_000, 50_000_000).translation.x;
    assert!((driven - 1.0).abs() < 1e-9, "{driven}");
    assert!(only(&recording).warnings().is_empty());
}

#[test]
fn what_is_better_is_preferred_and_what_is_left_out_is_told() {
    let (folder, _) = unzipped();
    let mut better = egomotion();
    better[5].1 = Values::Double(vec![3.0; 30]);
    write(&folder.path().join(format!("labels/egomotion.offline/{CLIP}.egomotion.offline.parquet")), &better);
    for name in ["lidar", "camera"] {
        fs::create_dir(folder.path().join(name)).unwrap();
    }
    let recording = open(folder.path(), &[]).unwrap();
    assert_eq!(only(&recording).sequence().motion.between(0, 50_000_000).translation.x, 0.0);
    let [lidar, cameras] = only(&recording).warnings() else { panic!("two warnings") };
    assert!(lidar.contains("Draco") && cameras.contains("f-theta"));
    fs::remove_dir_all(folder.path().join("labels")).unwrap();
    let recording = open(folder.path(), &[]).unwrap();
    assert!(!only(&recording).sequence().motion.is_known());
    assert!(only(&recording).warnings()[2].contains("no egomotion"));
}

/// What pandas writes of an index without a name; and the mountings of several chunks.
#[test]
fn other_names_of_the_index_and_other_chunks() {
    let (folder, recording) = unzipped();
    let mut rows = radar(true);
    rows[0].0 = "__index_level_0__";
    write(&folder.path().join(format!("radar/{FRONT}/{CLIP}.{FRONT}.parquet")), &rows);
    let calibration = folder.path().join("calibration/sensor_extrinsics");
    write(&calibration.join("sensor_extrinsics.chunk_0001.parquet"), &extrinsics(CLIP));
    write(&calibration.join("sensor_extrinsics.chunk_0000.parquet"), &extrinsics("another"));
    assert_eq!(text(&open(folder.path(), &[]).unwrap()), text(&recording));
}

/// pandas and pyarrow take Snappy unless they are told otherwise.
#[test]
fn tables_are_read_however_they_are_compressed() {
    let (folder, recording) = unzipped();
    let gzip = Compression::GZIP(GzipLevel::default());
    for compression in [Compression::SNAPPY, gzip, Compression::LZ4, Compression::LZ4_RAW] {
        let motion = folder.path().join(format!("labels/egomotion/{CLIP}.egomotion.parquet"));
        write_compressed(&motion, &egomotion(), compression);
        let front = folder.path().join(format!("radar/{FRONT}/{CLIP}.{FRONT}.parquet"));
        write_compressed(&front, &radar(true), compression);
        assert_eq!(text(&open(folder.path(), &[]).unwrap()), text(&recording), "{compression}");
    }
}

#[test]
fn rows_of_a_scan_need_not_lie_together() {
    let (folder, recording) = unzipped();
    // Rows of the scans 7, 8, 9, 8, 7, 8, each scan's in their order.
    let order = [0, 2, 5, 3, 1, 4];
    fn picked<T: Copy>(values: &[T], order: &[usize]) -> Vec<T> {
        order.iter().map(|row| values[*row]).collect()
    }
    let mut rows = radar(true);
    for (_, values) in &mut rows {
        match values {
            Values::Byte(values) => *values = picked(values, &order),
            Values::Long(values) | Values::Time(_, values) => *values = picked(values, &order),
            Values::Float(values) => *values = picked(values, &order),
            Values::Double(values) => *values = picked(values, &order),
            Values::Optional(values) => *values = picked(values, &order),
            Values::Text(_) => {}
        }
    }
    write(&folder.path().join(format!("radar/{FRONT}/{CLIP}.{FRONT}.parquet")), &rows);
    assert_eq!(text(&open(folder.path(), &[]).unwrap()), text(&recording));
}

#[test]
fn times_have_the_unit_that_their_column_says() {
    let (folder, recording) = unzipped();
    let expected = text(&recording);
    let radar_file = folder.path().join(format!("radar/{FRONT}/{CLIP}.{FRONT}.parquet"));
    let motion_file = folder.path().join(format!("labels/egomotion/{CLIP}.egomotion.parquet"));
    let units = [
        (TimeUnit::MILLIS, Box::new(|us: i64| us / 1000) as Box<dyn Fn(i64) -> i64>),
        (TimeUnit::MICROS, Box::new(|us| us)),
        (TimeUnit::NANOS, Box::new(|us| us * 1000)),
    ];
    for (unit, of) in units {
        for (file, columns) in [(&radar_file, radar(true)), (&motion_file, egomotion())] {
            let in_unit = |(name, values)| match (name, values) {
                ("timestamp", Values::Long(times)) => {
                    (name, Values::Time(unit, times.into_iter().map(&of).collect()))
                }
                other => other,
            };
            write(file, &columns.into_iter().map(in_unit).collect());
        }
        assert_eq!(text(&open(folder.path(), &[]).unwrap()), expected, "{unit:?}");
    }
}
