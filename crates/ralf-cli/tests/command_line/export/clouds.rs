//! PCD and SemanticKITTI's tree.

use super::{BRANCHES, export, found, list, recorded, small};
use crate::support::{Dataset, Shape, ralf, read_export, tree};
use serde_json::json;

#[test]
fn clouds_hold_the_radars_fields_and_what_was_found() {
    let dataset = small();
    let Some(read) = read_export("pcd", &export(&dataset, "pcd", "clouds", &[])) else { return };
    let expected = found(&dataset, "00");
    assert_eq!(list(&read).len(), expected.len());
    for (row, found) in list(&read).iter().zip(&expected) {
        assert_eq!((&row["radar"], &row["scan"]), (&json!(found.radar), &json!(found.scan)));
        assert_eq!([row["label"].as_i64(), row["flags"].as_i64()], [found.label, found.flags].map(Some));
        assert_eq!(row["plausibility"].as_f64(), found.w);
        assert_eq!(BRANCHES.map(|name| row[name].as_f64()), found.branches);
        let value = |name: &str| row[name].as_f64().unwrap();
        if found.radar == "radar_front" {
            let measured = &recorded(&dataset, "radar_front", found.scan, 5)[found.point as usize];
            assert_eq!(["x", "y", "z", "doppler", "rcs"].map(value), measured[..]);
        } else {
            let measured = &recorded(&dataset, "radar_left", found.scan, 3)[found.point as usize];
            assert_eq!(["range", "azimuth", "doppler"].map(value), measured[..]);
            assert!((value("x").hypot(value("y")) - measured[0]).abs() < 1e-5);
            assert!((value("y").atan2(value("x")) - measured[1]).abs() < 1e-6);
            assert_eq!(value("z"), 0.0, "it measures no elevation");
        }
    }
    assert_eq!(read["types"]["label"], "uint32");
    assert_eq!(read["types"]["flags"], "uint16");
    assert_eq!(read["viewpoints"]["radar_front"], json!([3.6, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0]));
}

/// pypcd4 reads fields up to the first character that it doesn't know, and takes those for all.
#[test]
fn fields_are_called_so_that_all_of_them_are_read() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    dataset.edit("sequence.toml", "\"doppler\", \"rcs\"", "\"speed m/s\", \"rcs [dBsm]\"");
    ralf(["label", &dataset.path, "-o", &dataset.out, "--no-check"]).exits(0);
    let path = export(&dataset, "pcd", "clouds", &[]);
    let cloud = std::fs::read(format!("{path}/sequences/00/radar_front/000000.pcd")).unwrap();
    let header = String::from_utf8_lossy(&cloud);
    assert!(header.contains("\nFIELDS x y z speed_m_s rcs__dBsm_ plausibility "), "{header}");
    let Some(read) = read_export("pcd", &path) else { return };
    let found = found(&dataset, "00");
    for (row, found) in list(&read).iter().zip(&found).filter(|(_, found)| found.radar == "radar_front") {
        let measured = &recorded(&dataset, "radar_front", found.scan, 5)[found.point as usize];
        let names = ["x", "y", "z", "speed_m_s", "rcs__dBsm_"];
        assert_eq!(names.map(|name| row[name].as_f64().unwrap()), measured[..]);
    }
}

#[test]
fn the_tree_of_semantic_kitti_is_one_sequence_per_radar() {
    let dataset = small();
    let path = export(&dataset, "semantickitti", "kitti", &["--sensors"]);
    let table = std::fs::read_to_string(format!("{path}/sequences.csv")).unwrap();
    assert_eq!(table, "number,sequence,radar,scans\n00,00,radar_front,3\n01,00,radar_left,3\n");
    let Some(read) = read_export("semantickitti", &path) else { return };
    let expected = found(&dataset, "00");
    assert_eq!(list(&read).len(), expected.len());
    for (row, found) in list(&read).iter().zip(&expected) {
        assert_eq!((&row["radar"], &row["scan"]), (&json!(found.radar), &json!(found.scan)));
        assert_eq!([row["label"].as_i64(), row["instance"].as_i64()], [Some(found.label), Some(0)]);
        assert_eq!(row["point"], found.point);
        let value = |name: &str| row[name].as_f64().unwrap();
        if found.radar == "radar_front" {
            let measured = &recorded(&dataset, "radar_front", found.scan, 5)[found.point as usize];
            let expected = [measured[0], measured[1], measured[2], measured[4]];
            assert_eq!(["x", "y", "z", "intensity"].map(value), expected);
        } else {
            assert_eq!(value("intensity"), 0.0, "no field of this radar is one");
        }
    }
    // At 5 m/s along x, a scan every 0.1 s.
    let files = &read["files"]["01"];
    assert_eq!(files["times"], json!([0.0, 0.1, 0.2]));
    for (pose, x) in files["poses"].as_array().unwrap().iter().zip([0.0, 0.5, 1.0]) {
        let expected = [1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let found = pose.as_array().unwrap().iter().map(|value| value.as_f64().unwrap());
        assert!(found.zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{pose}");
    }
    let mounting = files["Tr"].as_array().unwrap().iter().map(|value| value.as_f64().unwrap());
    let expected = [0.0, -1.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.9, 0.0, 0.0, 1.0, 0.5];
    assert!(mounting.zip(expected).all(|(a, b)| (a - b).abs() < 1e-9));
}

#[test]
fn labels_come_alone_unless_the_clouds_are_asked_for() {
    let dataset = small();
    let names: Vec<String> = tree(export(&dataset, "semantickitti", "kitti", &[])).into_keys().collect();
    assert!(names.iter().all(|name| !name.contains("velodyne") && !name.ends_with(".txt")), "{names:?}");
    assert_eq!(names.iter().filter(|name| name.ends_with(".label")).count(), 6);
}

#[test]
fn numbered_sequences_of_one_radar_keep_their_numbers() {
    let dataset = small();
    let toml = std::fs::read_to_string(dataset.file("sequence.toml")).unwrap();
    let begin = toml.rfind("[[radar]]").unwrap();
    let end = toml.find("[[lidar]]").unwrap();
    dataset.put("sequence.toml", [&toml[..begin], &toml[end..]].concat());
    std::fs::rename(dataset.file(""), format!("{}/sequences/08", dataset.path)).unwrap();
    crate::support::ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let path = export(&dataset, "semantickitti", "kitti", &["--sequence", "08"]);
    assert!(std::fs::exists(format!("{path}/sequences/08/labels/000002.label")).unwrap());
    let table = std::fs::read_to_string(format!("{path}/sequences.csv")).unwrap();
    assert_eq!(table, "number,sequence,radar,scans\n08,08,radar_front,3\n");
}
