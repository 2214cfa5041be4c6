//! What a radar could have seen in one of its scans.
//!
//! Fields of view are stated coarsely, and how far a radar sees depends on the direction and on what is there. So its
//! reach in a direction is taken from what it detected there in the scans at hand.

use super::neighbouring::NeighbouringScan;
use super::rays::direction_of;
use crate::sensors::{Radar, RadarScan};
use crate::space::{Point, Transform};
use std::f64::consts::PI;

/// Directions are told apart by so many sectors, of 10 degrees each.
const SECTORS: usize = 36;
/// A place as far as the farthest detection may be measured a little farther: by so many standard deviations.
const SIGMAS: f64 = 3.0;

/// How far a radar reaches in each direction, m; nowhere until it has seen something.
#[derive(Debug, Clone, PartialEq)]
pub struct Reach([Option<f64>; SECTORS]);

impl Reach {
    /// The reach of a radar that made these scans: as far as its farthest detection in a sector of 10 degrees or in
    /// those beside it.
    pub fn of_scans<'a>(radar: &Radar, scans: impl Iterator<Item = &'a RadarScan>) -> Self {
        let mut farthest = [None; SECTORS];
        for place in scans.flat_map(|scan| &scan.spherical) {
            if place.range.is_finite() && place.azimuth.is_finite() {
                let known: &mut Option<f64> = &mut farthest[sector(place.azimuth)];
                *known = Some(known.unwrap_or(0.0).max(place.range + SIGMAS * radar.sigma_range));
            }
        }
        let beside = |sector: usize| {
            let around = [SECTORS - 1, 0, 1].map(|step| farthest[(sector + step) % SECTORS]);
            around.into_iter().flatten().reduce(f64::max)
        };
        Self(std::array::from_fn(beside))
    }
}

/// A radar at the time of one scan.
#[derive(Debug, Clone)]
pub struct Sight<'a> {
    radar_from_vehicle: Transform,
    reach: &'a Reach,
}

impl<'a> Sight<'a> {
    /// The radar that made a neighbouring scan, in the vehicle frame at the reference scan's time.
    pub fn new(radar: &Radar, scan: &NeighbouringScan, reach: &'a Reach) -> Self {
        let radar_from_vehicle = (scan.vehicle_from_scan * radar.vehicle_from_radar).inverse();
        Self { radar_from_vehicle, reach }
    }

    /// Whether it could have seen a place, if something was there.
    pub fn covers(&self, p: &Point) -> bool {
        let p = self.radar_from_vehicle * p;
        self.reach.0[sector_of(&p)].is_some_and(|reach| p.coords.norm_squared() <= reach * reach)
    }
}

/// The sector of an azimuth, rad.
fn sector(azimuth: f64) -> usize {
    (sectors(azimuth) as usize).min(SECTORS - 1)
}

/// From the first sector's begin to an azimuth, rad, in sectors.
fn sectors(azimuth: f64) -> f64 {
    (azimuth + PI) / (2.0 * PI) * SECTORS as f64
}

/// The sector of a place as the radar sees it: by its exact azimuth where the quick one lies at a sector's border.
fn sector_of(p: &Point) -> usize {
    /// More than the quick azimuth is off by, in sectors.
    const BORDER: f64 = 1e-3;
    let quick = sectors(direction_of(p.x as f32, p.y as f32, 0.0).0.into());
    let inside = quick > BORDER && (quick.fract() - 0.5).abs() < 0.5 - BORDER;
    if inside { quick as usize } else { sector(p.y.atan2(p.x)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_sector_is_that_of_the_exact_azimuth(
            x in -9.0f64..9.0, y in -9.0f64..9.0, border in -18i32..19, aside in -1e-5f64..1e-5,
        ) {
            let azimuth = f64::from(border) * PI / 18.0 + aside;
            for (x, y) in [(x, y), (0.0, y), (x, 0.0), (-x, -0.0), (20.0 * azimuth.cos(), 20.0 * azimuth.sin())] {
                prop_assert_eq!(sector_of(&Point::new(x, y, 1.0)), sector(y.atan2(x)));
            }
        }
    }

    #[test]
    fn what_is_no_direction_has_a_sector_all_the_same() {
        for (x, y) in [(0.0f64, 0.0f64), (-0.0, 0.0), (-0.0, -0.0), (f64::NAN, 1.0), (1e300, -1e300)] {
            assert_eq!(sector_of(&Point::new(x, y, 0.0)), sector(y.atan2(x)));
        }
    }
}
