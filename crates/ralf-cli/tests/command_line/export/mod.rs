//! `ralf export`: each format as other people's packages read it, and what is exported where.

mod clouds;
mod corrections;
#[cfg(unix)]
mod full_disk;
mod places;
mod recordings;
mod splits;
mod tables;

use crate::support::{Dataset, Ran, Shape, program, ralf, rows};
use serde_json::Value;
use std::fs;

/// A labelled recording.
fn labelled(shape: &Shape) -> Dataset {
    let dataset = Dataset::of(shape);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    dataset
}

/// Three scans of two radars.
fn small() -> Dataset {
    labelled(&Shape { scans: 3, ..Shape::default() })
}

/// Exports to a folder or file beside the recording, whose path it returns.
#[track_caller]
fn export(dataset: &Dataset, format: &str, name: &str, more: &[&str]) -> String {
    let path = dataset.beside(name);
    run(dataset, format, &path, more).exits(0).prints_nothing().says([&path]);
    path
}

/// Runs the command.
#[track_caller]
fn run(dataset: &Dataset, format: &str, path: &str, more: &[&str]) -> Ran {
    let command = ["export", &dataset.path, &dataset.out, "--to", format, "-o", path];
    Ran::of(&program().args(command).args(more).output().unwrap())
}

/// What `ralf label` found of one detection.
#[derive(Debug, Clone)]
struct Found {
    sequence: String,
    radar: String,
    scan: i64,
    point: i64,
    t_ns: i64,
    flags: i64,
    /// As the `.label` file has it.
    label: i64,
    /// `w`, and `w_lm`, `w_cm`, `w_tr`, `w_opt`.
    w: Option<f64>,
    branches: [Option<f64>; 4],
    /// Vehicle frame.
    x: Option<f64>,
    range: Option<f64>,
}

const BRANCHES: [&str; 4] = ["w_lm", "w_cm", "w_tr", "w_opt"];

/// All detections of a sequence in the order of `plausibility.parquet`.
fn found(dataset: &Dataset, sequence: &str) -> Vec<Found> {
    let folder = format!("{}/sequences/{sequence}", dataset.out);
    let mut all = Vec::new();
    for row in rows(format!("{folder}/plausibility.parquet")) {
        let (radar, scan) = (row.radar().to_owned(), row.whole("scan").unwrap());
        let point = row.whole("point").unwrap();
        let labels = fs::read(format!("{folder}/{radar}/{scan:06}.label")).unwrap();
        let label = i64::from(labels.as_chunks::<4>().0[point as usize][0]);
        all.push(Found {
            sequence: sequence.to_owned(),
            radar,
            scan,
            point,
            label,
            t_ns: row.whole("t_ns").unwrap(),
            flags: row.whole("flags").unwrap(),
            w: row.decimal("w"),
            branches: BRANCHES.map(|name| row.decimal(name)),
            x: row.decimal("x"),
            range: row.decimal("range"),
        });
    }
    assert!(all.iter().any(|found| found.label == 1) && all.iter().any(|found| found.label == 99));
    all
}

/// The rows that a package read.
#[track_caller]
fn list(read: &Value) -> &Vec<Value> {
    read["rows"].as_array().unwrap()
}

/// The float32 rows of a radar's scan, as recorded.
fn recorded(dataset: &Dataset, radar: &str, scan: i64, columns: usize) -> Vec<Vec<f64>> {
    let bytes = fs::read(dataset.file(&format!("{radar}/{scan:06}.bin"))).unwrap();
    let values: Vec<f64> =
        bytes.as_chunks::<4>().0.iter().map(|bytes| f64::from(f32::from_le_bytes(*bytes))).collect();
    values.chunks_exact(columns).map(<[f64]>::to_vec).collect()
}
