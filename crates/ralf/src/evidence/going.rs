//! Where what moves may go. A radar measures how fast a thing recedes and not how fast it goes across the ray, so two
//! things are supposed in turn: that it moves along the ray, and that it drives as the road does, which is how the own
//! vehicle drives.

use super::course::Course;
use super::rates::Rates;
use crate::scene::{Detection, Frame, radar_velocity};
use crate::space::{Point, Vector};
use std::f64::consts::SQRT_2;

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
    /// How well the velocity is known, along and across itself, m/s.
    sigmas: [f64; 2],
    /// How well range rates of it agree at best, m/s.
    rate_sigma: f64,
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
    pub(super) fn of(&self, i: usize, detection: &Detection, across: f64) -> impl Iterator<Item = Going> {
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
        along_ray.into_iter().chain(along_road)
    }

    fn going(&self, detection: &Detection, direction: Vector, speed: f64, direction_sigma: f64) -> Going {
        let from_radar = detection.position - self.radar;
        let range = from_radar.norm();
        let velocity = direction * speed;
        // As far as its place is uncertain across the ray, so is the part of its motion that the rate shows.
        let uncertain = detection.axes.columns(1, 2).tr_mul(&(velocity - self.radar_velocity)).norm();
        let rate_sigma = self.rates.spread().hypot(if range > 0.0 { uncertain / range } else { 0.0 });
        let cosine = if range > 0.0 { (from_radar.dot(&direction) / range).abs() } else { 1.0 };
        let sigmas = [rate_sigma / cosine, direction_sigma * speed.abs()];
        Going { detection: *detection, velocity, sigmas, rate_sigma }
    }
}

impl Going {
    /// m/s, horizontally.
    pub(super) fn velocity(&self) -> [f64; 2] {
        [self.velocity.x, self.velocity.y]
    }

    /// The detection so many seconds later: moved, and less certain the longer ago.
    pub(super) fn after(&self, seconds: f64) -> Detection {
        let mut moved = self.detection;
        moved.position += self.velocity * seconds;
        let along = self.velocity.try_normalize(0.0).unwrap_or_default();
        let [along_sigma, across_sigma] = self.sigmas.map(|sigma| sigma * seconds);
        for column in 0..2 {
            let axis: Vector = moved.axes.column(column).into();
            let Some(direction) = axis.try_normalize(0.0) else { continue };
            let share = direction.dot(&along);
            let drift = (along_sigma * share).hypot(across_sigma * (1.0 - share * share).max(0.0).sqrt());
            moved.axes.set_column(column, &(direction * axis.norm().hypot(drift)));
        }
        moved
    }

    /// How far its range rate at a place is from another's, as a radar measures them whose own motion is taken away, in
    /// standard deviations; `None` where the other was not measured.
    pub(super) fn rate_difference(&self, place: &Point, radar: &Point, other: f64) -> Option<f64> {
        let ray = (place - radar).try_normalize(0.0).unwrap_or_default();
        Some((self.velocity.dot(&ray) - other).abs() / (SQRT_2 * self.rate_sigma))
            .filter(|difference| difference.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{EgoMotion, OdometrySample};
    use nalgebra::Matrix3;

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
        let [ray, road] = goings.of(0, &detection(), 0.3).collect::<Vec<_>>()[..] else { panic!("two ways") };
        // 16 m/s along (0.8, 0.6); a car at 16 / 0.8 = 20 m/s.
        assert!((ray.velocity - Vector::new(12.8, 9.6, 0.0)).norm() < 1e-12);
        assert!((road.velocity - Vector::new(20.0, 0.0, 0.0)).norm() < 1e-12);
        // Seen from the radar the car falls back at 10 m/s, of which 6 are across the ray; the azimuth is known by
        // 0.1 / 10 rad: 0.06 m/s. Along the road that is 0.8 of the speed.
        let sigma = 0.12f64.hypot(0.06);
        assert!((road.rate_sigma - sigma).abs() < 1e-12);
        assert!((road.sigmas[0] - sigma / 0.8).abs() < 1e-12 && (road.sigmas[1] - 0.03 * 20.0).abs() < 1e-12);
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
        let radar = Point::origin();
        let difference = road.rate_difference(&after.position, &radar, 18.0).unwrap();
        let expected = (20.0 * 18.0 / 360f64.sqrt() - 18.0) / (SQRT_2 * sigma);
        assert!((difference - expected).abs() < 1e-9);
        assert_eq!(road.rate_difference(&after.position, &radar, f64::NAN), None);
    }

    #[test]
    fn what_no_speed_explains_goes_along_its_ray_alone() {
        let rates = Rates::new(vec![60.0, 0.0, 0.0, f64::NAN, 9.0]);
        let count = |i: usize, course| goings(&rates, course).of(i, &detection(), 0.0).count();
        assert_eq!(count(0, straight()), 1, "75 m/s");
        assert_eq!([count(1, straight()), count(3, straight())], [0, 0], "stands still; no rate");
        assert_eq!([count(4, straight()), count(4, None)], [2, 1]);
        let mut beside = detection();
        beside.position = Point::new(1.0, 9.0, 0.0);
        assert_eq!(goings(&rates, straight()).of(4, &beside, 0.0).count(), 1, "across the ray");
    }
}
