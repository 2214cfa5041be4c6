//! A run that was killed goes on where it stopped; one with other settings replaces all of it.

use crate::support::{Dataset, Ran, Shape, Tree, program, ralf, tree, without_timings};
use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// How many scans of a sequence a run under way has labelled so far.
fn labelled(dataset: &Dataset) -> usize {
    let labels = fs::read_dir(dataset.result("radar_front")).into_iter().flatten().flatten();
    labels.filter(|file| file.path().extension().is_some_and(|ending| ending == "label")).count()
}

/// Starts a run and kills it as soon as some scans are labelled.
fn kill_midway(dataset: &Dataset, jobs: &str) {
    let mut run = program()
        .args(["label", "--no-check", &dataset.path, "-o", &dataset.out, "--jobs", jobs])
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while labelled(dataset) < 10 {
        assert!(run.try_wait().unwrap().is_none(), "it ended before it could be killed");
        assert!(begun.elapsed() < Duration::from_secs(60), "it labels nothing");
        sleep(Duration::from_millis(2));
    }
    // SIGKILL on Unix.
    run.kill().unwrap();
    assert!(!run.wait().unwrap().success());
    assert!(!Path::new(&dataset.out).join("run.json").exists());
}

/// The folder where runs with the usual settings keep what is not finished, by its name.
fn run_folder(dataset: &Dataset) -> String {
    let stopped = dataset.beside("stopped");
    // A folder in the place of the table lets the run fail when all scans are labelled.
    fs::create_dir_all(format!("{stopped}/sequences/00/plausibility.parquet/in-the-way")).unwrap();
    ralf(["label", "--no-check", &dataset.path, "-o", &stopped]).exits(1);
    let name = fs::read_dir(format!("{stopped}/.ralf-run")).unwrap().next().unwrap().unwrap().file_name();
    name.into_string().unwrap()
}

