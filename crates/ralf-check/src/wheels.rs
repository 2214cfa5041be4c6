//! Odometry beside poses: both tell the vehicle's speed and yaw rate, and have to tell the same.

use crate::doppler::{CREEPING, ClockFigures, MOVING, STANDING, Timed, Turning, VelocityFit, clock, compare};
use nalgebra::{Matrix2, Vector2};
use ralf::space::{EgoMotion, Transform};

/// Motion is averaged over this, ns: poses that are known within 5 cm then tell a speed within 0.1 m/s.
const STRETCH_NS: i64 = 600_000_000;
/// And over this where times are compared, which changes of speed tell.
const SHORT_NS: i64 = 200_000_000;
/// Stretches that are compared at most, evenly over what both know.
const STRETCHES: i64 = 240;
/// Samples of odometry over a stretch: as often as buses send them.
const SAMPLES: i64 = 30;
/// Yaw rates count as the speeds of what is so far from the axle, m, where the radars of a car are.
pub(crate) const LEVER: f64 = 3.0;
/// Turns that are seen clearly, rad/s: 0.15 m/s on the lever, the noise of a range rate.
const TURNS: f64 = 0.05;

/// What odometry and poses tell of the same stretches of time.
pub(crate) struct Beside {
    stretches: Vec<Stretch>,
    /// The poses' velocities on the lever, as if a radar had measured them.
    seen: Vec<Timed>,
}

/// Speed (m/s, forward) and yaw rate (rad/s) over a stretch, by odometry and by poses.
struct Stretch {
    told: [f64; 2],
    seen: [f64; 2],
}

impl Beside {
    /// Compares what both know; nothing of what only one does.
    pub(crate) fn of(odometry: &EgoMotion, poses: &EgoMotion) -> Self {
        let span = common(odometry, poses);
        let middles = |length: i64| span.into_iter().flat_map(move |span| middles(span, length));
        let stretch =
            |t_ns: i64| Stretch { told: sampled(odometry, t_ns), seen: stepped(poses, t_ns, STRETCH_NS) };
        let seen = |t_ns: i64| on_lever(t_ns, stepped(poses, t_ns, SHORT_NS));
        Self {
            stretches: middles(STRETCH_NS).map(stretch).collect(),
            seen: middles(SHORT_NS).map(seen).collect(),
        }
    }

    /// Of the speed by poses, the shares that odometry tells, where the vehicle moves.
    pub(crate) fn ratios(&self) -> Vec<f64> {
        let moving = self.stretches.iter().filter(|stretch| stretch.seen[0].abs() >= MOVING);
        moving.map(|stretch| stretch.told[0] / stretch.seen[0]).collect()
    }

    /// Stretches in which one of both moves while the other stands.
    pub(crate) fn contradicting(&self) -> usize {
        let apart = |a: f64, b: f64| a.abs() < STANDING && b.abs() > CREEPING;
        let contradicts = |Stretch { told: [told, _], seen: [seen, _], .. }: &&Stretch| {
            apart(*told, *seen) || apart(*seen, *told)
        };
        self.stretches.iter().filter(contradicts).count()
    }

    /// Yaw rates everywhere.
    pub(crate) fn turning(&self) -> Turning {
        turning(self.stretches.iter())
    }

    /// Yaw rates where one of both turns clearly.
    pub(crate) fn turns(&self) -> Turning {
        let turns = |stretch: &&Stretch| stretch.told[1].abs().max(stretch.seen[1].abs()) > TURNS;
        turning(self.stretches.iter().filter(turns))
    }

    /// By how much the poses seem late or early against the odometry.
    pub(crate) fn clock(&self, odometry: &EgoMotion) -> Option<ClockFigures> {
        let mount = Transform::translation(LEVER, 0.0, 0.0);
        let figures = compare(&self.seen, odometry, &mount)?;
        clock(&self.seen, odometry, &mount, &figures)
    }
}

fn on_lever(t_ns: i64, [speed, yaw_rate]: [f64; 2]) -> Timed {
    let velocity = Vector2::new(speed, yaw_rate * LEVER);
    let covariance = Matrix2::zeros();
    Timed { t_ns, fit: VelocityFit { velocity, inliers: 1.0, count: 1, covariance, vertical: (0.0, 0.0) } }
}

fn turning<'a>(stretches: impl Iterator<Item = &'a Stretch>) -> Turning {
    Turning { pairs: stretches.map(|stretch| [stretch.told[1], stretch.seen[1]]).collect() }
}

