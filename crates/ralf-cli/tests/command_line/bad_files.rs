//! A measurement that can't be read costs its own scans and no others; odd values cost nothing but themselves.

use crate::support::{Dataset, Ran, Row, ralf, rows};
use std::path::Path;

fn label(dataset: &Dataset) -> Ran {
    ralf(["label", &dataset.path, "-o", &dataset.out])
}

fn of_scan(dataset: &Dataset, radar: &str, scan: i64) -> Vec<Row> {
    let all = rows(dataset.result("plausibility.parquet"));
    all.into_iter().filter(|row| row.radar() == radar && row.whole("scan") == Some(scan)).collect()
}

#[test]
fn a_radar_scan_that_is_cut_short_is_the_only_one_left_out() {
    let dataset = Dataset::new();
    dataset.cut("radar_front/000003.bin", 7);
    let ran = label(&dataset).exits(3);
    let named = ran.not_labelled();
    assert_eq!(named.len(), 1, "{named:?}");
    let expected = "00 radar_front scan 3: sequences/00/radar_front/000003.bin: byte 500: expected rows of 5 float32 \
                    (20 bytes), found 13 bytes left over at the end";
    assert_eq!(named[0], expected);
    assert!(!dataset.result("radar_front/000003.label").exists());
    assert!(of_scan(&dataset, "radar_front", 3).is_empty());
    for neighbour in [2, 4] {
        assert!(of_scan(&dataset, "radar_front", neighbour).iter().any(|row| row.decimal("d_tr").is_some()));
    }
    assert_eq!(rows(dataset.result("plausibility.parquet")).len(), 7 * 26 + 8 * 20);
    // Asked again, it says so again.
    assert_eq!(label(&dataset).exits(3).says(["nothing to do"]).not_labelled(), [expected]);
}

#[test]
fn a_radar_scan_that_is_gone_is_a_failure() {
    let dataset = Dataset::new();
    std::fs::remove_file(dataset.file("radar_front/000003.bin")).unwrap();
    label(&dataset).exits(1).prints_nothing().says(["radar_front/timestamps.txt", "7 files", "8 lines"]);
}

