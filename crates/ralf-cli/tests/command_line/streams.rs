//! Results go to standard output, everything else to standard error, and the exit status tells how it ended.

use crate::support::{Dataset, Ran, Shape, program, ralf};
use std::fs;
use std::process::Stdio;

const COMMANDS: [&str; 6] = ["inspect", "label", "evaluate", "plot", "convert", "completions"];

#[test]
fn wrong_usage_is_2() {
    let dataset = Dataset::new();
    let (path, out) = (dataset.path.as_str(), dataset.out.as_str());
    ralf([]).exits(2).prints_nothing();
    ralf(["lable", path]).exits(2).prints_nothing().says(["lable", "label"]);
    ralf(["label", path, "-o", out, "--fast"]).exits(2).prints_nothing().says(["--fast"]);
    ralf(["label", path]).exits(2).says(["--output"]);
    ralf(["label", path, "-o", out, "--jobs", "0"]).exits(2).says(["--jobs"]);
    ralf(["label", path, "-o", out, "--format", "kitti"]).exits(2).says(["kitti", "nuscenes"]);
    ralf(["plot", path, out, "-o", "a.png"]).exits(2).says(["--scan"]);
    assert!(!fs::exists(out).unwrap());
}

#[test]
fn wrong_settings_on_the_command_line_are_2() {
    let dataset = Dataset::new();
    for (setting, named) in [
        ("lidar.beat=1", "beat"),
        ("lidar.beta=much", "beta"),
        ("lidar.beta=-1", "lidar.beta"),
        ("lidar.beta", "lidar.beta"),
    ] {
        let ran = ralf(["label", &dataset.path, "-o", &dataset.out, "--set", setting]);
        ran.exits(2).prints_nothing().says(["error: --set", named]);
    }
    assert!(!fs::exists(&dataset.out).unwrap());
}

#[test]
fn wrong_settings_in_a_file_are_1_and_name_the_file() {
    let dataset = Dataset::new();
    let file = dataset.beside("ralf.toml");
    for (text, named) in [
        ("[lidar]\nbeat = 1\n", "beat"),
        ("[lidar]\nbeta = \"much\"\n", "beta"),
        ("[fusion]\nalpha = 2\n", "fusion.alpha"),
        ("[lidar\n", "ralf.toml"),
    ] {
        fs::write(&file, text).unwrap();
        let ran = ralf(["label", &dataset.path, "-o", &dataset.out, "--config", &file]);
        ran.exits(1).prints_nothing().says([&file, named]);
    }
    let missing = dataset.beside("missing.toml");
    ralf(["label", &dataset.path, "-o", &dataset.out, "--config", &missing]).exits(1).says([&missing]);
}

#[test]
fn settings_that_do_not_fit_the_recording_are_refused() {
    let dataset = Dataset::new();
    for (setting, named) in [
        ("sensors.radar_back.sigma_range_m=0.2", ["radar_back", "radar_front"]),
        ("sensors.radar_front.sigma_range_m=-1", ["sigma_range_m", "found -1"]),
    ] {
        let ran = ralf(["label", &dataset.path, "-o", &dataset.out, "--set", setting]);
        ran.exits(1).prints_nothing().says(named);
    }
    assert!(!fs::exists(&dataset.out).unwrap());
}

#[test]
fn a_recording_that_is_not_there_is_named() {
    let dataset = Dataset::new();
    let nowhere = dataset.beside("nowhere");
    ralf(["inspect", &nowhere]).exits(1).prints_nothing().says([&nowhere]);
    ralf(["label", &nowhere, "-o", &dataset.out]).exits(1).prints_nothing().says([&nowhere]);
    ralf(["convert", &nowhere, "-o", &dataset.out]).exits(1).prints_nothing().says([&nowhere]);
    ralf(["plot", &nowhere, &dataset.out, "--all", "-o", "a.png"]).exits(1).prints_nothing().says([&nowhere]);
}

