//! A disk that is full, and one that can't be written: nothing half-written stays.

use super::{export, small};
use crate::full_disk::with_files_up_to;
use crate::support::{Dataset, tree};
use std::fs;

/// What lies beside the recording and its results.
fn beside(dataset: &Dataset) -> Vec<String> {
    let folder = std::path::Path::new(&dataset.path).parent().unwrap().to_owned();
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort_unstable();
    names
}

#[test]
fn an_export_appears_whole_or_not_at_all() {
    let dataset = small();
    let before = beside(&dataset);
    let path = dataset.beside("labels");
    for format in ["npz", "pcd", "parquet", "mcap", "rosbag1"] {
        let arguments = ["export", &dataset.path, &dataset.out, "--to", format, "--sensors", "-o", &path];
        with_files_up_to(1, &arguments).exits(1).prints_nothing().says(["File too large"]);
        assert_eq!(beside(&dataset), before, "{format}");
    }
}

#[test]
fn an_earlier_export_stays_until_the_new_one_is_whole() {
    let dataset = small();
    let path = export(&dataset, "pcd", "labels", &[]);
    let before = tree(&path);
    let arguments = ["export", &dataset.path, &dataset.out, "--to", "pcd", "--force", "-o", &path];
    with_files_up_to(1, &arguments).exits(1).says(["File too large"]);
    assert!(tree(&path) == before);
}
