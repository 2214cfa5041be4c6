//! Many recordings in three steps: what comes out is what `ralf label` writes.

use crate::support::{Dataset, Shape, ralf, without_timings};
use std::fs;

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
    ralf(["cluster", "assemble", "--quiet", &out]).exits(3).says(["no labels: ", "sequence.toml"]);
    ralf(["label", "--quiet", &dataset.path, "-o", &dataset.out]).exits(0);
    let name = std::path::Path::new(&dataset.path).file_name().unwrap().to_str().unwrap();
    let mut found = without_timings(format!("{out}/{name}"));
    assert!(found.remove("plan.json").is_some());
    assert!(found == without_timings(&dataset.out));
    // All is done: there is nothing left to plan.
    let again = ralf(["cluster", "plan", "--quiet", &dataset.path, "-o", &out]).exits(0);
    assert_eq!(again.stdout.trim(), "0");
}

#[test]
fn a_folder_that_nobody_planned_is_refused() {
    let dataset = Dataset::of(&Shape::default());
    ralf(["cluster", "assemble", &dataset.out]).exits(1).says(["expected what `ralf cluster plan` wrote"]);
    ralf(["cluster", "label", &dataset.out, "--task", "0"]).exits(1).says(["tasks.jsonl"]);
    ralf(["cluster", "plan", "-o", &dataset.out]).exits(2);
}
