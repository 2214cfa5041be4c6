//! How far a radar saw in one scan, direction by direction.

use crate::sensors::{Radar, RadarScan};
use std::f64::consts::PI;

/// Directions are told apart by so many sectors, of 10 degrees each.
pub(super) const SECTORS: usize = 36;
/// A place as far as the farthest detection may be measured a little farther: by so many standard deviations.
const SIGMAS: f64 = 3.0;

/// How far a radar saw in each direction in one scan, m; minus infinity where it saw nothing.
#[derive(Debug, Clone)]
pub(super) struct Farthest {
    pub(super) by_sector: [f64; SECTORS],
}

impl Farthest {
    pub(super) fn new(radar: &Radar, scan: &RadarScan) -> Self {
        let mut farthest = [f64::NEG_INFINITY; SECTORS];
        for place in &scan.spherical {
            if place.range.is_finite() && place.azimuth.is_finite() {
                let known = &mut farthest[sector(place.azimuth)];
                *known = known.max(0.0).max(place.range + SIGMAS * radar.sigma_range);
            }
        }
        Self { by_sector: farthest }
    }
}

/// The sector of an azimuth, rad.
pub(super) fn sector(azimuth: f64) -> usize {
    (sectors(azimuth) as usize).min(SECTORS - 1)
}

/// From the first sector's begin to an azimuth, rad, in sectors.
pub(super) fn sectors(azimuth: f64) -> f64 {
    (azimuth + PI) / (2.0 * PI) * SECTORS as f64
}
