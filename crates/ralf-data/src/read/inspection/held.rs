//! Measurements outside of the times of which the vehicle's motion tells: its nearest sample is held there.

use ralf::sensors::Sequence;
use ralf::space::EgoMotion;

/// Samples hold for this long without a word, ns: two scans of most LiDARs.
pub(super) const A_LITTLE_NS: i64 = 200_000_000;

/// A sentence where sensors measured long before or after all that is known of the motion; `None` where they didn't, or
/// of a vehicle of which nothing but its standing still is known.
pub fn held_motion(sequence: &Sequence) -> Option<String> {
    let motion = &sequence.motion;
    if motion.stands_still() {
        return None;
    }
    let span = span(motion)?;
    let times = &sequence.times;
    let kinds = [("radar scans", &times.radars), ("LiDAR scans", &times.lidars), ("images", &times.cameras)];
    let (mut parts, mut farthest) = (Vec::new(), 0);
    for (name, sensors) in kinds {
        let far = sensors.iter().flatten().map(|t_ns| outside(*t_ns, span)).filter(|ns| *ns > A_LITTLE_NS);
        let all: usize = sensors.iter().map(Vec::len).sum();
        let far: Vec<i64> = far.collect();
        if !far.is_empty() {
            parts.push(format!("{} of {all} {name}", far.len()));
        }
        farthest = far.into_iter().fold(farthest, i64::max);
    }
    let (samples, held) = match motion.poses().is_empty() {
        true => ("samples of the odometry", "the nearest speed and yaw rate go on there"),
        false => ("poses", "the nearest pose is held there, as if the vehicle stood still"),
    };
    let [ms, seconds] = [A_LITTLE_NS as f64 * 1e-6, farthest as f64 * 1e-9];
    let what = listed(&parts)?;
    Some(format!(
        "{what} lie more than {ms} ms before or after all {samples}, by up to {seconds:.1} s: {held}"
    ))
}

/// The first and the last time of which the motion tells, ns.
fn span(motion: &EgoMotion) -> Option<[i64; 2]> {
    let (poses, wheels) = (motion.poses(), motion.odometry());
    match poses.is_empty() {
        true => Some([wheels.first()?.t_ns, wheels.last()?.t_ns]),
        false => Some([poses.first()?.t_ns, poses.last()?.t_ns]),
    }
}

/// How far a time lies outside of a span, ns.
fn outside(t_ns: i64, [first, last]: [i64; 2]) -> i64 {
    first.saturating_sub(t_ns).max(t_ns.saturating_sub(last)).max(0)
}

fn listed(parts: &[String]) -> Option<String> {
    let (last, others) = parts.split_last()?;
    Some(if others.is_empty() { last.clone() } else { format!("{} and {last}", others.join(", ")) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::sensors::{DepthOutput, Rig, Timelines};
    use ralf::space::{OdometrySample, PoseSample, Transform};

    const MS: i64 = 1_000_000;

    fn sequence(motion: EgoMotion, times: Timelines) -> Sequence {
        let (name, title) = ("00".to_owned(), String::new());
        Sequence { name, title, rig: Rig::default(), times, motion, depth_output: DepthOutput::default() }
    }

    fn told(motion: &EgoMotion, radars: &[i64], lidars: &[i64]) -> Option<String> {
        let [radars, lidars] = [radars, lidars].map(|times| vec![times.iter().map(|ms| ms * MS).collect()]);
        held_motion(&sequence(motion.clone(), Timelines { radars, lidars, cameras: Vec::new() }))
    }

    #[test]
    fn measurements_long_before_or_after_the_motion_are_counted() {
        let pose = |ms: i64| PoseSample { t_ns: ms * MS, odom_from_vehicle: Transform::identity() };
        let wheels = |ms: i64, velocity| OdometrySample { t_ns: ms * MS, velocity, yaw_rate: 0.0 };
        let poses = EgoMotion::new(vec![wheels(-900, 8.0)], vec![pose(0), pose(600)]).unwrap();
        assert_eq!(told(&poses, &[-200, 0, 800], &[-90]), None, "a scan or so");
        let sentence = told(&poses, &[-300, 0, 801], &[-1500, 10]).unwrap();
        let expected = "2 of 3 radar scans and 1 of 2 LiDAR scans lie more than 200 ms before or after all poses, by up \
                        to 1.5 s: the nearest pose is held there, as if the vehicle stood still";
        assert_eq!(sentence, expected);
        let driving = EgoMotion::new(vec![wheels(0, 8.0), wheels(100, 0.0)], vec![]).unwrap();
        assert!(
            told(&driving, &[1000], &[]).unwrap().ends_with("the nearest speed and yaw rate go on there")
        );
        let parked = EgoMotion::new(vec![wheels(0, 0.0)], vec![]).unwrap();
        assert_eq!(told(&parked, &[1000], &[]), None);
        assert_eq!(told(&EgoMotion::unknown(), &[1000], &[]), None);
        assert!(told(&poses, &[i64::MIN / MS, i64::MAX / MS], &[]).is_some());
    }
}
