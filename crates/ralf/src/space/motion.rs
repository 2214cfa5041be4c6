//! How the vehicle moved (paper, equation 7; docs/method.md, section 2): where the vehicle was in the odom frame at any
//! time.

use crate::space::{Transform, check_rigid};
use nalgebra::{Translation3, UnitQuaternion, Vector3};

/// A sample of wheel odometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OdometrySample {
    /// Time, ns.
    pub t_ns: i64,
    /// Longitudinal velocity `v`, m/s.
    pub velocity: f64,
    /// rad/s, positive to the left.
    pub yaw_rate: f64,
}

/// A 6-DoF pose of the vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseSample {
    /// Time, ns.
    pub t_ns: i64,
    /// Pose in the odom frame.
    pub odom_from_vehicle: Transform,
}

/// The vehicle's motion over a sequence. Where 6-DoF poses exist they are used, else wheel odometry is integrated.
#[derive(Debug, Clone)]
pub struct EgoMotion {
    odometry: Vec<OdometrySample>,
    /// The planar pose (x, y, psi) at each odometry sample.
    planar: Vec<[f64; 3]>,
    poses: Vec<PoseSample>,
}

impl EgoMotion {
    /// From wheel odometry, 6-DoF poses, or both; each in time order. `None` where both are empty.
    pub fn new(odometry: Vec<OdometrySample>, poses: Vec<PoseSample>) -> Option<Self> {
        if odometry.is_empty() && poses.is_empty() {
            return None;
        }
        let mut planar = Vec::with_capacity(odometry.len());
        let mut pose = [0.0; 3];
        for (i, sample) in odometry.iter().enumerate() {
            if let Some(previous) = i.checked_sub(1).map(|i| &odometry[i]) {
                pose = advance(pose, previous, sample.t_ns);
            }
            planar.push(pose);
        }
        Some(Self { odometry, planar, poses })
    }

    /// Refuses, with the place and what was expected and found there, samples that no file may hold either: numbers
    /// that aren't finite, poses that aren't rigid, times that go back or are out of all reach.
    pub fn check(&self) -> Result<(), (String, String)> {
        let odometry = self.odometry.iter().map(|OdometrySample { t_ns, velocity, yaw_rate }| {
            let odd = [velocity, yaw_rate].into_iter().find(|value| !value.is_finite());
            (*t_ns, odd.map_or(Ok(()), |found| Err(format!("finite numbers, found {found}"))))
        });
        let poses = self.poses.iter().map(|pose| (pose.t_ns, check_rigid(&pose.odom_from_vehicle)));
        check_samples("odometry", odometry)?;
        check_samples("poses", poses)
    }

    /// A vehicle of whose motion nothing is known. Until something is, it stands still.
    pub fn unknown() -> Self {
        Self { odometry: Vec::new(), planar: Vec::new(), poses: Vec::new() }
    }

    /// Whether there is odometry or a pose.
    pub fn is_known(&self) -> bool {
        !self.odometry.is_empty() || !self.poses.is_empty()
    }

    /// Whether all that is known is that the vehicle stands still.
    pub fn stands_still(&self) -> bool {
        let stands = |sample: &OdometrySample| sample.velocity == 0.0 && sample.yaw_rate == 0.0;
        self.is_known() && self.poses.is_empty() && self.odometry.iter().all(stands)
    }

    /// The wheel odometry, as recorded.
    pub fn odometry(&self) -> &[OdometrySample] {
        &self.odometry
    }

    /// The 6-DoF poses, as recorded.
    pub fn poses(&self) -> &[PoseSample] {
        &self.poses
    }

    /// `T(to <- from)`: the vehicle pose at `from_ns` in the vehicle frame at `to_ns`.
    pub fn between(&self, to_ns: i64, from_ns: i64) -> Transform {
        if to_ns == from_ns {
            return Transform::identity();
        }
        self.odom_from_vehicle(to_ns).inv_mul(&self.odom_from_vehicle(from_ns))
    }

    /// The vehicle's pose at a time. Outside the poses' span the pose is held; outside the odometry's the nearest
    /// velocity and yaw rate go on.
    pub fn odom_from_vehicle(&self, t_ns: i64) -> Transform {
        if self.poses.is_empty() { self.integrated(t_ns) } else { self.interpolated(t_ns) }
    }

    /// The vehicle's velocity (m/s, vehicle frame, at its origin) and turn rate (rad/s) at a time: measured by the
    /// wheels where there is odometry, else from the poses around. Where poses span the time, they are asked, too, once
    /// the wheels' last word is half a second old: a log may end, or have a gap.
    pub fn twist(&self, t_ns: i64) -> (Vector3<f64>, Vector3<f64>) {
        const OLD_NS: u64 = 500_000_000;
        match self.odometry.get(self.sample_at(t_ns)) {
            Some(sample) if sample.t_ns.abs_diff(t_ns) <= OLD_NS || !self.poses_span(t_ns) => {
                (Vector3::new(sample.velocity, 0.0, 0.0), Vector3::new(0.0, 0.0, sample.yaw_rate))
            }
            _ => self.twist_of_poses(t_ns),
        }
    }

