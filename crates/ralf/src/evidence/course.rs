//! Where the vehicle is going: nothing stands in its way, and most of what lies there is road.

use crate::scene::Frame;
use crate::space::{EgoMotion, Point};
use nalgebra::Vector2;

/// A slower vehicle goes straight ahead, m/s: the direction of so little motion is noise.
const SLOWEST: f64 = 0.5;

/// The arc on which the vehicle's origin moves at a moment, in the vehicle frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Course {
    /// Of unit length.
    ahead: Vector2<f64>,
    /// 1/m, positive to the left.
    curvature: f64,
}

impl Course {
    /// The course at a frame's time; `None` where nobody knows how the vehicle moves.
    pub(super) fn of(frame: &Frame) -> Option<Self> {
        frame.motion.is_known().then(|| Self::at(frame.motion, frame.scan.t_ns()))
    }

    pub(super) fn at(motion: &EgoMotion, t_ns: i64) -> Self {
        let (velocity, turn) = motion.twist(t_ns);
        let velocity = velocity.xy();
        let speed = velocity.norm();
        if speed < SLOWEST {
            return Self { ahead: Vector2::x(), curvature: 0.0 };
        }
        Self { ahead: velocity / speed, curvature: turn.z / speed }
    }

    /// How far beside it a place lies, m.
    ///
    /// With the place `a` ahead and `l` to the left, and the curvature `k`, the distance from the arc is that from its
    /// middle less its radius, `|hypot(a, l - 1/k) - 1/|k||`, written so that a straight line is none but `k = 0`.
    pub(super) fn beside(&self, place: &Point) -> f64 {
        let (place, k) = (place.coords.xy(), self.curvature);
        let (a, l) = (self.ahead.dot(&place), self.ahead.perp(&place));
        (k * (a * a + l * l) - 2.0 * l).abs() / ((k * a).hypot(1.0 - k * l) + 1.0)
    }

    /// Where a road leads at a place that is everywhere as far from the arc as there, of unit length: on a circle
    /// around the same middle, `(1 - k l, k a)` ahead and to the left.
    pub(super) fn direction_at(&self, place: &Point) -> Vector2<f64> {
        let (place, k) = (place.coords.xy(), self.curvature);
        let (a, l) = (self.ahead.dot(&place), self.ahead.perp(&place));
        let left = Vector2::new(-self.ahead.y, self.ahead.x);
        (self.ahead * (1.0 - k * l) + left * (k * a)).try_normalize(1e-9).unwrap_or(self.ahead)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{OdometrySample, Vector};
    use proptest::prelude::*;

    fn course(velocity: f64, yaw_rate: f64) -> Course {
        Course::at(&EgoMotion::new(vec![OdometrySample { t_ns: 0, velocity, yaw_rate }], vec![]).unwrap(), 0)
    }

    #[test]
    fn a_course_by_hand() {
        // 10 m/s and 0.5 rad/s: a circle of 20 m around (0, 20).
        for (place, beside) in [
            ([0.0, 0.0], 0.0),
            ([20.0, 20.0], 0.0),
            ([0.0, 20.0], 20.0),
            ([0.0, -3.0], 3.0),
            ([0.0, 43.0], 3.0),
        ] {
            let found = course(10.0, 0.5).beside(&Point::new(place[0], place[1], 7.0));
            assert!((found - beside).abs() < 1e-12, "{place:?}: {found}");
        }
        let place = Point::new(50.0, -3.0, 0.0);
        for (velocity, yaw_rate) in [(30.0, 0.0), (-2.0, 0.0), (0.3, 1.0), (0.0, 0.0)] {
            assert!((course(velocity, yaw_rate).beside(&place) - 3.0).abs() < 1e-12, "{velocity} {yaw_rate}");
        }
    }

    #[test]
    fn a_road_leads_around_the_same_middle() {
        // Around (0, 20), to the left; beyond the middle it leads back. The square root of one half is 0.7071.
        for (place, direction) in [
            ([0.0, 0.0], [1.0, 0.0]),
            ([20.0, 20.0], [0.0, 1.0]),
            ([10.0, 10.0], [0.5f64.sqrt(), 0.5f64.sqrt()]),
            ([0.0, 43.0], [-1.0, 0.0]),
            ([0.0, 20.0], [1.0, 0.0]),
        ] {
            let found = course(10.0, 0.5).direction_at(&Point::new(place[0], place[1], 7.0));
            assert!((found - Vector2::from(direction)).norm() < 1e-12, "{place:?}: {found}");
        }
        let reversing = course(-3.0, 0.0).direction_at(&Point::new(9.0, 4.0, 0.0));
        assert_eq!(reversing, Vector2::new(-1.0, 0.0));
    }

    proptest! {
        /// Whoever follows a road stays as far from the course as before.
        #[test]
        fn a_road_keeps_its_distance(curvature in -0.05..0.05_f64, x in -60.0..60.0_f64, y in -15.0..15.0_f64) {
            let (course, place) = (course(10.0, 10.0 * curvature), Point::new(x, y, 0.0));
            let direction = course.direction_at(&place);
            let step = Vector::new(direction.x, direction.y, 0.0) * 1e-3;
            let change = course.beside(&(place + step)) - course.beside(&(place - step));
            prop_assert!(change.abs() < 1e-6, "{}", change);
        }
    }

    proptest! {
        /// Against the nearest of many places that the vehicle comes by.
        #[test]
        fn a_course_is_where_the_vehicle_goes(
            velocity in 1.0..40.0_f64, curvature in -0.1..0.1_f64, x in -80.0..80.0_f64, y in -80.0..80.0_f64,
        ) {
            let mut least = f64::INFINITY;
            for step in [0.01, -0.01] {
                let (mut at, mut heading) = ([0.0, 0.0], 0.0_f64);
                for _ in 0..40_000 {
                    least = least.min((at[0] - x).hypot(at[1] - y));
                    let between = heading + 0.5 * step * curvature;
                    at = [at[0] + step * between.cos(), at[1] + step * between.sin()];
                    heading += step * curvature;
                }
            }
            let place = Point::new(x, y, 0.0);
            prop_assert!((course(velocity, velocity * curvature).beside(&place) - least).abs() < 0.02);
        }
    }
}
