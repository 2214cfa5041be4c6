//! Faults that are planted into good recordings are noticed, with the right remedy; good recordings raise nothing.
#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    unreachable_pub,
    reason = "tests fail as tests do, and print a table for people"
)]

mod compensated;
mod cut;
mod depth;
mod labels;
mod odometry;
mod recording;
mod refinement;
mod sweep;
mod table;
mod wheels;
mod worlds;

use nalgebra::UnitQuaternion;
use ralf::sensors::Source;
use ralf_check::{
    Question, Remedy, SensorChange, SequenceCheck, State, Verdict, check, check_and_refine, doppler,
};
use recording::{Planted, Recording};
use std::sync::Arc;
use table::{Fault, faults};

/// 30 km/h along a street.
const STRAIGHT: &str = "ego = { start = [0, -1.5, 0], speed_kmh = 30, leg = [{ length = 200 }] }";
/// 18 km/h in a slalom.
const TURNING: &str = "ego = { start = [0, -2, 0], speed_kmh = 18, leg = [{ length = 6, turn_deg = 35 }, \
    { length = 14, turn_deg = -70 }, { length = 14, turn_deg = 70 }, { length = 14, turn_deg = -60 }, { length = 60, turn_deg = 20 }] }";

/// Whether an environment variable names this, as one of several between commas, or isn't set.
fn is_asked_for(variable: &str, name: &str) -> bool {
    std::env::var(variable).ok().is_none_or(|named| named.split(',').any(|one| one == name))
}

/// What a check says of a fault.
struct Row {
    noticed: bool,
    right_remedy: Option<bool>,
    says: String,
}

fn judge(base: &Arc<Recording>, fault: &Fault) -> Row {
    let mut planted = Planted::new(base);
    // Images cost the most, and say of other faults nothing that is asked for.
    if !fault.subjects.iter().any(|subject| subject.starts_with("camera")) {
        planted.sequence.rig.cameras.clear();
        planted.sequence.times.cameras.clear();
    }
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
    let speaks = |v: &&Verdict| matches!(v.state, State::Doubt | State::Fact);
    found
        .verdicts
        .iter()
        .filter(speaks)
        .map(|v| format!("{}: {}", v.subject, v.says()))
        .collect::<Vec<_>>()
        .join("; ")
}

/// All faults that are wanted, or those whose numbers `RALF_FAULTS` names.
fn run(title: &str, base: &Arc<Recording>, wanted: impl Fn(&Fault) -> bool) {
    let mut failed = Vec::new();
    let (mut noticed, mut remedies) = ([0; 2], [0; 2]);
    println!("{title}\n{:>3}  {:<40} {:<8} {:<7} says", "", "fault", "noticed", "remedy");
    let asked = |i: usize| is_asked_for("RALF_FAULTS", &(i + 1).to_string());
    for (i, fault) in faults().iter().enumerate().filter(|(i, fault)| asked(*i) && wanted(fault)) {
        let row = judge(base, fault);
        let mark = |good| if good { "yes" } else { "NO" };
        let remedy = row.right_remedy.map_or("-", mark);
        println!("{:>3}  {:<40} {:<8} {:<7} {}", i + 1, fault.name, mark(row.noticed), remedy, row.says);
        noticed = [noticed[0] + usize::from(row.noticed), noticed[1] + 1];
        if let Some(is_right) = row.right_remedy {
            remedies = [remedies[0] + usize::from(is_right), remedies[1] + 1];
        }
        if !row.noticed || row.right_remedy == Some(false) {
            failed.push(fault.name);
        }
    }
    let [[noticed, faults], [right, remedies]] = [noticed, remedies];
    println!("{title}: {noticed} of {faults} faults noticed, {right} of {remedies} remedies right");
    assert!(failed.is_empty(), "{title}: {failed:?}");
}

#[test]
fn every_fault_is_noticed_on_a_straight_road() {
    run("30 km/h, straight", &Recording::of(STRAIGHT, 120, 1), |fault| fault.straight);
}

