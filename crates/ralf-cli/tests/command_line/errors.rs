//! Errors: the last line tells what is wrong, in the words of the people who read it.

use crate::support::{Dataset, Ran, Shape, program, ralf};
use std::fs;

fn labelled() -> Dataset {
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out, "-q"]).exits(0);
    dataset
}

#[test]
fn a_settings_file_is_shown_where_it_is_wrong_and_the_error_is_the_last_line() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    let file = dataset.beside("a.toml");
    let refused = |text: &str| {
        fs::write(&file, text).unwrap();
        ralf(["check", &dataset.path, "--config", &file]).exits(1)
    };
    let shown = refused("[lidar]\nbeta = \"much\"\n").says(["2 | beta = \"much\""]);
    shown.ends_with_error(["a.toml: TOML parse error at line 2, column 8: ", "expected a number"]);
    refused("lidar = 3\n").ends_with_error(["expected a table `lidar`"]);
    refused("[a]\n[a]\n").says(["2 | [a]"]).ends_with_error(["a.toml", "line 2", "duplicate key"]);
    let known = ["a.toml: line 1: unknown field `lidarr`", "`sensors`, `topics`, `corrections`, `motion`"];
    refused("[lidarr]\n").ends_with_error(known);
    let scenario = dataset.beside("made");
    ralf(["simulate", "-o", &scenario, "--scenario", &file])
        .exits(1)
        .says(["1 | [lidarr]"])
        .ends_with_error(["unknown field `lidarr`"]);
}

#[test]
fn topics_that_are_asked_for_have_to_be_there() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    let file = dataset.beside("topics.toml");
    fs::write(&file, "[lidar]\nbeta = 0.5\n").unwrap();
    let asked = ["label", &dataset.path, "-o", &dataset.out, "--topics", &file];
    ralf(asked)
        .exits(1)
        .ends_with_error(["--topics", "topics.toml: expected the table `topics`, found none"]);
}

#[test]
fn settings_that_are_typed_are_named_in_one_line() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    let refused = |set: &str| ralf(["check", &dataset.path, "--set", set]).exits(2);
    refused("seed=3\nlidar.beta=3").ends_with_error(["KEY=VALUE in one line", "`seed=3\\nlidar.beta=3`"]);
    refused("lidarr.beta=3").ends_with_error(["`sensors`, `topics`, `corrections`, `motion`"]);
    refused("lidar=3").ends_with_error(["expected a table `lidar`"]);
    refused("motion=1").ends_with_error(["expected a table in `motion`"]);
    refused("ground.model=3").ends_with_error(["expected a name in `ground.model`"]);
    refused("corrections.radar_front.position_factor=0").ends_with_error(["position_factor", "above 0"]);
    let alone = "motion.source=trajectory";
    ralf(["check", &dataset.path, "--set", alone])
        .exits(1)
        .ends_with_error(["motion.source", "--trajectory"]);
}

#[test]
fn wrong_usage_ends_with_the_error_too() {
    ralf(["labl"]).exits(2).says(["tip: ", "--help"]).ends_with_error(["unrecognized subcommand 'labl'"]);
    let dataset = labelled();
    let [path, out] = [&dataset.path, &dataset.out];
    ralf(["label", path])
        .exits(2)
        .says(["Usage: ralf label"])
        .ends_with_error(["not provided: --output <OUT>"]);
    let model = dataset.beside("model.txt");
    ralf(["label", path, "-o", &dataset.beside("other"), "--model", &model])
        .exits(2)
        .ends_with_error(["--model", "--method learned"]);
    // Where the settings ask a model, its file is read.
    ralf(["label", path, "-o", &dataset.beside("other"), "--model", &model, "--set", "method=learned"])
        .exits(1)
        .ends_with_error(["model.txt"]);
    for (format, file) in [("mcap", "a.bag"), ("rosbag1", "a.mcap"), ("npz", "a.mcap")] {
        let file = dataset.beside(file);
        ralf(["export", path, out, "--to", format, "-o", &file])
            .exits(1)
            .ends_with_error([&file, &format!("expected a place for the format {format}")]);
        assert!(!fs::exists(&file).unwrap());
    }
}

