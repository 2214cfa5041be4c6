//! Many recordings in three steps: what comes out is what `ralf label` writes.

use crate::support::{Dataset, Ran, Shape, program, ralf, tree, without_timings};
use std::fs;
use std::path::Path;

#[test]
fn three_steps_make_what_one_command_makes() {
    let dataset = Dataset::of(&Shape { scans: 12, ..Shape::default() });
    let out = dataset.beside("many");
    let damaged = dataset.beside("damaged");
    fs::create_dir_all(format!("{damaged}/sequences/00")).unwrap();
    fs::write(format!("{damaged}/sequences/00/sequence.toml"), "[[").unwrap();
    let planned = ralf(["cluster", "plan", "--quiet", &damaged, &dataset.path, "-o", &out, "--scans", "5"]);
    let planned = planned.exits(3).says(["not planned: ", "sequence.toml"]);
    let tasks: usize = planned.stdout.trim().parse().unwrap();
    assert!(tasks > 2, "{tasks}");
    for task in (0..tasks).rev() {
        ralf(["cluster", "label", &out, "--task", &task.to_string()]).exits(0).says_nothing();
    }
    ralf(["cluster", "label", &out, "--task", &tasks.to_string()]).exits(1).says(["expected a task below"]);
    // All is labelled, though it isn't put together: nothing is left to plan, and numbers that wait have nothing to do.
    let plan = ["cluster", "plan", "-q", &dataset.path, "-o", &out, "--scans", "5"];
    ralf(plan).exits(0).prints(["0"]);
    let last = (tasks - 1).to_string();
    ralf(["cluster", "label", &out, "--task", &last]).exits(0).says(["nothing to do"]);
    ralf(["cluster", "assemble", "--quiet", &out]).exits(3).says(["no labels: ", "sequence.toml"]);
    ralf(["label", "--quiet", &dataset.path, "-o", &dataset.out]).exits(0);
    let name = std::path::Path::new(&dataset.path).file_name().unwrap().to_str().unwrap();
    let mut found = without_timings(format!("{out}/{name}"));
    assert!(found.remove("plan.json").is_some());
    assert!(found == without_timings(&dataset.out));
    // All is done: there is nothing left to plan.
    let again = ralf(["cluster", "plan", "--quiet", &dataset.path, "-o", &out]).exits(0);
    assert_eq!(again.stdout.trim(), "0");
    // Drives are put away once they are labelled.
    fs::rename(&dataset.path, dataset.beside("archive")).unwrap();
    let assembled = ralf(["cluster", "assemble", "-q", &format!("{out}/{name}")]).exits(0);
    assembled.prints(["1 of 1 recordings"]).says(["found none of 00", "their labels stay"]);
}

#[test]
fn a_place_among_measurements_and_a_trajectory_of_several_recordings_are_refused() {
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    let [other, out] = ["other", "many"].map(|name| dataset.beside(name));
    ralf(["convert", "-q", &dataset.path, "-o", &other]).exits(0);
    let before = tree(&other);
    for place in ["", "/sequences", "/sequences/00/radar_front"] {
        let place = format!("{other}{place}");
        ralf(["cluster", "plan", "-q", &dataset.path, "-o", &place]).exits(1).ends_with_error([&place]);
        assert!(tree(&other) == before, "{place}");
    }
    ralf(["label", "-q", &dataset.path, "-o", &dataset.out]).exits(0);
    let labels = tree(&dataset.out);
    let plan = ["cluster", "plan", "-q", &other, "-o", &dataset.out];
    ralf(plan).exits(1).ends_with_error([&dataset.out, "found results of one"]);
    assert!(tree(&dataset.out) == labels);
    let poses = dataset.beside("poses.tum");
    fs::write(&poses, "1700000000.0 0 0 0 0 0 0 1\n1700000001.0 8 0 0 0 0 0 1\n").unwrap();
    let plan = ["cluster", "plan", "-q", &dataset.path, &other, "-o", &out, "--trajectory", &poses];
    ralf(plan).exits(2).ends_with_error(["--trajectory", "expected one DATASET", "found 2"]);
    assert!(!Path::new(&out).exists());
}

