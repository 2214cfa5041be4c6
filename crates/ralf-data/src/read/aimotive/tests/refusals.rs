//! What is refused, and how it is named.

use super::recording::{FRAMES, T0, laz, write_sequence};
use crate::disk::laz as file;
use crate::read::aimotive::open;
use crate::testing::check_left_out;
use nalgebra::Point3;
use std::fs;
use std::path::Path;

const CALIBRATION: &str = "sensor/calibration/calibration.json";
const POSES: &str = "sensor/gnssins/egomotion.json";

fn drive() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    write_sequence(folder.path());
    folder
}

/// Replaces a part of a file, which must be there.
fn replace(folder: &Path, name: &str, from: &str, to: &str) {
    let file = folder.join(name);
    let text = fs::read_to_string(&file).unwrap();
    assert!(text.contains(from), "{text} lacks {from}");
    fs::write(&file, text.replacen(from, to, 1)).unwrap();
}

#[test]
fn damaged_metadata_is_named_when_a_sequence_is_opened() {
    let boxes = format!("dynamic/box/3d_body/frame_{:07}.json", FRAMES[1]);
    let cases: [(&str, &str, &str, &[&str]); 12] = [
        (CALIBRATION, "{", "[", &["calibration.json: line 1, column", "the sensors by name"]),
        (CALIBRATION, "\"F_LRR_C\"", "\"G_LRR_C\"", &["F_LRR_C: expected a radar, found no such sensor"]),
        (CALIBRATION, "\"lidar\"", "\"sonar\"", &["sensors: expected one LiDAR, found none"]),
        (CALIBRATION, "\"gps_ins\"", "\"lidar\"", &["expected one LiDAR, found M_LIDAR_M, novatel"]),
        (CALIBRATION, "3.8", "null", &["calibration.json: line 1, column", "expected a number"]),
        (CALIBRATION, "[0.0,0.0,0.0,1.0]", "[0.0,0.0,0.1,1.0]", &["a last row of 0 0 0 1"]),
        (CALIBRATION, "-1.0", "1.0", &["RT_body_from_sensor: expected a rotation"]),
        (POSES, "0033644", "frame 2", &["egomotion.json: keys: expected numbers of frames, found `frame 2`"]),
        (POSES, "[[", "[[3.5,", &["egomotion.json: line 1, column", "poses by frame"]),
        (&boxes, "Timestamp", "Time", &["frame_0033644.json: line 1", "missing field `Timestamp`"]),
        (&boxes, "\"4833", "\"x4833", &["frame_0033644.json", "`x4833256230000` as Timestamp"]),
        (
            &boxes,
            "\"4833",
            "\"3833",
            &["frame 33644: expected a time after 4833189570000 ns", "found 3833256230000 ns"],
        ),
    ];
    for (name, from, to, words) in cases {
        let folder = drive();
        replace(folder.path(), name, from, to);
        let error = open(folder.path(), &[]).unwrap_err().to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error} lacks some of {words:?}");
        assert!(error.starts_with(folder.path().to_str().unwrap()), "{error}");
    }
}

#[test]
fn missing_and_strange_files_are_named() {
    let refused = |harm: &dyn Fn(&Path), words: &[&str]| {
        let folder = drive();
        harm(folder.path());
        let error = open(folder.path(), &[]).unwrap_err().to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error} lacks some of {words:?}");
        assert!(error.starts_with(folder.path().to_str().unwrap()), "{error}");
    };
    refused(
        &|path| fs::remove_file(path.join(CALIBRATION)).unwrap(),
        &["sequences with", "calibration.json"],
    );
    refused(
        &|path| fs::write(path.join("sensor/radar/F_LRR_C/F_LRR_C_new.json"), "").unwrap(),
        &["F_LRR_C_new.json: file name: expected F_LRR_C_NNNNNNN.json"],
    );
    refused(
        &|path| fs::write(path.join("sensor/radar/F_LRR_C/F_LRR_C_33643.json"), "").unwrap(),
        &["expected one file of frame 33643, found"],
    );
    refused(
        &|path| {
            fs::remove_dir_all(path.join("dynamic/box")).unwrap();
            fs::remove_dir_all(path.join("dynamic/raw-revolutions")).unwrap();
        },
        &["frame 33643", "boxes or LiDAR files of two frames or more", "none"],
    );
    let whole = tempfile::tempdir().unwrap();
    for environment in ["rain", "urban"] {
        write_sequence(&whole.path().join("train").join(environment).join("one"));
    }
    let error = open(whole.path(), &[]).unwrap_err().to_string();
    assert!(error.contains("a name that no other sequence has"), "{error}");
}

#[test]
fn bad_scans_are_named_when_they_are_read_and_the_others_are_read() {
    let folder = drive();
    let opened = open(folder.path(), &[]).unwrap();
    let reader = &opened.sequences[0];
    let radar = format!("sensor/radar/F_LRR_C/F_LRR_C_{:07}.json", FRAMES[1]);
    replace(folder.path(), &radar, "\"range\"", "\"rage\"");
    let error = reader.radar_scan(1, 1).unwrap_err().to_string();
    assert!(
        error.contains("F_LRR_C_0033644.json: line 1, column") && error.contains("missing field `range`"),
        "{error}"
    );
    let lidar = folder.path().join("dynamic/raw-revolutions/frame_0033644.laz");
    fs::write(&lidar, laz(&[(Point3::origin(), T0 + 3_000_000_000)])).unwrap();
    let error = reader.lidar_scan(0, 1).unwrap_err().to_string();
    assert!(error.contains("point 0, gps_time: expected a time within 1 s of the scan's"), "{error}");
    fs::remove_file(&lidar).unwrap();
    assert!(reader.lidar_scan(0, 1).unwrap_err().to_string().contains("frame_0033644.laz"));
    assert!(reader.radar_scan(1, 2).is_ok() && reader.lidar_scan(0, 2).is_ok());
}

