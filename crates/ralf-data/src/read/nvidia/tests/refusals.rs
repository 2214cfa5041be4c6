//! What is refused, and how it is named.

use super::recording::{
    CLIP, Columns, FRONT, REAR, Values, egomotion, extrinsics, radar, write, write_unzipped,
};
use crate::Settings;
use crate::read::nvidia::{open, recognises};
use crate::testing::check_left_out;
use std::fs;
use std::path::{Path, PathBuf};

const RADAR: &str = "radar/radar_front_center_imaging_lrr_1";
const CHUNK: &str = "calibration/sensor_extrinsics/sensor_extrinsics.chunk_0000.parquet";

/// What opening a clip says in which this table is another one.
fn refused(file: &str, columns: &Columns) -> String {
    let folder = tempfile::tempdir().unwrap();
    write_unzipped(folder.path());
    write(&folder.path().join(file), columns);
    let error = open(folder.path(), &[]).map(drop).unwrap_err().to_string();
    assert!(error.starts_with(folder.path().to_str().unwrap()), "{error}");
    error
}

fn changed(mut columns: Columns, name: &str, values: Values) -> Columns {
    columns.iter_mut().filter(|(column, _)| *column == name).for_each(|(_, old)| *old = values.clone());
    columns
}

#[test]
fn tables_that_do_not_fit_are_named() {
    let front = format!("{RADAR}/{CLIP}.{FRONT}.parquet");
    let motion = format!("labels/egomotion/{CLIP}.egomotion.parquet");
    let without = |mut columns: Columns, name: &str| {
        columns.retain(|(column, _)| *column != name);
        columns
    };
    let text = |rows: usize| Values::Text(vec!["a".to_owned(); rows]);
    let mut times: Vec<i64> = (-20..10).map(|n| 10_000 * n).collect();
    times[7] = times[6];
    for (error, words) in [
        (
            refused(&front, &without(radar(true), "rcs")),
            "columns: expected a column `rcs`, found scan_index, timestamp",
        ),
        (refused(&front, &without(radar(true), "scan_index")), "expected a column `__index_level_0__`"),
        (
            refused(&front, &changed(radar(true), "distance", text(6))),
            "distance: expected numbers, found BYTE_ARRAY",
        ),
        (
            refused(&front, &changed(radar(true), "timestamp", Values::Float(vec![0.0; 6]))),
            "timestamp: expected whole numbers, found FLOAT",
        ),
        (
            refused(&front, &changed(radar(true), "timestamp", Values::Long(vec![0, 1, 2, 2, 2, 3]))),
            "timestamp, row 1: expected 0 us, as of the scan's first row, found 1",
        ),
        (
            refused(&front, &changed(radar(true), "timestamp", Values::Long(vec![i64::MIN; 6]))),
            "timestamp, row 0: expected a time in us",
        ),
        (
            refused(&motion, &changed(egomotion(), "timestamp", Values::Long(times))),
            "timestamp, row 7: expected times that ascend",
        ),
        (
            refused(&motion, &changed(egomotion(), "qw", Values::Double(vec![0.0; 30]))),
            "row 0: expected finite numbers, and a quaternion of length 1",
        ),
        (
            refused(CHUNK, &extrinsics("another")),
            "radar_front_center_imaging_lrr_1: expected a mounting of the clip 0a1b",
        ),
        (
            refused(CHUNK, &changed(extrinsics(CLIP), "sensor_name", Values::Long(vec![1, 2]))),
            "sensor_name: expected texts, found INT64",
        ),
    ] {
        assert!(error.contains(words), "{error} lacks {words}");
    }
}

#[test]
fn a_second_row_of_a_sensor_says_the_same_or_is_refused() {
    let twice = |far: f64| -> Columns {
        let names = [FRONT, REAR, REAR].map(str::to_owned).to_vec();
        let mut rows = vec![("sensor_name", Values::Text(names))];
        for (name, values) in extrinsics(CLIP).into_iter().skip(2) {
            let Values::Double(mut numbers) = values else { panic!("decimals") };
            numbers.push(numbers[1] + if name == "x" { far } else { 0.0 });
            rows.push((name, Values::Double(numbers)));
        }
        rows
    };
    let error = refused(CHUNK, &twice(0.1));
    let expected = format!(
        "row 2: expected one mounting of each sensor of a clip, found another one of {REAR} than in a row before"
    );
    assert!(error.ends_with(&expected), "{error}");
    assert!(refused(CHUNK, &twice(1e308)).contains("row 2: expected at most 1000 m from the vehicle"));
    let folder = tempfile::tempdir().unwrap();
    write_unzipped(folder.path());
    write(&folder.path().join(CHUNK), &twice(0.0));
    assert!(open(folder.path(), &[]).is_ok());
}

