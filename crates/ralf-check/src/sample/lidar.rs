//! What is kept of a LiDAR's scan.

use super::digest;
use super::shape::CloudShape;
use crate::ground::{self, GroundFit};
use crate::misread::{Misread, misread};
use crate::picture::{DepthEdge, FEWEST_IMAGES, Moment, depth_edges};
use crate::plan_field::PlanField;
use crate::thinning::{returns, some};
use ralf::sensors::{LidarScan, Source};
use ralf::space::Point;

/// Points kept of a LiDAR scan.
const LIDAR_POINTS: usize = 60_000;
/// What stands between these heights above the ground is an obstacle that a radar sees as well, m.
const OBSTACLES: std::ops::Range<f64> = 0.4..3.0;
/// Which quantile of the beams' slopes counts as the steepest, so that a few odd points don't; of about so many points.
const STEEPEST: (f64, usize) = (0.98, 2000);
/// What a LiDAR sees nearer than this may be its own vehicle, m.
const VEHICLE: f64 = 3.0;
/// Points are put to one moment of a turn, from so much before or after at most, s: LiDARs turn ten times a second.
const TURN_S: f64 = 0.1;
/// Points kept to be sought in images.
const SEEN: usize = 6000;
/// Obstacles kept to be sought in another scan.
const PROBES: usize = 800;

/// A LiDAR's scan.
#[derive(Debug, Clone)]
pub(crate) struct LidarLook {
    pub(crate) lidar: usize,
    /// Number in its timeline.
    pub(crate) scan: usize,
    pub(crate) t_ns: i64,
    /// Obstacles above the ground, vehicle frame as recorded, m.
    pub(crate) probes: Vec<Point>,
    /// The same, all of them, by distance.
    pub(crate) field: PlanField,
    pub(crate) ground: Option<GroundFit>,
    /// Where there is no ground: what the scan shows one as.
    pub(crate) misread: Vec<Misread>,
    /// The LiDAR's place (vehicle frame as recorded), and the distance from it in plan, m, at which its steepest beams
    /// come down to where obstacles begin.
    blind: (Point, f64),
    /// How steeply its points lie below it at least, but for some odd ones, where they are no returns from the vehicle
    /// itself, whose directions are off: a slope. A point that was put to one moment of the turn may lie nearer
    /// than it was seen by as much as the vehicle drove meanwhile. None where nothing came back.
    pub(crate) steepest: Option<f64>,
    /// Where things end, for images; empty where there are too few of them.
    pub(crate) edges: Vec<DepthEdge>,
    /// Some of all points, vehicle frame as recorded, m, for stored depth; none where there are too few images.
    seen: Vec<Point>,
    /// Figures of its numbers, which a wrong data type gives away.
    pub(crate) shape: CloudShape,
    pub(crate) digest: u64,
}

impl LidarLook {
    /// Whether a thing at a place (vehicle frame as recorded) is so far away that no lower part of it, such as the nose
    /// of a car, is nearer than what the beams meet.
    pub(crate) fn sees_down_to_the_foot(&self, place: &Point) -> bool {
        let (lidar, blind) = &self.blind;
        (place - lidar).xy().norm() > *blind
    }

