//! Sequences that are labelled one after the other, into the same folder.

use crate::support::{Dataset, Shape, nuscenes, ralf, tree, without_timings};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const OTHER: &str = "fusion.threshold=0.9";

fn two() -> Dataset {
    Dataset::of(&Shape { scans: 4, sequences: &["00", "01"], ..Shape::default() })
}

/// The names of the sequences that `run.json` tells of.
fn recorded(dataset: &Dataset) -> Vec<String> {
    let record: Value =
        serde_json::from_slice(&fs::read(format!("{}/run.json", dataset.out)).unwrap()).unwrap();
    let names = record["sequences"].as_array().unwrap().iter();
    names.map(|sequence| sequence["name"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn one_after_the_other_is_the_same_as_all_at_once() {
    for order in [["00", "01"], ["01", "00"]] {
        let dataset = two();
        let whole = dataset.beside("whole");
        ralf(["label", &dataset.path, "-o", &whole, "--jobs", "1"]).exits(0);
        for sequence in order {
            ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", sequence, "--jobs", "3"])
                .exits(0)
                .says_nothing();
        }
        assert_eq!(recorded(&dataset), ["00", "01"]);
        assert!(without_timings(&dataset.out) == without_timings(&whole));
        let before = tree(&dataset.out);
        ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says(["nothing to do"]);
        assert!(tree(&dataset.out) == before);
    }
}

#[test]
fn radars_of_very_many_sequences_are_summed_up() {
    const NAMES: &[&str] = &[
        "00", "01", "02", "03", "04", "05", "06", "07", "08", "09", "10", "11", "12", "13", "14", "15", "16",
        "17", "18", "19", "20", "21", "22", "23", "24",
    ];
    let rows = |sequences: &'static [&str]| {
        let dataset = Dataset::of(&Shape { scans: 2, sequences, ..Shape::default() });
        let ran = ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
        ran.stdout.lines().filter(|line| line.contains("radar_front")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(rows(&NAMES[..24]).len(), 24);
    let [row] = <[String; 1]>::try_from(rows(NAMES)).unwrap();
    assert_eq!(
        row.split_whitespace().take(4).collect::<Vec<_>>(),
        ["(25", "sequences)", "radar_front", "50"]
    );
}

#[test]
fn only_what_is_not_labelled_yet_is_labelled() {
    let dataset = two();
    ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", "00"]).exits(0);
    let table = dataset.result("plausibility.parquet");
    let written = fs::metadata(&table).unwrap().modified().unwrap();
    let ran = ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing();
    ran.prints(["00", "01", "\n8 scans, "]);
    assert_eq!(fs::metadata(&table).unwrap().modified().unwrap(), written);
}

#[test]
fn other_settings_remove_the_other_sequences_and_say_so() {
    let dataset = two();
    let fresh = dataset.beside("fresh");
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let notes = dataset.result("notes.txt");
    fs::write(&notes, "mine").unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", "01", "--set", OTHER])
        .exits(0)
        .says(["removed", "other settings: 00\n"]);
    // What people put there stays.
    fs::remove_file(&notes).unwrap();
    fs::remove_dir(notes.parent().unwrap()).unwrap();
    ralf(["label", &dataset.path, "-o", &fresh, "--sequence", "01", "--set", OTHER]).exits(0);
    assert!(without_timings(&dataset.out) == without_timings(&fresh));
}

#[test]
fn a_sequence_that_changed_leaves_the_others_alone() {
    let dataset = two();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    dataset.edit("sequence.toml", "sigma_azimuth_deg = 0.6", "sigma_azimuth_deg = 0.7");
    let whole = dataset.beside("whole");
    ralf(["label", &dataset.path, "-o", &whole]).exits(0);
    let ran = ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).prints(["\n8 scans, "]);
    let ran = ran.says(["sequence 00 is labelled again: it is read from other inputs than before"]);
    assert!(!ran.stderr.contains("01"), "{}", ran.stderr);
    assert!(without_timings(&dataset.out) == without_timings(&whole));
}

#[test]
fn labels_of_another_recording_are_left_as_they_are() {
    let dataset = two();
    let shape = Shape { scans: 5, sequences: &["00", "02"], ..Shape::default() };
    let other = Dataset::of_another_drive(&shape);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let before = tree(&dataset.out);
    let label = |more: [&str; 2]| ralf(["label", &other.path, "-o", &dataset.out, more[0], more[1]]);
    let there = fs::canonicalize(&dataset.path).unwrap();
    for more in [["--jobs", "1"], ["--sequence", "00"], ["--set", OTHER]] {
        label(more).exits(1).prints_nothing().ends_with_error([
            "run.json: recording: expected labels of ",
            &other.path,
            "found those of another recording, ",
            there.to_str().unwrap(),
            "which would go (",
            "): label into another folder, or move these labels away",
        ]);
        assert!(tree(&dataset.out) == before, "{more:?}");
    }
    // With other settings all labels would go.
    let all = ["label", &other.path, "-o", &dataset.out, "--sequence", "02", "--set", OTHER];
    ralf(all).exits(1).ends_with_error(["those of another recording, ", "which would go (00, 01)"]);
    assert!(tree(&dataset.out) == before);
    // Of what has no labels yet, nothing is lost.
    label(["--sequence", "02"]).exits(0).says_nothing();
    assert_eq!(recorded(&dataset), ["00", "01", "02"]);
}

#[test]
fn a_recording_that_was_moved_or_changed_where_it_lies_is_the_same() {
    let dataset = two();
    let other = Dataset::of_another_drive(&Shape { scans: 5, ..Shape::default() });
    let moved = dataset.beside("moved");
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    fs::rename(&dataset.path, &moved).unwrap();
    let label = || ralf(["label", &moved, "-o", &dataset.out]).exits(0);
    label().says(["nothing to do"]);
    let told = "sequence 00 is labelled again: it is read from other inputs than before";
    fs::write(format!("{moved}/sequences/00/odometry.csv"), fs::read(other.file("odometry.csv")).unwrap())
        .unwrap();
    label().says([told]);
    fs::remove_dir_all(format!("{moved}/sequences")).unwrap();
    fs::rename(format!("{}/sequences", other.path), format!("{moved}/sequences")).unwrap();
    ralf(["label", &moved, "-o", &dataset.out, "--sequence", "00"]).exits(0).says([told]);
}

#[test]
fn where_a_recording_has_moved_to_it_may_change_as_it_likes() {
    let dataset = two();
    let other = Dataset::of_another_drive(&Shape { scans: 5, ..Shape::default() });
    let moved = dataset.beside("moved");
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    fs::rename(&dataset.path, &moved).unwrap();
    ralf(["label", &moved, "-o", &dataset.out]).exits(0).says(["nothing to do"]);
    fs::remove_dir_all(format!("{moved}/sequences")).unwrap();
    fs::rename(format!("{}/sequences", other.path), format!("{moved}/sequences")).unwrap();
    let told = "sequence 00 is labelled again: it is read from other inputs than before";
    ralf(["label", &moved, "-o", &dataset.out]).exits(0).says([told]);
}

#[test]
fn a_sequence_that_is_gone_is_named_and_its_labels_stay() {
    let dataset = two();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    fs::remove_dir_all(format!("{}/sequences/01", dataset.path)).unwrap();
    let before = tree(&dataset.out);
    let told = "expected all sequences that were labelled from here, found none of 01: their labels stay as they are";
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says(["nothing to do", &dataset.path, told]);
    let chosen = ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", "00"]).exits(0);
    assert!(!chosen.stderr.contains("found none of"), "{}", chosen.stderr);
    assert!(tree(&dataset.out) == before);
}

#[test]
fn a_damaged_sequence_is_in_nobodys_way_who_asks_for_another() {
    let dataset = two();
    let odometry = format!("{}/sequences/01/odometry.csv", dataset.path);
    fs::write(&odometry, "no odometry").unwrap();
    let told = |command: &str| ralf([command, &dataset.path, "--sequence", "01"]).exits(1).says([&odometry]);
    told("inspect");
    told("check");
    let left_out = ["left out: 01: ", &odometry];
    ralf(["inspect", &dataset.path]).exits(3).says(left_out);
    ralf(["inspect", &dataset.path, "--sequence", "00"]).exits(0);
    ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", "00"]).exits(0).says_nothing();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(3).says(left_out).says(["nothing to do"]);
    // A folder that lacks it is damaged as well.
    let sensors = format!("{}/sequences/01/sequence.toml", dataset.path);
    fs::remove_file(&sensors).unwrap();
    let whole = dataset.beside("whole");
    ralf(["label", &dataset.path, "-o", &whole]).exits(3).says(["left out: 01: ", &sensors]);
    assert!(without_timings(&whole) == without_timings(&dataset.out));
    // Whoever opens a recording without labelling it tells of it, too.
    let compare = ["simulate", "--compare", &dataset.path, "--with", &dataset.path, "--json"];
    ralf(compare).exits(3).says(["left out: 01: ", &sensors]);
}

#[test]
fn only_scans_of_what_is_asked_for_count_as_not_labelled() {
    let dataset = two();
    dataset.cut("radar_front/000003.bin", 1);
    let label = |sequence| ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", sequence]);
    assert_eq!(label("00").exits(3).not_labelled().len(), 1);
    label("01").exits(0).says_nothing();
    label("01").exits(0).says(["nothing to do"]);
    assert_eq!(label("00").exits(3).says(["nothing to do"]).not_labelled().len(), 1);
}

/// Adds a scene to a data set of nuScenes whose files lie in another part of the data set.
fn add_scene_elsewhere(folder: &Path, name: &str) {
    let edit = |table: &str, add: &dyn Fn(&mut Vec<Value>)| {
        let file = folder.join("v1.0-test").join(table);
        let mut rows: Vec<Value> = serde_json::from_slice(&fs::read(&file).unwrap()).unwrap();
        add(&mut rows);
        fs::write(&file, json!(rows).to_string()).unwrap();
    };
    edit("scene.json", &|rows| {
        rows.push(json!({"token": name, "log_token": "l", "name": name, "description": "elsewhere"}));
    });
    edit("sample.json", &|rows| rows.push(json!({"token": format!("x-{name}"), "scene_token": name})));
    // Every scene has its own measurements and poses.
    let copy = |rows: &mut Vec<Value>, own: &[&str]| {
        for mut row in rows
            .iter()
            .filter(|row| !row["token"].as_str().unwrap().contains("scene"))
            .cloned()
            .collect::<Vec<_>>()
        {
            for key in own {
                row[key] = json!(format!("{}-{name}", row[key].as_str().unwrap()));
            }
            rows.push(row);
        }
    };
    edit("sample_data.json", &|rows| copy(rows, &["token", "filename", "sample_token", "ego_pose_token"]));
    edit("ego_pose.json", &|rows| copy(rows, &["token"]));
}

#[test]
fn scenes_of_another_part_of_the_data_set_are_left_out_in_one_line() {
    let place = tempfile::tempdir().unwrap();
    let [recording, out] =
        ["recording", "out"].map(|name| place.path().join(name).to_str().unwrap().to_owned());
    nuscenes(Path::new(&recording));
    for number in 2..9 {
        add_scene_elsewhere(Path::new(&recording), &format!("scene-000{number}"));
    }
    let ran = ralf(["label", &recording, "-o", &out]).exits(0);
    let warnings: Vec<&str> = ran.stderr.lines().filter(|line| line.starts_with("warning: ")).collect();
    let why = "for no file of their radars is there";
    let named = "scene-0002, scene-0003, scene-0004, scene-0005, scene-0006 and 2 more";
    assert_eq!(warnings, [format!("warning: 7 of 8 sequences left out, {why}: {named}")]);
    assert!(!ran.stdout.contains("scene-0002"));
    // So it is where many machines label.
    let shared = place.path().join("shared");
    let planned = ralf(["cluster", "plan", "--quiet", &recording, "-o", shared.to_str().unwrap()]).exits(0);
    planned.says([&format!("7 of 8 sequences left out, {why}: scene-0002 and 6 more")]);
    ralf(["cluster", "assemble", "--quiet", shared.to_str().unwrap()]).exits(0);
    let labelled = |out: &Path| {
        let folders = fs::read_dir(out.join("sequences")).unwrap();
        folders.map(|folder| folder.unwrap().file_name()).collect::<Vec<_>>()
    };
    let [one, many] = [labelled(Path::new(&out)), labelled(&shared.join("recording"))];
    assert_eq!((one.len(), &one), (1, &many));
    // Whoever asks for one is told of each of its sensors.
    let warned = "scene-0002: 5 of 5 files of RADAR_FRONT are not there and were left out";
    ralf(["inspect", &recording, "--sequence", "scene-0002"]).exits(0).says([warned]);
}

#[test]
fn a_picture_is_of_a_sequence_that_has_labels() {
    let dataset = Dataset::of(&Shape { scans: 3, sequences: &["00", "01", "02"], ..Shape::default() });
    let picture = dataset.beside("scan.png");
    let plot = || ralf(["plot", &dataset.path, &dataset.out, "--scan", "1", "-o", &picture]);
    let label = |name: &str| {
        ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", name, "--no-check"]).exits(0);
    };
    label("01");
    plot().exits(0).says([&picture]);
    label("02");
    plot().exits(1).ends_with_error(["expected one sequence, found 2: choose with --sequence (01, 02)"]);
    ralf(["plot", &dataset.path, &dataset.out, "--sequence", "00", "--scan", "1", "-o", &picture]).exits(1);
}