#[test]
fn a_folder_that_nobody_planned_is_refused() {
    let dataset = Dataset::of(&Shape::default());
    let assembled = ralf(["cluster", "assemble", &dataset.out]).exits(1);
    assembled.says(["expected what `ralf cluster plan` wrote, found no such folder"]);
    ralf(["cluster", "label", &dataset.out, "--task", "0"]).exits(1).says(["tasks.jsonl"]);
    ralf(["cluster", "plan", "-o", &dataset.out]).exits(2);
}

#[test]
fn what_is_no_recording_leaves_nothing_behind() {
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    let [nothing, out, empty] = ["nothing", "many", "empty"].map(|name| dataset.beside(name));
    fs::create_dir(&empty).unwrap();
    for place in [&nothing, &empty] {
        let planned = ralf(["cluster", "plan", "-q", place, "-o", &out]).exits(3).prints(["0"]);
        planned.says(["not planned: ", place]);
        assert!(!Path::new(&out).exists(), "{place}");
    }
    ralf(["cluster", "plan", "-q", &nothing, &dataset.path, "-o", &out]).exits(3).prints(["1"]);
    assert!(!Path::new(&out).join("nothing").exists());
}

#[test]
fn labels_of_another_recording_are_no_plans() {
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    let other = Dataset::of_another_drive(&Shape { scans: 3, ..Shape::default() });
    let many = dataset.beside("many");
    let out = format!("{many}/dataset");
    ralf(["label", "-q", &dataset.path, "-o", &out]).exits(0);
    let before = without_timings(&out);
    ralf(["cluster", "plan", "-q", &other.path, "-o", &many]).exits(3).prints(["0"]).says([
        "not planned: ",
        &other.path,
        "found those of another recording, ",
    ]);
    assert!(without_timings(&out) == before);
}

#[test]
fn labels_of_other_settings_that_a_plan_removes_are_named() {
    let dataset = Dataset::of(&Shape { sequences: &["00", "01"], scans: 2, ..Shape::default() });
    let out = dataset.beside("many/dataset");
    let many = dataset.beside("many");
    let plan = |setting: &str| ralf(["cluster", "plan", "-q", &dataset.path, "-o", &many, "--set", setting]);
    ralf(["label", "-q", &dataset.path, "-o", &out]).exits(0);
    let told = "removed, for they were made by another version, of a recording of another format or with other settings";
    plan("fusion.alpha=0.7").exits(0).prints(["2"]).says([&out, told, ": 00, 01"]);
    ralf(["cluster", "label", &many, "--task", "1"]).exits(0).says_nothing();
    plan("fusion.alpha=0.6").exits(0).says([&out, told, ": what was labelled so far of 01"]);
    plan("fusion.alpha=0.6").exits(0).says_nothing();
}