#[test]
fn an_unknown_sequence_lists_those_that_exist() {
    let dataset = Dataset::of(&Shape { scans: 1, sequences: &["00", "01"], ..Shape::default() });
    let ran = ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", "07"]);
    ran.exits(1).prints_nothing().says(["`07`", "00, 01"]);
}

#[test]
fn the_help_of_every_command_has_examples() {
    ralf(["--help"]).exits(0).says_nothing().prints(["Examples:", "Exit status"]).prints(COMMANDS);
    for command in COMMANDS {
        ralf([command, "--help"]).exits(0).says_nothing().prints(["Example", &format!("  ralf {command} ")]);
    }
}

#[test]
fn completions_know_the_commands() {
    for shell in ["bash", "zsh", "fish"] {
        ralf(["completions", shell]).exits(0).says_nothing().prints(COMMANDS);
    }
}

#[test]
fn json_is_all_that_is_printed() {
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    let record = ralf(["label", &dataset.path, "-o", &dataset.out, "--json"]).exits(0).says_nothing().json();
    let written: serde_json::Value =
        serde_json::from_slice(&fs::read(format!("{}/run.json", dataset.out)).unwrap()).unwrap();
    assert_eq!(record, written);
    let look = ralf(["inspect", &dataset.path, "--json"]).exits(0).says_nothing().json();
    assert_eq!(look["sequences"][0]["sensors"][0]["count"], 2);
}

#[test]
fn a_reader_who_has_enough_is_no_failure() {
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let (path, out) = (dataset.path.as_str(), dataset.out.as_str());
    let commands: [&[&str]; 5] = [
        &["inspect", path],
        &["label", path, "-o", out],
        &["evaluate", out, "--truth", path],
        &["completions", "bash"],
        &["label", "--help"],
    ];
    for command in commands {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        Ran::of(&program().args(command).stdout(writer).output().unwrap()).exits(0);
    }
    // What a command has to say besides is said all the same.
    dataset.cut("radar_front/000001.bin", 3);
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut label = program();
    label.args(["label", path, "-o", &dataset.beside("other"), "-q"]).stdout(writer);
    Ran::of(&label.output().unwrap()).exits(3).says(["not labelled: ", "radar_front"]);
}

#[test]
fn options_that_say_nothing_of_labels_are_refused_where_labels_are_shown() {
    let dataset = Dataset::of(&Shape { scans: 2, sequences: &["00", "01"], ..Shape::default() });
    ralf(["label", "-q", &dataset.path, "-o", &dataset.out]).exits(0);
    let out = dataset.out.as_str();
    let one = ralf(["inspect", out, "--sequence", "01", "--json"]).exits(0).json();
    let names: Vec<&str> = one["sequences"]
        .as_array()
        .unwrap()
        .iter()
        .map(|sequence| sequence["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["01"]);
    ralf(["inspect", out, "--sequence", "02"]).exits(2).ends_with_error(["--sequence", "00, 01", "found 02"]);
    for option in [&["--quick"][..], &["--distributions"], &["--set", "lidar.beta=1"], &["--format", "ros"]] {
        let ran = Ran::of(&program().args(["inspect", out]).args(option).output().unwrap());
        ran.exits(2).ends_with_error([option[0], "expected a recording"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_result_that_can_not_be_printed_is_a_failure() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let inspect = program().args(["inspect", &dataset.path]).stdout(full).output().unwrap();
    Ran::of(&inspect).exits(1).says(["standard output", "No space left on device"]);
}

#[test]
fn nobody_has_to_listen_to_warnings() {
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    dataset.put("sequence.toml", fs::read_to_string(dataset.file("sequence.toml")).unwrap() + "colour = 3\n");
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut label = program();
    label.args(["label", &dataset.path, "-o", &dataset.out]).stdout(Stdio::piped()).stderr(writer);
    let output = label.spawn().unwrap().wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
}
