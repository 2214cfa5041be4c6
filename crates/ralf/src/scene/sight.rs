//! What a radar could have seen in one of its scans.
//!
//! Fields of view are stated coarsely, and how far a radar sees depends on the direction and on what is there. So its
//! reach in a direction is taken from what it detected there in the scans at hand.

use super::neighbouring::NeighbouringScan;
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
        self.reach.0[sector(p.y.atan2(p.x))].is_some_and(|reach| p.coords.norm_squared() <= reach * reach)
    }
}

/// The sector of an azimuth, rad.
fn sector(azimuth: f64) -> usize {
    let turn = (azimuth + PI) / (2.0 * PI);
    ((turn * SECTORS as f64) as usize).min(SECTORS - 1)
}
