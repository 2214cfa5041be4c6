//! What is damaged or contradicts itself is named.

use super::*;

#[test]
fn scans_that_are_damaged_name_the_place() {
    let whole = pcd(&[detection(1.0, 0.0, 0, [0.0; 4])]);
    let text = |from: &str, to: &str| {
        let mut bytes = HEADER.replace("{n}", "1").replace(from, to).into_bytes();
        bytes.extend(detection(1.0, 0.0, 0, [0.0; 4]));
        bytes
    };
    let data = HEADER.replace("{n}", "1").len();
    let cases: Vec<(Vec<u8>, String)> = vec![
        (
            whole[..data + 42].to_vec(),
            format!("byte {}: expected 1 records of 43 bytes from byte {data}", data + 42),
        ),
        (whole[..data - 15].to_vec(), "expected a PCD header up to `DATA`".into()),
        (vec![0xff; 40], "byte 0".into()),
        (vec![], "byte 0: expected a PCD header".into()),
        (
            text("DATA binary", "DATA zip"),
            "DATA: expected binary, binary_compressed or ascii, found zip".into(),
        ),
        (text(" vy_rms", ""), "SIZE: expected 17 entries, one per field, found 18".into()),
        (text("invalid_state", "state"), "a field `invalid_state`".into()),
        (text("COUNT 1 1 1 1 1", "COUNT 1 1 1 1 2"), "field `id`".into()),
        (text("SIZE 4", "SIZE 2"), "field `x`: expected one value of type F 4".into()),
        (text("WIDTH 1", "WIDTH -1"), "WIDTH: expected a whole number, found -1".into()),
        (text("WIDTH 1", "WIDTH 2"), "POINTS: expected WIDTH x HEIGHT = 2 x 1, found 1".into()),
        (text("POINTS 1\n", ""), "header: expected a line `POINTS`".into()),
        (text("WIDTH 1", "WIDTH 18446744073709551615"), "POINTS: expected".into()),
    ];
    for (bytes, words) in cases {
        let set = DataSet::new();
        set.write("samples/RADAR_FRONT/a.pcd", &bytes);
        let error = set.open().unwrap().radar_scan(0, 0).unwrap_err().to_string();
        assert!(error.contains(&words) && error.contains("a.pcd"), "{error} lacks {words}");
    }
}

#[test]
fn clouds_and_images_that_are_damaged_name_the_file() {
    let set = DataSet::new();
    set.write("samples/LIDAR_TOP/a.pcd.bin", &[0; 21]);
    let error = set.open().unwrap().lidar_scan(0, 0).unwrap_err().to_string();
    assert!(error.contains("a.pcd.bin: byte 20"), "{error}");
    image::RgbImage::new(5, 2).save(set.folder("samples/CAM_FRONT").join("a.png")).unwrap();
    let error = set.open().unwrap().image(0, 0).unwrap_err().to_string();
    assert!(
        error.contains("a.png: image size: expected 4 x 2 px, as the camera has, found 5 x 2 px"),
        "{error}"
    );
    set.write("samples/CAM_FRONT/a.png", b"no image");
    let error = set.open().unwrap().image(0, 0).unwrap_err().to_string();
    assert!(error.contains("a.png: content"), "{error}");
}

#[test]
fn tables_that_contradict_each_other_are_refused() {
    let change = |table: &str, key: &str, value: Value, words: &[&str]| {
        let set = DataSet::new();
        set.edit(table, |rows| rows[0][key] = value);
        set.refused(words);
    };
    change(
        "sample_data",
        "sample_token",
        json!("?"),
        &["sample_data.json: line 1", "`?`, which sample.json lacks"],
    );
    change("sample_data", "calibrated_sensor_token", json!("?"), &["which calibrated_sensor.json lacks"]);
    change("sample_data", "ego_pose_token", json!("?"), &["ego_pose.json: tokens", "no `?`"]);
    change("sample_data", "timestamp", json!("soon"), &["sample_data.json: line", "invalid type: string"]);
    change("sample_data", "timestamp", json!(i64::MAX), &["sample_data.json: line", "out of range"]);
    change("calibrated_sensor", "sensor_token", json!("?"), &["calibrated_sensor.json", "sensor.json lacks"]);
    change("calibrated_sensor", "rotation", json!([0, 0, 0, 0]), &["no unit quaternion w x y z"]);
    change("ego_pose", "rotation", json!([1, 0, 0]), &["ego_pose.json", "invalid length 3"]);
    change("sensor", "modality", json!("sonar"), &["sample_data.json", "CAM_FRONT, which is neither radar"]);
    change("sensor", "token", json!("x".repeat(33)), &["sensor.json", "at most 32 characters"]);
    change("sample", "scene_token", json!("?"), &["sample.json", "scene.json lacks"]);
    change("scene", "log_token", json!("?"), &["scene.json", "log.json lacks"]);
    let set = DataSet::new();
    set.edit("calibrated_sensor", |rows| rows[3]["camera_intrinsic"][0][1] = json!(0.5));
    set.refused(&["calibrated_sensor.json: camera_intrinsic of CAM_FRONT"]);
}