#[test]
fn a_damaged_record_is_named_in_one_line() {
    let dataset = labelled();
    let file = format!("{}/run.json", dataset.out);
    let text = fs::read_to_string(&file).unwrap();
    let refused = |from: &str, to: &str| {
        assert!(text.contains(from));
        fs::write(&file, text.replacen(from, to, 1)).unwrap();
        let page = dataset.beside("page.html");
        let ran = ralf(["report", &dataset.path, &dataset.out, "-o", &page]).exits(1);
        assert_eq!(ran.stderr.lines().count(), 1, "{}", ran.stderr);
        ran
    };
    refused("\"lidar\": {", "\"lidar\": 3, \"x\": {").ends_with_error(["run.json", "expected a table"]);
    refused("\"seed\": 0", "\"seed\": \"a\"").ends_with_error(["run.json: line ", "whole number"]);
}

#[test]
fn what_can_be_chosen_is_told_whatever_its_number() {
    let dataset = labelled();
    let [path, out, picture] = [&dataset.path, &dataset.out, &dataset.beside("scan.png")];
    let refused = |arguments: [&str; 2]| {
        let [option, value] = arguments;
        ralf(["plot", path, out, "--scan", "0", "-o", picture, option, value]).exits(1)
    };
    refused(["--camera", "front"]).ends_with_error(["expected a recording with a camera, found front"]);
    for column in ["lidar_window_beyond", "label"] {
        let told =
            refused(["--color-by", column]).ends_with_error(["d_tr, ", "`ralf label --evidence`", column]);
        assert!(!told.stderr.contains("flags"), "only numbers are drawn: {}", told.stderr);
    }
    ralf(["plot", path, out, "--scan", "2", "-o", picture])
        .exits(1)
        .ends_with_error(["from 0 to 1, found 2"]);
}

#[test]
fn a_sensor_beyond_a_vehicle_is_refused() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    let file = dataset.file("sequence.toml");
    let text = fs::read_to_string(&file).unwrap().replacen("[3.6, 0.0, 0.5]", "[3.6, -1e9, 0.5]", 1);
    fs::write(&file, text).unwrap();
    ralf(["inspect", &dataset.path])
        .exits(1)
        .ends_with_error(["sequence.toml: [[radar]] radar_front: translation: expected at most 1000 m"]);
}

#[test]
fn a_place_where_no_file_can_be_made_is_told_before_anything_is_read() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    let taken = dataset.beside("taken");
    fs::write(&taken, "mine").unwrap();
    let place = format!("{taken}/new.png");
    let refused = |arguments: &[&str]| {
        let ran = crate::support::program().args(arguments).output().unwrap();
        crate::support::Ran::of(&ran)
            .exits(1)
            .prints_nothing()
            .ends_with_error([&place, "found a file in the place of a folder"]);
    };
    refused(&["learn", "nowhere", "-o", &place]);
    refused(&["tune", "nowhere", "-o", &place, "--train", "00", "--test", "01"]);
    refused(&["inspect", "nowhere", "--write-topics", &place]);
    refused(&["check", "nowhere", "--write", &place]);
    refused(&["plot", "nowhere", "out", "--scan", "0", "-o", &place]);
    refused(&["report", "nowhere", "out", "-o", &place]);
    refused(&["simulate", "--compare", "nowhere", "-o", &place]);
    // And where one can be made, nothing is left by having tried it.
    ralf(["learn", "nowhere", "-o", &dataset.beside("model")]).exits(1).ends_with_error(["nowhere"]);
    assert!(["model", ".model.part"].iter().all(|name| !fs::exists(dataset.beside(name)).unwrap()));
}