#[test]
fn a_lidar_scan_that_is_cut_short_costs_no_radar_scan() {
    let dataset = Dataset::new();
    dataset.cut("lidar_top/000005.bin", 4);
    let told =
        ["labelled without: 00 lidar_top scan 5: ", "lidar_top/000005.bin: byte ", "rows of 4 float32"];
    assert!(label(&dataset).exits(0).says(told).not_labelled().is_empty());
    for row in of_scan(&dataset, "radar_front", 5) {
        assert_eq!((row.whole("flags").map(|flags| flags & 8), row.decimal("d_lm")), (Some(8), None));
        assert!(row.decimal("w").is_some() && row.decimal("d_tr").is_some());
    }
    let record = std::fs::read_to_string(Path::new(&dataset.out).join("run.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&record).unwrap();
    let named = &record["sequences"][0]["unreadable"];
    assert_eq!(
        (&named[0]["sensor"], &named[0]["scan"], named.as_array().unwrap().len()),
        (&"lidar_top".into(), &5.into(), 1)
    );
    // Asked again, it says so again.
    label(&dataset).exits(0).says(["nothing to do", "labelled without: 00 lidar_top scan 5"]);
    ralf(["inspect", &dataset.path]).exits(0).prints(["1 scans can't be read", "lidar_top scan 5: "]);
}

#[test]
fn lidar_classes_of_another_number_are_named() {
    let dataset = Dataset::new();
    dataset.put("lidar_top/000001.label", [0; 12]);
    let told =
        ["labelled without: 00 lidar_top scan 1", "lidar_top/000001.label", "one per point", "found 3"];
    label(&dataset).exits(0).says(told);
}

#[test]
fn without_any_readable_lidar_scan_the_other_branches_label() {
    let dataset = Dataset::new();
    for scan in 0..8 {
        dataset.cut(&format!("lidar_top/{scan:06}.bin"), 1);
    }
    assert!(
        label(&dataset).exits(0).says(["labelled without: 00 lidar_top scan 7"]).not_labelled().is_empty()
    );
    let rows = rows(dataset.result("plausibility.parquet"));
    assert_eq!(rows.len(), 8 * (26 + 20));
    assert!(rows.iter().all(|row| row.decimal("d_lm").is_none() && row.decimal("w_tr").is_some()));
}

#[test]
fn a_radar_that_saw_nothing_is_fine() {
    let dataset = Dataset::new();
    dataset.put("radar_front/000002.bin", []);
    dataset.put("ground_truth/radar_front/000002.label", []);
    label(&dataset).exits(0).says_nothing();
    assert!(std::fs::read(dataset.result("radar_front/000002.label")).unwrap().is_empty());
    assert!(of_scan(&dataset, "radar_front", 2).is_empty());
    ralf(["evaluate", &dataset.out, "--truth", &dataset.path]).exits(0).says_nothing();
}

#[test]
fn a_radar_that_never_saw_anything_is_doubted_and_all_else_is_labelled() {
    let dataset = Dataset::new();
    for scan in 0..8 {
        dataset.put(&format!("radar_left/{scan:06}.bin"), []);
    }
    let doubt =
        "radar_left are its files empty, as of a copy that broke off?: nothing was detected in 8 scans";
    label(&dataset).exits(0).says([doubt]).prints(["radar_left"]);
    assert_eq!(rows(dataset.result("plausibility.parquet")).len(), 8 * 26);
}

#[test]
fn a_lidar_that_saw_nothing_says_nothing_and_is_named() {
    let dataset = Dataset::new();
    dataset.put("lidar_top/000002.bin", []);
    label(&dataset).exits(0).says(["labelled without: 00 lidar_top scan 2: expected returns, found none"]);
    for row in of_scan(&dataset, "radar_left", 2) {
        assert_eq!([row.decimal("d_lm"), row.decimal("w_lm")], [None; 2]);
        assert_eq!(row.decimal("w_opt"), None);
        assert!(row.decimal("w_tr").is_some());
    }
}

#[test]
fn detections_without_a_place_keep_their_row() {
    let dataset = Dataset::new();
    let mut bytes = std::fs::read(dataset.file("radar_front/000004.bin")).unwrap();
    for (value, bad) in [(0, f32::NAN), (5 + 1, f32::INFINITY), (10 + 2, f32::NEG_INFINITY)] {
        bytes[4 * value..4 * value + 4].copy_from_slice(&bad.to_le_bytes());
    }
    // A field that is no coordinate may be missing alone.
    bytes[4 * 18..4 * 19].copy_from_slice(&f32::NAN.to_le_bytes());
    dataset.put("radar_front/000004.bin", bytes);
    label(&dataset).exits(0).says_nothing();
    let rows = of_scan(&dataset, "radar_front", 4);
    assert_eq!(rows.len(), 26);
    for row in &rows[..3] {
        assert_eq!(
            (row.whole("label"), row.whole("flags"), row.decimal("w")),
            (Some(0), Some(32), Some(0.0))
        );
        for column in
            ["x", "y", "z", "range", "azimuth", "elevation", "d_lm", "d_tr", "w_lm", "w_tr", "w_opt"]
        {
            assert_eq!(row.decimal(column), None, "{column}");
        }
    }
    assert_eq!((rows[3].decimal("doppler"), rows[3].whole("label")), (None, Some(1)));
    let labels = std::fs::read(dataset.result("radar_front/000004.label")).unwrap();
    assert_eq!(labels[..16], [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 99, 0, 0, 0]);
}

#[test]
fn lidar_points_without_a_place_are_skipped() {
    let dataset = Dataset::new();
    let whole = std::fs::read(dataset.file("lidar_top/000004.bin")).unwrap();
    label(&dataset).exits(0);
    let before = of_scan(&dataset, "radar_front", 4);
    let odd = [[f32::NAN, 1.0, 1.0, 0.0], [f32::INFINITY, 0.0, 0.0, 0.0], [0.0; 4]];
    let odd: Vec<u8> = odd.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    dataset.put("lidar_top/000004.bin", [odd, whole].concat());
    label(&dataset)
        .exits(0)
        .says(["sequence 00 is labelled again: it is read from other inputs than before"]);
    for (found, expected) in of_scan(&dataset, "radar_front", 4).iter().zip(&before) {
        assert_eq!(
            (found.whole("label"), found.whole("flags")),
            (expected.whole("label"), expected.whole("flags"))
        );
    }
}
