//! Faults that are planted into good recordings are noticed, with the right remedy; good recordings raise nothing.
#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    unreachable_pub,
    reason = "tests fail as tests do, and print a table for people"
)]

mod recording;
mod table;

use ralf_check::{SequenceCheck, State, Verdict, check};
use recording::{Planted, Recording};
use std::sync::Arc;
use table::{Fault, faults};

/// 30 km/h along a street.
const STRAIGHT: &str = "ego = { start = [0, -1.5, 0], speed_kmh = 30, leg = [{ length = 200 }] }";
/// 18 km/h in a slalom.
const TURNING: &str = "ego = { start = [0, -2, 0], speed_kmh = 18, leg = [{ length = 6, turn_deg = 35 }, \
    { length = 14, turn_deg = -70 }, { length = 14, turn_deg = 70 }, { length = 14, turn_deg = -60 }, { length = 60, turn_deg = 20 }] }";

/// What a check says of a fault.
struct Row {
    noticed: bool,
    right_remedy: Option<bool>,
    says: String,
}

fn judge(base: &Arc<Recording>, fault: &Fault) -> Row {
    let mut planted = Planted::new(base);
    (fault.plant)(&mut planted);
    let found = check(&planted);
    let speaks = |verdict: &&Verdict| {
        let counts =
            verdict.state == State::Doubt || (verdict.state == State::Fact && verdict.remedy.is_some());
        counts && fault.subjects.contains(&verdict.subject.as_str())
    };
    let own: Vec<&Verdict> = found.verdicts.iter().filter(speaks).collect();
    let remedies = || own.iter().filter_map(|verdict| verdict.remedy.as_ref());
    Row {
        noticed: !own.is_empty(),
        right_remedy: fault.remedy.map(|is_right| remedies().any(is_right)),
        says: told(&found),
    }
}

fn told(found: &SequenceCheck) -> String {
    let words =
        |verdict: &Verdict| verdict.remedy.as_ref().map_or_else(|| verdict.evidence.clone(), |r| r.words());
    let speaks = |v: &&Verdict| matches!(v.state, State::Doubt | State::Fact);
    found
        .verdicts
        .iter()
        .filter(speaks)
        .map(|v| format!("{}: {}", v.subject, words(v)))
        .collect::<Vec<_>>()
        .join("; ")
}

fn run(title: &str, base: &Arc<Recording>, wanted: impl Fn(&Fault) -> bool) {
    let mut failed = Vec::new();
    println!("{title}\n{:>3}  {:<40} {:<8} {:<7} says", "", "fault", "noticed", "remedy");
    for (i, fault) in faults().iter().enumerate().filter(|(_, fault)| wanted(fault)) {
        let row = judge(base, fault);
        let mark = |good| if good { "yes" } else { "NO" };
        let remedy = row.right_remedy.map_or("-", mark);
        println!("{:>3}  {:<40} {:<8} {:<7} {}", i + 1, fault.name, mark(row.noticed), remedy, row.says);
        if !row.noticed || row.right_remedy == Some(false) {
            failed.push(fault.name);
        }
    }
    assert!(failed.is_empty(), "{title}: {failed:?}");
}

#[test]
fn every_fault_is_noticed_on_a_straight_road() {
    run("30 km/h, straight", &Recording::of(STRAIGHT, 200, 1), |fault| fault.straight);
}

#[test]
fn every_fault_is_noticed_in_turns() {
    run("18 km/h, turning", &Recording::of(TURNING, 200, 2), |_| true);
}

#[test]
fn good_recordings_raise_nothing() {
    for (drive, seed) in [(STRAIGHT, 1), (TURNING, 2), (STRAIGHT, 3)] {
        let planted = Planted::new(&Recording::of(drive, 120, seed));
        assert!(table::measures_elevation(&planted));
        let found = check(&planted);
        assert_eq!(told(&found), "", "{drive}, seed {seed}");
    }
}
