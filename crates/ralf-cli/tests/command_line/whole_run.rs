//! `ralf label` writes what docs/formats.md, section 2, says, and it means something.

use crate::support::{ARTIFACT, CAR, Dataset, Row, Shape, WALL, ralf, rows, schema, tree};
use serde_json::{Value, json};
use std::fs;

fn labelled(dataset: &Dataset) -> Vec<Row> {
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing();
    rows(dataset.result("plausibility.parquet"))
}

/// The classes in a `.label` file.
fn classes(bytes: &[u8]) -> Vec<u16> {
    bytes
        .as_chunks::<4>()
        .0
        .iter()
        .map(|b| u32::from_le_bytes(*b))
        .map(|v| u16::try_from(v).unwrap())
        .collect()
}

#[test]
fn exactly_these_files_appear() {
    let dataset = Dataset::of(&Shape { scans: 2, sequences: &["00", "01"], ..Shape::default() });
    labelled(&dataset);
    let mut expected = vec!["run.json".to_owned(), "sequences".to_owned()];
    for sequence in ["sequences/00", "sequences/01"] {
        expected.extend([sequence.to_owned(), format!("{sequence}/plausibility.parquet")]);
        for radar in ["radar_front", "radar_left"] {
            let files = ["", "/000000.label", "/000001.label"];
            expected.extend(files.map(|file| format!("{sequence}/{radar}{file}")));
        }
    }
    expected.sort();
    assert_eq!(tree(&dataset.out).into_keys().collect::<Vec<_>>(), expected);
}

/// All work is named in its order, and what a scan costs is that of all of them divided by their number: two radars
/// with eight scans each.
#[test]
fn where_the_time_went_is_said_and_changes_no_result() {
    let [dataset, plain] = [Dataset::new(), Dataset::new()];
    ralf(["label", &plain.path, "-o", &plain.out]).exits(0).says_nothing();
    let said = ralf(["label", &dataset.path, "-o", &dataset.out, "--timings"]).exits(0).stderr;
    let rows: Vec<&str> = said.lines().filter(|line| !line.is_empty()).collect();
    let names = [
        "work",
        "opening",
        "hashing inputs",
        "check",
        "scans: reading, ground, images",
        "scans: evidence",
        "scans: labels",
        "scans: keeping",
        "writing results",
    ];
    assert!(
        rows.len() == names.len() && rows.iter().zip(names).all(|(row, name)| row.starts_with(name)),
        "{said}"
    );
    let [seconds, each] =
        [1, 0].map(|place| rows[6].split_whitespace().nth_back(place).unwrap().parse::<f64>());
    let (seconds, each) = (seconds.unwrap(), each.unwrap());
    assert!(seconds > 0.0 && (each * 16.0 - 1e3 * seconds).abs() <= 0.5 + 16.0 * 0.0005, "{said}");
    let [timed, plain] =
        [&dataset, &plain].map(|dataset| fs::read(dataset.result("plausibility.parquet")).unwrap());
    assert!(timed == plain);
}

#[test]
fn the_table_has_the_columns_of_the_contract() {
    let dataset = Dataset::new();
    labelled(&dataset);
    let decimal = |name: &str| format!("{name}: FLOAT NONE or null");
    let expected: Vec<String> =
        ["radar: BYTE_ARRAY UTF8", "scan: INT32 UINT_32", "point: INT32 UINT_32", "t_ns: INT64 NONE"]
            .map(str::to_owned)
            .into_iter()
            .chain(["x", "y", "z", "range", "azimuth", "elevation", "doppler", "rcs"].map(decimal))
            .chain(["d_lm", "d_cm", "d_tr", "w_lm", "w_cm", "w_tr", "w_opt", "w"].map(decimal))
            .chain(
                ["label: INT32 UINT_8", "flags: INT32 UINT_16", "semantic: INT32 UINT_16 or null"]
                    .map(str::to_owned),
            )
            .collect();
    assert_eq!(schema(dataset.result("plausibility.parquet")), expected);
}