#[test]
fn numbers_beyond_all_use_are_refused_before_any_work() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    let made = dataset.beside("made");
    for scans in ["0", "100001", "4294967295"] {
        let told = [scans, "--scans", "1..=100000"];
        ralf(["simulate", "-o", &made, "--scans", scans]).exits(2).ends_with_error(told);
        ralf(["simulate", "--compare", &dataset.path, "--preset", "worlds", "--scans", scans])
            .exits(2)
            .ends_with_error(told);
        ralf(["learn", "-o", &made, "--preset", "worlds", "--scans", scans]).exits(2).ends_with_error(told);
    }
    for seeds in ["0", "1001"] {
        let ran = ralf(["learn", "-o", &made, "--preset", "worlds", "--seeds", seeds]);
        ran.exits(2).ends_with_error([seeds, "--seeds", "1..=1000"]);
    }
    for (option, value, range) in [
        ("--rounds", "0", "1..=10000"),
        ("--rounds", "10001", "1..=10000"),
        ("--leaves", "0", "2..=256"),
        ("--leaves", "1", "2..=256"),
        ("--leaves", "257", "2..=256"),
    ] {
        let ran = ralf(["learn", &dataset.path, "-o", &made, option, value]);
        ran.exits(2).ends_with_error([option, value, range]);
    }
    assert!(!fs::exists(&made).unwrap());
}

#[test]
fn a_family_without_worlds_is_refused() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    let made = dataset.beside("made");
    let expected = "--family: expected --preset worlds";
    let simulate = ["simulate", "-o", &made, "--family", "yard"];
    let [a, b, c, d, e] = simulate;
    ralf(simulate).exits(2).ends_with_error([expected, "found --preset paper"]);
    ralf([a, b, c, d, e, "--preset", "tiny"]).exits(2).ends_with_error([expected, "found --preset tiny"]);
    ralf([a, b, c, d, e, "--scenario", "a.toml"]).exits(2).ends_with_error([expected, "found --scenario"]);
    ralf(["simulate", "--compare", &dataset.path, "--family", "yard"]).exits(2).ends_with_error([expected]);
    assert!(!fs::exists(&made).unwrap());
}

#[test]
fn a_correction_that_changes_nothing_of_such_a_sensor_is_refused() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() }).with_camera(1);
    let label = |set: &str| ralf(["label", &dataset.path, "-o", &dataset.out, "--no-check", "--set", set]);
    for (sensor, key, kinds) in [
        ("lidar_top", "doppler_factor=2", "a radar, found a LiDAR"),
        ("camera_front", "doppler_factor=2", "a radar, found a camera"),
        ("camera_front", "position_factor=2", "a radar or a LiDAR, found a camera"),
        ("camera_front", "mirror_y=true", "a radar or a LiDAR, found a camera"),
    ] {
        let named = format!("corrections.{sensor}.{}: expected {kinds}", key.split('=').next().unwrap());
        label(&format!("corrections.{sensor}.{key}")).exits(1).ends_with_error([&named]);
    }
    label("corrections.lidar_top.position_factor=1.01").exits(0);
    label("corrections.lidar_top.mirror_y=true").exits(0);
}

#[test]
fn settings_that_change_nothing_of_a_recording_are_refused() {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() });
    let poses = dataset.beside("poses.txt");
    fs::write(&poses, "1 0 0 0 0 1 0 0 0 0 1 0\n".repeat(3)).unwrap();
    let check =
        |more: &[&str]| Ran::of(&program().args(["check", &dataset.path]).args(more).output().unwrap());
    let no_trajectory =
        ": expected a trajectory that it tells of (--trajectory, motion.trajectory), found none";
    for (set, told) in [
        ("motion.trajectory_frame=lidar_tpo", no_trajectory),
        ("motion.trajectory_order=lidar_top", no_trajectory),
        ("corrections.lidar_top.tick_ms=7", ": expected a period_ms above 0 beside it, found none"),
    ] {
        let key = set.split('=').next().unwrap();
        check(&["--set", set]).exits(1).ends_with_error([format!("{}: {key}{told}", dataset.path).as_str()]);
    }
    let yaw_rate = ["--trajectory", &poses, "--set", "motion.yaw_rate_factor=2"];
    let told = "motion.yaw_rate_factor: expected a motion with yaw rates, found poses alone";
    check(&yaw_rate).exits(1).ends_with_error([told]);
    check(&["--set", "motion.trajectory_frame=vehicle", "--set", "corrections.lidar_top.period_ms=100"])
        .exits(0);
}

