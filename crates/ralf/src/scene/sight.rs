//! What a radar could have seen in one of its scans.
//!
//! Fields of view are stated coarsely, and how far a radar sees depends on the direction and on what is there. So its
//! reach in a direction is taken from what it detected there in the scans at hand.

use super::farthest::{SECTORS, sector, sectors};
use super::located::LocatedScan;
use super::neighbouring::NeighbouringScan;
use super::rays::direction_of;
use crate::sensors::Radar;
use crate::space::{LANES, ManyTransforms, Point, Transform, Vector};

/// How far a radar reaches in each direction, m; nowhere until it has seen something.
#[derive(Debug, Clone, PartialEq)]
pub struct Reach([Option<f64>; SECTORS]);

impl Reach {
    /// The reach of a radar that made these scans: as far as its farthest detection in a sector of 10 degrees or in
    /// those beside it.
    pub fn of_scans<'a>(radar: &Radar, scans: impl Iterator<Item = &'a LocatedScan>) -> Self {
        let mut farthest = [f64::NEG_INFINITY; SECTORS];
        for scan in scans {
            for (known, found) in farthest.iter_mut().zip(scan.farthest(radar).by_sector) {
                *known = known.max(found);
            }
        }
        let beside = |sector: usize| {
            let around = [SECTORS - 1, 0, 1].map(|step| farthest[(sector + step) % SECTORS]);
            Some(around.into_iter().fold(f64::NEG_INFINITY, f64::max))
                .filter(|reach| *reach > f64::NEG_INFINITY)
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

    /// Whether a place of a sector at a range, m, is in reach; `None` where that hangs on by how much the range may be
    /// off, which is at most twice the slack, m, and a rounding.
    fn reaches(&self, sector: usize, range: f32, slack: f32) -> Option<bool> {
        const ROUNDING: f32 = 1e-5;
        let Some(reach) = self.reach.0[sector] else { return Some(false) };
        let (over, open) = (range - reach as f32, 2.0 * slack + ROUNDING * range);
        if over < -open {
            Some(true)
        } else if over > open {
            Some(false)
        } else {
            None
        }
    }
}

/// Radars at the times of many scans, to be asked together.
#[derive(Debug)]
pub struct Sights<'a> {
    sights: Vec<Sight<'a>>,
    /// After the reference scan's time, s.
    seconds: Vec<f64>,
    radars_from_vehicle: ManyTransforms,
}

impl<'a> Sights<'a> {
    /// Radars at the times of scans, s after the reference scan's.
    pub fn new(timed: impl Iterator<Item = (Sight<'a>, f64)>) -> Self {
        let (sights, seconds): (Vec<Sight>, Vec<f64>) = timed.unzip();
        let transforms: Vec<Transform> = sights.iter().map(|sight| sight.radar_from_vehicle).collect();
        let radars_from_vehicle = ManyTransforms::new(&transforms, &seconds);
        Self { sights, seconds, radars_from_vehicle }
    }

    /// How long after the reference scan one of the scans was made, s.
    pub fn seconds(&self, scan: usize) -> f64 {
        self.seconds[scan]
    }

    /// Tells of each scan, by its number, whether its radar could have seen what is at a place at the reference
    /// scan's time and moves at this velocity, m/s: what [`Sight::covers`] says, which is only asked where single
    /// precision leaves it open.
    pub fn each(&self, p: &Point, velocity: &Vector, mut tell: impl FnMut(usize, bool)) {
        let slack = self.radars_from_vehicle.slack(p, velocity) as f32;
        let mut scan = 0;
        for (sights, [x, y, z]) in self.sights.chunks(LANES).zip(self.radars_from_vehicle.of(p, velocity)) {
            let ranges = (x * x + y * y + z * z).sqrt().to_array();
            let [x, y] = [x, y].map(|axis| axis.to_array());
            let azimuths: [f32; LANES] = std::array::from_fn(|lane| direction_of(x[lane], y[lane], 0.0).0);
            for (lane, sight) in sights.iter().enumerate() {
                let [x, y, range] = [x[lane], y[lane], ranges[lane]];
                let is_clear = x * x + y * y > (NEAR_SLACKS * slack) * (NEAR_SLACKS * slack);
                let known = clear_sector(azimuths[lane].into()).filter(|_| is_clear);
                let covered = known
                    .and_then(|sector| sight.reaches(sector, range, slack))
                    .unwrap_or_else(|| sight.covers(&(p + velocity * self.seconds[scan])));
                tell(scan, covered);
                scan += 1;
            }
        }
    }
}

/// What is nearer to a radar than so many times what its place may be off by has no sure azimuth.
const NEAR_SLACKS: f32 = 2e4;

/// The sector of a place as the radar sees it: by its exact azimuth where the quick one lies at a sector's border.
fn sector_of(p: &Point) -> usize {
    let quick = direction_of(p.x as f32, p.y as f32, 0.0).0;
    clear_sector(quick.into()).unwrap_or_else(|| sector(p.y.atan2(p.x)))
}

/// The sector of a quick azimuth, rad, unless it lies at a sector's border.
fn clear_sector(quick: f64) -> Option<usize> {
    /// More than the quick azimuth is off by, in sectors.
    const BORDER: f64 = 1e-3;
    let quick = sectors(quick);
    let inside = quick > BORDER && (quick.fract() - 0.5).abs() < 0.5 - BORDER;
    inside.then_some(quick as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

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

    proptest! {
        #[test]
        fn many_radars_see_what_each_of_them_sees(
            mountings in prop::collection::vec((prop::array::uniform3(-9f64..9.0), -3f64..3.0, -1f64..1.0), 1..20),
            velocity in prop_oneof![Just([0.0; 3]), prop::array::uniform3(-70f64..70.0)],
            reaches in prop::array::uniform12(prop_oneof![1 => Just(None), 3 => (0.0f64..40.0).prop_map(Some)]),
            places in prop::collection::vec((prop::array::uniform3(-30f64..30.0), any::<prop::sample::Index>(), -1e-4f64..1e-4), 20),
        ) {
            let reach = Reach(std::array::from_fn(|sector| reaches[sector / 3]));
            let sights: Vec<(Sight, f64)> = mountings.into_iter().map(|(offset, turn, seconds)| {
                let radar_from_vehicle = Transform::new(offset.into(), Vector::new(0.0, 0.0, turn));
                (Sight { radar_from_vehicle, reach: &reach }, seconds)
            }).collect();
            let many = Sights::new(sights.iter().cloned());
            let velocity = Vector::from(velocity);
            for (place, which, beside) in places {
                // Anywhere, at the very radar, and at the border of what it reaches.
                let (sight, seconds) = &sights[which.index(sights.len())];
                let direction = Vector::from(place).normalize();
                let border = Point::from(direction * (reaches[3].unwrap_or(7.0) + beside));
                let at_border = sight.radar_from_vehicle.inverse() * border;
                let at_radar = Point::from(sight.radar_from_vehicle.inverse().translation.vector + direction * beside);
                for there in [Point::from(place), at_border, at_radar] {
                    let p = there - velocity * *seconds;
                    let mut told = Vec::new();
                    many.each(&p, &velocity, |scan, covered| told.push((scan, covered)));
                    let covered = |(sight, seconds): &(Sight, f64)| sight.covers(&(p + velocity * *seconds));
                    let expected: Vec<(usize, bool)> = sights.iter().map(covered).enumerate().collect();
                    prop_assert_eq!(told, expected);
                }
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
