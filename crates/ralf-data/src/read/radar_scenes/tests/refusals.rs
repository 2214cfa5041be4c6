//! What is refused, and how it is named.

use super::hdf5::Values;
use super::recording::{Sequence, sensors, sequence, write_dataset, write_sequence};
use crate::read::radar_scenes::open;
use crate::testing::check_left_out;
use std::fs;

/// What opening a changed sequence says.
fn refused(change: impl Fn(&mut Sequence)) -> String {
    let folder = tempfile::tempdir().unwrap();
    let mut changed = sequence(false);
    change(&mut changed);
    write_sequence(&folder.path().join("sequence_1"), &changed);
    open(folder.path(), &[]).map(drop).unwrap_err().to_string()
}

#[test]
fn scenes_that_do_not_fit_the_table_are_named() {
    let first = "156862647501";
    let with = |key: &'static str, value: serde_json::Value| {
        move |changed: &mut Sequence| changed.scenes["scenes"][first][key] = value.clone()
    };
    for (error, words) in [
        (
            refused(with("radar_indices", [0, 4].into())),
            "radar_indices: expected every row once, found row 4, then row 5",
        ),
        (
            refused(with("radar_indices", [0, 99].into())),
            "scene 156862647501: expected rows of the 35 of radar_data, found 0 to 99",
        ),
        (refused(with("radar_indices", [5, 0].into())), "expected rows of the 35"),
        (refused(with("sensor_id", 3.into())), "expected detections of radar 3, found some of radar 2"),
        (refused(with("sensor_id", "two".into())), "scenes.json: line 1, column"),
        (
            refused(|changed| {
                changed.scenes =
                    serde_json::json!({"scenes": {"soon": {"sensor_id": 1, "radar_indices": [0, 0]}}})
            }),
            "scene soon: expected a time in us",
        ),
        (
            refused(|changed| changed.scenes["scenes"] = serde_json::json!({})),
            "every row once, found row 0, then row 35",
        ),
    ] {
        assert!(error.contains(words), "{error} lacks {words}");
    }
}

#[test]
fn damaged_tables_are_named() {
    let long = |values: &mut Values, change: &dyn Fn(&mut Vec<i64>)| {
        let Values::Long(numbers) = values else { panic!("whole numbers") };
        change(numbers);
    };
    for (error, words) in [
        (
            refused(|changed| drop(changed.radar.remove(5))),
            "radar_data, columns: expected a column `vr`, found timestamp",
        ),
        (
            refused(|changed| drop(changed.odometry.remove(3))),
            "odometry, columns: expected a column `yaw_seq`",
        ),
        (
            refused(|changed| long(&mut changed.odometry[0].1, &|times| times[4] = times[3])),
            "odometry, timestamp, row 4: expected times that ascend",
        ),
        (
            refused(|changed| long(&mut changed.odometry[0].1, &|times| times[0] = i64::MIN + 1)),
            "odometry, timestamp, row 0",
        ),
        (
            refused(|changed| changed.odometry[3].1 = Values::Double(vec![f64::NAN; 33])),
            "row 0: expected numbers, found",
        ),
        (
            refused(|changed| {
                changed.odometry.iter_mut().for_each(|(_, values)| *values = values.picked(&[]))
            }),
            "odometry: expected rows, found none",
        ),
    ] {
        assert!(error.contains(words), "{error} lacks {words}");
    }
}

#[test]
fn strange_mountings_and_labels_are_named() {
    let folder = tempfile::tempdir().unwrap();
    write_dataset(folder.path());
    let file = folder.path().join("data/sensors.json");
    let mut other = sensors();
    other["radar_2"]["id"] = 7.into();
    fs::write(&file, other.to_string()).unwrap();
    let error = open(folder.path(), &[]).map(drop).unwrap_err().to_string();
    assert!(error.contains("sensor_id: expected the id of a radar that has a mounting, found 2"), "{error}");
    let mut twice = sensors();
    twice["radar_3_again"] = twice["radar_3"].clone();
    fs::write(&file, twice.to_string()).unwrap();
    assert!(open(folder.path(), &[]).is_ok());
    twice["radar_3_again"]["yaw"] = 2.0.into();
    fs::write(&file, twice.to_string()).unwrap();
    let error = open(folder.path(), &[]).map(drop).unwrap_err().to_string();
    assert!(
        error.ends_with(
            "sensors.json: radar_3_again, id: expected an id of its own, \
             found 3, which radar_3 has, too, with another mounting"
        ),
        "{error}"
    );
    let mut far = sensors();
    far["radar_2"]["x"] = 1e308.into();
    fs::write(&file, far.to_string()).unwrap();
    let error = open(folder.path(), &[]).map(drop).unwrap_err().to_string();
    assert!(error.contains("sensors.json: radar_2: expected at most 1000 m from the vehicle"), "{error}");
    fs::write(&file, "{\"radar_2\": {\"id\": 2}}").unwrap();
    let error = open(folder.path(), &[]).map(drop).unwrap_err().to_string();
    assert!(error.contains("sensors.json: line 1, column") && error.contains("missing field `x`"), "{error}");
    let mut strange = sequence(false);
    let Values::Byte(labels) = &mut strange.radar[13].1 else { panic!("bytes") };
    labels[6] = 12;
    write_sequence(&folder.path().join("sequence_2"), &strange);
    let recording = open(&folder.path().join("sequence_2"), &[]).unwrap();
    let error = recording.sequences[0].truth(0, 0).unwrap_err().to_string();
    assert!(error.contains("label_id: expected a class from 0 to 11, found 12 in row 6"), "{error}");
}

#[test]
fn a_damaged_sequence_costs_the_others_nothing() {
    let folder = tempfile::tempdir().unwrap();
    write_dataset(folder.path());
    let damaged = folder.path().join("data/sequence_2");
    write_sequence(&damaged, &sequence(false));
    fs::write(damaged.join("radar_data.h5"), "").unwrap();
    check_left_out(folder.path(), ["sequence_1", "sequence_2"], "sequence_2/radar_data.h5: ");
}
