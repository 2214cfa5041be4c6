//! What no vehicle does.

use super::attitude;
use crate::remedy::Remedy;
use crate::statistics::{median, quantile};
use crate::verdict::{Question, Verdict};
use ralf::sensors::Sequence;
use ralf::space::{EgoMotion, OdometrySample, PoseSample};

/// Faster than any road vehicle in traffic, m/s.
const FASTEST: f64 = 70.0;
/// What speeds beyond it may be, in m/s: those of cm and of mm.
const SMALL_UNITS: [f64; 2] = [0.01, 0.001];
/// Turns faster than any, rad/s, and what tyres hold, m/s^2.
const YAW_RATE: f64 = 1.5;
const SIDEWAYS: f64 = 9.0;
/// Beyond this it is degrees, rad/s.
const DEGREES: f64 = 6.0;
/// Poses jump when a step is this much longer than the steps around it, and longer than so many metres.
const JUMP: (f64, f64) = (4.0, 1.0);
/// Between samples, ns: the vehicle does what it likes in a longer time.
const GAP_NS: i64 = 1_000_000_000;
/// In a shorter time a pose's own noise is a speed, ns.
const SHORTEST_NS: i64 = 10_000_000;
/// Scans may lie outside the motion's span by this, ns.
const OUTSIDE_NS: i64 = 250_000_000;
/// From one sample of odometry to the next speeds change by so much at most, m/s, and so much more for each second
/// between them: twice what brakes do. The same of yaw rates, rad/s.
const LEAP: (f64, f64) = (3.0, 20.0);
const TURN_LEAP: (f64, f64) = (1.0, 5.0);
/// More leaps among samples than this are another unit's.
const SELDOM: f64 = 0.1;
/// Samples of a moving vehicle that may repeat the last, share.
const SAME: f64 = 0.9;
/// No foot and no wheel is steady to the last bit for so long, s.
const LONGEST_STEADY: f64 = 5.0;

pub(super) fn judge(sequence: &Sequence) -> Vec<Verdict> {
    let motion = &sequence.motion;
    let poses = Poses::of(motion.poses());
    let scans: Vec<i64> = sequence.times.radars.iter().flatten().copied().collect();
    let mut verdicts = Vec::new();
    for told in [poses.told(), Told::by_odometry(motion)] {
        verdicts.extend(coverage(&told, &scans));
        verdicts.extend(rates(&told));
    }
    verdicts.extend(leaps(motion, &scans));
    verdicts.extend(stuck(motion));
    verdicts.extend(poses.jumps());
    verdicts.extend(attitude::judge(motion.poses()));
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

/// What one kind of measurement tells of the motion.
struct Told {
    /// For people.
    name: &'static str,
    times: Vec<i64>,
    /// Speeds and yaw rates, m/s and rad/s.
    twists: Vec<[f64; 2]>,
    /// Whether settings may change it: of odometry beside poses they would change the poses as well.
    is_alone: bool,
}

impl Told {
    fn by_odometry(motion: &EgoMotion) -> Self {
        let samples = motion.odometry();
        let is_alone = motion.poses().is_empty();
        // Of a parked vehicle one sample says all.
        let is_parked = matches!(samples, [only] if only.velocity == 0.0 && only.yaw_rate == 0.0);
        let times = samples.iter().filter(|_| !is_parked).map(|sample| sample.t_ns);
        Self {
            name: if is_alone { "it" } else { "odometry" },
            times: times.collect(),
            twists: samples.iter().map(|sample| [sample.velocity, sample.yaw_rate]).collect(),
            is_alone,
        }
    }
}

fn coverage(told: &Told, scans: &[i64]) -> Option<Verdict> {
    let Told { name, times, .. } = told;
    let (first, last) = (times.first()?, times.last()?);
    let outside = |t: &&i64| **t < first.saturating_sub(OUTSIDE_NS) || **t > last.saturating_add(OUTSIDE_NS);
    let lost = scans.iter().filter(outside).count();
    if lost > 0 {
        let evidence = format!(
            "{lost} of {} radar scans lie more than {} ms before or after all samples of {name}",
            scans.len(),
            OUTSIDE_NS / 1_000_000
        );
        return Some(doubt(
            evidence,
            Some(Remedy::LookInto("may have another clock than the sensors, or a part of it is missing")),
        ));
    }
    let within =
        |pair: &&[i64]| pair[1] - pair[0] > GAP_NS && scans.iter().any(|t| pair[0] < *t && *t < pair[1]);
    let gap = times.windows(2).filter(within).max_by_key(|pair| pair[1] - pair[0])?;
    let seconds = (gap[1] - gap[0]) as f64 * 1e-9;
    Some(doubt(format!("nothing is known of {name} for {seconds:.1} s in which radars measured"), None))
}

fn rates(told: &Told) -> Vec<Verdict> {
    let Told { name, twists, is_alone, .. } = told;
    let most = |figure: fn(&[f64; 2]) -> f64| {
        quantile(&twists.iter().map(figure).collect::<Vec<_>>(), 0.95).unwrap_or(0.0)
    };
    let (speed, turn) = (most(|t| t[0].abs()), most(|t| t[1].abs()));
    let sideways = most(|t| (t[0] * t[1]).abs());
    let mut found = Vec::new();
    if speed > FASTEST {
        let unit = SMALL_UNITS.into_iter().find(|unit| speed * unit <= FASTEST);
        let remedy = unit.filter(|_| *is_alone).map(Remedy::Speed);
        found.push(doubt(format!("{name} drives at {speed:.0} m/s"), remedy));
    }
    if turn > YAW_RATE {
        let remedy = (*is_alone && turn > DEGREES).then(|| Remedy::YawRate(1.0_f64.to_radians()));
        found.push(doubt(format!("{name} turns at {turn:.1} rad/s"), remedy));
    } else if sideways > SIDEWAYS && speed <= FASTEST {
        found.push(doubt(format!("{name} turns as if it took {sideways:.0} m/s^2 sideways"), None));
    }
    found
}

/// Odometry that leaps, as to the largest number that a bus can tell for what it doesn't know: the world is somewhere
/// else from then on. Where it leaps all the time, its unit is another one.
fn leaps(motion: &EgoMotion, scans: &[i64]) -> Option<Verdict> {
    let (first, last) = (scans.iter().min()?, scans.iter().max()?);
    let span = first.saturating_sub(GAP_NS)..=last.saturating_add(GAP_NS);
    let leaps = |pair: &&[OdometrySample]| {
        let seconds = (pair[1].t_ns - pair[0].t_ns) as f64 * 1e-9;
        let beyond = |of: fn(&OdometrySample) -> f64, (always, each_second): (f64, f64)| {
            (of(&pair[1]) - of(&pair[0])).abs() > always + each_second * seconds
        };
        span.contains(&pair[1].t_ns)
            && (beyond(|sample| sample.velocity, LEAP) || beyond(|sample| sample.yaw_rate, TURN_LEAP))
    };
    let samples = motion.odometry();
    let found: Vec<&[OdometrySample]> = samples.windows(2).filter(leaps).collect();
    let [before, after] = *found.first()? else { return None };
    if found.len() as f64 > SELDOM * samples.len() as f64 {
        return None;
    }
    let told = |sample: &OdometrySample| [sample.velocity, sample.yaw_rate].map(number);
    let ([v, turn], [then, turn_then]) = (told(before), told(after));
    let evidence = format!(
        "odometry leaps {} times as no vehicle does: from {v} m/s and {turn} rad/s to {then} and {turn_then} at {} ns",
        found.len(),
        after.t_ns
    );
    Some(doubt(evidence, Some(Remedy::LookInto("has samples that are none, to be left out"))))
}

/// With four digits; what is too large for any use as a power of ten.
fn number(value: f64) -> String {
    if value.abs() < 1e6 { format!("{value:.4}") } else { format!("{value:.3e}") }
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
    Some(doubt(evidence, Some(Remedy::LookInto("looks as if its recorder was stuck"))))
}

/// From one pose to the next.
struct Step {
    length: f64,
    /// Speed and yaw rate.
    twist: [f64; 2],
    jumped: bool,
}

struct Poses<'a> {
    poses: &'a [PoseSample],
    steps: Vec<Step>,
}

