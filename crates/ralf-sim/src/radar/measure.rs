//! From echoes to what the radar reports.

use super::{Echo, View};
use crate::random::Random;
use crate::truth::Truth;
use ralf::sensors::{Radar, RadarScan};
use ralf::space::{Point, Spherical};

/// Standard deviation of a range rate, m/s.
const RANGE_RATE_SIGMA: f64 = 0.06;

/// A detection and what is true of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Detection {
    /// As measured, in the radar's frame.
    position: Point,
    range_rate: f64,
    strength_db: f64,
    pub(crate) truth: Truth,
    /// Without the errors of measuring, in the radar's frame.
    #[cfg(test)]
    pub(crate) origin: Point,
}

/// Measures echoes with the radar's uncertainties; those outside its field of view are lost. The order is that of
/// range.
pub(super) fn measured(view: &View<'_>, echoes: &[Echo], random: &mut Random) -> Vec<Detection> {
    let radar = view.radar;
    let mut one = |echo: &Echo| {
        let origin = view.site_from_radar.inverse_transform_point(&echo.position);
        let exact = Spherical::from_cartesian(&origin);
        let noisy = Spherical {
            range: exact.range + random.normal(radar.sigma_range),
            azimuth: exact.azimuth + random.normal(radar.sigma_azimuth),
            elevation: exact.elevation + random.normal(radar.sigma_elevation),
        };
        let detection = Detection {
            position: noisy.to_cartesian(),
            range_rate: echo.range_rate + random.normal(RANGE_RATE_SIGMA),
            strength_db: echo.level_db,
            truth: echo.truth,
            #[cfg(test)]
            origin,
        };
        let inside = noisy.range > 0.1
            && noisy.azimuth.abs() <= radar.fov_azimuth / 2.0
            && noisy.elevation.abs() <= radar.fov_elevation / 2.0;
        inside.then_some((noisy.range, detection))
    };
    let mut found: Vec<(f64, Detection)> = echoes.iter().filter_map(&mut one).collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, detection)| detection).collect()
}

/// The scan as it lies in a file: x, y, z, doppler, rcs.
pub(crate) fn radar_scan(radar: &Radar, t_ns: i64, detections: &[Detection]) -> Result<RadarScan, String> {
    let column = |value: fn(&Detection) -> f64| detections.iter().map(|d| value(d) as f32).collect();
    let columns = vec![
        column(|d| d.position.x),
        column(|d| d.position.y),
        column(|d| d.position.z),
        column(|d| d.range_rate),
        column(|d| d.strength_db),
    ];
    RadarScan::new(radar, t_ns, columns)
}