#[test]
fn rows_are_in_the_order_of_radar_scan_and_point() {
    let dataset = Dataset::new();
    let found: Vec<_> = labelled(&dataset)
        .iter()
        .map(|row| (row.radar().to_owned(), row.whole("scan").unwrap(), row.whole("point").unwrap()))
        .collect();
    let of_radar = |name: &'static str, points: i64| {
        (0..8).flat_map(move |scan| (0..points).map(move |point| (name.to_owned(), scan, point)))
    };
    assert_eq!(found, of_radar("radar_front", 26).chain(of_radar("radar_left", 20)).collect::<Vec<_>>());
}

#[test]
fn what_is_absent_is_null_and_nothing_is_nan() {
    let dataset = Dataset::new();
    for row in labelled(&dataset) {
        let left = row.radar() == "radar_left";
        assert_eq!([row.decimal("elevation").is_none(), row.decimal("rcs").is_none()], [left, left]);
        assert_eq!([row.decimal("d_cm"), row.decimal("w_cm").filter(|w| *w != 0.0)], [None; 2]);
        assert_eq!(row.whole("semantic"), None);
        let decimals =
            ["x", "y", "z", "range", "azimuth", "doppler", "d_lm", "d_tr", "w_lm", "w_tr", "w_opt", "w"];
        for value in decimals.into_iter().filter_map(|column| row.decimal(column)) {
            assert!(value.is_finite());
        }
        assert!((0.0..=1.0).contains(&row.decimal("w").unwrap()));
    }
}

#[test]
fn a_detection_lies_where_it_was_measured() {
    let dataset = Dataset::new();
    let rows = labelled(&dataset);
    let at = |radar: &str, scan: i64| {
        rows.iter().find(|row| row.radar() == radar && row.whole("scan") == Some(scan)).unwrap()
    };
    // The wall's first detection lies at x = 8, y = 10, z = 1 of the world; the vehicle drives 0.5 m from scan to scan.
    let ahead = at("radar_front", 2);
    for (column, expected) in [("x", 7.0), ("y", 10.0), ("z", 1.0)] {
        assert!((ahead.decimal(column).unwrap() - expected).abs() < 0.04, "{column}");
    }
    assert_eq!(ahead.whole("t_ns"), Some(1_700_000_000_200_000_000));
    let left = at("radar_left", 0);
    for (column, expected) in [("x", -6.185), ("y", 10.0), ("z", 0.5)] {
        assert!((left.decimal(column).unwrap() - expected).abs() < 0.04, "{column}");
    }
    assert!((left.decimal("range").unwrap() - 9.1_f64.hypot(8.185)).abs() < 0.1);
}

/// A radar of x, y, z whose last field is called like a column that is computed elsewhere.
#[test]
fn a_range_that_is_told_beside_the_place_is_kept_and_moves_no_label() {
    let [plain, told] = [Dataset::new(), Dataset::new()];
    let strengths = labelled(&plain);
    for name in ["range", "azimuth", "elevation"] {
        told.put("sequence.toml", fs::read_to_string(plain.file("sequence.toml")).unwrap());
        told.edit("sequence.toml", "\"rcs\"", &format!("\"{name}\""));
        let out = told.beside(name);
        ralf(["label", &told.path, "-o", &out, "--no-check"]).exits(0);
        let rows = rows(format!("{out}/sequences/00/plausibility.parquet"));
        assert_eq!(rows.len(), strengths.len());
        for (row, strength) in rows.iter().zip(&strengths).filter(|(row, _)| row.radar() == "radar_front") {
            assert_eq!(row.decimal(name), strength.decimal("rcs"), "{name}");
            for column in ["x", "y", "z", "d_lm", "d_tr", "w_lm", "w_tr", "w_opt", "w"] {
                assert_eq!(row.decimal(column), strength.decimal(column), "{name}: {column}");
            }
        }
    }
}

