//! Odometry beside poses: labels take speeds from it, so its faults are noticed though the poses are right.

use crate::recording::{Planted, Recording};
use crate::{STRAIGHT, TURNING, told};
use ralf::space::{OdometrySample, PoseSample};
use ralf_check::{Remedy, SequenceCheck, Verdict, check};
use ralf_sim::world::{FAMILIES, Recording as World};
use std::sync::Arc;

const S: i64 = 1_000_000_000;

/// A fault of odometry, and whether a remedy of it is the right one where one exists.
type Fault = (&'static str, fn(&mut OdometrySample), Option<fn(&Remedy) -> bool>);

const FAULTS: [Fault; 11] = [
    (
        "speed in km/h",
        |s| s.velocity *= 3.6,
        Some(|r| matches!(r, Remedy::Speed(factor) if (factor * 3.6 - 1.0).abs() < 1e-9)),
    ),
    ("speed times ten", |s| s.velocity *= 10.0, None),
    (
        "speed in cm/s",
        |s| s.velocity *= 100.0,
        Some(|r| matches!(r, Remedy::Speed(factor) if *factor == 0.01)),
    ),
    (
        "speed sign",
        |s| s.velocity = -s.velocity,
        Some(|r| matches!(r, Remedy::Speed(factor) if *factor == -1.0)),
    ),
    ("speed 0", |s| s.velocity = 0.0, None),
    (
        "clock off by 0.4 s",
        |s| s.t_ns += 2 * S / 5,
        Some(|r| matches!(r, Remedy::MotionClock(ms) if (ms + 400.0).abs() < 60.0)),
    ),
    ("clock off by 10 s", |s| s.t_ns += 10 * S, None),
    ("clock off by 10^4 s", |s| s.t_ns -= 10_000 * S, None),
    (
        "yaw rate in deg/s",
        |s| s.yaw_rate = s.yaw_rate.to_degrees(),
        Some(|r| matches!(r, Remedy::YawRate(factor) if (factor.to_degrees() - 1.0).abs() < 1e-9)),
    ),
    (
        "yaw rate sign",
        |s| s.yaw_rate = -s.yaw_rate,
        Some(|r| matches!(r, Remedy::YawRate(factor) if *factor == -1.0)),
    ),
    ("yaw rate 0", |s| s.yaw_rate = 0.0, None),
];

/// A drive whose poses are the truth.
fn with_poses(base: &Arc<Recording>) -> Planted {
    let mut planted = Planted::new(base);
    planted.sequence.rig.cameras.clear();
    planted.sequence.times.cameras.clear();
    planted.add_poses();
    planted
}

fn of_motion(found: &SequenceCheck) -> Vec<&Verdict> {
    found.doubts().filter(|verdict| verdict.subject == "motion").collect()
}

/// Whether it is noticed, with the right remedy, and nothing else is doubted.
fn is_noticed(title: &str, planted: &Planted, is_right: Option<fn(&Remedy) -> bool>) {
    let found = check(planted);
    let own = of_motion(&found);
    own.iter().for_each(|verdict| println!("{title:<20} {}", verdict.evidence));
    println!("{:<20} {}", "", told(&found));
    assert!(!own.is_empty() && own.len() == found.doubts().count(), "{title}: {}", told(&found));
    let of_odometry = own.iter().filter_map(|verdict| match &verdict.remedy {
        Some(Remedy::Odometry(remedy)) => Some(remedy.as_ref()),
        _ => None,
    });
    let remedies: Vec<&Remedy> = of_odometry.collect();
    let expected = usize::from(is_right.is_some());
    let all_right = remedies.iter().all(|remedy| is_right.is_some_and(|is_right| is_right(remedy)));
    assert!(remedies.len() == expected && all_right, "{title}: {remedies:?}");
}

#[test]
fn every_fault_of_odometry_beside_poses_is_noticed() {
    let base = Recording::of(TURNING, 160, 2);
    for (title, edit, is_right) in FAULTS {
        let mut planted = with_poses(&base);
        planted.edit_odometry(edit);
        is_noticed(title, &planted, is_right);
    }
    let mut planted = with_poses(&base);
    planted.replace_odometry(|samples| samples.truncate(samples.len() / 10));
    is_noticed("ends early", &planted, None);
    let mut planted = with_poses(&base);
    planted.replace_odometry(|samples| {
        let lost = samples.len() / 2..samples.len() * 3 / 4;
        samples[lost].iter_mut().for_each(|sample| sample.velocity = 0.0);
    });
    is_noticed("0 for a quarter", &planted, None);
}

/// The first five seconds of a drive whose odometry goes on, as that of a bus does that is recorded for itself.
fn within_longer_odometry(offset_ns: i64) -> Planted {
    let mut planted = with_poses(&Recording::of(TURNING, 400, 2));
    let times = &mut planted.sequence.times;
    let end = times.radars[0][100];
    times.radars.iter_mut().chain(&mut times.lidars).for_each(|times| times.retain(|t| *t < end));
    planted.replace_poses(|poses| poses.retain(|pose| pose.t_ns < end + S));
    planted.edit_odometry(|sample| sample.t_ns += offset_ns);
    planted
}

#[test]
fn a_clock_that_is_off_within_longer_odometry_is_noticed() {
    assert_eq!(told(&check(&within_longer_odometry(0))), "");
    is_noticed("10 s early", &within_longer_odometry(-10 * S), None);
}

#[test]
fn odometry_that_goes_with_its_poses_raises_nothing() {
    for (drive, seed) in [(STRAIGHT, 1), (TURNING, 2)] {
        assert_eq!(told(&check(&with_poses(&Recording::of(drive, 120, seed)))), "", "{drive}, seed {seed}");
    }
}

#[test]
fn odometry_is_right_where_the_poses_are_not() {
    let mut planted = with_poses(&Recording::of(TURNING, 160, 2));
    planted.replace_poses(|poses| {
        poses.iter_mut().for_each(|pose| pose.odom_from_vehicle.translation.vector *= 3.6);
    });
    let found = check(&planted);
    let own = of_motion(&found);
    // Settings would scale the odometry, too.
    let of_poses = |verdict: &&&Verdict| {
        let remedy = verdict.remedy.as_ref();
        remedy
            .is_some_and(|remedy| matches!(remedy, Remedy::Poses(_)) && remedy.settings("motion").is_empty())
    };
    assert!(own.iter().filter(of_poses).count() == 1, "{own:?}");
    assert!(!told(&found).contains("odometry"), "{}", told(&found));
}

/// A clock that both have, and poses that turn the other way round, with odometry beside them or without.
#[test]
fn settings_are_proposed_where_they_put_right_what_is_wrong() {
    let base = Recording::of(TURNING, 160, 2);
    let late = |pose: &mut PoseSample| pose.t_ns += S / 2;
    let mut both = with_poses(&base);
    both.edit_odometry(|sample| sample.t_ns += S / 2);
    both.replace_poses(|poses| poses.iter_mut().for_each(late));
    let remedies = |planted: &Planted| {
        let found = check(planted);
        let of_motion = found.doubts().filter(|verdict| verdict.subject == "motion");
        of_motion.filter_map(|verdict| verdict.remedy.clone()).collect::<Vec<_>>()
    };
    let is_clock = |remedy: &Remedy| matches!(remedy, Remedy::MotionClock(ms) if (ms + 500.0).abs() < 100.0);
    assert!(remedies(&both).iter().any(is_clock), "{:?}", remedies(&both));
    // Another quantity of the odometry, and a bus that is late by little, say nothing against it.
    let mut other = with_poses(&base);
    other.edit_odometry(|sample| {
        (sample.velocity, sample.t_ns) = (sample.velocity * 3.6, sample.t_ns + S / 5)
    });
    other.replace_poses(|poses| {
        poses.iter_mut().for_each(|pose| pose.odom_from_vehicle.translation.vector *= 3.6);
    });
    let is_unit =
        |remedy: &Remedy| matches!(remedy, Remedy::Speed(factor) if (factor * 3.6 - 1.0).abs() < 1e-9);
    assert!(remedies(&other).iter().any(is_unit), "{:?}", remedies(&other));
    let mut poses_alone = with_poses(&base);
    poses_alone.replace_poses(|poses| poses.iter_mut().for_each(late));
    let found = remedies(&poses_alone);
    assert!(!found.is_empty() && found.iter().all(|one| one.settings("motion").is_empty()), "{found:?}");
}

#[test]
fn a_jump_of_poses_is_no_speed() {
    let mut planted = with_poses(&Recording::of(STRAIGHT, 60, 1));
    planted.replace_poses(|poses| {
        // Of so few steps the one is among the fastest twentieth.
        *poses = poses.iter().step_by(8).copied().collect();
        let half = poses.len() / 2;
        poses[half..].iter_mut().for_each(|pose| pose.odom_from_vehicle.translation.x += 250.0);
    });
    let found = check(&planted);
    let own = of_motion(&found);
    assert!(own.len() == 1 && own[0].evidence.contains("jump 1 times"), "{own:?}");
}

#[test]
fn worlds_with_odometry_and_poses_raise_nothing_of_either() {
    let mut compared = 0;
    for family in &FAMILIES {
        let world = World::new(family, 3).sequence(0, 40).unwrap().without_cameras();
        let found = check(&world);
        assert!(of_motion(&found).is_empty(), "{}: {}", family.name, told(&found));
        let compares = |verdict: &Verdict| verdict.evidence.contains("of the speed of the poses");
        compared += usize::from(found.verdicts.iter().any(compares));
    }
    assert!(compared > 1, "{compared}");
}