/// The span of time that both know.
fn common(odometry: &EgoMotion, poses: &EgoMotion) -> Option<[i64; 2]> {
    let (samples, poses) = (odometry.odometry(), poses.poses());
    let first = samples.first()?.t_ns.max(poses.first()?.t_ns);
    Some([first, samples.last()?.t_ns.min(poses.last()?.t_ns)])
}

/// The middles of stretches that lie in a span, as far apart as the shorter ones are long at least.
fn middles([first, last]: [i64; 2], length: i64) -> impl Iterator<Item = i64> {
    let room = last.saturating_sub(first).saturating_sub(length);
    let step = (room / STRETCHES).max(SHORT_NS);
    let begins = (0..STRETCHES).map(move |i| i * step).take_while(move |begin| *begin <= room);
    begins.map(move |begin| first + begin + length / 2)
}

/// Speed and yaw rate about a time, by what odometry tells at moments of it.
fn sampled(odometry: &EgoMotion, t_ns: i64) -> [f64; 2] {
    let moments = (0..SAMPLES).map(|i| (2 * i + 1 - SAMPLES) * STRETCH_NS / (2 * SAMPLES));
    let twists = moments.map(|moment| odometry.twist(t_ns.saturating_add(moment)));
    let [speed, turn] =
        twists.fold([0.0; 2], |[speed, turn], (velocity, rate)| [speed + velocity.x, turn + rate.z]);
    [speed / SAMPLES as f64, turn / SAMPLES as f64]
}

/// The same over a stretch of such a length, from its first pose to its last, forward being where the middle one looks.
fn stepped(poses: &EgoMotion, t_ns: i64, length: i64) -> [f64; 2] {
    let ends = [-length / 2, length / 2].map(|to| poses.between(t_ns, t_ns.saturating_add(to)));
    let way = ends[1].translation.vector - ends[0].translation.vector;
    let turn = ends[0].inv_mul(&ends[1]).rotation.scaled_axis().z;
    let seconds = length as f64 * 1e-9;
    [way.x / seconds, turn / seconds]
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::space::{OdometrySample, PoseSample, Vector};

    const MS: i64 = 1_000_000;

    /// So many seconds on a circle, as wheels and as poses have it; the wheels start later by some ms.
    fn circling(seconds: i64, late_ms: i64) -> [EgoMotion; 2] {
        let (velocity, yaw_rate) = (8.0, 0.4);
        let samples =
            (0..seconds * 50).map(|i| OdometrySample { t_ns: (i * 20 + late_ms) * MS, velocity, yaw_rate });
        let wheels = EgoMotion::new(samples.collect(), vec![]).unwrap();
        let truth = EgoMotion::new(vec![OdometrySample { t_ns: 0, velocity, yaw_rate }], vec![]).unwrap();
        let poses = (0..=seconds * 20).map(|i| i * 50 * MS);
        let poses = poses.map(|t_ns| PoseSample { t_ns, odom_from_vehicle: truth.odom_from_vehicle(t_ns) });
        [wheels, EgoMotion::new(vec![], poses.collect()).unwrap()]
    }

    #[test]
    fn both_tell_the_same_of_a_circle() {
        let [wheels, poses] = circling(4, 0);
        let beside = Beside::of(&wheels, &poses);
        let ratios = beside.ratios();
        assert!(ratios.len() == 17 && ratios.iter().all(|ratio| (ratio - 1.0).abs() < 3e-3), "{ratios:?}");
        assert!(beside.turns().misfit(1.0) < 1e-6 && beside.turns().misfit(0.0) > 0.39);
        assert_eq!(beside.contradicting(), 0);
    }

    #[test]
    fn what_only_one_of_both_knows_is_not_compared() {
        let [wheels, poses] = circling(4, 2000);
        assert_eq!(Beside::of(&wheels, &poses).ratios().len(), 8);
        let [wheels, poses] = circling(4, 10_000);
        assert!(Beside::of(&wheels, &poses).ratios().is_empty());
    }

    #[test]
    fn a_vehicle_that_moves_and_stands_at_once_is_counted() {
        let [_, poses] = circling(4, 0);
        let standing = |t_ns: i64| OdometrySample { t_ns, velocity: 0.0, yaw_rate: 0.0 };
        let wheels = EgoMotion::new(vec![standing(0), standing(1000 * MS)], vec![]).unwrap();
        assert_eq!(Beside::of(&wheels, &poses).contradicting(), 3);
        let still = Transform::new(Vector::zeros(), Vector::zeros());
        let poses = [0, 4000].map(|ms| PoseSample { t_ns: ms * MS, odom_from_vehicle: still });
        let poses = EgoMotion::new(vec![], poses.to_vec()).unwrap();
        assert_eq!(Beside::of(&wheels, &poses).contradicting(), 0);
    }
}
