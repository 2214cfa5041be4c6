//! Where exports go, and what they never take the place of; results that are not those of the recording.

use super::{export, labelled, run, small};
use crate::support::{Shape, put, ralf, tree};
use std::fs;

const FORMATS: [&str; 6] = ["mcap", "rosbag1", "semantickitti", "pcd", "npz", "parquet"];

#[test]
fn the_same_is_exported_every_time() {
    let dataset = small();
    for format in FORMATS {
        let [first, second] =
            ["a", "b"].map(|name| export(&dataset, format, &format!("{format}-{name}"), &["--sensors"]));
        assert!(tree(first) == tree(second), "{format}");
    }
}

#[test]
fn only_an_earlier_export_is_replaced_and_only_if_asked() {
    let dataset = small();
    let path = export(&dataset, "npz", "labels", &[]);
    let before = tree(&path);
    run(&dataset, "npz", &path, &[]).exits(1).says(["labels: folder: expected an empty folder", "--force"]);
    run(&dataset, "pcd", &path, &["--force"])
        .exits(1)
        .says(["an earlier export in the format pcd", "other files"]);
    assert!(tree(&path) == before);
    run(&dataset, "npz", &path, &["--force", "--split", "artifact"]).exits(0);
    assert!(tree(&path) != before);
    run(&dataset, "npz", &path, &["--force"]).exits(0);
    assert!(tree(&path) == before);
}

/// An export that takes the place of an earlier one is away for a moment.
#[test]
fn an_earlier_export_comes_back_where_the_next_one_was_killed_before_it_was_in_its_place() {
    let dataset = small();
    let path = export(&dataset, "npz", "labels", &[]);
    let before = tree(&path);
    fs::rename(&path, dataset.beside(".labels.earlier")).unwrap();
    run(&dataset, "pcd", &path, &[]).exits(1).says(["an earlier export in the format pcd", "other files"]);
    assert!(tree(&path) == before);
}

/// As a kill leaves it, by the mark that the folder has from then on; and without one, as earlier versions did.
#[test]
fn what_is_left_of_an_earlier_export_that_was_being_removed_never_comes_back() {
    let dataset = small();
    let path = export(&dataset, "npz", "labels", &[]);
    let whole = tree(&path);
    let earlier = dataset.beside(".labels.earlier");
    for is_marked in [true, false] {
        for is_there in [true, false] {
            put(&whole, &earlier);
            fs::remove_dir_all(format!("{earlier}/sequences")).unwrap();
            if is_marked {
                fs::rename(format!("{earlier}/_export.json"), format!("{earlier}/.ralf-removed")).unwrap();
            }
            if !is_there {
                fs::remove_dir_all(&path).unwrap();
            }
            run(&dataset, "npz", &path, if is_there { &["--force"] } else { &[] }).exits(0);
            assert!(tree(&path) == whole && !fs::exists(&earlier).unwrap(), "{is_marked} {is_there}");
        }
    }
}

/// What a person put beside an export's files, or among them, is not the export's.
#[test]
fn an_export_with_somebodys_own_files_is_never_replaced() {
    let dataset = small();
    let path = export(&dataset, "npz", "labels", &[]);
    for own in ["notes.md", "sequences/00/radar_front/mine.npz", "deep/folder/notes.md", "empty/"] {
        let file = format!("{path}/{own}");
        fs::create_dir_all(file.rsplit_once('/').unwrap().0).unwrap();
        if !own.ends_with('/') {
            fs::write(&file, "mine").unwrap();
        }
        let before = tree(&path);
        run(&dataset, "npz", &path, &["--force"])
            .exits(1)
            .ends_with_error(["labels: folder: expected an export's own files", &format!("also `{own}`")]);
        assert!(tree(&path) == before, "{own}");
        fs::remove_dir_all(&path).unwrap();
        export(&dataset, "npz", "labels", &[]);
    }
    run(&dataset, "npz", &path, &["--force"]).exits(0);
    // One made before exports told which files are theirs.
    let record = format!("{path}/_export.json");
    let mut told: serde_json::Value = serde_json::from_slice(&fs::read(&record).unwrap()).unwrap();
    assert!(told.as_object_mut().unwrap().remove("files").is_some());
    fs::write(&record, told.to_string()).unwrap();
    run(&dataset, "npz", &path, &["--force"])
        .exits(1)
        .ends_with_error(["_export.json", "an earlier version"]);
}