    pub(super) fn moment(&self) -> Moment<'_> {
        Moment { lidar: self.lidar, t_ns: self.t_ns, points: &self.seen }
    }

    pub(super) fn of(source: &dyn Source, (lidar, scan): (usize, usize), read: &LidarScan) -> Self {
        let mount = source.sequence().rig.lidars[lidar].vehicle_from_lidar;
        let returns = returns(read.points.iter().copied());
        let kept = some(&returns, LIDAR_POINTS);
        let points: Vec<Point> =
            kept.map(|[x, y, z]| mount * Point::new((*x).into(), (*y).into(), (*z).into())).collect();
        let lidar_at: Point = mount.translation.vector.into();
        let ground = ground::fit(&points, &lidar_at);
        let misread = if ground.is_some() { Vec::new() } else { misread(read, &mount) };
        let height = |p: &Point| ground.as_ref().map_or(p.z, |ground| ground.height(p));
        let obstacles: Vec<&Point> = points.iter().filter(|p| OBSTACLES.contains(&height(p))).collect();
        let images = source.sequence().times.cameras.iter().map(Vec::len).max().unwrap_or(0);
        let stands = |p: &Point| height(p) > OBSTACLES.start;
        let (edges, seen) = match images >= FEWEST_IMAGES {
            true => (depth_edges(&points, &mount, stands), every_so_many(&points, SEEN)),
            false => (Vec::new(), Vec::new()),
        };
        let moved = source.sequence().motion.twist(read.t_ns).0.norm() * TURN_S;
        let away: Vec<Point> = points.iter().filter(|p| (*p - lidar_at).norm() > VEHICLE).copied().collect();
        Self {
            lidar,
            scan,
            t_ns: read.t_ns,
            probes: some(&obstacles, PROBES).map(|p| **p).collect(),
            field: PlanField::new(obstacles.iter().map(|p| [p.x, p.y, p.z])),
            edges,
            seen,
            blind: (lidar_at, blind(steepest(&points, &lidar_at, 0.0), height(&lidar_at))),
            steepest: steepest(&away, &lidar_at, moved),
            ground,
            misread,
            shape: CloudShape::of(&returns, read.points.len()),
            digest: digest(read.points.as_flattened()),
        }
    }
}

/// About so many of the points, evenly. Rows of beams are powers of two: an odd step meets all of them.
fn every_so_many(points: &[Point], count: usize) -> Vec<Point> {
    points.iter().step_by(points.len().div_ceil(count) | 1).copied().collect()
}

/// The slope at which the points of a LiDAR lie below it, but for the steepest few, where each may have been seen from
/// so much farther away, m.
fn steepest(points: &[Point], lidar: &Point, moved: f64) -> Option<f64> {
    let looked = every_so_many(points, STEEPEST.1);
    let slopes: Vec<f64> =
        looked.iter().map(|p| (lidar.z - p.z) / ((p - lidar).xy().norm() + moved).max(1e-3)).collect();
    crate::statistics::quantile(&slopes, STEEPEST.0)
}

/// The distance at which the steepest beams of a LiDAR so high above the ground come down to where obstacles begin, m:
/// 0 where no beam looks down, for nothing is looked over then.
fn blind(steepest: Option<f64>, height: f64) -> f64 {
    match steepest {
        None => f64::INFINITY,
        Some(steepest) if steepest > 0.0 => (height - OBSTACLES.start).max(0.0) / steepest,
        Some(_) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_lidar_drove_towards_was_seen_less_steeply() {
        let (lidar, ahead) = (Point::new(0.0, 0.0, 2.0), vec![Point::new(2.8, 0.0, 0.0); 10]);
        let degrees = |moved: f64| steepest(&ahead, &lidar, moved).unwrap().atan().to_degrees();
        // Seen from 4 m behind, at 26.6 degrees, and put where it lies 1.2 m later.
        assert!((degrees(0.0) - 35.5).abs() < 0.1 && (degrees(1.2) - 26.6).abs() < 0.1);
    }

    #[test]
    fn beams_that_reach_a_road_at_eight_metres_reach_the_height_of_obstacles_before() {
        // Wherever the vehicle frame has its zero.
        for road in [0.0, -2.0, 1.0] {
            let lidar = Point::new(0.0, 0.0, road + 2.0);
            let ring = |z: f64| {
                let angles = (0..2000).map(|i| f64::from(i) * 0.01);
                angles.map(|a| Point::new(8.0 * a.cos(), 8.0 * a.sin(), z)).collect::<Vec<_>>()
            };
            assert!((blind(steepest(&ring(road), &lidar, 0.0), 2.0) - 8.0 * 1.6 / 2.0).abs() < 1e-9);
            assert_eq!(blind(steepest(&ring(road + 2.0), &lidar, 0.0), 2.0), 0.0);
            assert_eq!(blind(steepest(&[], &lidar, 0.0), 2.0), f64::INFINITY);
        }
    }
}
