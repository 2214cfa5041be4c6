//! Range rates, with and without the vehicle's own motion.

use crate::sensors::{Radar, RadarScan};
use crate::space::{EgoMotion, Point, Vector};

/// The range rates of a scan, m/s, positive when receding: one per detection, NaN where none was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Doppler {
    /// As the radar sees it: a wall ahead of a vehicle that drives comes nearer.
    pub raw: Vec<f64>,
    /// Without the radar's own motion: a wall stands still.
    pub compensated: Vec<f64>,
}

impl Doppler {
    /// The field of the raw range rates.
    pub const RAW: &str = "doppler";
    /// The field of those without the vehicle's motion.
    pub const COMPENSATED: &str = "doppler_compensated";

    /// The range rates of a radar's scan: the fields [`Self::RAW`] and [`Self::COMPENSATED`], each derived from the
    /// other where the radar has but one, or a detection (some recordings have no compensated one while the vehicle
    /// stands). `None` where it has neither.
    ///
    /// The difference is the radial part of the radar's own velocity, `u . (v + omega x t)`: `u` is the unit ray to the
    /// detection, `t` the radar's lever arm from the vehicle's origin.
    pub fn new(radar: &Radar, scan: &RadarScan, motion: &EgoMotion) -> Option<Self> {
        let column = |name: &str| radar.column(name).map(|place| &scan.columns[place]);
        let (raw, compensated) = (column(Self::RAW), column(Self::COMPENSATED));
        raw.or(compensated)?;
        let rate = |column: Option<&Vec<f32>>, at: usize| column.map_or(f64::NAN, |rates| rates[at].into());
        let rates = own_motion(radar, scan, motion).enumerate().map(|(at, along)| {
            let (raw, compensated) = (rate(raw, at), rate(compensated, at));
            match (raw.is_nan(), compensated.is_nan()) {
                (false, true) => (raw, raw + along),
                (true, false) => (compensated - along, compensated),
                _ => (raw, compensated),
            }
        });
        let (raw, compensated) = rates.unzip();
        Some(Self { raw, compensated })
    }
}

/// The velocity of a radar at a time, in the vehicle frame at that time, m/s: `v + omega x t`, with the radar's lever
/// arm `t` from the vehicle's origin.
pub fn radar_velocity(radar: &Radar, t_ns: i64, motion: &EgoMotion) -> Vector {
    let (velocity, turn) = motion.twist(t_ns);
    velocity + turn.cross(&radar.vehicle_from_radar.translation.vector)
}

/// How fast the radar itself moves towards each detection of a scan, m/s: what a raw range rate lacks of the one
/// without the vehicle's motion.
pub fn own_motion(radar: &Radar, scan: &RadarScan, motion: &EgoMotion) -> impl Iterator<Item = f64> {
    let of_radar = radar.vehicle_from_radar.rotation.inverse() * radar_velocity(radar, scan.t_ns, motion);
    scan.positions
        .iter()
        .map(move |position: &Point| position.coords.try_normalize(0.0).map_or(0.0, |ray| ray.dot(&of_radar)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensors::{Elevation, Reliability};
    use crate::space::{OdometrySample, Transform};

    fn radar(fields: &[&str]) -> Radar {
        Radar {
            name: "front".into(),
            fields: fields.iter().map(|name| (*name).to_owned()).collect(),
            vehicle_from_radar: Transform::translation(3.0, 0.0, 0.5),
            elevation: Elevation::None,
            fov_azimuth: 2.0,
            fov_elevation: 0.3,
            sigma_range: 0.1,
            sigma_azimuth: 0.01,
            sigma_elevation: 0.0,
            reliability: Reliability::default(),
        }
    }

    /// 5 m/s ahead, turning left by 0.4 rad/s: the radar, 3 m ahead of the origin, moves with (5, 0.4 * 3). A wall
    /// ahead comes nearer at 5 m/s, one to the left at 1.2 m/s.
    fn turning() -> EgoMotion {
        EgoMotion::new(vec![OdometrySample { t_ns: 0, velocity: 5.0, yaw_rate: 0.4 }], vec![]).unwrap()
    }

    const AHEAD_AND_LEFT: [[f32; 2]; 2] = [[10.0, 0.0], [0.0, 10.0]];

    fn doppler(field: &[&str], rates: &[[f32; 2]]) -> Option<Doppler> {
        let radar = radar(&[&["x", "y"], field].concat());
        let columns = AHEAD_AND_LEFT.iter().chain(rates).map(|column| column.to_vec()).collect();
        Doppler::new(&radar, &RadarScan::new(&radar, 0, columns).unwrap(), &turning())
    }

    fn close(found: &[f64], expected: [f64; 2]) {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{found:?} {expected:?}");
    }

    #[test]
    fn what_stands_still_has_no_compensated_doppler() {
        let found = doppler(&["doppler"], &[[-5.0, -1.2]]).unwrap();
        close(&found.raw, [-5.0, -1.2]);
        close(&found.compensated, [0.0, 0.0]);
    }

    #[test]
    fn a_recorded_value_is_taken_as_it_is_and_gives_the_other() {
        let found = doppler(&["doppler_compensated"], &[[2.5, 0.0]]).unwrap();
        assert_eq!(found.compensated, [2.5, 0.0]);
        close(&found.raw, [-2.5, -1.2]);
        let both = doppler(&["doppler", "doppler_compensated"], &[[7.0, 8.0], [1.0, 2.0]]).unwrap();
        assert_eq!((both.raw, both.compensated), (vec![7.0, 8.0], vec![1.0, 2.0]));
    }

    #[test]
    fn a_detection_may_lack_one_of_them() {
        let found =
            doppler(&["doppler", "doppler_compensated"], &[[-5.0, f32::NAN], [f32::NAN, 2.0]]).unwrap();
        close(&found.raw, [-5.0, 0.8]);
        close(&found.compensated, [0.0, 2.0]);
        let none = doppler(&["doppler", "doppler_compensated"], &[[f32::NAN; 2]; 2]).unwrap();
        assert!(none.raw.iter().chain(&none.compensated).all(|rate| rate.is_nan()));
    }

    #[test]
    fn a_radar_that_measures_no_rate_has_none() {
        assert_eq!(doppler(&[], &[]), None);
    }
}