impl<'a> Poses<'a> {
    fn of(poses: &'a [PoseSample]) -> Self {
        let mut steps = steps(poses);
        let speeds: Vec<f64> = steps.iter().map(|step| step.twist[0]).collect();
        for (i, step) in steps.iter_mut().enumerate() {
            let around = &speeds[i.saturating_sub(3)..(i + 4).min(speeds.len())];
            let is_faster = median(around).is_some_and(|usual| step.twist[0] > JUMP.0 * usual.max(1.0));
            step.jumped = step.length > JUMP.1 && is_faster;
        }
        Self { poses, steps }
    }

    /// Speeds are those of steps that are none of the jumps: a jump is no speed, in whatever unit.
    fn told(&self) -> Told {
        Told {
            name: "it",
            times: self.poses.iter().map(|pose| pose.t_ns).collect(),
            twists: self.steps.iter().filter(|step| !step.jumped).map(|step| step.twist).collect(),
            is_alone: true,
        }
    }

    fn jumps(&self) -> Option<Verdict> {
        let found: Vec<f64> = self.steps.iter().filter(|step| step.jumped).map(|step| step.length).collect();
        let largest = found.iter().copied().reduce(f64::max)?;
        let evidence = format!("poses jump {} times, by up to {largest:.1} m", found.len());
        Some(doubt(evidence, Some(Remedy::LookInto("jumps: split the sequence there"))))
    }
}

/// The steps from one pose to the next that is clearly later: of 100 poses a second every other.
fn steps(poses: &[PoseSample]) -> Vec<Step> {
    let mut from = poses.first();
    let mut steps = Vec::new();
    for to in poses {
        let Some(before) = from.filter(|before| to.t_ns - before.t_ns > SHORTEST_NS) else { continue };
        let seconds = (to.t_ns - before.t_ns) as f64 * 1e-9;
        let step = before.odom_from_vehicle.inv_mul(&to.odom_from_vehicle);
        let length = step.translation.vector.norm();
        let twist = [length / seconds, step.rotation.scaled_axis().z / seconds];
        steps.push(Step { length, twist, jumped: false });
        from = Some(to);
    }
    steps
}
