//! The LiDAR scans of one moment: their ground and their reference cloud, shared by all radars that use them.

use super::ground::Ground;
use super::mismatch::{Reference, Spread};
use crate::config::GroundConfig;
use crate::sensors::{Lidar, LidarScan, Radar, is_return};
use crate::space::{NeighborIndex, Point, Transform};
use std::sync::{Arc, OnceLock};

/// One LiDAR's part in a moment.
#[derive(Debug)]
struct Part {
    scan: Arc<LidarScan>,
    /// Of the moment's vehicle frame.
    moment_from_lidar: Transform,
    sigma_range: f64,
    /// Identity of the scan's first point.
    first_id: usize,
}

/// A moment of the LiDARs, seen from a radar scan.
#[derive(Debug, Clone)]
pub struct LidarView {
    /// The LiDAR scans with their ground.
    pub moment: Arc<LidarMoment>,
    /// From the moment's vehicle frame to that at the radar scan's time.
    pub vehicle_from_moment: Transform,
}

impl LidarView {
    /// All points, the ground's too, in the vehicle frame at hand, m; not finite where there was no return.
    pub fn all_points(&self) -> Vec<Point> {
        let rotation = self.vehicle_from_moment.rotation.to_rotation_matrix();
        let offset = self.vehicle_from_moment.translation.vector;
        self.moment.points.iter().map(|p| rotation * Point::from(p.map(f64::from)) + offset).collect()
    }
}

/// The scans that all LiDARs made around one moment, in the vehicle frame at that moment.
#[derive(Debug)]
pub struct LidarMoment {
    /// The moment, ns.
    pub t_ns: i64,
    parts: Vec<Part>,
    /// All points of all parts, m; not finite where there was no return. A point's place here is its identity.
    points: Vec<[f32; 3]>,
    ground: Option<Ground>,
    /// Identities of the points that are not ground.
    above_ground: Vec<u32>,
    index: OnceLock<NeighborIndex>,
}

impl LidarMoment {
    /// Brings the scans together at `t_ns`. `scans` gives each scan's LiDAR and the vehicle's pose at the scan's time
    /// in the vehicle frame at `t_ns`. The ground is fitted to all points together.
    pub fn new(
        t_ns: i64,
        scans: Vec<(&Lidar, Arc<LidarScan>, Transform)>,
        config: &GroundConfig,
        seed: u64,
    ) -> Self {
        let mut parts = Vec::with_capacity(scans.len());
        let mut points = Vec::with_capacity(scans.iter().map(|(_, scan, _)| scan.points.len()).sum());
        for (lidar, scan, moment_from_vehicle) in scans {
            let moment_from_lidar = moment_from_vehicle * lidar.vehicle_from_lidar;
            let first_id = points.len();
            points.extend(scan.points.iter().map(|p| moved_return(&moment_from_lidar, p)));
            parts.push(Part { scan, moment_from_lidar, sigma_range: lidar.sigma_range, first_id });
        }
        let ground = Ground::fit(&points, config, seed);
        let above_ground = above_ground(&points, ground.as_ref(), config.lidar_margin);
        Self { t_ns, parts, points, ground, above_ground, index: OnceLock::new() }
    }

    /// The ground, in the vehicle frame at the moment.
    pub fn ground(&self) -> Option<&Ground> {
        self.ground.as_ref()
    }

    /// Points above the ground for a radar that measures elevation, in the moment's frame.
    pub fn index(&self) -> &NeighborIndex {
        self.index.get_or_init(|| {
            let points: Vec<_> = self.above_ground.iter().map(|id| self.points[*id as usize]).collect();
            NeighborIndex::new(&points, &self.above_ground)
        })
    }

    /// Points above the ground within a radar's vertical field of view, in the horizontal plane of the vehicle frame
    /// that `vehicle_from_moment` leads to: for a radar that measures no elevation.
    pub fn horizontal_index(&self, radar: &Radar, vehicle_from_moment: &Transform) -> NeighborIndex {
        let radar_from_vehicle = radar.vehicle_from_radar.inverse();
        let (mut points, mut ids) = (Vec::new(), Vec::new());
        for &id in &self.above_ground {
            let in_vehicle = vehicle_from_moment * Point::from(self.points[id as usize].map(f64::from));
            if radar.sees_height_of(&(radar_from_vehicle * in_vehicle)) {
                points.push([in_vehicle.x as f32, in_vehicle.y as f32, 0.0]);
                ids.push(id);
            }
        }
        NeighborIndex::new(&points, &ids)
    }

    /// A point with its uncertainty along its own ray (docs/method.md, section 4), in the frame that
    /// `vehicle_from_moment` leads to.
    pub fn reference(&self, id: u32, vehicle_from_moment: &Transform) -> Reference {
        let (part, point) = self.find(id);
        let vehicle_from_lidar = vehicle_from_moment * part.moment_from_lidar;
        let p = Point::from(part.scan.points[point].map(f64::from));
        let ray = p.coords.normalize() * part.sigma_range;
        Reference { position: vehicle_from_lidar * p, spread: Spread::Ray(vehicle_from_lidar.rotation * ray) }
    }

    /// The SemanticKITTI id of a point, 0 where it has none.
    pub fn class(&self, id: u32) -> u16 {
        let (part, point) = self.find(id);
        part.scan.classes.as_ref().and_then(|classes| classes.get(point)).copied().unwrap_or(0)
    }

    /// The part that a point belongs to, and its place in that part's scan.
    fn find(&self, id: u32) -> (&Part, usize) {
        let part = self.parts.partition_point(|part| part.first_id <= id as usize) - 1;
        (&self.parts[part], id as usize - self.parts[part].first_id)
    }
}

fn moved_return(moment_from_lidar: &Transform, point: &[f32; 3]) -> [f32; 3] {
    if !is_return(point) {
        return [f32::NAN; 3];
    }
    let p = moment_from_lidar * Point::from(point.map(f64::from));
    [p.x as f32, p.y as f32, p.z as f32]
}

/// Identities of the returns that lie at least `margin` above the ground.
fn above_ground(points: &[[f32; 3]], ground: Option<&Ground>, margin: f64) -> Vec<u32> {
    let stays = |point: &[f32; 3]| {
        point[0].is_finite()
            && ground.is_none_or(|ground| ground.height(&Point::from(point.map(f64::from))) >= margin)
    };
    (0u32..).zip(points).filter(|(_, point)| stays(point)).map(|(id, _)| id).collect()
}
