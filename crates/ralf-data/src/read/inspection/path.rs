//! How far the vehicle drove, as far as its motion is known.

use super::held::A_LITTLE_NS;
use ralf::space::EgoMotion;

/// The path is measured in steps of this length.
const STEP_NS: i64 = 100_000_000;
/// Two samples of the motion that lie farther apart tell nothing of the time between them.
const PAUSE_NS: i64 = 2_000_000_000;
/// Nobody drives as fast, m/s: between two poses that say so lies a jump, as from one recording to another.
const FASTEST: f64 = 100.0;

/// The vehicle's path over a span of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Path {
    /// Its length without pauses and jumps, m.
    pub(super) metres: f64,
    /// How long the motion isn't known, s.
    pub(super) unknown_s: f64,
    /// Length of the span, s.
    span_s: f64,
    /// Steps that are too long to be driven.
    jumps: usize,
}

impl Path {
    /// The path between two times, ns. The time that this takes grows with the samples of the motion and not with the
    /// span, for the clocks of a recording may lie decades apart.
    pub(super) fn new(motion: &EgoMotion, [first, last]: [i64; 2]) -> Self {
        let span_s = seconds(first, last);
        let mut path = Self { metres: 0.0, unknown_s: span_s, span_s, jumps: 0 };
        if motion.stands_still() || !motion.is_known() {
            return Self { unknown_s: 0.0, ..path };
        }
        for [begin, end] in stretches(motion) {
            let (begin, end) = (begin.max(first), end.min(last));
            if begin < end {
                path.unknown_s -= seconds(begin, end);
                path.drive(motion, begin, end);
            }
        }
        // Sums of differences may end a little below.
        path.unknown_s = path.unknown_s.max(0.0);
        path
    }

    fn drive(&mut self, motion: &EgoMotion, begin: i64, end: i64) {
        let place = |t_ns| motion.odom_from_vehicle(t_ns).translation.vector;
        let (mut t_ns, mut from) = (begin, place(begin));
        while t_ns < end {
            let next = t_ns.saturating_add(STEP_NS).min(end);
            let to = place(next);
            let metres = (to - from).norm();
            if metres <= FASTEST * seconds(t_ns, next) {
                self.metres += metres;
            } else {
                self.jumps += 1;
            }
            (t_ns, from) = (next, to);
        }
    }

    /// What is not known, a sentence each.
    pub(super) fn missing(&self) -> Vec<String> {
        let mut missing = Vec::new();
        // A recorder that starts a little late is no reason to worry.
        if self.unknown_s > seconds(0, PAUSE_NS) {
            let Self { unknown_s, span_s, .. } = self;
            missing.push(format!(
                "the motion is not known for {unknown_s:.1} of {span_s:.1} s, where odometry and poses pause or are \
                 missing: the path is that of the rest"
            ));
        }
        if self.jumps > 0 {
            missing.push(format!("the motion jumps in {} places, which the path leaves out", self.jumps));
        }
        missing
    }
}

/// Spans in which the motion is known, in time order: from the first sample to the last, without the pauses. At both
/// ends the nearest sample holds on: a velocity for as long as it would before a pause, a pose for a little.
fn stretches(motion: &EgoMotion) -> Vec<[i64; 2]> {
    let poses = motion.poses().iter().map(|pose| pose.t_ns);
    let wheels = motion.odometry().iter().map(|sample| sample.t_ns);
    let (times, holds): (Vec<i64>, i64) = match motion.poses().is_empty() {
        true => (wheels.collect(), PAUSE_NS),
        false => (poses.collect(), A_LITTLE_NS),
    };
    let mut stretches: Vec<[i64; 2]> = Vec::new();
    for t_ns in times {
        match stretches.last_mut() {
            Some([_, end]) if t_ns.saturating_sub(*end) <= PAUSE_NS => *end = t_ns,
            _ => stretches.push([t_ns, t_ns]),
        }
    }
    if let Some([begin, _]) = stretches.first_mut() {
        *begin = begin.saturating_sub(holds);
    }
    if let Some([_, end]) = stretches.last_mut() {
        *end = end.saturating_add(holds);
    }
    stretches
}

fn seconds(from_ns: i64, to_ns: i64) -> f64 {
    to_ns.abs_diff(from_ns) as f64 * 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::space::{OdometrySample, PoseSample, transform_from_parts};

    const SECOND: i64 = 1_000_000_000;

    fn pose(t_ns: i64, x: f64) -> PoseSample {
        let odom_from_vehicle = transform_from_parts([x, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]).unwrap();
        PoseSample { t_ns, odom_from_vehicle }
    }

    fn wheels(t_ns: i64, velocity: f64) -> OdometrySample {
        OdometrySample { t_ns, velocity, yaw_rate: 0.0 }
    }

    #[test]
    fn two_frames_of_different_drives_are_no_path() {
        let motion = EgoMotion::new(vec![], vec![pose(0, 0.0), pose(45 * SECOND, 51.0)]).unwrap();
        let path = Path::new(&motion, [0, 45 * SECOND]);
        assert_eq!(path.metres, 0.0);
        assert!(path.missing()[0].contains("not known for 45.0 of 45.0 s"), "{:?}", path.missing());
        // Neighbouring numbers of two drives: nobody drives 510 m/s.
        let motion = EgoMotion::new(vec![], vec![pose(0, 0.0), pose(SECOND / 10, 51.0)]).unwrap();
        let path = Path::new(&motion, [0, SECOND / 10]);
        assert_eq!((path.metres, path.jumps, path.missing().len()), (0.0, 1, 1));
    }

    #[test]
    fn a_pose_tells_nothing_of_a_second_later() {
        let motion = EgoMotion::new(vec![], vec![pose(SECOND, 0.0), pose(2 * SECOND, 8.0)]).unwrap();
        let path = Path::new(&motion, [0, 2 * SECOND + SECOND / 10]);
        assert!((path.metres - 8.0).abs() < 1e-9 && (path.unknown_s - 0.8).abs() < 1e-9, "{path:?}");
        assert!(path.missing().is_empty(), "it is told by what was measured then");
    }

    #[test]
    fn the_path_is_what_the_wheels_measured() {
        let samples = (0..=100).map(|i| wheels(i * SECOND / 10, 7.0)).collect();
        let motion = EgoMotion::new(samples, vec![]).unwrap();
        let path = Path::new(&motion, [SECOND / 20, 10 * SECOND + SECOND / 20]);
        assert!((path.metres - 70.0).abs() < 1e-9, "{path:?}");
        assert_eq!((path.missing(), path.unknown_s), (vec![], 0.0));
    }

    #[test]
    fn a_span_of_decades_takes_no_longer_than_its_samples() {
        let now = 1_700_000_000 * SECOND;
        let samples = vec![wheels(0, 7.0), wheels(now, 7.0), wheels(now + SECOND, 7.0)];
        let motion = EgoMotion::new(samples, vec![]).unwrap();
        let path = Path::new(&motion, [0, now + SECOND]);
        assert!((path.metres - 7.0).abs() < 1e-6, "{path:?}");
        assert!(
            path.missing()[0].contains("not known for 1700000000.0 of 1700000001.0 s"),
            "{:?}",
            path.missing()
        );
        let path = Path::new(&motion, [i64::MIN / 2, i64::MAX / 2]);
        assert!(path.metres < 50.0, "{path:?}");
    }
}
