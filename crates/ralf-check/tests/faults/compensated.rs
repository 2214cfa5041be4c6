//! Range rates that are said to be without the vehicle's motion.

use crate::recording::{Planted, Recording};
use crate::{STRAIGHT, TURNING, told};
use nalgebra::Vector3;
use ralf_check::{Question, Remedy, State, Verdict, check};

const FRONT: usize = 0;

/// A recording whose front radar is said to have such range rates, besides raw ones or not; they have so much of the
/// vehicle's motion taken out.
fn said_compensated(drive: &str, taken_out: f32, with_raw: bool) -> Planted {
    let mut planted = Planted::new(&Recording::of(drive, 120, 7));
    planted.sequence.rig.cameras.clear();
    planted.sequence.times.cameras.clear();
    let (times, motion) = (planted.sequence.times.radars[FRONT].clone(), planted.sequence.motion.clone());
    let fields = &mut planted.sequence.rig.radars[FRONT].fields;
    if with_raw {
        fields.push("doppler_compensated".into())
    } else {
        fields[3] = "doppler_compensated".into()
    }
    let mount = planted.sequence.rig.radars[FRONT].vehicle_from_radar;
    planted.edit_radars(move |radar, scan, columns| {
        if radar != FRONT {
            return;
        }
        let (velocity, turn) = motion.twist(times[scan]);
        let own = mount.rotation.inverse() * (velocity + turn.cross(&mount.translation.vector));
        let ray = |row: usize| Vector3::from([0, 1, 2].map(|axis| f64::from(columns[axis][row]))).normalize();
        let rates = columns[3].iter().enumerate();
        let without = rates.map(|(row, rate)| rate + taken_out * ray(row).dot(&own) as f32).collect();
        if with_raw { columns.push(without) } else { columns[3] = without }
    });
    planted
}

/// What is said of the field.
fn of_field(planted: &Planted) -> (Verdict, String) {
    let found = check(planted);
    let is_own = |v: &&Verdict| v.question == Question::Doppler && v.evidence.contains("doppler_compensated");
    let own: Vec<&Verdict> = found.verdicts.iter().filter(is_own).collect();
    assert!(own.len() == 1 && own[0].subject == "radar_front", "{own:?}");
    (own[0].clone(), told(&found))
}

#[test]
fn raw_range_rates_that_are_said_to_be_without_the_vehicles_motion_are_doubted() {
    for (drive, with_raw) in [(STRAIGHT, false), (TURNING, false), (STRAIGHT, true)] {
        let (verdict, says) = of_field(&said_compensated(drive, 0.0, with_raw));
        assert_eq!(verdict.state, State::Doubt, "{verdict:?}");
        let is_right =
            |remedy: &Remedy| matches!(remedy, Remedy::LookInto(what) if what.contains("`doppler`"));
        assert!(verdict.remedy.as_ref().is_some_and(is_right), "{verdict:?}");
        assert_eq!(says.matches(": ").count(), 2, "nothing else is doubted: {says}");
    }
}

#[test]
fn range_rates_without_the_vehicles_motion_raise_nothing() {
    for (drive, with_raw) in [(STRAIGHT, false), (TURNING, false), (TURNING, true)] {
        let (verdict, says) = of_field(&said_compensated(drive, 1.0, with_raw));
        assert_eq!((verdict.state, says.as_str()), (State::Good, ""), "{verdict:?}");
    }
}

#[test]
fn without_motion_nothing_is_said_of_it() {
    let mut planted = said_compensated(STRAIGHT, 0.0, true);
    planted.edit_odometry(|sample| (sample.velocity, sample.yaw_rate) = (0.0, 0.0));
    assert_eq!(of_field(&planted).0.state, State::CannotJudge);
}
