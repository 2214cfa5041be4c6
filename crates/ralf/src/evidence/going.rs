//! Where what moves may go. A radar measures how fast a thing recedes and not how fast it goes across the ray, so two
//! things are supposed in turn: that it moves along the ray, and that it drives as the road does, which is how the own
//! vehicle drives.

use super::course::Course;
use super::distance::{DriftingSpot, Spot};
use super::rates::{Rates, difference};
use crate::scene::{Detection, Frame, radar_velocity, rate_sigma};
use crate::space::{Point, Vector};
use nalgebra::Matrix3;

/// Nothing on a road is faster, m/s.
const FASTEST: f64 = 70.0;
/// Of what drives so nearly across the ray its range rate tells no speed: cosine of the angle between them.
const ACROSS: f64 = 0.15;
/// How well the direction of others is known from that of the own vehicle, rad: they change lanes.
const DIRECTION_SIGMA: f64 = 0.03;

/// What is known of how a frame's detections may move.
pub(super) struct Goings<'a> {
    rates: &'a Rates,
    radar: Point,
    radar_velocity: Vector,
    course: Option<Course>,
}

/// One way in which a detection may go on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Going {
    detection: Detection,
    /// Horizontal along a road, along the ray otherwise; m/s.
    velocity: Vector,
    /// The detection's axes but the one that leads up, each with how it grows.
    axes: [Axis; 2],
    /// How well range rates of it agree at best, m/s.
    rate_sigma: f64,
}

/// One axis of a detection's uncertainty and how fast it grows.
#[derive(Debug, Clone, Copy)]
struct Axis {
    direction: Vector,
    /// m^2
    variance: f64,
    /// What is open of the velocity, as far as it lies along this axis: m^2/s^2.
    growth: f64,
}

impl<'a> Goings<'a> {
    /// `rates` are those of the frame's scan.
    pub(super) fn new(frame: &Frame, rates: &'a Rates) -> Self {
        Self {
            rates,
            radar: Point::from(frame.radar.vehicle_from_radar.translation.vector),
            radar_velocity: radar_velocity(frame.radar, frame.scan.t_ns(), frame.motion),
            course: Course::of(frame),
        }
    }

    /// The ways in which a detection of the scan may go on that moves; none of one that stands still or has no rate.
    /// What goes along the ray goes across it within `across` of that, two times in three.
    pub(super) fn of(&self, i: usize, detection: &Detection, across: f64) -> [Option<Going>; 2] {
        let rate = self.rates.motion(i);
        let ray = (detection.position - self.radar).try_normalize(0.0).unwrap_or_default();
        let along_ray = (rate != 0.0).then(|| self.going(detection, ray, rate, across));
        let along_road = self.course.filter(|_| rate != 0.0).and_then(|course| {
            let [x, y] = course.direction_at(&detection.position).into();
            let direction = Vector::new(x, y, 0.0);
            let cosine = direction.dot(&ray);
            let speed = rate / cosine;
            let is_told = cosine.abs() >= ACROSS && speed.abs() <= FASTEST;
            is_told.then(|| self.going(detection, direction, speed, DIRECTION_SIGMA))
        });
        [along_ray, along_road]
    }

    fn going(&self, detection: &Detection, direction: Vector, speed: f64, direction_sigma: f64) -> Going {
        let from_radar = detection.position - self.radar;
        let range = from_radar.norm();
        let velocity = direction * speed;
        let seen = velocity - self.radar_velocity;
        let rate_sigma = self.rates.spread().hypot(rate_sigma(detection, range, &seen));
        let cosine = if range > 0.0 { (from_radar.dot(&direction) / range).abs() } else { 1.0 };
        let sigmas = [rate_sigma / cosine, direction_sigma * speed.abs()];
        let axes = [0, 1].map(|column| Axis::new(detection.axes.column(column).into(), &velocity, sigmas));
        Going { detection: *detection, velocity, axes, rate_sigma }
    }
}

impl Axis {
    /// `sigmas` tell how well the velocity is known along and across itself, m/s.
    fn new(axis: Vector, velocity: &Vector, sigmas: [f64; 2]) -> Self {
        let direction = axis.try_normalize(0.0).unwrap_or_default();
        let ahead = velocity.try_normalize(0.0).unwrap_or_default();
        let share = direction.dot(&ahead);
        let aside_squared = (1.0 - share * share).max(0.0);
        let growth = (sigmas[0] * share).powi(2) + sigmas[1] * sigmas[1] * aside_squared;
        Self { direction, variance: axis.norm_squared(), growth }
    }

    fn after(&self, seconds: f64) -> Vector {
        self.direction * (self.variance + self.growth * seconds * seconds).sqrt()
    }
}

/// How well a way to go fits the scans that could have seen it: the share of them that did, as if it had been seen in
/// half of one more; of equal ones the nearest.
pub(super) fn fit(again: usize, scans: usize, distance: f64) -> [f64; 2] {
    [(again as f64 + 0.5) / (scans as f64 + 1.0), -distance]
}

impl Going {
    /// Where it is at its own time, and how that drifts: as [`Self::after`] has it.
    pub(super) fn drift(&self) -> DriftingSpot {
        let [first, second] = self.axes.map(|axis| axis.direction * axis.growth.sqrt());
        let axes = Matrix3::from_columns(&[first, second, Vector::zeros()]);
        let drift = Detection { position: Point::from(self.velocity), axes };
        DriftingSpot { spot: Spot::new(&self.detection), drift: Spot::new(&drift) }
    }

