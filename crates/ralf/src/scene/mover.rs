//! Where a detection is at another time, if its range rate is that of something that moves.

use super::located::Detection;
use crate::sensors::Radar;
use crate::space::Vector;

/// A thing seldom moves along the ray to it. How fast it moves across is not measured; the standard deviation of that
/// is taken to be this share of its range rate, as if it moved within 17 degrees of the ray, two times in three.
pub const ACROSS_PER_ALONG: f64 = 0.3;
/// Range rates agree within so many standard deviations of what the azimuth leaves open.
const SIGMAS: f64 = 2.0;

/// A detection with its own velocity: what is left of its range rate without the vehicle's motion.
#[derive(Debug, Clone, Copy)]
pub struct Mover {
    detection: Detection,
    /// From the radar to the detection, of unit length.
    ray: Vector,
    /// Where growing azimuth leads, of unit length.
    across: Vector,
    /// Compensated range rate, m/s, positive when receding; `None` where none was measured.
    rate: Option<f64>,
    /// How well that is known, m/s.
    rate_sigma: f64,
}

impl Mover {
    /// A radar's detection (vehicle frame) with its compensated range rate, m/s, not finite where none was measured.
    /// `radar_velocity` is the radar's own (vehicle frame, m/s): as far as the azimuth is uncertain, so is the part of
    /// it that was taken from the range rate.
    pub fn new(radar: &Radar, detection: &Detection, rate: f64, radar_velocity: &Vector) -> Self {
        let from_radar = detection.position.coords - radar.vehicle_from_radar.translation.vector;
        let range = from_radar.norm();
        let ray = from_radar.try_normalize(0.0).unwrap_or_default();
        let up = radar.vehicle_from_radar.rotation * Vector::z();
        let across = up.cross(&ray).try_normalize(1e-9).unwrap_or_default();
        Self {
            detection: *detection,
            ray,
            across,
            rate: Some(rate).filter(|rate| rate.is_finite()),
            rate_sigma: rate_sigma(detection, range, radar_velocity),
        }
    }

    /// Compensated range rate, m/s; 0 where none was measured.
    pub fn rate(&self) -> f64 {
        self.rate.unwrap_or(0.0)
    }

    /// The detection so many seconds later: moved along its ray, its uncertainty with it.
    pub fn along_ray(&self, seconds: f64) -> Detection {
        let position = self.detection.position + self.ray * (self.rate() * seconds);
        Detection { position, axes: self.detection.axes }
    }

    /// The detection so many seconds later: moved along its ray, and less certain across it the farther it went, for
    /// its motion there is not measured.
    pub fn after(&self, seconds: f64) -> Detection {
        let mut moved = self.along_ray(seconds);
        let drift = ACROSS_PER_ALONG * self.rate() * seconds;
        // The second column is how far the azimuth's standard deviation leads.
        let sigma = moved.axes.column(1).norm().hypot(drift);
        moved.axes.set_column(1, &(self.across * sigma));
        moved
    }

    /// Whether another detection's compensated range rate (m/s, not finite where none was measured) can be that of the
    /// same thing: equal within the tolerance, m/s, and within what the uncertain azimuth of both leaves open. What was
    /// not measured contradicts nothing.
    pub fn agrees_with(&self, other: f64, tolerance: f64) -> bool {
        let Some(rate) = self.rate.filter(|_| other.is_finite()) else { return true };
        (rate - other).abs() <= tolerance.hypot(SIGMAS * std::f64::consts::SQRT_2 * self.rate_sigma)
    }
}

/// How well the part of a velocity (m/s) is known that lies along the ray to a detection at this range, m: as far as
/// the place is uncertain across the ray, so is that part. m/s.
pub fn rate_sigma(detection: &Detection, range: f64, velocity: &Vector) -> f64 {
    let uncertain = detection.axes.columns(1, 2).tr_mul(velocity).norm();
    if range > 0.0 { uncertain / range } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::LocatedScan;
    use crate::sensors::{Elevation, RadarScan, Reliability};
    use crate::space::{Point, Transform};

    /// 1 m ahead of the vehicle's origin, looking to the left; 0.2 m, 0.02 rad, 0.01 rad.
    fn radar() -> Radar {
        let left = Vector::new(0.0, 0.0, std::f64::consts::FRAC_PI_2);
        Radar {
            name: "left".into(),
            fields: ["x", "y", "z"].map(str::to_owned).to_vec(),
            vehicle_from_radar: Transform::new(Vector::new(1.0, 0.0, 0.0), left),
            elevation: Elevation::Measured,
            fov_azimuth: 2.0,
            fov_elevation: 0.3,
            sigma_range: 0.2,
            sigma_azimuth: 0.02,
            sigma_elevation: 0.01,
            reliability: Reliability::default(),
        }
    }

    /// 20 m to the left of the radar.
    fn mover(rate: f64, radar_velocity: Vector) -> Mover {
        let radar = radar();
        let scan = RadarScan::new(&radar, 0, vec![vec![20.0], vec![0.0], vec![0.0]]).unwrap();
        let detection = LocatedScan::new(&radar, scan).detections[0].unwrap();
        Mover::new(&radar, &detection, rate, &radar_velocity)
    }

    #[test]
    fn goes_along_its_ray_and_is_less_certain_across() {
        let moved = mover(-10.0, Vector::zeros()).after(0.2);
        assert!((moved.position - Point::new(1.0, 18.0, 0.0)).norm() < 1e-9);
        // Along the ray 0.2 m as before; across 20 * 0.02 = 0.4 m and a drift of 0.3 * 2 m = 0.6 m; upward 20 * 0.01.
        for (direction, sigma) in [(Vector::y(), 0.2), (Vector::x(), 0.4f64.hypot(0.6)), (Vector::z(), 0.2)] {
            assert!((moved.sigma_along(&direction) - sigma).abs() < 1e-9, "{direction}");
        }
        let before = mover(-10.0, Vector::zeros()).along_ray(-0.1);
        assert!((before.position - Point::new(1.0, 21.0, 0.0)).norm() < 1e-9);
        assert!((before.sigma_along(&Vector::x()) - 0.4).abs() < 1e-9);
    }

    #[test]
    fn without_a_range_rate_it_stays_and_contradicts_nothing() {
        let still = mover(f64::NAN, Vector::new(30.0, 0.0, 0.0));
        assert_eq!(still.after(9.0).position, still.along_ray(0.0).position);
        assert!(still.agrees_with(17.0, 0.1) && mover(5.0, Vector::zeros()).agrees_with(f64::NAN, 0.1));
    }

    #[test]
    fn range_rates_agree_within_the_tolerance_and_what_the_azimuth_leaves_open() {
        let standing = mover(5.0, Vector::zeros());
        assert!(standing.agrees_with(5.29, 0.3) && !standing.agrees_with(5.31, 0.3));
        // Ahead at 10 m/s, across the ray: 0.02 rad are 0.2 m/s, of two detections 2 sqrt(2) * 0.2 = 0.566 m/s; with
        // the tolerance sqrt(0.3^2 + 0.566^2) = 0.640 m/s.
        let driving = mover(5.0, Vector::new(10.0, 0.0, 0.0));
        assert!(driving.agrees_with(5.63, 0.3) && !driving.agrees_with(5.65, 0.3));
        // To the left, along the ray: the azimuth tells nothing of it.
        assert!(!mover(5.0, Vector::new(0.0, 10.0, 0.0)).agrees_with(5.31, 0.3));
    }
}
