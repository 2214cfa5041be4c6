//! NPZ, Parquet, and nuScenes' sidecars.

use super::{BRANCHES, export, found, labelled, list, small};
use crate::support::{Dataset, Shape, put, ralf, read_export, rows, schema, tree};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// Rows as read hold what was found, in its order.
#[track_caller]
fn hold(read: &Value, dataset: &crate::support::Dataset, truth: fn(bool) -> Value) {
    let expected: Vec<_> = ["00", "01"].into_iter().flat_map(|sequence| found(dataset, sequence)).collect();
    assert_eq!(list(read).len(), expected.len());
    for (row, found) in list(read).iter().zip(expected) {
        assert_eq!(row["sequence"], found.sequence, "{row}");
        assert_eq!(row["radar"], found.radar, "{row}");
        for (name, value) in [
            ("scan", found.scan),
            ("point", found.point),
            ("t_ns", found.t_ns),
            ("label", found.label),
            ("flags", found.flags),
        ] {
            assert_eq!(row[name].as_i64(), Some(value), "{name}: {row}");
        }
        assert_eq!(row["plausible"], truth(found.label != 1), "{row}");
        assert_eq!(row["w"].as_f64(), found.w, "{row}");
        assert_eq!(BRANCHES.map(|name| row[name].as_f64()), found.branches, "{row}");
        // Of what was measured nothing, unless it was asked for.
        if row.get("range").is_some() {
            assert_eq!([row["x"].as_f64(), row["range"].as_f64()], [found.x, found.range], "{row}");
        }
    }
}

fn two() -> crate::support::Dataset {
    labelled(&Shape { scans: 3, sequences: &["00", "01"], ..Shape::default() })
}

const ANSWERS: [&str; 8] = ["d_lm", "d_cm", "d_tr", "w_lm", "w_cm", "w_tr", "w_opt", "w"];

#[test]
fn numpy_reads_an_archive_per_scan() {
    let dataset = two();
    let path = export(&dataset, "npz", "labels", &[]);
    assert_eq!(tree(format!("{path}/sequences/01/radar_left")).len(), 3);
    let Some(read) = read_export("npz", &path) else { return };
    hold(&read, &dataset, |plausible| json!(i8::from(plausible)));
    let mut types = json!({"scan": "uint32", "point": "uint32", "t_ns": "int64", "plausible": "int8",
        "label": "uint16", "flags": "uint16"});
    ANSWERS.iter().for_each(|name| types[name] = "float32".into());
    assert_eq!(read["types"], types);
    let read = read_export("npz", &export(&dataset, "npz", "measured", &["--sensors=radar"])).unwrap();
    hold(&read, &dataset, |plausible| json!(i8::from(plausible)));
    for name in ["x", "y", "z", "range", "azimuth", "elevation", "doppler", "rcs"] {
        types[name] = "float32".into();
    }
    assert_eq!(read["types"], types);
}

#[test]
fn arrow_reads_a_data_set_partitioned_by_sequence() {
    let dataset = two();
    let path = export(&dataset, "parquet", "labels", &[]);
    let names: Vec<String> = tree(&path).into_keys().filter(|name| name.contains('/')).collect();
    let file = |sequence, radar| format!("sequence={sequence}/{radar}.parquet");
    let expected = ["00", "01"].map(|sequence| [file(sequence, "radar_front"), file(sequence, "radar_left")]);
    assert_eq!(names, expected.concat());
    let Some(read) = read_export("parquet", &path) else { return };
    hold(&read, &dataset, Value::from);
    let mut types = json!({"radar": "string not null", "scan": "uint32 not null", "point": "uint32 not null",
        "t_ns": "int64 not null", "plausible": "bool", "label": "uint16 not null", "flags": "uint16 not null",
        "sequence": "string"});
    ANSWERS.iter().for_each(|name| types[name] = "float".into());
    assert_eq!(read["types"], types);
    let path =
        export(&dataset, "parquet", "measured", &["--sensors", "--sequence", "00", "--sequence", "01"]);
    let read = read_export("parquet", &path).unwrap();
    hold(&read, &dataset, Value::from);
    assert_eq!(list(&read)[0]["rcs"], json!(3.0));
}