#[test]
fn a_run_that_was_killed_goes_on_and_ends_the_same() {
    let dataset = Dataset::of(&Shape { scans: 60, ..Shape::default() });
    kill_midway(&dataset, "1");
    let kept = dataset.result("radar_front/000000.label");
    let written = fs::metadata(&kept).unwrap().modified().unwrap();
    ralf(["label", "--no-check", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing();
    assert_eq!(fs::metadata(&kept).unwrap().modified().unwrap(), written, "it was labelled again");
    let whole = dataset.beside("whole");
    ralf(["label", "--no-check", &dataset.path, "-o", &whole]).exits(0);
    assert!(without_timings(&dataset.out) == without_timings(&whole));
}

#[test]
fn sequences_under_way_side_by_side_go_on_and_end_the_same() {
    let dataset = Dataset::of(&Shape { scans: 20, sequences: &["00", "01", "02", "03"], ..Shape::default() });
    kill_midway(&dataset, "3");
    ralf(["label", "--no-check", &dataset.path, "-o", &dataset.out, "--jobs", "2"]).exits(0).says_nothing();
    let whole = dataset.beside("whole");
    ralf(["label", "--no-check", &dataset.path, "-o", &whole, "--jobs", "1"]).exits(0);
    assert!(without_timings(&dataset.out) == without_timings(&whole));
}

#[test]
fn a_run_that_was_killed_is_judged_by_no_command() {
    let dataset = Dataset::of(&Shape { scans: 60, ..Shape::default() });
    kill_midway(&dataset, "1");
    let (path, out) = (dataset.path.as_str(), dataset.out.as_str());
    let told = [out, "run.json: expected the record of a finished `ralf label`, found an unfinished run"];
    ralf(["evaluate", out, "--truth", path]).exits(1).prints_nothing().ends_with_error(told);
    ralf(["evaluate", out]).exits(1).prints_nothing().ends_with_error(told);
    ralf(["inspect", out]).exits(1).prints_nothing().ends_with_error(told);
    ralf(["label", "--no-check", path, "-o", out]).exits(0);
    ralf(["evaluate", out, "--truth", path]).exits(0);
}

#[test]
fn a_sequence_that_was_begun_beside_finished_ones_is_not_judged() {
    let dataset = Dataset::of(&Shape { scans: 4, sequences: &["00", "01"], ..Shape::default() });
    let (path, out) = (dataset.path.as_str(), dataset.out.as_str());
    ralf(["label", path, "-o", out, "--sequence", "00"]).exits(0);
    // A folder in the place of the table lets the run fail when all scans are labelled.
    let table = format!("{out}/sequences/01/plausibility.parquet");
    fs::create_dir_all(format!("{table}/in-the-way")).unwrap();
    ralf(["label", path, "-o", out, "--sequence", "01"]).exits(1);
    let told = [out, "sequence 01: expected labels of all scans, found an unfinished run"];
    ralf(["evaluate", out, "--truth", path]).exits(1).prints_nothing().ends_with_error(told);
    fs::remove_dir_all(table).unwrap();
    ralf(["label", path, "-o", out, "--sequence", "01"]).exits(0);
    ralf(["evaluate", out, "--truth", path]).exits(0);
}

#[test]
fn what_a_power_cut_spoiled_is_made_again() {
    let dataset = Dataset::of(&Shape { scans: 60, ..Shape::default() });
    let whole = dataset.beside("whole");
    ralf(["label", "--no-check", &dataset.path, "-o", &whole]).exits(0);
    kill_midway(&dataset, "1");
    let unfinished = Path::new(&dataset.out).join(".ralf-run");
    let log = tree(&unfinished).into_keys().find(|name| name.ends_with(".scans")).unwrap();
    // RUN/FINGERPRINT/00/0.scans: a byte of some scan, and the last one not whole.
    let log = unfinished.join(log);
    let mut bytes = fs::read(&log).unwrap();
    let length = bytes.len();
    bytes[length / 2] ^= 1;
    fs::write(&log, &bytes[..length - 3]).unwrap();
    fs::write(dataset.result("radar_front/000001.label"), "").unwrap();
    // The record of a finished sequence.
    fs::write(log.ancestors().nth(2).unwrap().with_extension("json"), "{").unwrap();
    ralf(["label", "--no-check", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing();
    assert!(without_timings(&dataset.out) == without_timings(&whole));
    fs::write(format!("{}/run.json", dataset.out), "{").unwrap();
    ralf(["label", "--no-check", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing();
    assert!(without_timings(&dataset.out) == without_timings(&whole));
}

/// Leaves what is on disk between the last sequence and the record.
fn killed_before_the_record(dataset: &Dataset) {
    let record: serde_json::Value =
        serde_json::from_slice(&fs::read(format!("{}/run.json", dataset.out)).unwrap()).unwrap();
    let unfinished = format!("{}/.ralf-run/{}", dataset.out, run_folder(dataset));
    fs::create_dir_all(&unfinished).unwrap();
    for sequence in record["sequences"].as_array().unwrap() {
        let inputs: Vec<_> = record["inputs"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|input| input["sequence"] == sequence["name"])
            .collect();
        let file = format!("{unfinished}/{}.json", sequence["fingerprint"].as_str().unwrap());
        fs::write(file, serde_json::json!([sequence, inputs]).to_string()).unwrap();
    }
    fs::remove_file(format!("{}/run.json", dataset.out)).unwrap();
}

#[test]
fn a_sequence_that_was_finished_before_the_kill_is_kept() {
    let dataset = Dataset::of(&Shape { scans: 4, sequences: &["00", "01"], ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let whole = without_timings(&dataset.out);
    killed_before_the_record(&dataset);
    let table = dataset.result("plausibility.parquet");
    let written = fs::metadata(&table).unwrap().modified().unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says(["nothing to do"]);
    assert_eq!(fs::metadata(&table).unwrap().modified().unwrap(), written);
    assert!(without_timings(&dataset.out) == whole);
}

#[test]
fn finished_labels_of_a_killed_run_that_other_settings_remove_are_named() {
    let dataset = Dataset::of(&Shape { scans: 2, sequences: &["00", "01"], ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    killed_before_the_record(&dataset);
    let other = ["--sequence", "01", "--set", "fusion.threshold=0.9"];
    let ran = ralf(["label", &dataset.path, "-o", &dataset.out, other[0], other[1], other[2], other[3]]);
    let ran = ran.exits(0).says(["removed, for they were made by another version"]);
    let lines: Vec<&str> = ran.stderr.lines().filter(|line| line.contains("another version")).collect();
    assert!(lines[0].ends_with("settings: 00") && lines[1].ends_with("settings: 01"), "{}", ran.stderr);
    assert!(lines[1].starts_with("labelled again, for they were made by another version"), "{}", ran.stderr);
}

#[test]
fn labels_of_other_settings_or_inputs_that_are_made_again_are_named() {
    let dataset = Dataset::of(&Shape { scans: 2, sequences: &["00", "01"], ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing();
    let ran = ralf(["label", &dataset.path, "-o", &dataset.out, "--set", "fusion.threshold=0.9"]);
    ran.exits(0).says(["labelled again, for they were made by another version", "settings: 00, 01"]);
    dataset.edit("sequence.toml", "sigma_azimuth_deg = 0.6", "sigma_azimuth_deg = 0.7");
    let ran = ralf(["label", &dataset.path, "-o", &dataset.out, "--set", "fusion.threshold=0.9"]);
    ran.exits(0).says(["sequence 00 is labelled again: it is read from other inputs than before"]);
}

#[test]
fn without_a_branch_it_is_said_that_all_are_artifacts() {
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    let off = ["lidar", "camera", "tracking"].map(|branch| format!("{branch}.enabled=false"));
    let off = off.iter().flat_map(|setting| ["--set", setting]);
    let ran = program().args(["label", &dataset.path, "-o", &dataset.out]).args(off).output().unwrap();
    Ran::of(&ran).exits(0).says(["are all false: every detection is an artifact"]);
}

#[test]
fn a_run_that_has_not_checked_is_checked_later() {
    let dataset = Dataset::new();
    let whole = dataset.beside("whole");
    ralf(["label", &dataset.path, "-o", &whole]).exits(0);
    ralf(["label", "--no-check", &dataset.path, "-o", &dataset.out]).exits(0);
    assert!(without_timings(&dataset.out) != without_timings(&whole));
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says(["nothing to do"]);
    assert!(without_timings(&dataset.out) == without_timings(&whole));
}

#[test]
fn a_lost_record_is_made_again() {
    let dataset = Dataset::new();
    ralf(["label", "--no-check", &dataset.path, "-o", &dataset.out]).exits(0);
    let whole = without_timings(&dataset.out);
    fs::remove_file(format!("{}/run.json", dataset.out)).unwrap();
    fs::create_dir_all(format!("{}/.ralf-run/of-another-run/00", dataset.out)).unwrap();
    ralf(["label", "--no-check", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing();
    assert!(without_timings(&dataset.out) == whole);
}

#[test]
fn other_settings_replace_everything() {
    let dataset = Dataset::new();
    let fresh = dataset.beside("fresh");
    ralf(["label", "--no-check", &dataset.path, "-o", &dataset.out]).exits(0);
    let label = |out| {
        ralf(["label", "--no-check", &dataset.path, "-o", out, "--set", "fusion.threshold=0.9"]).exits(0)
    };
    label(&dataset.out).says(["labelled again, for they were made by another version", "settings: 00"]);
    label(&fresh).says_nothing();
    assert!(without_timings(&dataset.out) == without_timings(&fresh));
}

#[test]
fn other_settings_replace_what_a_killed_run_left() {
    let dataset = Dataset::of(&Shape { scans: 60, sequences: &["00", "01"], ..Shape::default() });
    kill_midway(&dataset, "1");
    // A kill may fall into the writing of a file.
    fs::write(dataset.result("radar_front/.000000.label.part"), "half").unwrap();
    fs::write(dataset.result(".plausibility.parquet.part"), "half").unwrap();
    let fresh = dataset.beside("fresh");
    let labelled = |out: &str| {
        let other = ["--sequence", "01", "--set", "fusion.threshold=0.9"];
        ralf(["label", "--no-check", &dataset.path, "-o", out, other[0], other[1], other[2], other[3]])
            .exits(0)
    };
    labelled(&dataset.out).says(["removed", "what was labelled so far of 00"]);
    labelled(&fresh).says_nothing();
    assert!(without_timings(&dataset.out) == without_timings(&fresh));
}

#[test]
fn what_a_killed_run_left_of_another_recording_stays() {
    let dataset = Dataset::of(&Shape { scans: 60, sequences: &["00", "01"], ..Shape::default() });
    let other = Dataset::of_another_drive(&Shape { scans: 2, sequences: &["00", "02"], ..Shape::default() });
    kill_midway(&dataset, "1");
    let left = || tree(&dataset.out).into_iter().filter(|(name, _)| name != ".ralf-lock").collect::<Tree>();
    let label = |path: &str, chosen: &str, threshold: &str| {
        let set = format!("fusion.threshold={threshold}");
        ralf(["label", "--no-check", path, "-o", &dataset.out, "--sequence", chosen, "--set", &set])
    };
    let there = fs::canonicalize(&dataset.path).unwrap();
    let told = ["recording.json: recording: expected labels of ", "found those of another recording, "];
    let before = left();
    // Other settings take all of it, the same ones what has the same name.
    for (chosen, threshold) in [("00", "0.9"), ("02", "0.9"), ("00", "0.4")] {
        label(&other.path, chosen, threshold)
            .exits(1)
            .ends_with_error([told[0], told[1]])
            .says([there.to_str().unwrap(), ", which would go (00)"]);
        assert!(left() == before, "{chosen} {threshold}");
    }
    label(&other.path, "02", "0.4").exits(0).says_nothing();
    // Of what an older version left nobody knows whose it is.
    let kept = tree(&dataset.out).into_keys().find(|name| name.ends_with("/recording.json")).unwrap();
    fs::remove_file(Path::new(&dataset.out).join(kept)).unwrap();
    label(&dataset.path, "01", "0.9").exits(1).ends_with_error(["those of another recording, ", "(02)"]);
    fs::remove_file(format!("{}/run.json", dataset.out)).unwrap();
    label(&other.path, "02", "0.9").exits(0).says(["removed", "what was labelled so far of 00"]);
}

#[test]
fn finished_labels_that_a_killed_run_left_of_another_recording_stay() {
    let dataset = Dataset::of(&Shape { scans: 2, sequences: &["00", "01"], ..Shape::default() });
    let other = Dataset::of_another_drive(&Shape { scans: 2, sequences: &["02"], ..Shape::default() });
    ralf(["label", "--no-check", &dataset.path, "-o", &dataset.out]).exits(0);
    killed_before_the_record(&dataset);
    let before = tree(&dataset.out);
    let label = |path: &str, more: [&str; 2]| {
        ralf(["label", "--no-check", path, "-o", &dataset.out, more[0], more[1]])
    };
    let refused = label(&other.path, ["--set", "fusion.threshold=0.9"]).exits(1);
    refused.ends_with_error(["found those of another recording, ", ", which would go (00, 01)"]);
    assert!(tree(&dataset.out) == before);
    // With the same settings they lie side by side.
    label(&other.path, ["--jobs", "1"]).exits(0).says_nothing();
    assert!(dataset.result("plausibility.parquet").exists());
    label(&dataset.path, ["--jobs", "1"]).exits(0).says(["nothing to do"]);
}

#[test]
fn a_scan_that_can_not_be_labelled_any_more_keeps_no_label() {
    let dataset = Dataset::new();
    ralf(["label", "--no-check", &dataset.path, "-o", &dataset.out]).exits(0);
    dataset.cut("radar_front/000003.bin", 1);
    ralf(["label", "--no-check", &dataset.path, "-o", &dataset.out]).exits(3);
    assert!(!dataset.result("radar_front/000003.label").exists());
    assert!(dataset.result("radar_front/000002.label").exists());
}

/// A program that was built from other sources has the same version.
#[test]
fn labels_of_another_build_are_made_again() {
    let dataset = Dataset::new();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let whole = without_timings(&dataset.out);
    let file = format!("{}/run.json", dataset.out);
    let mut record: serde_json::Value = serde_json::from_slice(&fs::read(&file).unwrap()).unwrap();
    let program = record["program"].as_str().unwrap().to_owned();
    assert!(program.len() == 32 && program.bytes().all(|byte| byte.is_ascii_hexdigit()), "{program}");
    record["program"] = "of-other-sources".into();
    fs::write(&file, record.to_string()).unwrap();
    let table = dataset.result("plausibility.parquet");
    let written = fs::metadata(&table).unwrap().modified().unwrap();
    let told = "labelled again, for they were made by another version";
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says([told]);
    assert_ne!(fs::metadata(&table).unwrap().modified().unwrap(), written, "nothing was done");
    assert!(without_timings(&dataset.out) == whole);
}

#[test]
fn a_conversion_or_simulation_that_was_ended_writes_what_is_missing_when_it_is_typed_again() {
    let dataset = Dataset::of(&Shape { scans: 2, sequences: &["00", "01", "02"], ..Shape::default() });
    let [copy, made] = ["copy", "made"].map(|name| dataset.beside(name));
    let world = ["simulate", "-o", &made, "--preset", "worlds", "--scans", "4", "--no-images", "-q"];
    for (command, place) in
        [(vec!["convert", &dataset.path, "-o", &copy, "-q"], &copy), (world.to_vec(), &made)]
    {
        let run = || Ran::of(&program().args(&command).output().unwrap());
        run().exits(0);
        let whole = tree(place);
        for lost in ["00", "02"] {
            fs::remove_dir_all(format!("{place}/sequences/{lost}")).unwrap();
        }
        let ran = run().exits(0).prints_nothing();
        let said: Vec<&str> = ran.stderr.lines().collect();
        let [kept, first, second] = said[..] else { panic!("{}", ran.stderr) };
        assert!(kept.starts_with("kept as it is") && kept.contains("sequences/01"), "{kept}");
        for (line, name) in [(first, "00"), (second, "02")] {
            assert_eq!(line, format!("wrote {place}/sequences/{name}"));
        }
        assert!(tree(place) == whole);
    }
}
