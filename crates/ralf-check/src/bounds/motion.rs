//! What no vehicle does.

use crate::remedy::Remedy;
use crate::statistics::{median, quantile};
use crate::verdict::{Question, Verdict};
use ralf::sensors::Sequence;
use ralf::space::{EgoMotion, OdometrySample, PoseSample};

/// Faster than any road vehicle in traffic, m/s.
const FASTEST: f64 = 70.0;
/// Turns faster than any, rad/s, and what tyres hold, m/s^2.
const YAW_RATE: f64 = 1.5;
const SIDEWAYS: f64 = 9.0;
/// Beyond this it is degrees, rad/s.
const DEGREES: f64 = 6.0;
/// Poses jump when a step is this much longer than the steps around it, and longer than so many metres.
const JUMP: (f64, f64) = (4.0, 1.0);
/// Between samples, ns: the vehicle does what it likes in a longer time.
const GAP_NS: i64 = 1_000_000_000;
/// Scans may lie outside the motion's span by this, ns.
const OUTSIDE_NS: i64 = 250_000_000;
/// Samples of a moving vehicle that may repeat the last, share.
const SAME: f64 = 0.9;
/// No foot and no wheel is steady to the last bit for so long, s.
const LONGEST_STEADY: f64 = 5.0;

pub(super) fn judge(sequence: &Sequence) -> Vec<Verdict> {
    let motion = &sequence.motion;
    let mut verdicts: Vec<Verdict> = coverage(sequence).into_iter().collect();
    verdicts.extend(rates(motion));
    verdicts.extend(stuck(motion));
    verdicts.extend(jumps(motion.poses()));
    if verdicts.is_empty() {
        verdicts.push(Verdict::good(
            "motion",
            Question::Bounds,
            "speeds, turns and times are such as a vehicle has".into(),
        ));
    }
    verdicts
}

fn doubt(evidence: String, remedy: Option<Remedy>) -> Verdict {
    Verdict::doubt("motion", Question::Bounds, evidence, remedy)
}

/// Times of what labels rest on.
fn times(motion: &EgoMotion) -> Vec<i64> {
    if motion.poses().is_empty() {
        return motion.odometry().iter().map(|sample| sample.t_ns).collect();
    }
    motion.poses().iter().map(|pose| pose.t_ns).collect()
}

/// Whether the motion is that of a parked vehicle, of which one sample says all.
fn is_parked(motion: &EgoMotion) -> bool {
    let stands = |sample: &OdometrySample| sample.velocity == 0.0 && sample.yaw_rate == 0.0;
    motion.poses().is_empty() && matches!(motion.odometry(), [only] if stands(only))
}

fn coverage(sequence: &Sequence) -> Option<Verdict> {
    if is_parked(&sequence.motion) {
        return None;
    }
    let own = times(&sequence.motion);
    let (first, last) = (own.first()?, own.last()?);
    let scans: Vec<i64> = sequence.times.radars.iter().flatten().copied().collect();
    let outside = |t: &&i64| **t < first - OUTSIDE_NS || **t > last + OUTSIDE_NS;
    let lost = scans.iter().filter(outside).count();
    if lost > 0 {
        let evidence = format!(
            "{lost} of {} radar scans lie more than {} ms before or after all samples of it",
            scans.len(),
            OUTSIDE_NS / 1_000_000
        );
        return Some(doubt(
            evidence,
            Some(Remedy::LookInto("is its clock the sensors', and is all of it there?")),
        ));
    }
    let within =
        |pair: &&[i64]| pair[1] - pair[0] > GAP_NS && scans.iter().any(|t| pair[0] < *t && *t < pair[1]);
    let gap = own.windows(2).filter(within).max_by_key(|pair| pair[1] - pair[0])?;
    let seconds = (gap[1] - gap[0]) as f64 * 1e-9;
    Some(doubt(format!("nothing is known of it for {seconds:.1} s in which radars measured"), None))
}

