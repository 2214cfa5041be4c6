//! What is wrong with a recording as a whole is said before anything is labelled: file, place, expected, found.

use crate::support::{Dataset, Ran, program, ralf};
use std::fs;

/// Labelling fails, and says this.
#[track_caller]
fn refused<const N: usize>(dataset: &Dataset, parts: [&str; N]) {
    let label = ["label", &dataset.path, "-o", &dataset.out];
    ralf(label).exits(1).prints_nothing().says(parts).says([&dataset.path]);
    assert!(!fs::exists(&dataset.out).unwrap(), "results of nothing");
}

#[test]
fn times_of_another_number_than_scans() {
    let dataset = Dataset::new();
    let times = fs::read_to_string(dataset.file("radar_left/timestamps.txt")).unwrap();
    dataset.put("radar_left/timestamps.txt", times.lines().take(5).collect::<Vec<_>>().join("\n"));
    refused(
        &dataset,
        ["radar_left/timestamps.txt: end: expected a line for each of the 8 files", "found 5 lines"],
    );
}

#[test]
fn times_that_go_back() {
    let dataset = Dataset::new();
    let times = fs::read_to_string(dataset.file("lidar_top/timestamps.txt")).unwrap();
    let mut lines: Vec<_> = times.lines().collect();
    lines.swap(3, 4);
    dataset.put("lidar_top/timestamps.txt", lines.join("\n"));
    refused(&dataset, ["lidar_top/timestamps.txt: line 5: expected a time of 1700000000420000000 or later"]);
}

#[test]
fn times_that_are_no_number() {
    let dataset = Dataset::new();
    dataset.edit("radar_front/timestamps.txt", "1700000000300000000", "later");
    refused(&dataset, ["radar_front/timestamps.txt: line 4: expected a time", "found `later`"]);
}

#[test]
fn a_sensor_without_extrinsics() {
    let dataset = Dataset::new();
    dataset.edit("sequence.toml", "translation = [1.2, 0.0, 1.9]\n", "");
    refused(&dataset, ["sequence.toml: line", "[[lidar]]: expected the key `translation`, found none"]);
}

#[test]
fn a_quaternion_of_length_0() {
    let dataset = Dataset::new();
    let (from, to) = ("[0.0, 0.0, 0.7071067811865476, 0.7071067811865476]", "[0, 0, 0, 0]");
    dataset.edit("sequence.toml", from, to);
    refused(&dataset, ["sequence.toml: [[radar]] radar_left: quaternion_xyzw: expected a length of 1"]);
}

#[test]
fn a_deviation_below_0() {
    let dataset = Dataset::new();
    dataset.edit("sequence.toml", "sigma_range_m = 0.10", "sigma_range_m = -0.1");
    refused(&dataset, ["sequence.toml: [[radar]] radar_front: ", "found"]);
}

#[test]
fn a_name_that_leads_elsewhere() {
    let dataset = Dataset::new();
    dataset.edit("sequence.toml", "\"radar_left\"", "\"../00/radar_left\"");
    refused(&dataset, ["sequence.toml: [[radar]] ../00/radar_left: name"]);
}

#[test]
fn no_radar() {
    let dataset = Dataset::new();
    let text = fs::read_to_string(dataset.file("sequence.toml")).unwrap();
    let [before, lidar] = [text.split("[[radar]]").next().unwrap(), text.split("[[lidar]]").nth(1).unwrap()];
    dataset.put("sequence.toml", format!("{before}[[lidar]]{lidar}"));
    refused(&dataset, ["radars: expected at least one scan to label, found none"]);
}

#[test]
fn a_sensor_without_its_folder() {
    let dataset = Dataset::new();
    fs::rename(dataset.file("lidar_top"), dataset.file("lidar")).unwrap();
    refused(&dataset, ["00/lidar_top: expected a folder of measurements, found none of this name"]);
}

#[test]
fn no_motion() {
    let dataset = Dataset::new();
    fs::remove_file(dataset.file("odometry.csv")).unwrap();
    // The radars tell it.
    let told = ["warning: 00: neither odometry nor poses", "range rates"];
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says(told);
}

#[test]
fn a_parked_vehicle_needs_no_rows_of_odometry() {
    let dataset = Dataset::new();
    dataset.put("odometry.csv", "t_ns,v_mps,yaw_rate_radps\n");
    let told = ["warning: 00: ", "odometry.csv: no rows: the vehicle is taken to stand still"];
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says(told);
    ralf(["inspect", &dataset.path]).exits(0).prints(["0.7 s, 0 m"]);
}

#[test]
fn a_radar_with_another_clock_is_named_at_once() {
    let dataset = Dataset::new();
    let times: String = (0..8).map(|scan| format!("{}\n", scan * 100_000_000)).collect();
    dataset.put("radar_left/timestamps.txt", times);
    ralf(["inspect", &dataset.path]).exits(0).prints([
        "radar_left: all its times lie 1699999999 s or more before",
        "those of the vehicle's motion: is it another clock?",
        "the motion is not known for 1699999997.9 of",
    ]);
}