#[test]
fn label_files_say_1_or_99_as_the_table_does() {
    let dataset = Dataset::new();
    let rows = labelled(&dataset);
    for (radar, scan) in [("radar_front", 0), ("radar_left", 7)] {
        let of_scan = rows.iter().filter(|row| row.radar() == radar && row.whole("scan") == Some(scan));
        let expected: Vec<u16> =
            of_scan.map(|row| if row.whole("label") == Some(1) { 99 } else { 1 }).collect();
        let file = dataset.result(&format!("{radar}/{scan:06}.label"));
        assert_eq!(classes(&fs::read(file).unwrap()), expected);
        assert!(expected.contains(&99) && expected.contains(&1));
    }
}

#[test]
fn classes_come_from_a_lidar_that_carries_them() {
    let dataset = Dataset::of(&Shape { classes: true, ..Shape::default() });
    let rows = labelled(&dataset);
    let found = classes(&fs::read(dataset.result("radar_front/000003.label")).unwrap());
    assert_eq!(found[..16], [[WALL; 10].as_slice(), &[CAR; 6]].concat());
    assert_eq!(found[16..], [ARTIFACT; 10]);
    let semantic =
        rows.iter().filter(|row| row.whole("label") == Some(1)).map(|row| row.whole("semantic").unwrap());
    assert!(semantic.clone().all(|class| [i64::from(WALL), i64::from(CAR)].contains(&class)));
}

#[test]
fn what_lies_below_the_road_is_flagged_as_ground() {
    let dataset = Dataset::new();
    for row in labelled(&dataset) {
        let below = row.radar() == "radar_front" && row.whole("point") == Some(25);
        assert_eq!(row.whole("flags").unwrap() & 1 == 1, below);
        if below {
            assert_eq!([row.decimal("d_lm"), row.decimal("d_cm")], [None; 2]);
            assert_eq!(["w_lm", "w_cm", "w_opt"].map(|column| row.decimal(column)), [Some(0.0); 3]);
            assert_eq!(row.whole("label"), Some(0));
        }
    }
}

#[test]
fn labels_are_right_where_the_truth_is_known() {
    let dataset = Dataset::new();
    labelled(&dataset);
    let found =
        ralf(["evaluate", &dataset.out, "--truth", &dataset.path, "--json"]).exits(0).says_nothing().json();
    let pooled = &found["overall"]["pooled"];
    assert!(
        pooled["recall"].as_f64().unwrap() > 0.97 && pooled["precision"].as_f64().unwrap() > 0.97,
        "{pooled}"
    );
    let counts = ["tp", "fp", "tn", "fn"].map(|key| pooled[key].as_u64().unwrap());
    assert_eq!(counts.iter().sum::<u64>(), 8 * (26 + 20));
}

#[test]
fn the_record_names_version_settings_inputs_and_scans() {
    let dataset = Dataset::new();
    labelled(&dataset);
    let record: Value =
        serde_json::from_slice(&fs::read(format!("{}/run.json", dataset.out)).unwrap()).unwrap();
    let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    let expected = ["check", "format", "inputs", "program", "sequences", "settings", "timings", "version"];
    assert_eq!(keys(&record), expected);
    assert_eq!((&record["version"], &record["format"]), (&json!(env!("CARGO_PKG_VERSION")), &json!("ralf")));
    assert_eq!(record["settings"]["lidar"]["neighbours"], json!(3));
    let inputs = record["inputs"].as_array().unwrap();
    // sequence.toml, odometry.csv, and per sensor eight scans and their times.
    assert_eq!(inputs.len(), 2 + 3 * 9);
    assert!(inputs.iter().all(|input| keys(input) == ["blake3", "bytes", "file", "mtime_ns", "sequence"]));
    assert!(
        inputs
            .iter()
            .any(|input| input["file"] == "sequences/00/radar_front/000007.bin" && input["bytes"] == 520)
    );
    let sequence = &record["sequences"][0];
    assert_eq!((&sequence["name"], &sequence["not_labelled"]), (&json!("00"), &json!([])));
    assert_eq!(sequence["radars"][1]["name"], json!("radar_left"));
    assert_eq!(sequence["radars"][1]["detections"], json!(vec![20; 8]));
    assert_eq!(sequence["radars"][0]["flags"], json!(vec![1; 8]));
}