#[test]
fn a_record_tells_of_no_sensors_that_the_format_has_no_place_for() {
    let dataset = small();
    for (format, others) in [("npz", false), ("parquet", false), ("mcap", true)] {
        let path = export(&dataset, format, format, &["--sensors"]);
        let record = fs::read(format!("{path}/_export.json")).unwrap();
        let record: serde_json::Value = serde_json::from_slice(&record).unwrap();
        let expected = serde_json::json!({ "radar": true, "lidar": others, "camera": others });
        assert_eq!(record["sensors"], expected, "{format}");
    }
}

#[test]
fn a_file_is_replaced_like_a_folder() {
    let dataset = small();
    for (format, name) in [("mcap", "labels.mcap"), ("rosbag1", "labels.bag")] {
        let path = export(&dataset, format, name, &[]);
        let before = fs::read(&path).unwrap();
        run(&dataset, format, &path, &[])
            .exits(1)
            .says([name, "an earlier export, which only --force replaces"]);
        assert!(fs::read(&path).unwrap() == before);
        run(&dataset, format, &path, &["--force", "--split", "artifact"]).exits(0);
        assert!(fs::read(&path).unwrap() != before);
    }
}

#[test]
fn no_format_is_written_into_the_recording() {
    let dataset = small();
    let before = tree(&dataset.path);
    for format in FORMATS {
        for place in ["sequences/labels", "sequences/00/labels", "sequences/../sequences/labels"] {
            let place = format!("{}/{place}", dataset.path);
            run(&dataset, format, &place, &[]).exits(1).says(["expected a place outside the recording"]);
        }
    }
    assert!(tree(&dataset.path) == before);
}

#[cfg(unix)]
#[test]
fn what_a_link_leads_to_is_written_and_the_link_stays() {
    use std::os::unix::fs::symlink;
    let dataset = small();
    let [file, link, folder, to_folder] =
        ["there.mcap", "link.mcap", "there", "link"].map(|name| dataset.beside(name));
    for (format, target, link) in [("mcap", &file, &link), ("npz", &folder, &to_folder)] {
        symlink(target, link).unwrap();
        run(&dataset, format, link, &[]).exits(0);
        run(&dataset, format, link, &["--force"]).exits(0);
        assert!(fs::symlink_metadata(link).unwrap().is_symlink() && fs::exists(target).unwrap());
    }
    let [page, linked] = ["page.html", "linked.html"].map(|name| dataset.beside(name));
    fs::write(&page, "<!DOCTYPE html>an earlier one").unwrap();
    symlink(&page, &linked).unwrap();
    ralf(["report", &dataset.path, &dataset.out, "-o", &linked]).exits(0);
    assert!(fs::symlink_metadata(&linked).unwrap().is_symlink());
    assert!(!fs::read_to_string(&page).unwrap().contains("an earlier one"));
}

#[test]
fn a_layout_for_foxglove_lies_beside_mcap_files() {
    let dataset = small();
    let folder = export(&dataset, "mcap", "all", &["--sensors"]);
    let text = fs::read_to_string(format!("{folder}/foxglove.json")).unwrap();
    let layout: serde_json::Value = serde_json::from_str(&text).unwrap();
    let scene = &layout["configById"]["3D!ralf"];
    assert_eq!((&layout["layout"], &scene["followTf"]), (&"3D!ralf".into(), &"base_link".into()));
    let topics = &scene["topics"];
    assert_eq!(topics["/radar_front/points_labelled"]["colorField"], "plausibility");
    assert_eq!(topics["/lidar_top/points"]["visible"], true);
    // Beside an only file, and never in the place of one's own.
    let file = export(&dataset, "mcap", "labels.mcap", &[]);
    let beside = file.replace(".mcap", ".foxglove.json");
    assert!(fs::read_to_string(&beside).unwrap().contains("points_labelled"));
    fs::write(&beside, "mine").unwrap();
    run(&dataset, "mcap", &file, &["--force"]).exits(0);
    assert_eq!(fs::read_to_string(&beside).unwrap(), "mine");
    assert!(!fs::exists(format!("{}/foxglove.json", export(&dataset, "rosbag1", "bags", &[]))).unwrap());
}