#[test]
fn every_fault_is_noticed_in_turns() {
    run("18 km/h, turning", &Recording::of(TURNING, 160, 2), |_| true);
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

/// A driver's second echoes lie between the first ones, and most are none.
#[test]
fn returns_with_as_many_rows_of_nothing_between_them_raise_nothing() {
    let mut planted = Planted::new(&Recording::of(STRAIGHT, 120, 1));
    planted.sequence.rig.cameras.clear();
    planted.sequence.times.cameras.clear();
    planted.edit_lidar(|scan| {
        let rows = scan.points.iter().flat_map(|point| [[f32::NAN; 3], *point, [0.0; 3], [f32::NAN; 3]]);
        scan.points = rows.collect();
        scan.intensity = scan.intensity.iter().flat_map(|value| [*value; 4]).collect();
        scan.times = scan.times.as_ref().map(|times| times.iter().flat_map(|time| [*time; 4]).collect());
    });
    assert_eq!(told(&check(&planted)), "");
}

/// A recording with neither LiDAR nor range rates but for the radars that are told.
fn without_lidar(base: &Arc<Recording>, with_range_rates: &[usize]) -> Planted {
    let mut planted = Planted::new(base);
    planted.sequence.rig.lidars.clear();
    planted.sequence.times.lidars.clear();
    planted.sequence.rig.cameras.clear();
    planted.sequence.times.cameras.clear();
    for (radar, sensor) in planted.sequence.rig.radars.iter_mut().enumerate() {
        if !with_range_rates.contains(&radar) {
            sensor.fields[3] = "speed".into();
        }
    }
    planted
}

#[test]
fn radars_that_see_the_same_tell_a_wrong_one() {
    let base = Recording::of(TURNING, 160, 2);
    let planted = |with_range_rates: &[usize], degrees: f64| {
        let mut planted = without_lidar(&base, with_range_rates);
        let turned = SensorChange { turn_deg: [0.0, 0.0, degrees], ..SensorChange::default() };
        table::plant(&mut planted, &[SensorChange::default(), turned]);
        check(&planted)
    };
    assert_eq!(told(&planted(&[], 0.0)), "");
    // Nothing else knows any of the radars: all that can be said is that two contradict each other.
    let unknown = planted(&[], 7.0);
    let own: Vec<_> = unknown.doubts().filter(|v| v.question == Question::Neighbours).collect();
    assert!(!own.is_empty(), "{:?}", unknown.verdicts);
    let says_both = |v: &Verdict| format!("{} {}", v.subject, v.evidence).contains("radar_left");
    assert!(
        own.iter().all(|v| says_both(v) && v.remedy.is_none() && v.evidence.contains("can't be told")),
        "{own:?}"
    );
    // Range rates know the others: it is this one.
    let known = planted(&[0, 2, 3], 7.0);
    let own: Vec<_> = known.doubts().collect();
    assert!(!own.is_empty() && own.iter().all(|v| v.subject == "radar_left"), "{}", told(&known));
    let yaw = own.iter().find_map(|v| match &v.remedy {
        Some(Remedy::Sensor(change)) => Some(change.turn_deg[2]),
        _ => None,
    });
    assert!(yaw.is_some_and(|yaw| (yaw + 7.0).abs() < 1.5), "{yaw:?}");
}

#[test]
fn lidars_that_see_the_same_tell_a_wrong_one() {
    let base = Recording::of(TURNING, 160, 2);
    let twins = |with_radars: bool, degrees: f64| {
        let mut planted = Planted::new(&base);
        let sequence = &mut planted.sequence;
        let mut second = sequence.rig.lidars[0].clone();
        sequence.rig.cameras.clear();
        sequence.times.cameras.clear();
        second.name = "lidar_second".into();
        let turn = UnitQuaternion::from_euler_angles(0.0, 0.0, degrees.to_radians());
        second.vehicle_from_lidar.rotation *= turn;
        sequence.rig.lidars.push(second);
        let times = sequence.times.lidars[0].clone();
        sequence.times.lidars.push(times);
        if !with_radars {
            sequence.rig.radars.clear();
            sequence.times.radars.clear();
        }
        check(&planted)
    };
    assert_eq!(told(&twins(true, 0.0)), "");
    let with = twins(true, 5.0);
    let doubts: Vec<_> = with.doubts().filter(|v| v.remedy.is_some()).collect();
    let is_right =
        |remedy: &Remedy| matches!(remedy, Remedy::Sensor(change) if (change.turn_deg[2] + 5.0).abs() < 1.0);
    let right = |v: &&&Verdict| v.subject == "lidar_second" && v.remedy.as_ref().is_some_and(is_right);
    assert!(doubts.iter().any(|v| right(&v)), "{}", told(&with));
    let without = twins(false, 5.0);
    let doubts: Vec<_> = without.doubts().filter(|v| v.question == Question::Neighbours).collect();
    assert!(doubts.len() == 1 && doubts[0].evidence.contains("can't be told"), "{:?}", without.verdicts);
}

#[test]
fn corrections_come_near_known_errors() {
    let base = Recording::of(TURNING, 160, 4);
    let known = [
        SensorChange { turn_deg: [0.0, 0.0, 3.5], clock_ms: -120.0, ..SensorChange::default() },
        SensorChange { turn_deg: [0.0, 0.0, -4.5], shift_m: [0.2, -0.25, 0.0], ..SensorChange::default() },
        SensorChange { shift_m: [-0.3, 0.0, 0.0], clock_ms: 180.0, ..SensorChange::default() },
        SensorChange {
            turn_deg: [0.0, 0.0, 5.0],
            shift_m: [0.0, 0.3, 0.0],
            clock_ms: 60.0,
            ..SensorChange::default()
        },
    ];
    let mut planted = Planted::new(&base);
    planted.sequence.rig.cameras.clear();
    planted.sequence.times.cameras.clear();
    table::plant(&mut planted, &known);
    let (_, refined) = check_and_refine(&[&planted]);
    for (radar, change) in known.iter().enumerate() {
        let name = &planted.sequence.rig.radars[radar].name;
        let found = refined.iter().find(|refinement| refinement.name == *name).unwrap();
        let off = [
            found.change.turn_deg[2] + change.turn_deg[2],
            found.change.shift_m[0] + change.shift_m[0],
            found.change.shift_m[1] + change.shift_m[1],
            found.change.clock_ms + change.clock_ms,
        ];
        println!(
            "{name}: off by {:+.2} deg, {:+.3} m, {:+.3} m, {:+.0} ms, +- {:?}",
            off[0], off[1], off[2], off[3], found.deviations
        );
        let within = off.iter().zip([0.6, 0.15, 0.15, 45.0]).all(|(off, limit)| off.abs() < limit);
        assert!(within, "{name}: {off:?}");
    }
}

#[test]
fn range_rates_tell_the_vehicles_motion() {
    let base = Recording::of(TURNING, 160, 5);
    let planted = Planted::new(&base);
    let sequence = planted.sequence();
    let found = doppler::from_doppler(&planted).unwrap();
    let times = &sequence.times.radars[0];
    let (first, last) = (times[0], times[times.len() - 1]);
    let (told, seen) = (sequence.motion.between(first, last), found.between(first, last));
    let way = told.translation.vector.norm();
    let off = (told.translation.vector - seen.translation.vector).norm();
    assert!(way > 20.0 && off < 0.03 * way, "{off} of {way}");
    assert!(told.rotation.angle_to(&seen.rotation).to_degrees() < 3.0);
}

#[test]
fn what_cannot_be_judged_says_what_is_missing() {
    let mut planted = Planted::new(&Recording::of(STRAIGHT, 40, 6));
    planted.sequence.rig.lidars.clear();
    planted.sequence.times.lidars.clear();
    planted.sequence.rig.radars.iter_mut().for_each(|radar| radar.fields[3] = "speed".into());
    let found = check(&planted);
    let missing = |subject: &str, question: Question, what: &str| {
        let own = found.verdicts.iter().find(|v| v.subject == subject && v.question == question).unwrap();
        assert!(own.state == State::CannotJudge && own.evidence.contains(what), "{own:?}");
    };
    missing("motion", Question::Motion, "`doppler`");
    missing("radar_front", Question::Doppler, "`doppler`");
    missing("radar_front", Question::Lidar, "150 are needed");
    assert_eq!(told(&found), "");
}