/// Rows that are alike take no room in a file, and much in memory.
#[test]
fn more_rows_than_there_can_be_are_refused() {
    let front = format!("{RADAR}/{CLIP}.{FRONT}.parquet");
    let rows = |count: usize| -> Columns { vec![("timestamp", Values::Long(vec![0; count]))] };
    for (file, most) in [
        (front.as_str(), 1 << 22),
        (CHUNK, 1 << 17),
        (&format!("labels/egomotion/{CLIP}.egomotion.parquet"), 1 << 20),
    ] {
        let error = refused(file, &rows(most + 1));
        assert!(
            error.contains(&format!("rows: expected at most {most} rows, found {}", most + 1)),
            "{error}"
        );
    }
    let long = Values::Text(vec!["a".repeat(1025); 2]);
    let error = refused(CHUNK, &changed(extrinsics(CLIP), "sensor_name", long));
    assert!(error.contains("sensor_name: expected a text of at most 1024 bytes in every row"), "{error}");
}

#[test]
fn damaged_and_zipped_files_are_named() {
    let folder = tempfile::tempdir().unwrap();
    write_unzipped(folder.path());
    let file = folder.path().join(format!("{RADAR}/{CLIP}.{FRONT}.parquet"));
    let whole = fs::read(&file).unwrap();
    fs::write(&file, &whole[..whole.len() - 9]).unwrap();
    let error = open(folder.path(), &[]).map(drop).unwrap_err().to_string();
    assert!(error.contains("content: expected a Parquet file, found"), "{error}");
    let zipped = tempfile::tempdir().unwrap();
    fs::create_dir_all(zipped.path().join(RADAR)).unwrap();
    fs::write(zipped.path().join(RADAR).join("a.chunk_0000.zip"), "PK").unwrap();
    assert!(recognises(zipped.path()));
    let error = open(zipped.path(), &[]).map(drop).unwrap_err().to_string();
    assert!(error.ends_with("found zip files: unzip them where they lie"), "{error}");
}

/// No writer of such files is at hand: a file says so that isn't compressed.
#[test]
fn a_compression_that_is_not_read_is_named() {
    let folder = tempfile::tempdir().unwrap();
    write_unzipped(folder.path());
    let file = folder.path().join(format!("{RADAR}/{CLIP}.{FRONT}.parquet"));
    let mut bytes = fs::read(&file).unwrap();
    // The path of a column, and then the field of its compression: 0 is none, 4 Brotli, both as zigzag numbers.
    let told = b"\x19\x18\x03rcs\x15\x00";
    let place = bytes.windows(told.len()).rposition(|window| window == told).unwrap();
    bytes[place + told.len() - 1] = 8;
    fs::write(&file, bytes).unwrap();
    let error = open(folder.path(), &[]).map(drop).unwrap_err().to_string();
    assert!(
        error.ends_with(
            "rcs: expected values that are compressed by Snappy, gzip, LZ4 or zstd, or not at all, \
                             found some that are compressed by BROTLI, which isn't read"
        ),
        "{error}"
    );
}

/// A second clip whose front radar alone has a file, and which tells no motion.
fn second_clip(folder: &Path) -> PathBuf {
    write_unzipped(folder);
    let front = folder.join(format!("{RADAR}/another.{FRONT}.parquet"));
    write(&front, &radar(true));
    let chunk = CHUNK.replace("0000", "0001");
    write(&folder.join(chunk), &extrinsics("another"));
    front
}

#[test]
fn a_damaged_clip_costs_the_others_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let front = second_clip(folder.path());
    fs::write(front, "PAR1").unwrap();
    check_left_out(folder.path(), [CLIP, "another"], "expected a Parquet file");
}

/// Two detections a scan are too few to tell it.
#[test]
fn a_clip_whose_motion_nothing_tells_costs_the_others_nothing() {
    let folder = tempfile::tempdir().unwrap();
    second_clip(folder.path());
    check_left_out(folder.path(), [CLIP, "another"], "sequence another: the vehicle's motion: ");
    let asked = Settings::from_toml("", &["motion.source=radar"]).unwrap();
    let error = asked.correct(open(folder.path(), &[]).unwrap()).unwrap_err().to_string();
    assert!(error.contains("the vehicle's motion: "), "{error}");
}
