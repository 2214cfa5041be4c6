//! `ralf check`, and the same at the head of `ralf label`: faults are noticed, told and put right; motion comes from elsewhere.

use crate::support::{Dataset, Ran, Shape, Tree, nuscenes, program, put, ralf, tree};
use std::fs;
use std::path::Path;
use std::sync::OnceLock;

/// A good recording, small: simulated once, for each test to spoil its own.
fn simulated(dataset: &Dataset) -> String {
    static SIMULATED: OnceLock<Tree> = OnceLock::new();
    let made = dataset.beside("made");
    let files = SIMULATED.get_or_init(|| {
        ralf(["simulate", "-o", &made, "--preset", "tiny", "-q"]).exits(0);
        tree(&made)
    });
    put(files, &made);
    made
}

fn sequence_file(recording: &str, name: &str) -> String {
    format!("{recording}/sequences/tiny/{name}")
}

/// The first radar's mounting is turned by 8 degrees.
fn turn_the_front_radar(recording: &str) {
    let file = sequence_file(recording, "sequence.toml");
    let text = fs::read_to_string(&file).unwrap();
    let turned = text.replacen("[0.0, 0.0, 0.0, 1.0]", "[0.0, 0.0, 0.0697564737, 0.9975640503]", 1);
    assert_ne!(text, turned);
    fs::write(&file, turned).unwrap();
}

fn record(out: &str) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(format!("{out}/run.json")).unwrap()).unwrap()
}

#[test]
fn a_good_recording_raises_nothing() {
    let dataset = Dataset::new();
    let made = simulated(&dataset);
    let picture = dataset.beside("check.png");
    ralf(["check", &made, "--strict", "-o", &picture]).exits(0).prints(["tiny: nothing speaks against it"]);
    assert!(fs::read(&picture).unwrap().starts_with(b"\x89PNG"));
    let json = ralf(["check", &made, "--json"]).exits(0).json();
    assert!(json[0]["verdicts"].as_array().unwrap().len() > 10, "{json}");
    ralf(["inspect", &made]).exits(0).prints(["tiny: nothing speaks against it"]);
}

#[test]
fn a_turned_radar_is_noticed_told_and_put_right() {
    let dataset = Dataset::new();
    let made = simulated(&dataset);
    turn_the_front_radar(&made);
    let [fixes, out, fixed] = ["fixes.toml", "labels", "fixed"].map(|name| dataset.beside(name));
    let found = ralf(["check", &made, "--strict", "--write", &fixes]).exits(3);
    found.prints(["DOUBT", "radar_front", "fits better with yaw -"]);

    ralf(["label", &made, "-o", &out, "--strict", "-q"])
        .exits(3)
        .says(["doubt: tiny: radar_front", "--strict"]);
    assert!(!Path::new(&out).exists(), "nothing is labelled");
    ralf(["label", &made, "-o", &out, "-q"]).exits(0).says(["doubt: tiny: radar_front"]);
    let doubt = &record(&out)["check"][0]["doubts"][0];
    assert_eq!(doubt["subject"], "radar_front", "{doubt}");
    ralf(["label", &made, "-o", &fixed, "--config", &fixes, "--strict", "-q"]).exits(0).says_nothing();
    assert_eq!(record(&fixed)["check"][0]["doubts"].as_array().unwrap().len(), 0);
}

/// Of the recording with these arguments of its own: what is proposed, given to `label`, leaves nothing to be doubted.
fn is_put_right_by_what_is_proposed(recording: &str, config: &[&str]) {
    let [fixes, out] = [".fixes.toml", ".labels"].map(|ending| recording.to_owned() + ending);
    let with = |command: &[&str], more: &[&str]| {
        Ran::of(&program().args(command).args(config).args(more).output().unwrap())
    };
    with(&["check", recording, "--strict", "--write", &fixes], &[]).exits(3);
    with(&["check", recording, "--strict"], &["--config", &fixes])
        .exits(0)
        .prints(["nothing speaks against"]);
    let label = ["label", recording, "-o", &out, "--strict", "-q"];
    with(&label, &["--config", &fixes]).exits(0).says_nothing();
    assert!(!record(&out)["settings"]["sensors"]["radar_left"]["fov_azimuth_deg"].is_null());
}