/// Numbers of tasks that wait somewhere stay those of the same tasks.
#[test]
fn a_further_plan_leaves_the_tasks_of_other_recordings_and_of_busy_ones() {
    let dataset = Dataset::of(&Shape { scans: 6, ..Shape::default() });
    let [other, out] = ["other", "many"].map(|name| dataset.beside(name));
    ralf(["convert", "-q", &dataset.path, "-o", &other]).exits(0);
    let list = || -> Vec<String> {
        let text = fs::read_to_string(Path::new(&out).join("tasks.jsonl")).unwrap();
        text.lines().map(str::to_owned).collect()
    };
    let plan = |recording: &str| ralf(["cluster", "plan", "-q", recording, "-o", &out, "--scans", "4"]);
    plan(&dataset.path).exits(0);
    let first = list();
    let planned = plan(&other).exits(0);
    assert_eq!(planned.stdout.trim(), (2 * first.len()).to_string());
    let both = list();
    assert!(both.starts_with(&first) && both[first.len()..].iter().all(|line| line.contains("other")));
    // Somebody is at work on the first one.
    let mut lock = fs::File::options();
    lock.create(true).truncate(false).write(true).read(true);
    let lock = lock.open(Path::new(&out).join("dataset/.ralf-lock")).unwrap();
    lock.lock_shared().unwrap();
    plan(&dataset.path).exits(3).says(["not planned", "another run of ralf writes here"]);
    assert_eq!(list(), both);
    drop(lock);
    ralf(["cluster", "assemble", "-q", &format!("{out}/dataset")]).exits(0);
    plan(&dataset.path).exits(0);
    assert!(
        list()[..first.len()].iter().all(String::is_empty) && list()[first.len()..] == both[first.len()..]
    );
    ralf(["cluster", "label", &out, "--task", "0"]).exits(0).says(["task 0: nothing to do"]);
    ralf(["cluster", "assemble", "-q", &out]).exits(0);
    assert_eq!(plan(&other).exits(0).stdout.trim(), "0");
}

#[test]
fn a_recording_that_is_typed_as_a_dot_has_the_name_of_its_folder() {
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    let out = dataset.beside("many");
    let plan = ["cluster", "plan", "-q", ".", "-o", &out];
    Ran::of(&program().current_dir(&dataset.path).args(plan).output().unwrap()).exits(0).prints(["1"]);
    assert!(Path::new(&out).join("dataset/plan.json").exists());
}

#[test]
fn what_tasks_are_labelled_without_is_said() {
    let dataset = Dataset::of(&Shape { scans: 6, ..Shape::default() });
    dataset.cut("lidar_top/000003.bin", 4);
    let out = dataset.beside("many");
    ralf(["cluster", "plan", "-q", &dataset.path, "-o", &out]).exits(0).prints(["1"]);
    let told = "labelled without: 00 lidar_top scan 3: sequences/00/lidar_top/000003.bin: byte ";
    for _ in 0..2 {
        ralf(["cluster", "label", &out, "--task", "0"]).exits(0).says([told]);
    }
    ralf(["cluster", "assemble", "-q", &out]).exits(0).says([told]);
}

/// What a plan remembers of the inputs is what the record will tell of them.
#[test]
fn hashes_that_are_damaged_between_the_steps_are_made_again() {
    let dataset = Dataset::of(&Shape { scans: 4, ..Shape::default() });
    let many = dataset.beside("many");
    let out = format!("{many}/dataset");
    ralf(["label", "-q", &dataset.path, "-o", &dataset.out]).exits(0);
    for damage in [flip_digit, cut_in_half] {
        ralf(["cluster", "plan", "-q", &dataset.path, "-o", &many]).exits(0).prints(["1"]);
        ralf(["cluster", "label", &many, "--task", "0"]).exits(0);
        let mut inputs = Path::new(&out).join(".ralf-run");
        for _ in 0..2 {
            inputs = fs::read_dir(&inputs).unwrap().next().unwrap().unwrap().path();
        }
        damage(&inputs.join("inputs.json"));
        ralf(["cluster", "assemble", "-q", &many]).exits(0);
        let mut found = without_timings(&out);
        found.remove("plan.json");
        assert!(found == without_timings(&dataset.out));
        fs::remove_dir_all(&out).unwrap();
    }
}

/// Another digit in the first hash.
fn flip_digit(file: &Path) {
    let text = fs::read_to_string(file).unwrap();
    let at = text.find("\"blake3\": \"").unwrap() + 11;
    let digit = if &text[at..=at] == "0" { "1" } else { "0" };
    fs::write(file, [&text[..at], digit, &text[at + 1..]].concat()).unwrap();
}

fn cut_in_half(file: &Path) {
    let bytes = fs::read(file).unwrap();
    fs::write(file, &bytes[..bytes.len() / 2]).unwrap();
}