#[test]
fn poses_that_end_before_the_sensors() {
    let dataset = Dataset::new();
    let pose = |ms: i64| {
        format!("{},{},0,0,0,0,0,1\n", 1_700_000_000_000_000_000 + ms * 1_000_000, ms as f64 * 0.01)
    };
    dataset.put("poses.csv", format!("t_ns,x,y,z,qx,qy,qz,qw\n{}{}", pose(0), pose(300)));
    let told = "5 of 16 radar scans and 3 of 8 LiDAR scans lie more than 200 ms before or after all poses, by up to 0.4 s";
    ralf(["inspect", &dataset.path]).exits(0).prints([told, "0.7 s, 3 m"]);
    let unknown = ralf(["inspect", &dataset.path, "--quick", "--json"]).exits(0).json();
    let seconds = unknown["sequences"][0]["motion_unknown_s"].as_f64().unwrap();
    assert!((seconds - 0.237).abs() < 1e-9, "{seconds}");
    ralf(["label", &dataset.path, "-o", &dataset.out, "--no-check"]).exits(0).says(["warning: 00: ", told]);
    ralf(["convert", &dataset.path, "-o", &dataset.beside("own")]).exits(0).says([told]);
}

#[test]
fn a_motion_that_is_not_finite() {
    let dataset = Dataset::new();
    let rows = "t_ns,v_mps,yaw_rate_radps\n1,2,0\n2,NaN,0\n";
    dataset.put("odometry.csv", rows);
    refused(&dataset, ["odometry.csv: line 3, v_mps: expected a finite number, found `NaN`"]);
}

#[test]
fn a_camera_without_images() {
    let dataset = Dataset::new();
    let text = fs::read_to_string(dataset.file("sequence.toml")).unwrap();
    let camera = "[[camera]]\nname = \"camera_front\"\ntranslation = [2, 0, 1]\n\
        quaternion_xyzw = [-0.5, 0.5, -0.5, 0.5]\nwidth = 64\nheight = 48\nmodel = \"pinhole\"\n\
        fx = 50\nfy = 50\ncx = 32\ncy = 24\n";
    dataset.put("sequence.toml", text + camera);
    refused(&dataset, ["00/camera_front: expected a folder of measurements, found none of this name"]);
}

#[test]
fn a_folder_that_is_no_recording() {
    let dataset = Dataset::new();
    fs::rename(format!("{}/sequences", dataset.path), format!("{}/sequence", dataset.path)).unwrap();
    refused(&dataset, ["the folder `sequences` (ralf)", "none of them"]);
}

#[test]
fn results_in_the_place_of_a_file() {
    let dataset = Dataset::new();
    fs::write(&dataset.out, "mine").unwrap();
    let label = |out: &str| -> Ran { ralf(["label", &dataset.path, "-o", out]) };
    label(&dataset.out)
        .exits(1)
        .prints_nothing()
        .says([&dataset.out, "expected a folder, or nothing yet, found a file"]);
    let below = format!("{}/out", dataset.out);
    label(&below).exits(1).prints_nothing().says([&below, "found a file in the place of a folder"]);
    assert_eq!(fs::read(&dataset.out).unwrap(), b"mine");
}

#[test]
fn unknown_keys_are_but_a_warning() {
    let dataset = Dataset::new();
    dataset.edit("sequence.toml", "max_range_m = 120.0", "max_range_m = 120.0\ncolour = 3");
    let ran = ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    ran.says(["warning: 00: ", "sequence.toml: unknown key `lidar.0.colour` ignored"]);
}

#[test]
fn what_is_not_there_is_named_with_what_it_was_needed_for() {
    let dataset = Dataset::new();
    let nowhere = dataset.beside("nowhere");
    let label = |more: &[&str]| {
        let asked = ["label", &dataset.path, "-o", &dataset.out, "-q", "--no-check"];
        Ran::of(&program().args(asked).args(more).output().unwrap())
    };
    let absent = format!("{nowhere}: expected a regular file, found none of this name");
    for option in ["--config", "--topics", "--trajectory", "--depth-model"] {
        label(&[option, &nowhere]).exits(1).says([option, &absent]);
    }
    label(&["--method", "learned", "--model", &nowhere]).exits(1).says(["--model", &absent]);
    ralf(["simulate", "-o", &dataset.out, "--scenario", &nowhere]).exits(1).says(["--scenario", &absent]);
    let recording =
        format!("{nowhere}: expected the folder or the file of a recording, found none of this name");
    ralf(["inspect", &nowhere]).exits(1).says([&recording]);
    label(&[]).exits(0);
    ralf(["label", &dataset.out, "-o", &nowhere])
        .exits(1)
        .says([&dataset.out, "content: expected a recording, found the labels of one"]);
    label(&["--set", "lidar.beta=abc"])
        .exits(2)
        .says(["error: --set: invalid type: string \"abc\", expected a number in `lidar.beta`\n"]);
    ralf(["evaluate", &dataset.out, "--truth", &nowhere])
        .exits(1)
        .says([&nowhere, "expected a folder with corrected labels"]);
}

/// What one method can label the others can: it is told at once that the learned one writes a column of this name, or
/// that evidence has it.
#[test]
fn fields_with_the_name_of_a_column_that_another_method_writes() {
    for name in ["cause", "novelty", "reason_lidar_rays", "class_from", "sight_wall_length"] {
        let dataset = Dataset::new();
        dataset.edit("sequence.toml", "\"rcs\"]", &format!("\"{name}\"]"));
        let told = format!("field `{name}` of radar_front has the name of a column of the result");
        refused(&dataset, ["sequence 00", &told]);
    }
}