#[test]
fn nothing_else_is_ever_replaced() {
    let dataset = small();
    let recording = tree(&dataset.path);
    for (path, told) in [(&dataset.path, "outside the recording"), (&dataset.out, "expected an empty folder")]
    {
        run(&dataset, "npz", path, &["--force"]).exits(1).says([path, told]);
    }
    assert!(tree(&dataset.path) == recording);
    let file = dataset.beside("notes.mcap");
    fs::write(&file, "mine").unwrap();
    run(&dataset, "npz", &file, &["--force"])
        .exits(1)
        .says(["notes.mcap: path: expected a folder", "a file"]);
    run(&dataset, "mcap", &file, &["--force"]).exits(1).says(["notes.mcap"]);
    assert_eq!(fs::read(&file).unwrap(), b"mine");
    let recording = dataset.beside("recording.mcap");
    ralf(["convert", &dataset.path, "-o", &recording]).exits(0);
    run(&dataset, "mcap", &recording, &["--force"])
        .exits(1)
        .says(["no file yet, or an earlier export", "without labelled"]);
    let below = format!("{file}/labels");
    run(&dataset, "npz", &below, &[]).exits(1).says(["notes.mcap"]);
    let empty = dataset.beside("empty");
    fs::create_dir(&empty).unwrap();
    run(&dataset, "npz", &empty, &[]).exits(0);
}

#[test]
fn what_a_killed_export_left_is_gone_after_the_next_one() {
    let dataset = small();
    fs::create_dir(dataset.beside(".labels.part")).unwrap();
    for file in ["_export.json", "half"] {
        fs::write(dataset.beside(&format!(".labels.part/{file}")), "half").unwrap();
    }
    let path = export(&dataset, "npz", "labels", &[]);
    assert!(!fs::exists(dataset.beside(".labels.part")).unwrap());
    assert!(tree(path).into_keys().all(|name| name != "half"));
    // Killed again, while that was removed.
    fs::create_dir(dataset.beside(".labels.part")).unwrap();
    for file in [".ralf-removed", "half"] {
        fs::write(dataset.beside(&format!(".labels.part/{file}")), "half").unwrap();
    }
    run(&dataset, "npz", &dataset.beside("labels"), &["--force"]).exits(0);
    assert!(!fs::exists(dataset.beside(".labels.part")).unwrap());
}

#[test]
fn what_has_the_names_of_what_a_killed_export_leaves_and_is_none_is_kept() {
    let dataset = small();
    for name in [".labels.part", ".labels.earlier"] {
        let folder = dataset.beside(name);
        fs::create_dir(&folder).unwrap();
        fs::write(format!("{folder}/mine"), "mine").unwrap();
        let told = [name, "folder: expected nothing of this name", "move it away"];
        run(&dataset, "npz", &dataset.beside("labels"), &[]).exits(1).ends_with_error(told);
        run(&dataset, "mcap", &dataset.beside("labels"), &[]).exits(1).ends_with_error(told);
        assert_eq!(fs::read(format!("{folder}/mine")).unwrap(), b"mine");
        fs::remove_dir_all(folder).unwrap();
    }
    export(&dataset, "npz", "labels", &[]);
}

#[test]
fn one_file_takes_one_sequence() {
    let dataset = labelled(&Shape { scans: 3, sequences: &["00", "01"], ..Shape::default() });
    let file = dataset.beside("both.mcap");
    run(&dataset, "mcap", &file, &[]).exits(1).says(["expected one sequence for one file", "found 00, 01"]);
    run(&dataset, "mcap", &file, &["--sequence", "01"]).exits(0);
    assert!(fs::metadata(&file).unwrap().is_file());
    let folder = export(&dataset, "rosbag1", "bags", &[]);
    assert_eq!(tree(folder).into_keys().collect::<Vec<_>>(), ["00.bag", "01.bag", "_export.json"]);
}