    fn poses_span(&self, t_ns: i64) -> bool {
        let span = self.poses.first().zip(self.poses.last());
        span.is_some_and(|(first, last)| (first.t_ns..=last.t_ns).contains(&t_ns))
    }

    fn twist_of_poses(&self, t_ns: i64) -> (Vector3<f64>, Vector3<f64>) {
        const HALF_STEP_NS: i64 = 25_000_000;
        let span = self.poses.first().zip(self.poses.last());
        let (first, last) = span.map_or((t_ns, t_ns), |(first, last)| {
            (first.t_ns.max(t_ns - HALF_STEP_NS), last.t_ns.min(t_ns + HALF_STEP_NS))
        });
        if last <= first {
            return (Vector3::zeros(), Vector3::zeros());
        }
        // Both ends as the vehicle sees them at that time: seen from the first one, a turn leads the velocity astray.
        let [begin, end] = [first, last].map(|end_ns| self.between(t_ns, end_ns));
        let dt = seconds(last - first);
        let turned = begin.rotation.rotation_to(&end.rotation).scaled_axis();
        ((end.translation.vector - begin.translation.vector) / dt, turned / dt)
    }

    fn sample_at(&self, t_ns: i64) -> usize {
        self.odometry.partition_point(|sample| sample.t_ns <= t_ns).saturating_sub(1)
    }

    fn integrated(&self, t_ns: i64) -> Transform {
        let at = self.sample_at(t_ns);
        let (Some(planar), Some(sample)) = (self.planar.get(at), self.odometry.get(at)) else {
            return Transform::identity();
        };
        let [x, y, psi] = advance(*planar, sample, t_ns);
        let rotation = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), psi);
        Transform::from_parts(Translation3::new(x, y, 0.0), rotation)
    }

    fn interpolated(&self, t_ns: i64) -> Transform {
        let after = self.poses.partition_point(|pose| pose.t_ns <= t_ns);
        match (after.checked_sub(1).map(|before| self.poses[before]), self.poses.get(after)) {
            (Some(a), Some(b)) => {
                let share = (t_ns - a.t_ns) as f64 / (b.t_ns - a.t_ns) as f64;
                interpolate(&a.odom_from_vehicle, &b.odom_from_vehicle, share)
            }
            (Some(only), None) => only.odom_from_vehicle,
            (None, Some(only)) => only.odom_from_vehicle,
            (None, None) => Transform::identity(),
        }
    }
}

/// Samples with their times and what is wrong with their numbers.
fn check_samples(
    what: &str,
    samples: impl Iterator<Item = (i64, Result<(), String>)>,
) -> Result<(), (String, String)> {
    let mut before = i64::MIN;
    for (n, (t_ns, numbers)) in samples.enumerate() {
        let refused = |reason| Err((format!("{what}: {n}"), reason));
        if t_ns.unsigned_abs() > i64::MAX.unsigned_abs() / 2 {
            return refused(format!("a time within 146 years of 0, found {t_ns} ns"));
        }
        if t_ns < before {
            return refused(format!("a time of {before} ns or later, found {t_ns} ns"));
        }
        if let Err(reason) = numbers {
            return refused(reason);
        }
        before = t_ns;
    }
    Ok(())
}

/// The planar pose at `t_ns`, from the pose at `sample`, along the exact arc of constant velocity and yaw rate.
fn advance([x, y, psi]: [f64; 3], sample: &OdometrySample, t_ns: i64) -> [f64; 3] {
    let dt = seconds(t_ns.saturating_sub(sample.t_ns));
    let dpsi = sample.yaw_rate * dt;
    let (along, across) = if dpsi.abs() < 1e-6 {
        (1.0 - dpsi * dpsi / 6.0, dpsi / 2.0)
    } else {
        (dpsi.sin() / dpsi, (1.0 - dpsi.cos()) / dpsi)
    };
    let distance = sample.velocity * dt;
    let (sin, cos) = psi.sin_cos();
    [x + distance * (cos * along - sin * across), y + distance * (sin * along + cos * across), psi + dpsi]
}

/// Linear in position, slerp in rotation, the shorter way round.
fn interpolate(a: &Transform, b: &Transform, share: f64) -> Transform {
    let position = a.translation.vector.lerp(&b.translation.vector, share);
    // Opposite rotations have no shortest way; either end is then as good.
    let rotation = a.rotation.try_slerp(&b.rotation, share, 1e-12).unwrap_or(a.rotation);
    Transform::from_parts(Translation3::from(position), rotation)
}