#[test]
fn what_a_model_says_is_exported_in_its_words() {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out, "--method", "learned"]).exits(0);
    let said = rows(dataset.result("plausibility.parquet"));
    let Some(arrays) = read_export("npz", &export(&dataset, "npz", "arrays", &[])) else { return };
    let data_set = read_export("parquet", &export(&dataset, "parquet", "tables", &[])).unwrap();
    assert!(said.iter().any(|row| row.text("cause") == Some("road")) && list(&arrays).len() == said.len());
    for ((said, array), row) in said.iter().zip(list(&arrays)).zip(list(&data_set)) {
        for name in ["cause", "visibility", "lacking"] {
            assert_eq!([array[name].as_str(), row[name].as_str()], [said.text(name); 2], "{name}: {array}");
        }
        assert_eq!(row["reason"].as_str(), said.text("reason"));
        assert!(array.get("reason").is_none() && array["reason_doppler"].is_number(), "{array}");
    }
}

#[test]
fn which_sensor_told_a_class_is_exported() {
    let mut dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    dataset.path = dataset.beside("simulated");
    let made = ["simulate", "-o", &dataset.path, "--preset", "tiny", "--scans", "2", "--segmentation"];
    ralf(made).exits(0);
    // Of the LiDAR's scans one tells classes, so that cameras are asked in the other alone.
    let scan = Path::new(&dataset.path).join("sequences/tiny/lidar_top/000000.bin");
    let points = fs::metadata(&scan).unwrap().len() as usize / 16;
    fs::write(scan.with_extension("label"), 50_u32.to_le_bytes().repeat(points)).unwrap();
    // The same sequence, of which no camera was asked.
    let mut untold = tree(format!("{}/sequences/tiny", dataset.path));
    untold.retain(|name, _| !name.contains("/segmentation"));
    put(&untold, format!("{}/sequences/untold", dataset.path));
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let said = rows(Path::new(&dataset.out).join("sequences/tiny/plausibility.parquet"));
    for source in [Some("lidar"), Some("camera"), Some("")] {
        assert!(said.iter().any(|row| row.text("class_from") == source), "{source:?}");
    }
    let tables = export(&dataset, "parquet", "tables", &[]);
    for of_radar in said.chunk_by(|one, next| one.radar() == next.radar()) {
        let radar = of_radar[0].radar();
        let exported = rows(format!("{tables}/sequence=tiny/{radar}.parquet"));
        let [told, exported] =
            [of_radar, &exported].map(|rows| rows.iter().map(|row| row.text("class_from")));
        assert!(exported.eq(told), "{radar}");
    }
    let untold = rows(format!("{tables}/sequence=untold/radar_front.parquet"));
    for row in &untold {
        let has_class = ![1, 99].contains(&row.whole("label").unwrap());
        assert_eq!(row.text("class_from"), Some(if has_class { "lidar" } else { "" }));
    }
    assert!(untold.iter().any(|row| row.text("class_from") == Some("lidar")));
    let Some(arrays) = read_export("npz", &export(&dataset, "npz", "arrays", &[])) else { return };
    for radar in ["radar_front", "radar_rear"] {
        let told = said.iter().filter(|row| row.radar() == radar).map(|row| row.text("class_from"));
        let of_radar = |row: &&Value| row["sequence"] == "tiny" && row["radar"] == radar;
        let arrays = list(&arrays).iter().filter(of_radar);
        assert!(arrays.map(|row| row["class_from"].as_str()).eq(told), "{radar}");
    }
}