/// The bytes of a LAZ file of some points.
fn points() -> Vec<u8> {
    laz(&(0..400).map(|n| (Point3::new(f64::from(n), 1.0, 0.5), T0 + i64::from(n))).collect::<Vec<_>>())
}

fn read(bytes: &[u8]) -> Result<Vec<file::LazPoint>, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.laz");
    fs::write(&path, bytes).unwrap();
    file::read(&path).map_err(|error| error.to_string())
}

#[test]
fn laz_files_that_claim_too_much_are_refused_before_memory_is_taken() {
    let good = points();
    assert_eq!(read(&good).unwrap().len(), 400);
    let with = |at: usize, bytes: &[u8]| {
        let mut damaged = good.clone();
        damaged[at..at + bytes.len()].copy_from_slice(bytes);
        read(&damaged).unwrap_err()
    };
    assert!(
        with(107, &u32::MAX.to_le_bytes()).contains("expected at most 16777216 points, found 4294967295")
    );
    assert!(with(107, &1_000_000u32.to_le_bytes()).contains("1000000 points in all"));
    assert!(with(25, &[4]).contains("expected LAS 1.0 to 1.3, found 1.4"));
    assert!(with(0, b"PCD ").contains("frame.laz: content: expected a LAS or LAZ file"));
    let begin = u32::from_le_bytes(good[96..100].try_into().unwrap()) as usize;
    let table = i64::from_le_bytes(good[begin..begin + 8].try_into().unwrap()) as usize;
    let refused = with(table + 4, &u32::MAX.to_le_bytes());
    assert!(
        refused.contains("chunk table: expected at most") && refused.contains("found 4294967295"),
        "{refused}"
    );
    let cut = read(&good[..good.len() - 20]).unwrap_err();
    assert!(
        cut.ends_with(&format!("found none in {} bytes: the file is cut short", good.len() - 20)),
        "{cut}"
    );
    let record = good.windows(14).position(|part| part == b"laszip encoded").unwrap() + 52;
    for (place, value) in [(0, 3_u16), (12, 0), (32, 0), (32, 9), (36, 21)] {
        let mut damaged = good.clone();
        damaged[record + place..record + place + 2].copy_from_slice(&value.to_le_bytes());
        damaged[record + 14..record + 16].fill(0);
        let error = read(&damaged).unwrap_err();
        assert!(error.contains("LASzip record: expected chunks of one size"), "{error}");
    }
    assert!(read(&[]).unwrap_err().contains("header: expected 227 bytes or more, found 0 bytes"));
}

#[test]
fn a_damaged_laz_file_is_an_error_or_other_points_and_nothing_worse() {
    let good = points();
    for end in (0..good.len()).step_by(7) {
        assert!(read(&good[..end]).is_err(), "the first {end} bytes");
    }
    for at in 0..good.len() {
        for value in [0x00, 0x7f, 0xff] {
            let mut damaged = good.clone();
            damaged[at] = value;
            let _ = read(&damaged);
        }
    }
}

#[test]
fn a_sequence_that_lost_its_calibration_or_radars_is_named_and_makes_no_recording() {
    let folder = tempfile::tempdir().unwrap();
    let night = folder.path().join("train/night");
    for (name, lost) in [("A", None), ("B", Some("calibration")), ("C", Some("radar")), ("D", Some(""))] {
        write_sequence(&night.join(name));
        if let Some(lost) = lost {
            fs::remove_dir_all(night.join(name).join("sensor").join(lost)).unwrap();
        }
    }
    fs::create_dir_all(night.join("notes")).unwrap();
    let opened = crate::open(folder.path(), None).unwrap();
    assert_eq!(opened.sequences.len(), 1);
    let lost: Vec<_> =
        opened.incomplete.iter().map(|lost| (lost.name.clone(), lost.lost.to_string())).collect();
    let missing = [("B", CALIBRATION), ("C", "sensor/radar"), ("D", CALIBRATION)];
    assert_eq!(lost, missing.map(|(name, part)| (name.to_owned(), format!("{part} is missing"))));
    fs::remove_dir_all(night.join("A")).unwrap();
    let error = |format| crate::open(folder.path(), format).unwrap_err().to_string();
    assert!(error(None).ends_with("found none of them"), "{}", error(None));
    let told = error(Some("aimotive"));
    assert!(told.ends_with("found none: B is without sensor/calibration/calibration.json"), "{told}");
}

#[test]
fn a_damaged_sequence_costs_the_others_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let night = folder.path().join("train/night");
    ["A", "B"].into_iter().for_each(|name| write_sequence(&night.join(name)));
    fs::write(night.join("A").join(CALIBRATION), "").unwrap();
    check_left_out(folder.path(), ["B", "A"], "calibration.json: ");
    fs::write(night.join("B").join(CALIBRATION), "").unwrap();
    let error = open(folder.path(), &[]).unwrap_err().to_string();
    assert!(error.contains("night/A/sensor/calibration"), "{error}");
}
