//! What is damaged or contradicts itself is named.

use super::recording::world::T0;
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

#[test]
fn a_filename_that_leads_out_of_the_data_set_is_refused() {
    check_filenames::<DataSet>();
}

#[test]
fn of_several_versions_one_is_opened_by_its_folder() {
    check_versions::<DataSet>("v1.2-trainval");
}

#[test]
fn a_scene_without_measurements_costs_the_others_nothing() {
    check_empty_scene::<DataSet>();
}

/// A second scene of another lorry, with a sample, a measurement and poses of its own, this much after the first, us.
fn other_lorry(set: &DataSet, after: i64, name: &str) {
    let twin = |rows: &mut Vec<Value>, changes: &[(&str, Value)]| {
        let mut row = rows[0].clone();
        changes.iter().for_each(|(key, value)| row[*key] = value.clone());
        rows.push(row);
    };
    set.edit("scene", |rows| twin(rows, &[("token", json!("scene")), ("name", json!(name))]));
    let of_scene = [("token", json!("sample")), ("scene_token", json!("scene"))];
    set.edit("sample", |rows| twin(rows, &of_scene));
    let us = T0 + after;
    let data = [("token", json!("data")), ("sample_token", json!("sample")), ("timestamp", json!(us))];
    set.edit("sample_data", |rows| twin(rows, &data));
    for later in [0, 10_000] {
        let pose = [("timestamp", json!(us + later)), ("translation", json!([0, 0, 0]))];
        set.edit("ego_pose", |rows| twin(rows, &pose));
    }
}

#[test]
fn two_lorries_at_one_time_are_refused() {
    let count = |set: &DataSet| crate::read::open(set.0.path(), None).unwrap().sequences.len();
    let apart = DataSet::new();
    other_lorry(&apart, 3_000_000, "another");
    assert_eq!(count(&apart), 2);
    for after in [100_000, 1_000_000] {
        let set = DataSet::new();
        other_lorry(&set, after, "another");
        let span = format!("`another` from {us}000 to {us}000 ns", us = T0 + after);
        set.refused(&[
            "ego_pose.json: timestamp: expected scenes",
            &format!("`{SCENE}` from "),
            &span,
            "m apart",
        ]);
    }
    // The same lorry a moment later: its poses are those of both scenes.
    let set = DataSet::new();
    other_lorry(&set, 300_000, "another");
    set.edit("ego_pose", |rows| rows.truncate(rows.len() - 2));
    assert_eq!(count(&set), 2);
}

#[test]
fn names_of_scenes_are_their_own() {
    for (name, words) in [
        ("", "a scene of the name \"\", which no folder can have"),
        ("../a", "a scene of the name \"../a\", which no folder can have"),
        (SCENE, "a second scene of the name"),
    ] {
        let set = DataSet::new();
        other_lorry(&set, 3_000_000, name);
        set.refused(&["scene.json: line 1", words]);
    }
}