#[test]
fn what_is_proposed_for_a_field_of_view_puts_it_right_in_every_format() {
    let dataset = Dataset::new();
    let made = simulated(&dataset);
    turn_the_front_radar(&made);
    let [file, settings] = ["made.mcap", "made.toml"].map(|name| dataset.beside(name));
    ralf(["convert", &made, "-o", &file, "-q"]).exits(0);
    // The settings that were written beside it tell the fields of view.
    let alone = ralf(["check", &file]).exits(0);
    assert!(alone.stdout.contains("fov_azimuth_deg should rather be"), "{}", alone.stdout);
    let told = ralf(["check", &file, "--config", &settings]).exits(0);
    assert!(!told.stdout.contains("fov_azimuth_deg"), "{}", told.stdout);

    let toml = sequence_file(&made, "sequence.toml");
    let narrow = |text: &str| text.replace("fov_azimuth_deg = 160.0", "fov_azimuth_deg = 90.0");
    fs::write(&toml, narrow(&fs::read_to_string(&toml).unwrap())).unwrap();
    fs::write(&settings, narrow(&fs::read_to_string(&settings).unwrap())).unwrap();
    is_put_right_by_what_is_proposed(&made, &[]);
    is_put_right_by_what_is_proposed(&file, &["--config", &settings]);
}

#[test]
fn a_recording_that_is_read_by_settings_is_written_as_they_have_it() {
    let dataset = Dataset::new();
    let [file, settings, back] = ["made.mcap", "made.toml", "back"].map(|name| dataset.beside(name));
    ralf(["convert", &dataset.path, "-o", &file, "-q"]).exits(0);
    ralf(["convert", &file, "-o", &back, "-q", "--config", &settings]).exits(0);
    let text = fs::read_to_string(format!("{back}/sequences/made/sequence.toml")).unwrap();
    for told in ["fov_azimuth_deg = 150.0", "sigma_azimuth_deg = 0.8", "lowest_beam_deg = 25.0"] {
        assert!(text.contains(told), "expected {told} in\n{text}");
    }
    ralf(["check", &dataset.path, "--set", "sensors.radar_up.sigma_range_m=1"]).exits(1).says(["radar_up"]);

    let tables = dataset.beside("nuscenes");
    nuscenes(Path::new(&tables));
    let told = |set: &str| ralf(["check", &tables, "-v", "--set", set]).exits(0).stdout;
    let [given, narrow] = ["120", "1"].map(|fov| told(&format!("sensors.RADAR_FRONT.fov_azimuth_deg={fov}")));
    assert!(!given.contains("fov_azimuth_deg should"), "{given}");
    assert!(narrow.contains("fov_azimuth_deg should rather be"), "{narrow}");
}

#[test]
fn a_lidar_whose_files_are_empty_is_doubted() {
    let dataset = Dataset::new();
    let made = simulated(&dataset);
    for file in fs::read_dir(sequence_file(&made, "lidar_top")).unwrap() {
        let file = file.unwrap().path();
        if file.extension().is_some_and(|kind| kind == "bin") {
            fs::write(file, []).unwrap();
        }
    }
    ralf(["check", &made, "--strict"]).exits(3).prints([
        "lidar_top",
        "nothing came back in",
        "are its files empty",
    ]);
}

#[test]
fn without_odometry_the_radars_tell_the_motion() {
    let dataset = Dataset::new();
    let made = simulated(&dataset);
    fs::remove_file(sequence_file(&made, "odometry.csv")).unwrap();
    let out = dataset.beside("labels");
    ralf(["label", &made, "-o", &out, "-q"]).exits(0).says(["motion is taken from the radars' range rates"]);
    assert_eq!(record(&out)["sequences"][0]["motion"], "radar");
    let told = ralf(["inspect", &made, "--quick"]).exits(0).stdout;
    assert!(told.contains("0 poses, 0 odometry samples\n") && !told.contains("wheel odometry"), "{told}");
    assert!(told.contains("- the motion is taken from the radars' range rates\n"), "{told}");
    // A damaged scan costs itself, not the source of the motion.
    let scan = sequence_file(&made, "radar_front/000003.bin");
    let whole = fs::read(&scan).unwrap();
    fs::write(&scan, &whole[..whole.len() - 7]).unwrap();
    let said = ["motion is taken from the radars' range rates", "radar_front scan 3: "];
    ralf(["label", &made, "-o", &dataset.beside("damaged"), "-q"]).exits(3).says(said);
}

#[test]
fn without_odometry_and_range_rates_the_lidar_tells_the_motion() {
    let dataset = Dataset::new();
    let made = simulated(&dataset);
    fs::remove_file(sequence_file(&made, "odometry.csv")).unwrap();
    let file = sequence_file(&made, "sequence.toml");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replace("\"doppler\"", "\"speed\"")).unwrap();
    let out = dataset.beside("labels");
    ralf(["label", &made, "-o", &out, "-q"]).exits(0).says(["motion is taken from the LiDAR's scans"]);
    assert_eq!(record(&out)["sequences"][0]["motion"], "lidar");
    ralf(["inspect", &made, "--quick"])
        .exits(0)
        .prints(["0 poses, 0 odometry samples\n", "- the motion is taken from a LiDAR's scans\n"]);
    // Nothing is left that tells it.
    fs::write(&file, text.replace("\"doppler\"", "\"speed\"").split("[[lidar]]").next().unwrap()).unwrap();
    ralf(["check", &made]).exits(1).says(["range rates", "LiDAR", "--trajectory"]);
}

