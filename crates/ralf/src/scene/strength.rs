//! How strong the echoes of a scan were, with and without what distance does to them.

use super::ordered::Ordered;
use crate::sensors::{AmplitudeKind, Radar, RadarScan};

/// An echo from nearer than this is taken for one from there, m: a range of zero has no logarithm.
const NEAREST: f64 = 0.1;

/// The strengths of a scan's echoes, dB: one per detection, NaN where none was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Strength {
    /// What reflected: the radar cross-section, but for a constant of the radar.
    pub cross_section: Vec<f64>,
    /// What came back, but for a constant of the radar.
    pub power: Vec<f64>,
    /// The power by range, m.
    pub power_by_range: Ordered<f64>,
}

impl Strength {
    /// The strengths of a radar's scan, by the field that [`Radar::amplitude`] names. The radar equation gives the
    /// other quantity: `power = cross_section - 40 log10(r / 1 m)`. `None` where the radar measures no strength.
    pub fn new(radar: &Radar, scan: &RadarScan) -> Option<Self> {
        let field = radar.amplitude()?;
        let measured: Vec<f64> = scan.columns[field.column].iter().copied().map(f64::from).collect();
        let losses =
            scan.spherical.iter().map(|place| 40.0 * place.range.clamp(NEAREST, f64::INFINITY).log10());
        let (cross_section, power) = match field.kind {
            AmplitudeKind::CrossSection => {
                let power = measured.iter().zip(losses).map(|(rcs, loss)| rcs - loss).collect();
                (measured, power)
            }
            AmplitudeKind::Power => {
                let cross_section = measured.iter().zip(losses).map(|(power, loss)| power + loss).collect();
                (cross_section, measured)
            }
        };
        let power_by_range =
            Ordered::new(scan.spherical.iter().map(|place| place.range), power.iter().copied());
        Some(Self { cross_section, power, power_by_range })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensors::{Elevation, Reliability};
    use crate::space::Transform;

    fn strength(field: &str) -> Option<Strength> {
        let radar = Radar {
            name: "front".into(),
            fields: ["range", "azimuth", field].map(str::to_owned).into(),
            vehicle_from_radar: Transform::identity(),
            elevation: Elevation::None,
            fov_azimuth: 2.0,
            fov_elevation: 0.3,
            sigma_range: 0.1,
            sigma_azimuth: 0.01,
            sigma_elevation: 0.0,
            reliability: Reliability::default(),
        };
        let columns = vec![vec![10.0, 100.0, 0.0], vec![0.0; 3], vec![5.0, f32::NAN, 7.0]];
        Strength::new(&radar, &RadarScan::new(&radar, 0, columns).unwrap())
    }

    #[test]
    fn the_radar_equation_gives_the_other_quantity() {
        let of_rcs = strength("RCS").unwrap();
        assert_eq!((of_rcs.cross_section[0], of_rcs.power[0]), (5.0, -35.0));
        let of_power = strength("power").unwrap();
        assert_eq!((of_power.cross_section[0], of_power.power[0]), (45.0, 5.0));
        assert!(of_rcs.power[1].is_nan() && of_power.cross_section[1].is_nan());
        // From 0.1 m the loss is -40 dB.
        assert_eq!(of_rcs.power[2], 47.0);
    }

    #[test]
    fn a_radar_without_a_field_of_strength_has_none() {
        assert_eq!(strength("doppler"), None);
    }
}