#[test]
fn a_calibration_that_changes_inside_a_scene_is_refused() {
    let set = DataSet::new();
    set.edit("calibrated_sensor", |rows| {
        let mut other = rows[0].clone();
        (other["token"], other["translation"]) = (json!("other"), json!([3.0, 1.0, 0.6]));
        rows.push(other);
    });
    set.edit("sample_data", |rows| rows[0]["calibrated_sensor_token"] = json!("other"));
    set.refused(&[
        "sample_data.json: line",
        "calibrated_sensor of RADAR_FRONT that changes inside scene-0001",
    ]);
}

#[test]
fn a_second_row_of_a_token_says_the_same_or_is_refused() {
    for (table, key, value) in [
        ("calibrated_sensor", "translation", json!([3.0, 1.0, 0.6])),
        ("sensor", "channel", json!("RADAR_BACK_LEFT")),
        ("scene", "description", json!("Straight on")),
    ] {
        let set = DataSet::new();
        set.edit(table, |rows| rows.push(rows[0].clone()));
        assert!(set.open().is_ok(), "{table}");
        set.edit(table, |rows| rows[0][key] = value);
        set.refused(&[&format!("{table}.json: line"), "a second row of the token", "with other values"]);
    }
}

#[test]
fn a_measurement_that_is_listed_twice_is_read_once() {
    let set = DataSet::new();
    let count = |set: &DataSet| set.open().unwrap().sequence().times.radars[0].len();
    let once = count(&set);
    set.edit("sample_data", |rows| rows.extend(rows.clone()));
    set.edit("sample", |rows| rows.push(rows[0].clone()));
    assert_eq!(count(&set), once);
    set.edit("sample_data", |rows| rows[0]["timestamp"] = json!(T0 + 151 * MS));
    set.refused(&[
        "sample_data.json: token `sweeps/RADAR_FRONT/c.pcd`: expected one row, or rows that are alike",
    ]);
    let set = DataSet::new();
    set.edit("scene", |rows| {
        let mut other = rows[0].clone();
        (other["token"], other["name"]) = (json!("t"), json!("scene-0000"));
        rows.push(other);
    });
    set.edit("sample", |rows| rows.push(json!({"token": "x", "scene_token": "t", "timestamp": T0})));
    set.refused(&["sample.json: line", "a second row of the token `x`, with other values"]);
}

#[test]
fn a_sensor_far_from_the_vehicle_is_refused() {
    let set = DataSet::new();
    set.edit("calibrated_sensor", |rows| rows[0]["translation"][2] = json!(1e308));
    set.refused(&["calibrated_sensor.json: line 1", "m, where no sensor is mounted"]);
}

#[test]
fn a_scene_without_measurements_costs_the_others_nothing() {
    check_empty_scene::<DataSet>();
}

#[test]
fn a_filename_that_leads_out_of_the_data_set_is_refused() {
    check_filenames::<DataSet>();
}

#[test]
fn of_several_versions_one_is_opened_by_its_folder() {
    check_versions::<DataSet>("v1.0-mini");
}

#[test]
fn cut_and_missing_tables_are_named() {
    let set = DataSet::new();
    set.write(&format!("{VERSION}/ego_pose.json"), b"[{\"token\": \"a\", ");
    set.refused(&["ego_pose.json: line 1", "EOF"]);
    fs::remove_file(set.0.path().join(VERSION).join("log.json")).unwrap();
    set.refused(&["log.json"]);
}

#[test]
fn a_lorry_is_sent_to_its_own_reader() {
    let set = DataSet::new();
    set.table("ego_motion_chassis", json!([]));
    set.refused(&["found ego_motion_chassis.json, of MAN TruckScenes (--format truckscenes)"]);
    let rows = set.folder("v1.0-mini");
    fs::remove_dir(&rows).unwrap();
    fs::rename(set.0.path().join(VERSION), rows).unwrap();
    assert_eq!(crate::read::open(set.0.path(), None).unwrap().format, "truckscenes");
}

#[test]
fn exactly_one_version_folder() {
    let set = DataSet::new();
    assert!(recognises(set.0.path()));
    set.folder("v1.0-mini");
    set.refused(&["exactly one version folder", "found v1.0-mini, v1.0-test"]);
    let empty = tempfile::tempdir().unwrap();
    assert!(open(empty.path(), &[]).map(drop).unwrap_err().to_string().contains("found none"));
    assert!(!recognises(empty.path()));
}