#[test]
fn a_trajectory_takes_the_place_of_odometry() {
    let dataset = Dataset::new();
    let made = simulated(&dataset);
    let [poses, out] = ["poses.tum", "labels"].map(|name| dataset.beside(name));
    // 2 m/s straight on from the first scan; the LiDAR's poses.
    let times = (0..10).map(|i| 1_600_000_000.0 + 0.1 * f64::from(i));
    let rows = times.enumerate().map(|(i, t)| format!("{t:.3} {} 0 0 0 0 0 1\n", 0.2 * i as f64));
    fs::write(&poses, rows.collect::<String>()).unwrap();
    ralf(["label", &made, "-o", &out, "-q", "--trajectory", &poses, "--trajectory-frame", "lidar_top"])
        .exits(0);
    let record = record(&out);
    assert_eq!(record["sequences"][0]["motion"], "trajectory");
    assert_eq!(record["settings"]["motion"]["trajectory_frame"], "lidar_top");
    let inputs = record["inputs"].to_string();
    assert!(inputs.contains("poses.tum"), "{inputs}");

    let refused =
        |frame: &str| ralf(["check", &made, "--trajectory", &poses, "--trajectory-frame", frame]).exits(1);
    refused("lidar_bottom").says(["expected `vehicle` or the name of a sensor", "lidar_bottom"]);
    fs::write(&poses, "0 0 0 0 0 0 0 1\n0.1 0 0 0 0 0 1\n").unwrap();
    refused("vehicle").says(["poses.tum", "line 2", "7 numbers"]);
    ralf(["check", &made, "--set", "corrections.radar_up.add_yaw_deg=1"])
        .exits(1)
        .says(["radar_up", "radar_front"]);
}

/// Makes the values of these columns NaN, in all but the first so many detections of each scan of the front radar.
fn blank(recording: &str, columns: &[usize], kept: usize) {
    const FIELDS: usize = 5;
    for entry in fs::read_dir(sequence_file(recording, "radar_front")).unwrap() {
        let file = entry.unwrap().path();
        if file.extension().is_none_or(|extension| extension != "bin") {
            continue;
        }
        let mut bytes = fs::read(&file).unwrap();
        for (value, place) in bytes.chunks_exact_mut(4).zip(0..) {
            if place / FIELDS >= kept && columns.contains(&(place % FIELDS)) {
                value.copy_from_slice(&f32::NAN.to_le_bytes());
            }
        }
        fs::write(&file, bytes).unwrap();
    }
}

#[test]
fn a_radar_without_places_is_named_and_the_others_are_labelled() {
    let dataset = Dataset::new();
    let made = simulated(&dataset);
    blank(&made, &[0, 1, 2, 3, 4], 0);
    let found = ralf(["check", &made]).exits(0).prints([
        "radar_front (numbers): 100 % of the detections have no finite coordinates",
        "`x`, `y`, `z`, `doppler`, `rcs` are not a finite number in any of",
    ]);
    assert!(!found.stdout.contains("elevation is said to be measured"), "{}", found.stdout);
    let out = dataset.beside("labels");
    let labelled = ralf(["label", &made, "-o", &out, "-q", "--no-check"])
        .exits(0)
        .prints(["tiny radar_front: none of its", "detections has a place"]);
    assert!(!labelled.stdout.contains("of the other radars'"), "{}", labelled.stdout);
    let told = &record(&out)["sequences"][0]["without_numbers"];
    assert_eq!((&told[0]["radar"], &told[0]["places"]), (&"radar_front".into(), &true.into()), "{told}");
    ralf(["inspect", &out]).exits(0).prints(["none of its"]);
}

#[test]
fn a_field_that_is_never_a_number_is_named_and_a_few_rows_are_not() {
    let dataset = Dataset::new();
    let made = simulated(&dataset);
    blank(&made, &[3], 0);
    ralf(["inspect", &made])
        .exits(0)
        .prints(["radar_front (numbers)", "`doppler` is not a finite number in any of"]);
    let out = dataset.beside("labels");
    ralf(["label", &made, "-o", &out, "-q", "--no-check"])
        .exits(0)
        .prints(["tiny radar_front: `doppler` is NaN in all of"]);

    let few = Dataset::new();
    let made = simulated(&few);
    blank(&made, &[0, 1, 2, 3, 4], 5);
    let out = few.beside("labels");
    let labelled = ralf(["label", &made, "-o", &out, "-q", "--no-check"]).exits(0);
    assert!(
        !labelled.stdout.contains("NaN") && !labelled.stdout.contains("has a place"),
        "{}",
        labelled.stdout
    );
    assert_eq!(record(&out)["sequences"][0].get("without_numbers"), None);
}

