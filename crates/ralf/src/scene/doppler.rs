//! The range rate of a detection without the vehicle's own motion.

use crate::sensors::{Radar, RadarScan};
use crate::space::{EgoMotion, Vector};

/// Ego-compensated range rates of a scan, m/s, positive when receding: the field `doppler_compensated` where the radar
/// has it, else `doppler` plus the radial part of the radar's own velocity, `u . (v + omega x t)`. `None` where it has
/// neither.
pub fn compensated_doppler(radar: &Radar, scan: &RadarScan, motion: &EgoMotion) -> Option<Vec<f64>> {
    if let Some(column) = radar.column("doppler_compensated") {
        return Some(scan.columns[column].iter().copied().map(f64::from).collect());
    }
    let raw = &scan.columns[radar.column("doppler")?];
    let (velocity, turn) = motion.twist(scan.t_ns);
    let mount = &radar.vehicle_from_radar;
    let of_radar: Vector = mount.rotation.inverse() * (velocity + turn.cross(&mount.translation.vector));
    let compensated = |(doppler, position): (&f32, &crate::space::Point)| {
        let along = position.coords.try_normalize(0.0).map_or(0.0, |ray| ray.dot(&of_radar));
        f64::from(*doppler) + along
    };
    Some(raw.iter().zip(&scan.positions).map(compensated).collect())
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

    #[test]
    fn what_stands_still_has_no_compensated_doppler() {
        let radar = radar(&["x", "y", "doppler"]);
        let motion =
            EgoMotion::new(vec![OdometrySample { t_ns: 0, velocity: 5.0, yaw_rate: 0.4 }], vec![]).unwrap();
        // The radar moves with (5, 0.4 * 3): a wall ahead comes nearer at 5 m/s, one to the left at 1.2 m/s.
        let columns = vec![vec![10.0, 0.0], vec![0.0, 10.0], vec![-5.0, -1.2]];
        let scan = RadarScan::new(&radar, 0, columns).unwrap();
        let compensated = compensated_doppler(&radar, &scan, &motion).unwrap();
        assert!(compensated.iter().all(|v| v.abs() < 1e-6), "{compensated:?}");
    }

    #[test]
    fn a_recorded_value_is_taken_as_it_is() {
        let motion =
            EgoMotion::new(vec![OdometrySample { t_ns: 0, velocity: 5.0, yaw_rate: 0.0 }], vec![]).unwrap();
        let with = radar(&["x", "y", "doppler_compensated"]);
        let scan = RadarScan::new(&with, 0, vec![vec![1.0], vec![0.0], vec![2.5]]).unwrap();
        assert_eq!(compensated_doppler(&with, &scan, &motion), Some(vec![2.5]));
        let without = radar(&["x", "y"]);
        let scan = RadarScan::new(&without, 0, vec![vec![1.0], vec![0.0]]).unwrap();
        assert_eq!(compensated_doppler(&without, &scan, &motion), None);
    }
}