#[test]
fn what_contradicts_itself_is_refused_and_a_file_may_be_overruled() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    let label = |method: &str, option: &str, value: &str| {
        ralf(["label", &dataset.path, "-o", &dataset.out, "--no-check", "--method", method, option, value])
    };
    for [typed, set] in [["paper", "method=learned"], ["learned", "method=paper"]] {
        label(typed, "--set", set).exits(2).ends_with_error(["--method", "--set method="]);
    }
    assert!(!fs::exists(&dataset.out).unwrap());
    label("paper", "--set", "method=paper").exits(0);
    let file = dataset.beside("a.toml");
    fs::write(&file, "method = 'learned'\n").unwrap();
    label("paper", "--config", &file).exits(0);
}

#[test]
fn a_limit_in_the_environment_that_is_no_number_is_refused() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    let mut command = crate::support::program();
    command.env("RALF_MAX_FILE_MB", "abc").args(["inspect", &dataset.path]);
    let ran = crate::support::Ran::of(&command.output().unwrap());
    ran.exits(2).prints_nothing().ends_with_error(["RALF_MAX_FILE_MB", "megabytes", "`abc`"]);
}

#[test]
fn help_tells_of_what_this_build_has() {
    for (command, told, built) in [
        (vec!["--help"], "ralf review recordings", cfg!(feature = "review")),
        (vec!["label", "--help"], "--depth-model midas.onnx", cfg!(feature = "depth")),
        (vec!["label", "--help"], "-o out --segmentation classes", cfg!(feature = "depth")),
        (vec!["label", "--help"], "`ralf depth -o`", cfg!(feature = "depth")),
        (vec!["cluster", "plan", "--help"], "`ralf segment -o`", cfg!(feature = "depth")),
        (vec!["assign", "--help"], "`ralf review --second NAME`", cfg!(feature = "review")),
    ] {
        let ran = crate::support::Ran::of(&crate::support::program().args(&command).output().unwrap());
        let ran = ran.exits(0).prints(["Examples:"]);
        assert_eq!(ran.stdout.contains(told), built, "{told}");
    }
}

#[test]
fn a_command_that_is_told_can_be_typed_again() {
    let dataset = Dataset::of(&Shape { scans: 3, sequences: &["00", "01"], ..Shape::default() });
    let [recording, model] = ["it's a town", "a model"].map(|name| dataset.beside(name));
    fs::rename(&dataset.path, &recording).unwrap();
    let few = ["--rounds", "2", "--leaves", "2"];
    let [a, b, c, d] = few;
    ralf(["learn", &recording, "-o", &model, a, b, c, d, "--without-group", "LiDAR rays", "-q"]).exits(0);
    let text = fs::read_to_string(&model).unwrap();
    let quoted = format!("'{}'", recording.replace('\'', r"'\''"));
    let command = format!("command ralf learn {quoted} --rounds 2 --leaves 2 --without-group 'LiDAR rays' ");
    assert!(text.contains(&command), "{:?}", text.lines().nth(2));
    let file = dataset.beside("ralf.toml");
    ralf(["tune", &recording, "-o", &file, "--train", "00", "--test", "01", "--trials", "1", "-q"]).exits(0);
    let text = fs::read_to_string(&file).unwrap();
    assert!(text.contains(&format!("ralf tune {quoted} --train 00 --test 01 ")), "{text}");
}