/// Some data sets have no range rates without the vehicle's motion while it stands: they are the measured ones.
#[test]
fn compensated_range_rates_may_be_missing_while_the_vehicle_stands() {
    let dataset = Dataset::new();
    let made = simulated(&dataset);
    blank(&made, &[4], 0);
    let file = sequence_file(&made, "sequence.toml");
    let renamed = fs::read_to_string(&file).unwrap().replace("\"rcs\"", "\"doppler_compensated\"");
    fs::write(&file, renamed).unwrap();
    let doubt = "`doppler_compensated` is not a finite number in any of";
    ralf(["check", &made]).exits(0).prints([doubt]);
    let odometry = "t_ns,v_mps,yaw_rate_radps\n0,0,0\n";
    fs::write(sequence_file(&made, "odometry.csv"), odometry).unwrap();
    let _ = fs::remove_file(sequence_file(&made, "poses.csv"));
    let standing = ralf(["check", &made]).exits(0);
    assert!(!standing.stdout.contains(doubt), "{}", standing.stdout);
    blank(&made, &[3], 0);
    ralf(["check", &made])
        .exits(0)
        .prints(["`doppler`, `doppler_compensated` are not a finite number in any of"]);
}

#[test]
fn scans_of_one_time_are_named() {
    let dataset = Dataset::new();
    let made = simulated(&dataset);
    let file = sequence_file(&made, "radar_left/timestamps.txt");
    let text = fs::read_to_string(&file).unwrap();
    let mut times: Vec<&str> = text.lines().collect();
    times[2] = times[1];
    fs::write(&file, times.join("\n") + "\n").unwrap();
    let told = format!(
        "radar_left (numbers): a measurement may be recorded twice or in parts, or its clock may stand: 1 of its {} measurements have the time of the one before, first number 2",
        times.len()
    );
    ralf(["check", &made]).exits(0).prints([&told]);
    let out = dataset.beside("labels");
    ralf(["label", &made, "-o", &out, "-q"]).exits(0).says(["doubt: tiny: radar_left"]);

    times.swap(3, 4);
    fs::write(&file, times.join("\n") + "\n").unwrap();
    ralf(["check", &made]).exits(1).says(["timestamps.txt: line 5", "as in the line above"]);
}

/// Where the calibration is of images of another size, nothing is made out of where their edges lie.
#[test]
fn images_of_another_size_than_the_calibrations_are_told_and_not_judged() {
    let dataset = Dataset::of(&Shape { scans: 16, ..Shape::default() }).with_camera(16);
    let text = fs::read_to_string(dataset.file("sequence.toml")).unwrap();
    let (before, camera) = text.split_once("[[camera]]").unwrap();
    let halved = camera.replacen("width = 160", "width = 80", 1).replacen("height = 120", "height = 60", 1);
    assert_ne!(camera, halved);
    dataset.put("sequence.toml", format!("{before}[[camera]]{halved}"));
    let found = ralf(["check", &dataset.path, "--json"]).exits(0).json();
    let verdicts = found[0]["verdicts"].as_array().unwrap().clone();
    let own: Vec<_> = verdicts.iter().filter(|verdict| verdict["question"] == "camera").collect();
    assert_eq!(own.len(), 1, "{own:?}");
    assert_eq!(own[0]["state"], "doubt", "{own:?}");
    assert_eq!(own[0]["evidence"], "images are 160 x 120, calibrated for 80 x 60");
    assert!(own[0].get("remedy").is_none(), "{own:?}");
}

/// Depth is laid on the LiDAR where settings have the sensors, as labelling lays it.
#[cfg(feature = "depth")]
#[test]
fn depth_is_checked_as_settings_correct_the_recording() {
    let dataset = Dataset::new();
    let made = simulated(&dataset);
    let fixes = dataset.beside("fixes.toml");
    let recorded = ralf(["depth", &made, "--check", "--json"]).exits(0).json();
    let corrected = || ralf(["depth", &made, "--check", "--json", "--config", &fixes]);
    fs::write(&fixes, "[corrections.camera_front]\nadd_yaw_deg = 20.0\n").unwrap();
    assert_ne!(corrected().exits(0).json(), recorded);
    fs::write(&fixes, "[corrections.no_such]\nadd_yaw_deg = 20.0\n").unwrap();
    corrected().exits(1).says(["corrections.no_such: expected one of its sensors"]);
}
