//! What a radar could have seen in one of its scans.
//!
//! Fields of view are stated coarsely, and range depends on direction; so a radar's reach in a direction is how far away
//! it detected anything there in any of the scans at hand.

use crate::scene::{Frame, NeighbouringScan};
use crate::space::{Point, Spherical, Transform};
use std::f64::consts::PI;

/// Directions are told apart by so many sectors, of 10 degrees each.
const SECTORS: usize = 36;

/// What was detected farthest away lies within reach in its own scan, whatever is rounded, m.
const SLACK: f64 = 0.1;

/// How far a radar reaches in each direction, m; 0 where it detected nothing.
#[derive(Debug, Clone, PartialEq)]
struct Reach([f64; SECTORS]);

/// One radar at the time of one scan.
pub(super) struct Sight {
    /// Whether it is the radar of the frame's scan.
    pub(super) own: bool,
    /// Where the radar was, in the vehicle frame at the frame's time, m.
    pub(super) origin: Point,
    radar_from_vehicle: Transform,
    reach: Reach,
}

impl Sight {
    /// The radars at the times of a frame's `radar_window`, one entry per scan.
    pub(super) fn of_window(frame: &Frame) -> Vec<Self> {
        let mut reaches = vec![Reach::nothing(); frame.rig.radars.len()];
        for neighbour in &frame.radar_window {
            reaches[neighbour.radar].add(&neighbour.scan.measured.spherical);
        }
        for (radar, reach) in reaches.iter_mut().enumerate() {
            if frame.is_own(radar) {
                reach.add(&frame.scan.measured.spherical);
            }
            *reach = reach.with_neighbours();
        }
        let sight = |neighbour: &NeighbouringScan| {
            let mounting = frame.rig.radars[neighbour.radar].vehicle_from_radar;
            let vehicle_from_radar = neighbour.vehicle_from_scan * mounting;
            Self {
                own: frame.is_own(neighbour.radar),
                origin: Point::from(vehicle_from_radar.translation.vector),
                radar_from_vehicle: vehicle_from_radar.inverse(),
                reach: reaches[neighbour.radar].clone(),
            }
        };
        frame.radar_window.iter().map(sight).collect()
    }

    /// Whether the radar could have seen a point (vehicle frame at the frame's time).
    pub(super) fn covers(&self, p: &Point) -> bool {
        let p = self.radar_from_vehicle * p;
        let reach = self.reach.0[sector(p.y.atan2(p.x))];
        reach > 0.0 && p.coords.norm() <= reach + SLACK
    }
}

impl Reach {
    fn nothing() -> Self {
        Self([0.0; SECTORS])
    }

    fn add(&mut self, places: &[Spherical]) {
        for place in places.iter().filter(|place| place.range.is_finite() && place.azimuth.is_finite()) {
            let reach = &mut self.0[sector(place.azimuth)];
            *reach = reach.max(place.range);
        }
    }

    /// The same where each sector reaches as far as those beside it.
    fn with_neighbours(&self) -> Self {
        let at = |sector: usize| self.0[sector % SECTORS];
        Self(std::array::from_fn(|i| at(i).max(at(i + 1)).max(at(i + SECTORS - 1))))
    }
}

/// The sector of an azimuth, rad; the first where it is no number.
fn sector(azimuth: f64) -> usize {
    let share = (azimuth + PI) / (2.0 * PI);
    ((share * SECTORS as f64) as usize).min(SECTORS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(rows: &[(f64, f64)]) -> Reach {
        let mut reach = Reach::nothing();
        let place = |&(range, degrees): &(f64, f64)| Spherical {
            range,
            azimuth: f64::to_radians(degrees),
            elevation: 0.0,
        };
        reach.add(&rows.iter().map(place).collect::<Vec<_>>());
        reach.with_neighbours()
    }

    #[test]
    fn a_radar_reaches_as_far_as_it_detected_in_the_sector_and_those_beside() {
        // Sectors begin at -180 degrees: 15 degrees lies in that from 10 to 20.
        let sight = Sight {
            own: true,
            origin: Point::new(2.0, 0.0, 0.0),
            radar_from_vehicle: Transform::translation(-2.0, 0.0, 0.0),
            reach: seen(&[(30.0, 15.0), (20.0, 15.0), (f64::NAN, 95.0), (9.0, -179.0)]),
        };
        let at = |range: f64, degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            sight.covers(&Point::new(2.0 + range * cos, range * sin, 0.0))
        };
        assert!(at(29.9, 1.0) && at(29.9, 29.0) && !at(30.2, 15.0));
        assert!(!at(1.0, 31.0) && !at(1.0, -1.0) && !at(1.0, 95.0));
        assert!(at(8.9, -165.0) && at(8.9, 175.0) && !at(8.9, 165.0), "all the way round");
    }
}