    /// The detection so many seconds later: moved, and less certain the longer ago.
    pub(super) fn after(&self, seconds: f64) -> Detection {
        let mut moved = self.detection;
        moved.position += self.velocity * seconds;
        for (column, axis) in self.axes.iter().enumerate() {
            moved.axes.set_column(column, &axis.after(seconds));
        }
        moved
    }

    /// How far its range rate at a place is from another's, as a radar measures them whose own motion is taken away, in
    /// standard deviations; `None` where the other was not measured.
    pub(super) fn rate_difference(&self, place: &Vector, radar: &Vector, other: f64) -> Option<f64> {
        let ray = (place - radar).try_normalize(0.0).unwrap_or_default();
        difference(self.velocity.dot(&ray), other, self.rate_sigma)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{EgoMotion, OdometrySample};
    use std::f64::consts::SQRT_2;

    /// A radar at the vehicle's origin; the vehicle drives straight ahead at 30 m/s. Rates of a spread of 0.12 m/s.
    fn goings(rates: &Rates, course: Option<Course>) -> Goings<'_> {
        Goings { rates, radar: Point::origin(), radar_velocity: Vector::new(30.0, 0.0, 0.0), course }
    }

    fn straight() -> Option<Course> {
        let samples = vec![OdometrySample { t_ns: 0, velocity: 30.0, yaw_rate: 0.0 }];
        Some(Course::at(&EgoMotion::new(samples, vec![]).unwrap(), 0))
    }

    /// Ahead on the left, 10 m away, the ray of slope 3 / 4: 0.2 m along it, 0.1 m across, 0.3 m up.
    fn detection() -> Detection {
        let [ray, across] = [Vector::new(0.8, 0.6, 0.0), Vector::new(-0.6, 0.8, 0.0)];
        let axes = Matrix3::from_columns(&[ray * 0.2, across * 0.1, Vector::z() * 0.3]);
        Detection { position: Point::new(8.0, 6.0, 0.0), axes }
    }

    #[test]
    fn along_the_ray_and_along_the_road_by_hand() {
        let rates = Rates::new(vec![16.0, 0.0, 0.0, f64::NAN, 0.0]);
        let goings = goings(&rates, straight());
        let [Some(ray), Some(road)] = goings.of(0, &detection(), 0.3) else { panic!("two ways") };
        // 16 m/s along (0.8, 0.6); a car at 16 / 0.8 = 20 m/s.
        assert!((ray.velocity - Vector::new(12.8, 9.6, 0.0)).norm() < 1e-12);
        assert!((road.velocity - Vector::new(20.0, 0.0, 0.0)).norm() < 1e-12);
        // Seen from the radar the car falls back at 10 m/s, of which 6 are across the ray; the azimuth is known by
        // 0.1 / 10 rad: 0.06 m/s. Along the road that is 0.8 of the speed.
        let sigma = 0.12f64.hypot(0.06);
        assert!((road.rate_sigma - sigma).abs() < 1e-12);
        // In half a second 10 m ahead. Its axis along the ray grows by 0.8 of what the speed leaves open and 0.6 of
        // what the direction does, the other the other way round; upward nothing grows.
        let after = road.after(0.5);
        assert!((after.position - Point::new(18.0, 6.0, 0.0)).norm() < 1e-12);
        let [along, aside] = [sigma / 0.8 * 0.5, 0.6 * 0.5];
        for (axis, before, share) in [(0, 0.2f64, 0.8), (1, 0.1, 0.6), (2, 0.3, 0.0)] {
            let grown = before.hypot(along * share).hypot(aside * (1.0 - share * share).sqrt());
            let expected = if axis == 2 { 0.3 } else { grown };
            assert!((after.axes.column(axis).norm() - expected).abs() < 1e-12, "{axis}");
        }
        // There the ray is (18, 6) / 18.97, and 20 m/s ahead are 18.974 m/s along it.
        let (place, radar) = (after.position.coords, Vector::zeros());
        let difference = road.rate_difference(&place, &radar, 18.0).unwrap();
        let expected = (20.0 * 18.0 / 360f64.sqrt() - 18.0) / (SQRT_2 * sigma);
        assert!((difference - expected).abs() < 1e-9);
        assert_eq!(road.rate_difference(&place, &radar, f64::NAN), None);
        // A spot drifts to the same.
        let (drifted, there) = (road.drift().after(0.5), Spot::new(&after));
        assert!((drifted.place - there.place).norm() < 1e-12);
        for (a, b) in drifted.horizontal.iter().zip(&there.horizontal) {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
    }

    #[test]
    fn what_no_speed_explains_goes_along_its_ray_alone() {
        let rates = Rates::new(vec![60.0, 0.0, 0.0, f64::NAN, 9.0]);
        let count =
            |i: usize, course| goings(&rates, course).of(i, &detection(), 0.0).iter().flatten().count();
        assert_eq!(count(0, straight()), 1, "75 m/s");
        assert_eq!([count(1, straight()), count(3, straight())], [0, 0], "stands still; no rate");
        assert_eq!([count(4, straight()), count(4, None)], [2, 1]);
        let mut beside = detection();
        beside.position = Point::new(1.0, 9.0, 0.0);
        assert_eq!(
            goings(&rates, straight()).of(4, &beside, 0.0).iter().flatten().count(),
            1,
            "across the ray"
        );
    }
}
