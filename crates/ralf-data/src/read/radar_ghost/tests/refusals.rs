//! What is refused, and how it is named.

use super::hdf5::{Columns, Values};
use super::recording::{lidar, radar, write_sequence};
use crate::read::radar_ghost::open;
use crate::testing::check_left_out;
use std::fs;

/// What opening a sequence of these tables says.
fn refused(radar: &Columns, lidar: &Columns) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scenario-01_a.h5");
    write_sequence(&file, radar, lidar);
    let error = open(&file, &[]).map(drop).unwrap_err().to_string();
    assert!(error.starts_with(file.to_str().unwrap()), "{error}");
    error
}

fn changed(columns: Columns, column: &str, values: impl Fn(Values) -> Values) -> Columns {
    let change = |(name, old)| (name, if name == column { values(old) } else { old });
    columns.into_iter().map(change).collect()
}

fn without(mut columns: Columns, column: &str) -> Columns {
    columns.retain(|(name, _)| *name != column);
    columns
}

#[test]
fn version_1_0_is_refused_with_the_reason() {
    let old = |(name, values): (&'static str, Values)| {
        let names = [("x_cc", "x_sc"), ("y_cc", "y_sc"), ("z_cc", "z_sc")];
        (names.iter().find(|(new, _)| *new == name).map_or(name, |(_, old)| old), values)
    };
    let error = refused(&radar(), &lidar().into_iter().map(old).collect());
    assert!(
        error.contains("lidar: this is version 1.0") && error.contains("10.5281/zenodo.6676246"),
        "{error}"
    );
}

#[test]
fn missing_columns_and_strange_values_are_named() {
    for column in
        ["frame", "timestamp", "sensor", "r_sc", "phi_sc", "vr_sc", "amp", "x_cc", "y_cc", "label_id"]
    {
        let error = refused(&without(radar(), column), &lidar());
        assert!(error.contains(&format!("radar, columns: expected a column `{column}`, found")), "{error}");
    }
    for column in ["timestamp", "x_cc", "y_cc", "z_cc"] {
        let error = refused(&radar(), &without(lidar(), column));
        assert!(error.contains(&format!("lidar, columns: expected a column `{column}`, found")), "{error}");
    }
    let renamed = |values: Values| {
        let Values::Text(bytes, mut names) = values else { panic!("texts") };
        names[9] = "top".into();
        Values::Text(bytes, names)
    };
    let error = refused(&changed(radar(), "sensor", renamed), &lidar());
    assert!(error.contains("radar, sensor, row 9: expected `left` or `right`, found `top`"), "{error}");
    let slow = |values: Values| {
        let Values::Double(times) = values else { panic!("doubles") };
        Values::Double(times.iter().map(|time| time * 50.0).collect())
    };
    let error = refused(&changed(radar(), "timestamp", slow), &lidar());
    assert!(error.contains("radar, timestamp: expected times of 10 ms to 1 s from scan to scan"), "{error}");
    let error = refused(&radar(), &changed(lidar(), "timestamp", slow));
    assert!(error.contains("lidar, timestamp: expected times"), "{error}");
    let none =
        |columns: Columns| columns.into_iter().map(|(name, values)| (name, values.picked(&[]))).collect();
    let error = refused(&none(radar()), &none(lidar()));
    assert!(error.contains("radar, lidar: expected rows, found none"), "{error}");
}

/// A recording with a label that nobody knows can still be labelled; its truth can't be read.
#[test]
fn a_label_that_the_convention_does_not_have_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scenario-01_a.h5");
    let strange = |values: Values| {
        let Values::Long(mut ids) = values else { panic!("whole numbers") };
        ids[5] = 7;
        Values::Long(ids)
    };
    write_sequence(&file, &changed(radar(), "label_id", strange), &lidar());
    let recording = open(&file, &[]).unwrap();
    assert!(recording.sequences[0].radar_scan(0, 0).is_ok());
    let error = recording.sequences[0].truth(0, 0).unwrap_err().to_string();
    assert!(error.contains("radar, label_id: expected 0, -1, -2 or four digits"), "{error}");
    assert!(error.ends_with("found 7 in row 5"), "{error}");
}

#[test]
fn other_files_and_two_of_one_name_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("train/scenario-01_a.h5");
    write_sequence(&file, &radar(), &lidar());
    let whole = fs::read(&file).unwrap();
    fs::create_dir(folder.path().join("val")).unwrap();
    fs::write(folder.path().join("val/scenario-01_a.h5"), &whole).unwrap();
    let error = open(folder.path(), &[]).map(drop).unwrap_err().to_string();
    assert!(error.contains("name: expected a name that no other sequence has, found"), "{error}");
    fs::write(&file, &whole[..whole.len() / 2]).unwrap();
    assert!(open(&file, &[]).map(drop).unwrap_err().to_string().contains("scenario-01_a.h5: "));
    let empty = tempfile::tempdir().unwrap();
    let error = open(empty.path(), &[]).map(drop).unwrap_err().to_string();
    assert!(error.contains("files: expected sequences, `scenario-*.h5`, found none"), "{error}");
}

#[test]
fn a_damaged_sequence_costs_the_others_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join("train").join(name).with_extension("h5");
    let names = ["scenario-01_a", "scenario-01_b"];
    names.into_iter().for_each(|name| write_sequence(&file(name), &radar(), &lidar()));
    let whole = fs::read(file(names[1])).unwrap();
    fs::write(file(names[1]), &whole[..whole.len() / 2]).unwrap();
    check_left_out(folder.path(), names, "scenario-01_b.h5: ");
}