/// A reader of the data set takes the columns of its first file for those of all.
#[test]
fn all_files_of_a_data_set_have_the_columns_of_every_sequence() {
    let dataset = Dataset::of(&Shape { scans: 2, sequences: &["00", "01"], ..Shape::default() });
    let file = format!("{}/sequences/01/sequence.toml", dataset.path);
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replacen("\"rcs\"", "\"power\"", 1)).unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out, "--no-check"]).exits(0);
    let path = export(&dataset, "parquet", "labels", &["--sensors"]);
    let table = |sequence, radar| format!("{path}/sequence={sequence}/{radar}.parquet");
    let columns = schema(table("00", "radar_front"));
    for (sequence, own, other) in [("00", "rcs", "power"), ("01", "power", "rcs")] {
        assert_eq!(schema(table(sequence, "radar_front")), columns);
        assert_eq!(schema(table(sequence, "radar_left")), columns);
        for row in rows(table(sequence, "radar_front")) {
            assert!(row.decimal(own).is_some() && row.decimal(other).is_none(), "{sequence}");
        }
    }
    // Of one sequence alone, the other's columns are nobody's.
    let alone = export(&dataset, "parquet", "alone", &["--sensors", "--sequence", "00"]);
    let alone = schema(format!("{alone}/sequence=00/radar_front.parquet"));
    assert_eq!(columns.len(), alone.len() + 1);
    assert!(alone.iter().all(|column| columns.contains(column) && !column.starts_with("power")));
    let Some(read) = read_export("parquet", &path) else { return };
    for name in ["rcs", "power"] {
        assert!(list(&read).iter().any(|row| row[name].is_number()), "{name}");
    }
}

/// Readers pass over files whose names begin with an underscore.
#[test]
fn the_rows_of_every_radar_are_found_whatever_its_name() {
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    dataset.edit("sequence.toml", "\"radar_left\"", "\"_front\"");
    fs::rename(dataset.file("radar_left"), dataset.file("_front")).unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out, "--no-check"]).exits(0);
    let path = export(&dataset, "parquet", "labels", &[]);
    export(&dataset, "parquet", "labels", &["--force"]);
    let files: Vec<String> = tree(&path).into_keys().filter(|name| name.contains('/')).collect();
    assert_eq!(files, ["radar_front", "radarradar_front"].map(|name| format!("sequence=00/{name}.parquet")));
    let named = rows(format!("{path}/sequence=00/radarradar_front.parquet"));
    assert!(!named.is_empty() && named.iter().all(|row| row.radar() == "_front"));
    let Some(read) = read_export("parquet", &path) else { return };
    assert_eq!(list(&read).len(), rows(dataset.result("plausibility.parquet")).len());
}

#[test]
fn sidecars_need_the_tokens_of_nuscenes() {
    let dataset = small();
    let path = dataset.beside("sidecars");
    let told =
        "00: sample_data tokens: only a recording that is read from the tables of nuScenes or TruckScenes";
    super::run(&dataset, "nuscenes", &path, &[]).exits(1).says([told]);
    assert!(!std::fs::exists(&path).unwrap());
}

#[test]
fn a_field_that_is_called_like_a_column_of_the_export_is_refused() {
    for name in ["plausible", "sequence"] {
        let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
        let file = format!("{}/sequences/00/sequence.toml", dataset.path);
        let text = fs::read_to_string(&file).unwrap();
        let renamed = text.replace("\"rcs\"", &format!("\"{name}\""));
        assert_ne!(renamed, text);
        fs::write(&file, renamed).unwrap();
        ralf(["label", &dataset.path, "-o", &dataset.out, "--no-check"]).exits(0);
        for format in ["parquet", "npz"] {
            let place = dataset.beside(format);
            let told =
                format!("expected fields of other names than those that the export adds, found `{name}`");
            super::run(&dataset, format, &place, &["--sensors"]).exits(1).ends_with_error([told.as_str()]);
            assert!(!fs::exists(&place).unwrap());
        }
        export(&dataset, "parquet", "plain", &[]);
    }
}