fn seconds(ns: i64) -> f64 {
    ns as f64 * 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::Point;
    use std::f64::consts::FRAC_PI_2;

    const SECOND: i64 = 1_000_000_000;

    fn odometry(rows: &[(i64, f64, f64)]) -> EgoMotion {
        let sample = |&(t, velocity, yaw_rate)| OdometrySample { t_ns: t * SECOND, velocity, yaw_rate };
        EgoMotion::new(rows.iter().map(sample).collect(), vec![]).unwrap()
    }

    #[test]
    fn a_quarter_circle_is_exact() {
        // A quarter turn in 1 s on a circle of radius 2: v = 2 * pi / 2.
        let motion = odometry(&[(0, 2.0 * FRAC_PI_2, FRAC_PI_2), (5, 0.0, 0.0)]);
        let pose = motion.odom_from_vehicle(SECOND);
        assert!((pose.translation.vector - Vector3::new(2.0, 2.0, 0.0)).norm() < 1e-12);
        assert!((pose * Point::new(1.0, 0.0, 0.0) - Point::new(2.0, 3.0, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn motion_goes_on_before_the_first_and_after_the_last_sample() {
        let motion = odometry(&[(0, 3.0, 0.0), (1, 5.0, 0.0)]);
        assert!((motion.odom_from_vehicle(-2 * SECOND).translation.x + 6.0).abs() < 1e-12);
        assert!((motion.odom_from_vehicle(3 * SECOND).translation.x - 13.0).abs() < 1e-12);
    }

    #[test]
    fn the_series_meets_the_arc() {
        let arc =
            |yaw_rate: f64| advance([0.0; 3], &OdometrySample { t_ns: 0, velocity: 10.0, yaw_rate }, SECOND);
        for (below, above) in arc(0.99e-6).into_iter().zip(arc(1.01e-6)) {
            assert!((below - above).abs() < 1e-6);
        }
    }

    #[test]
    fn between_moves_points_to_the_other_time() {
        let motion = odometry(&[(0, 2.0, 0.0)]);
        // A wall 10 m ahead at t = 0 is 6 m ahead two seconds later.
        let wall = motion.between(2 * SECOND, 0) * Point::new(10.0, 0.0, 0.0);
        assert!((wall - Point::new(6.0, 0.0, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn poses_are_interpolated_and_held() {
        let pose = |t: i64, x: f64, yaw: f64| PoseSample {
            t_ns: t * SECOND,
            odom_from_vehicle: Transform::new(Vector3::new(x, 0.0, 0.0), Vector3::new(0.0, 0.0, yaw)),
        };
        let samples = vec![OdometrySample { t_ns: 0, velocity: 99.0, yaw_rate: 9.0 }];
        let motion = EgoMotion::new(samples, vec![pose(0, 0.0, 0.0), pose(2, 4.0, 1.0)]).unwrap();
        let halfway = motion.odom_from_vehicle(SECOND);
        assert!((halfway.translation.x - 2.0).abs() < 1e-12);
        assert!((halfway.rotation.euler_angles().2 - 0.5).abs() < 1e-12);
        assert_eq!(motion.odom_from_vehicle(-SECOND).translation.x, 0.0);
        assert_eq!(motion.odom_from_vehicle(9 * SECOND).translation.x, 4.0);
        assert_eq!(motion.twist(SECOND / 2).0.x, 99.0, "the wheels measure it");
        assert!((motion.twist(SECOND).0.norm() - 2.0).abs() < 1e-3, "what they said long ago holds no more");
        assert_eq!(motion.twist(9 * SECOND).0.x, 99.0, "nor is there a pose");
        let (velocity, turn) = EgoMotion::new(vec![], motion.poses().to_vec()).unwrap().twist(SECOND);
        assert!((velocity.norm() - 2.0).abs() < 1e-3 && (turn.z - 0.5).abs() < 1e-9);
    }

    /// 15 m/s ahead and 0.6 rad/s to the left, of which poses tell every 10 ms: the vehicle never slides sideways.
    #[test]
    fn in_a_turn_the_velocity_of_poses_is_ahead() {
        let driven = odometry(&[(0, 15.0, 0.6)]);
        let pose = |i: i64| {
            let t_ns = i * 10_000_000;
            PoseSample { t_ns, odom_from_vehicle: driven.odom_from_vehicle(t_ns) }
        };
        let motion = EgoMotion::new(vec![], (0..=100).map(pose).collect()).unwrap();
        for t_ns in [300_000_000, 505_000_000, 777_777_777] {
            let (velocity, turn) = motion.twist(t_ns);
            assert!((velocity - Vector3::new(15.0, 0.0, 0.0)).norm() < 2e-3, "{velocity}");
            assert!((turn - Vector3::new(0.0, 0.0, 0.6)).norm() < 1e-9, "{turn}");
        }
    }

    #[test]
    fn no_samples_is_no_motion() {
        assert!(EgoMotion::new(vec![], vec![]).is_none());
        let unknown = EgoMotion::unknown();
        assert!(
            !unknown.is_known()
                && !unknown.stands_still()
                && unknown.between(SECOND, 0) == Transform::identity()
        );
        assert_eq!(unknown.twist(0), (Vector3::zeros(), Vector3::zeros()));
    }
}