fn rates(motion: &EgoMotion) -> Vec<Verdict> {
    let steps = motion.poses().windows(2).filter_map(twist);
    let twists: Vec<[f64; 2]> = if motion.poses().is_empty() {
        motion.odometry().iter().map(|sample| [sample.velocity, sample.yaw_rate]).collect()
    } else {
        steps.collect()
    };
    let most = |figure: fn(&[f64; 2]) -> f64| {
        quantile(&twists.iter().map(figure).collect::<Vec<_>>(), 0.95).unwrap_or(0.0)
    };
    let (speed, turn) = (most(|t| t[0].abs()), most(|t| t[1].abs()));
    let sideways = most(|t| (t[0] * t[1]).abs());
    let mut found = Vec::new();
    if speed > FASTEST {
        found.push(doubt(format!("it drives at {speed:.0} m/s"), Some(Remedy::Speed(0.01))));
    }
    if turn > YAW_RATE {
        let remedy = (turn > DEGREES).then(|| Remedy::YawRate(1.0_f64.to_radians()));
        found.push(doubt(format!("it turns at {turn:.1} rad/s"), remedy));
    } else if sideways > SIDEWAYS && speed <= FASTEST {
        found.push(doubt(format!("its turns ask for {sideways:.0} m/s^2 sideways"), None));
    }
    found
}

/// Speed and yaw rate between two poses.
fn twist(pair: &[PoseSample]) -> Option<[f64; 2]> {
    let dt = (pair[1].t_ns - pair[0].t_ns) as f64 * 1e-9;
    let step = pair[0].odom_from_vehicle.inv_mul(&pair[1].odom_from_vehicle);
    (dt > 0.01).then(|| [step.translation.vector.norm() / dt, step.rotation.scaled_axis().z / dt])
}

fn stuck(motion: &EgoMotion) -> Option<Verdict> {
    let samples = motion.odometry();
    let moving = |pair: &&[OdometrySample]| pair[1].velocity.abs() > 0.5;
    let pairs: Vec<_> = samples.windows(2).filter(moving).collect();
    let seconds = pairs.iter().map(|pair| (pair[1].t_ns - pair[0].t_ns) as f64 * 1e-9).sum::<f64>();
    let same = |pair: &&&[OdometrySample]| {
        (pair[0].velocity, pair[0].yaw_rate) == (pair[1].velocity, pair[1].yaw_rate)
    };
    let repeated = pairs.iter().filter(same).count() as f64 / pairs.len().max(1) as f64;
    if seconds < LONGEST_STEADY || repeated < SAME {
        return None;
    }
    let evidence = format!("{:.0} % of its samples repeat the one before to the last bit", repeated * 100.0);
    Some(doubt(evidence, Some(Remedy::LookInto("is its recorder stuck?"))))
}

fn jumps(poses: &[PoseSample]) -> Option<Verdict> {
    let speeds: Vec<f64> = poses.windows(2).filter_map(|pair| twist(pair).map(|t| t[0])).collect();
    let lengths: Vec<f64> = poses
        .windows(2)
        .filter(|pair| twist(pair).is_some())
        .map(|pair| {
            (pair[1].odom_from_vehicle.translation.vector - pair[0].odom_from_vehicle.translation.vector)
                .norm()
        })
        .collect();
    let jumped = |i: &usize| {
        let around: Vec<f64> = speeds[i.saturating_sub(3)..(*i + 4).min(speeds.len())].to_vec();
        lengths[*i] > JUMP.1 && median(&around).is_some_and(|usual| speeds[*i] > JUMP.0 * usual.max(1.0))
    };
    let found: Vec<usize> = (0..speeds.len()).filter(jumped).collect();
    let largest = found.iter().map(|i| lengths[*i]).reduce(f64::max)?;
    let evidence = format!("poses jump {} times, by up to {largest:.1} m", found.len());
    Some(doubt(evidence, Some(Remedy::LookInto("split the sequence where they do"))))
}
