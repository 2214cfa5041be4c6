//! The ground that a LiDAR sees: how far it is tilted and shifted against the vehicle's z = 0.

use crate::thinning::some;
use ralf::config::{GroundConfig, GroundModel};
use ralf::scene::Ground;
use ralf::space::Point;

/// Points that a fit looks at.
const POINTS: usize = 6000;
/// A wrong mounting may be off by so much: what the labeler itself would no longer take for the ground is found as
/// well.
const WIDEST: (f64, f64) = (20.0, 3.0);
/// A point this close to the plane supports it, m.
const CLOSE: f64 = 0.15;
/// Beams at the horizon hit walls all around at one height, which looks like a plane: points have to lie this far
/// below, as a slope.
const BELOW: f64 = 0.06;
/// So far below the plane, m, lies at most this share of the points.
const UNDER: (f64, f64) = (0.3, 0.08);
/// Only within this distance of the vehicle is the road a plane, m.
const NEAR: f64 = 25.0;
/// The vehicle's own path is so wide to either side, m.
const PATH: f64 = 2.0;
/// A bank beside a road may hold more points than the road. It isn't what the vehicle drives on where so many times as
/// many points of its path lie near z = 0.
const DRIVEN_ON: f64 = 1.5;

/// Roads are cambered by two degrees, and vehicles pitch by one: more is the mounting's, degrees.
pub(crate) const TILT_DEG: f64 = 2.0;
/// z = 0 is the road within, m: loaded vehicles sink by a decimetre.
pub(crate) const OFFSET: f64 = 0.2;
/// Less of what is nearby on the plane is no ground.
pub(crate) const SUPPORT: f64 = 0.15;

/// A plane through the ground.
#[derive(Debug, Clone)]
pub(crate) struct GroundFit {
    ground: Ground,
    /// Rise towards the front and to the left, rad.
    pub(crate) slope: [f64; 2],
    /// Height of the plane at the vehicle's origin, m.
    pub(crate) offset: f64,
    /// Share of the points nearby that lie on it.
    pub(crate) support: f64,
}

impl GroundFit {
    /// Height above the plane, m.
    pub(crate) fn height(&self, p: &Point) -> f64 {
        self.ground.height(p)
    }

    /// Whether a point lies on the plane.
    pub(crate) fn is_on(&self, p: &Point) -> bool {
        self.height(p).abs() < CLOSE
    }
}

/// The plane with the most LiDAR points (vehicle frame, m) of a LiDAR at a place, unless the vehicle's own path lies on
/// another one near z = 0; `None` where none is found.
pub(crate) fn fit(points: &[Point], lidar: &Point) -> Option<GroundFit> {
    let near: Vec<[f32; 3]> = points
        .iter()
        .filter(|p| p.coords.xy().norm() < NEAR && lidar.z - p.z > BELOW * (*p - lidar).xy().norm())
        .map(|p| [p.x as f32, p.y as f32, p.z as f32])
        .collect();
    let thin: Vec<[f32; 3]> = some(&near, POINTS).copied().collect();
    let widest = plane(&thin, WIDEST)?;
    let path: Vec<[f32; 3]> = thin.iter().filter(|p| f64::from(p[1].abs()) < PATH).copied().collect();
    let is_driven_on = |road: &Ground| on(road, &path) as f64 > DRIVEN_ON * on(&widest, &path).max(1) as f64;
    let ground = plane(&thin, (TILT_DEG, OFFSET)).filter(is_driven_on).unwrap_or(widest);
    // Upright, where heights over the plane are told at right angles to it.
    let upright = ground.height(&Point::new(0.0, 0.0, 1.0)) - ground.height(&Point::origin());
    let height = |x: f64, y: f64| -ground.height(&Point::new(x, y, 0.0)) / upright;
    let offset = height(0.0, 0.0);
    let slope = [height(1.0, 0.0) - offset, height(0.0, 1.0) - offset].map(f64::atan);
    // Nothing lies under the road: what has more below it is a band on walls.
    let below = thin.iter().filter(|p| height_over(&ground, p) < -UNDER.0).count();
    if below as f64 > UNDER.1 * thin.len() as f64 {
        return None;
    }
    let support = on(&ground, &thin) as f64 / thin.len().max(1) as f64;
    Some(GroundFit { ground, slope, offset, support })
}

/// The plane with the most points that is tilted and shifted by so much at most, degrees and m.
fn plane(points: &[[f32; 3]], (max_tilt_deg, max_offset): (f64, f64)) -> Option<Ground> {
    let model = GroundModel::Plane;
    let config =
        GroundConfig { model, max_tilt_deg, max_offset, inlier_distance: CLOSE, ..GroundConfig::default() };
    Ground::fit(points, &config, 0)
}

fn height_over(ground: &Ground, &[x, y, z]: &[f32; 3]) -> f64 {
    ground.height(&Point::new(x.into(), y.into(), z.into()))
}

/// How many points lie on a plane.
fn on(ground: &Ground, points: &[[f32; 3]]) -> usize {
    points.iter().filter(|p| height_over(ground, p).abs() < CLOSE).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_road_that_rises_by_three_degrees_is_told() {
        let slope = 3.0_f64.to_radians().tan();
        let road = (0..900).map(|i| [f64::from(i % 30) - 15.0, f64::from(i / 30) - 15.0]);
        let points: Vec<Point> = road.map(|[x, y]| Point::new(x, y, 0.2 + slope * x)).collect();
        let found = fit(&points, &Point::new(0.0, 0.0, 2.0)).unwrap();
        assert!((found.slope[0].to_degrees() - 3.0).abs() < 0.1 && found.slope[1].abs() < 0.002, "{found:?}");
        assert!((found.offset - 0.2).abs() < 0.01 && found.support > 0.99);
    }

    /// A road 8 m wide, and beside it a bank that rises by 16 degrees and holds three times as many points.
    #[test]
    fn the_road_is_what_the_vehicle_drives_on_and_not_the_bank_beside_it() {
        let rise = 16.0_f64.to_radians().tan();
        let (mut points, lidar) = (Vec::new(), Point::new(0.0, 0.0, 3.0));
        for x in (-200..200).map(|i| f64::from(i) * 0.1) {
            points.extend((-4..=4).map(|y| Point::new(x, f64::from(y), 0.0)));
            points.extend((0..27).map(|i| f64::from(i) * 0.25).map(|y| Point::new(x, -4.0 - y, rise * y)));
        }
        let found = fit(&points, &lidar).unwrap();
        // The foot of the bank belongs to it, within the limits of a road.
        let is_level = found.slope.iter().all(|rise| rise.to_degrees().abs() < TILT_DEG);
        assert!(is_level && found.offset.abs() < 0.05, "{found:?}");
        // A LiDAR that is tilted so sees the vehicle's own path tilted, too.
        let road = points.iter().filter(|p| p.z == 0.0).map(|p| Point::new(p.x, p.y, rise * p.y));
        let tilted = fit(&road.collect::<Vec<_>>(), &lidar).unwrap();
        assert!((tilted.slope[1].to_degrees() - 16.0).abs() < 0.1, "{tilted:?}");
    }

    #[test]
    fn no_points_have_no_ground() {
        assert!(fit(&[], &Point::origin()).is_none());
    }
}