#[test]
fn sequences_without_labels_are_named_and_left_out() {
    let dataset = labelled(&Shape { scans: 3, sequences: &["00", "01"], ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out, "--set", "fusion.threshold=0.9", "--sequence", "00"])
        .exits(0);
    let path = dataset.beside("labels");
    run(&dataset, "npz", &path, &[]).exits(3).says(["sequence 01 has no labels: left out"]);
    assert!(!fs::exists(format!("{path}/sequences/01")).unwrap());
    let other = dataset.beside("other");
    run(&dataset, "npz", &other, &["--sequence", "01"])
        .exits(1)
        .says(["run.json, sequences: expected labels of the recording"]);
    run(&dataset, "npz", &other, &["--sequence", "07"]).exits(1).says(["no sequence `07`"]);
    assert!(!fs::exists(&other).unwrap());
}

#[test]
fn scans_that_could_not_be_labelled_are_named() {
    let dataset = crate::support::Dataset::of(&Shape { scans: 3, ..Shape::default() });
    let scan = fs::read(dataset.file("radar_front/000001.bin")).unwrap();
    dataset.put("radar_front/000001.bin", &scan[..scan.len() - 3]);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(3);
    for format in FORMATS {
        let path = dataset.beside(format);
        run(&dataset, format, &path, &["--sensors"])
            .exits(3)
            .says(["not labelled: 00/radar_front/000001: exported without labels"]);
    }
    // The numbers of the others stay, and a viewer finds as many clouds as labels.
    for kind in ["velodyne/000001.bin", "labels/000001.label"] {
        let file = format!("{}/sequences/00/{kind}", dataset.beside("semantickitti"));
        assert_eq!(fs::metadata(file).unwrap().len(), 0);
    }
}

#[test]
fn results_of_another_recording_are_refused() {
    let dataset = small();
    let path = dataset.beside("labels");
    let refused = |parts: [&str; 2]| {
        let asked = ["--sensors", "--changed-recording"];
        run(&dataset, "npz", &path, &asked[..1]).exits(1).says(["expected what was labelled"]);
        run(&dataset, "npz", &path, &asked).exits(1).prints_nothing().says(parts);
        assert!(!fs::exists(&path).unwrap());
    };
    let times = fs::read_to_string(dataset.file("radar_front/timestamps.txt")).unwrap();
    dataset.edit("radar_front/timestamps.txt", "1700000000100000000", "1700000000100000001");
    refused([
        "00/radar_front/000001: expected a scan at 1700000000100000001 ns",
        "found 1700000000100000000",
    ]);
    dataset.put("radar_front/timestamps.txt", &times);
    dataset.edit("sequence.toml", "\"doppler\", \"rcs\"", "\"doppler\", \"power\"");
    refused(["plausibility.parquet: Parquet: expected a result of `ralf label`", "no column `power`"]);
    dataset.edit("sequence.toml", "name = \"radar_left\"", "name = \"radar_right\"");
    fs::rename(dataset.file("radar_left"), dataset.file("radar_right")).unwrap();
    refused(["run.json, sequence 00: expected the recording's radars", "radar_left (3)"]);
    fs::remove_file(format!("{}/run.json", dataset.out)).unwrap();
    run(&dataset, "npz", &path, &[])
        .exits(1)
        .says(["run.json: expected the record of a finished `ralf label`", "no such file"]);
}

#[test]
fn what_can_not_be_asked_for_is_wrong_usage() {
    let dataset = small();
    let path = dataset.beside("labels");
    run(&dataset, "csv", &path, &[]).exits(2).says(["invalid value 'csv'", "semantickitti"]);
    run(&dataset, "npz", &path, &["--split", "half"]).exits(2).says(["plausible, artifact, all"]);
    run(&dataset, "npz", &path, &["--sensors=sonar"]).exits(2).says(["radar, lidar, camera"]);
    run(&dataset, "npz", &path, &["--sensors=lidar"]).exits(2).says(["--to npz: no data of these sensors"]);
    run(&dataset, "nuscenes", &path, &["--sensors"])
        .exits(2)
        .says(["--to nuscenes: no data of these sensors"]);
}
