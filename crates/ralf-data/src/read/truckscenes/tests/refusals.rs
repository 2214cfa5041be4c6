//! What is damaged or contradicts itself is named.

use super::*;

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
        &["sample_data.json: line 1", "which sample.json lacks"],
    );
    change("sample_data", "timestamp", json!(1.5), &["sample_data.json: line 1", "invalid type"]);
    change(
        "sensor",
        "modality",
        json!("sonar"),
        &["sample_data.json", "RADAR_LEFT_BACK, which is neither radar"],
    );
    change("ego_pose", "rotation", json!([0, 0, 0, 0]), &["ego_pose.json", "no unit quaternion"]);
    change("ego_motion_cabin", "vx", json!("fast"), &["ego_motion_cabin.json: line 1", "invalid type"]);
}

#[test]
fn a_scene_without_poses_is_refused() {
    let set = DataSet::new();
    set.edit("ego_pose", |rows| rows.drain(..130).for_each(drop));
    set.refused(&[SCENE, "expected at least one measurement with its ego pose"]);
    fs::remove_file(set.0.path().join(VERSION).join("ego_pose.json")).unwrap();
    set.refused(&["ego_pose.json"]);
}

#[test]
fn damaged_scans_name_file_and_place() {
    let set = DataSet::new();
    let error = |text: &str, is_radar: bool| {
        let channel = if is_radar { "RADAR_LEFT_FRONT" } else { "LIDAR_TOP_FRONT" };
        let file = set.file("samples", channel, 0);
        testing::write(&file, text.as_bytes());
        let scene = set.open().unwrap();
        let found =
            if is_radar { scene.radar_scan(0, 0).map(drop) } else { scene.lidar_scan(0, 0).map(drop) };
        let error = found.unwrap_err().to_string();
        assert!(error.contains(file.file_name().unwrap().to_str().unwrap()), "{error}");
        error
    };
    let head =
        "SIZE 4 4 4 4 8\nTYPE F F F F U\nCOUNT 1 1 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3 4 ";
    let lidar = |fields: &str, time: &str| error(&format!("FIELDS x y z {fields}\n{head}{time}"), false);
    assert!(lidar("intensity time", "5").contains("FIELDS: expected a field `timestamp`"));
    let found = lidar("intensity timestamp", "1695473000000000");
    assert!(found.contains("point 0, `timestamp`: expected a time within 1 s of the scan's"), "{found}");
    let found = error(&format!("FIELDS x y z rcs vrel_x\n{head}5"), true);
    assert!(found.contains("expected a field `vrel_y`, found x y z rcs vrel_x"), "{found}");
}

#[test]
fn the_version_is_told_by_the_folder() {
    for (name, expected) in [
        ("v1.0-mini", true),
        ("v1.2-trainval", true),
        ("v10.12-test", true),
        ("v1-mini", false),
        ("1.2-mini", false),
        ("v1.2", false),
        ("v1.x-mini", false),
    ] {
        assert_eq!(is_version(name), expected, "{name}");
    }
    let set = DataSet::new();
    fs::create_dir(set.0.path().join("v1.1-mini")).unwrap();
    set.refused(&["exactly one version folder", "found v1.1-mini, v1.2-mini"]);
}
