//! The LiDAR scans of one moment: their rays, their ground and their reference cloud, shared by all radars that use
//! them.

use super::ground::{Floor, Ground, GroundSurface, ids_where};
use super::mismatch::{Reference, Spread};
use super::rays::RayTable;
use super::standing::standing_points;
use super::terrain::{Patch, patches};
use crate::config::GroundConfig;
use crate::sensors::{Lidar, LidarScan, Radar, is_return};
use crate::space::{NeighborIndex, Point, Transform, Vector, placed};
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// One LiDAR's scan in the vehicle frame at the moment.
#[derive(Debug)]
pub struct LidarSweep {
    /// The scan, in the LiDAR's frame.
    pub scan: Arc<LidarScan>,
    /// From the LiDAR's frame to the vehicle frame at the moment.
    pub moment_from_lidar: Transform,
    /// `s_r,lidar`, m.
    pub sigma_range: f64,
    /// Identity of the scan's first point.
    first_id: usize,
    rays: OnceLock<RayTable>,
}

impl LidarSweep {
    /// The rays by their direction.
    pub fn rays(&self) -> &RayTable {
        self.rays.get_or_init(|| RayTable::new(&self.scan.points))
    }
}

impl LidarSweep {
    /// From a time to when a point was measured, s; to the scan's time where the recording doesn't tell the point's.
    fn seconds_after(&self, t_ns: i64, point: usize) -> f64 {
        let time = self.scan.times.as_ref().and_then(|times| times.get(point));
        self.seconds_to_scan(t_ns) + time.map_or(0.0, |seconds| f64::from(*seconds))
    }

    fn seconds_to_scan(&self, t_ns: i64) -> f64 {
        (self.scan.t_ns - t_ns) as f64 * 1e-9
    }
}

/// A ray that came back: where it began, where it went, and how far it came.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LidarRay {
    /// The LiDAR, m.
    pub origin: Point,
    /// Where the ray went, of unit length.
    pub direction: Vector,
    /// From the LiDAR to the return, m.
    pub range: f64,
}

/// A moment of the LiDARs, seen from a radar scan.
#[derive(Debug, Clone)]
pub struct LidarView {
    /// The LiDAR scans with their ground.
    pub moment: Arc<LidarSnapshot>,
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

    /// The rays of all LiDARs that came back, in the vehicle frame at hand, in the order of the points.
    pub fn rays(&self) -> Vec<LidarRay> {
        let mut rays = Vec::new();
        for sweep in &self.moment.sweeps {
            let vehicle_from_lidar = self.vehicle_from_moment * sweep.moment_from_lidar;
            let origin = Point::from(vehicle_from_lidar.translation.vector);
            let returns = sweep.scan.points.iter().filter(|point| is_return(point));
            rays.extend(returns.map(|point| {
                let ray = Vector::from(point.map(f64::from));
                let range = ray.norm();
                LidarRay { origin, direction: vehicle_from_lidar.rotation * (ray / range), range }
            }));
        }
        rays
    }
}

/// The scans that all LiDARs made around one moment, in the vehicle frame at that moment.
#[derive(Debug)]
pub struct LidarSnapshot {
    /// The moment, ns.
    pub t_ns: i64,
    sweeps: Vec<LidarSweep>,
    /// All points of all sweeps, m; not finite where there was no return. A point's index here is its identity.
    points: Vec<[f32; 3]>,
    config: GroundConfig,
    seed: u64,
    ground: OnceLock<Option<Ground>>,
    /// Identities of the points that are not ground.
    above_ground: OnceLock<Vec<u32>>,
    index: OnceLock<NeighborIndex>,
    /// From the moment to the first and the last point, s.
    span: OnceLock<Range<f64>>,
    lowest_points: OnceLock<Vec<[f32; 3]>>,
    floor: OnceLock<Floor>,
    standing_points: OnceLock<Vec<[f32; 3]>>,
    patches: OnceLock<Vec<Patch>>,
}

impl LidarSnapshot {
    /// Brings the scans together at `t_ns`. `scans` gives each scan's LiDAR and the vehicle's pose at the scan's time
    /// in the vehicle frame at `t_ns`. The ground is fitted to all points together once it is asked for.
    pub fn new(
        t_ns: i64,
        scans: Vec<(&Lidar, Arc<LidarScan>, Transform)>,
        config: &GroundConfig,
        seed: u64,
    ) -> Self {
        let mut sweeps = Vec::with_capacity(scans.len());
        let mut points = Vec::with_capacity(scans.iter().map(|(_, scan, _)| scan.points.len()).sum());
        for (lidar, scan, moment_from_vehicle) in scans {
            let moment_from_lidar = moment_from_vehicle * lidar.vehicle_from_lidar;
            let first_id = points.len();
            points.extend(scan.points.iter().map(|p| moved_return(&moment_from_lidar, p)));
            let sigma_range = lidar.sigma_range;
            sweeps.push(LidarSweep { scan, moment_from_lidar, sigma_range, first_id, rays: OnceLock::new() });
        }
        Self {
            t_ns,
            sweeps,
            points,
            config: config.clone(),
            seed,
            ground: OnceLock::new(),
            above_ground: OnceLock::new(),
            index: OnceLock::new(),
            span: OnceLock::new(),
            lowest_points: OnceLock::new(),
            floor: OnceLock::new(),
            standing_points: OnceLock::new(),
            patches: OnceLock::new(),
        }
    }

    /// One entry per LiDAR that delivered a scan.
    pub fn sweeps(&self) -> &[LidarSweep] {
        &self.sweeps
    }

    /// The largest `s_r,lidar` of the LiDARs, m.
    pub fn max_sigma_range(&self) -> f64 {
        self.sweeps.iter().map(|sweep| sweep.sigma_range).fold(0.0, f64::max)
    }

    /// Whether points carry classes.
    pub fn has_classes(&self) -> bool {
        self.sweeps.iter().any(|sweep| sweep.scan.classes.is_some())
    }

    /// The ground, in the vehicle frame at the moment; `None` where there is none.
    pub fn ground(&self) -> Option<&Ground> {
        self.ground.get_or_init(|| Ground::fit(&self.points, &self.config, self.seed)).as_ref()
    }

    /// The lowest point of each cell of a grid, in the moment's frame, m: all that a [`GroundSurface`] needs.
    pub fn lowest_points(&self) -> &[[f32; 3]] {
        self.lowest_points.get_or_init(|| GroundSurface::lowest_points(&self.points))
    }

    /// The points above the lowest ones, thinned, in the moment's frame, m: all that a [`StaticMap`](super::StaticMap)
    /// needs.
    pub fn standing_points(&self) -> &[[f32; 3]] {
        self.standing_points.get_or_init(|| standing_points(&self.points, self.floor()))
    }

    /// The ground's brightness and roughness, cell by cell and LiDAR by LiDAR.
    pub(super) fn patches(&self) -> &[Patch] {
        self.patches.get_or_init(|| {
            let mut found = Vec::new();
            for sweep in &self.sweeps {
                let points = &self.points[sweep.first_id..][..sweep.scan.points.len()];
                found.extend(patches(points, &sweep.scan.intensity, self.floor()));
            }
            found
        })
    }

    fn floor(&self) -> &Floor {
        self.floor.get_or_init(|| GroundSurface::lowest_within_a_metre(self.lowest_points()))
    }

    /// Points above the ground for a radar that measures elevation, in the moment's frame: the reference cloud.
    pub fn index(&self) -> &NeighborIndex {
        self.index.get_or_init(|| {
            let ids = self.above_ground();
            let points: Vec<_> = ids.iter().map(|id| self.points[*id as usize]).collect();
            NeighborIndex::new(&points, ids)
        })
    }

    /// Points above the ground within a radar's vertical field of view, in the horizontal plane of the vehicle frame
    /// that `vehicle_from_moment` leads to: the reference cloud for a radar that measures no elevation.
    pub fn horizontal_index(&self, radar: &Radar, vehicle_from_moment: &Transform) -> NeighborIndex {
        let (radar_from_vehicle, sees) = (radar.vehicle_from_radar.inverse(), radar.sees_heights_of());
        let (mut points, mut ids) = (Vec::new(), Vec::new());
        for &id in self.above_ground() {
            let in_vehicle = placed(vehicle_from_moment, &self.points[id as usize]);
            if sees(&(radar_from_vehicle * in_vehicle)) {
                points.push([in_vehicle.x as f32, in_vehicle.y as f32, 0.0]);
                ids.push(id);
            }
        }
        NeighborIndex::new(&points, &ids)
    }

    /// From each sweep's LiDAR to the frame that `vehicle_from_moment` leads to.
    pub fn vehicle_from_lidars(&self, vehicle_from_moment: &Transform) -> Vec<Transform> {
        self.sweeps.iter().map(|sweep| vehicle_from_moment * sweep.moment_from_lidar).collect()
    }

    /// A point with its uncertainty along its own ray (docs/method.md, section 4), in the frame that
    /// [`Self::vehicle_from_lidars`] leads to.
    pub fn reference(&self, id: u32, vehicle_from_lidars: &[Transform]) -> Reference {
        let (sweep, point) = self.find(id);
        let (sweep, vehicle_from_lidar) = (&self.sweeps[sweep], &vehicle_from_lidars[sweep]);
        let p = Point::from(sweep.scan.points[point].map(f64::from));
        let ray = p.coords.normalize() * sweep.sigma_range;
        Reference { position: vehicle_from_lidar * p, spread: Spread::Ray(vehicle_from_lidar.rotation * ray) }
    }

    /// From a time to when a point was measured, s; to its scan's time where the recording doesn't tell.
    pub fn seconds_after(&self, t_ns: i64, id: u32) -> f64 {
        let (sweep, point) = self.find(id);
        self.sweeps[sweep].seconds_after(t_ns, point)
    }

    /// From a time to when the first and the last point were measured, s.
    pub fn span_after(&self, t_ns: i64) -> Range<f64> {
        let span = self.span.get_or_init(|| self.span());
        let seconds = (self.t_ns - t_ns) as f64 * 1e-9;
        span.start + seconds..span.end + seconds
    }

    /// From the moment to when the first and the last point were measured, s.
    fn span(&self) -> Range<f64> {
        let mut span = f64::INFINITY..f64::NEG_INFINITY;
        for sweep in self.sweeps.iter().filter(|sweep| !sweep.scan.points.is_empty()) {
            let seconds = sweep.seconds_to_scan(self.t_ns);
            for time in sweep.scan.times.as_deref().unwrap_or(&[0.0]) {
                span.start = span.start.min(seconds + f64::from(*time));
                span.end = span.end.max(seconds + f64::from(*time));
            }
        }
        span
    }

    /// The SemanticKITTI id of a point, 0 where it has none.
    pub fn class(&self, id: u32) -> u16 {
        let (sweep, point) = self.find(id);
        self.sweeps[sweep].scan.classes.as_ref().and_then(|classes| classes.get(point)).copied().unwrap_or(0)
    }

    /// Identities of the returns that lie at least the margin above the ground.
    fn above_ground(&self) -> &[u32] {
        self.above_ground.get_or_init(|| match self.ground() {
            None => ids_where(&self.points, |point| point[0].is_finite()),
            Some(ground) => ground.ids_above(&self.points, self.config.lidar_margin),
        })
    }

    /// Which sweep a point belongs to, and the point's index in that sweep's scan.
    fn find(&self, id: u32) -> (usize, usize) {
        let sweep = self.sweeps.partition_point(|sweep| sweep.first_id <= id as usize) - 1;
        (sweep, id as usize - self.sweeps[sweep].first_id)
    }
}

fn moved_return(moment_from_lidar: &Transform, point: &[f32; 3]) -> [f32; 3] {
    if !is_return(point) {
        return [f32::NAN; 3];
    }
    let p = placed(moment_from_lidar, point);
    [p.x as f32, p.y as f32, p.z as f32]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_ray_leads_from_its_lidar_to_its_return() {
        let lidar = Lidar {
            name: "roof".into(),
            vehicle_from_lidar: Transform::new(Vector::new(1.0, 0.0, 2.0), Vector::new(0.0, 0.0, FRAC_PI_2)),
            sigma_range: 0.03,
            lowest_beam: 0.4,
            max_range: None,
        };
        let points = vec![[3.0, 4.0, 0.0], [0.0; 3], [f32::NAN, 0.0, 1.0], [0.0, 0.0, -2.0]];
        let scan = Arc::new(LidarScan { t_ns: 0, points, ..Default::default() });
        let scans = vec![(&lidar, scan, Transform::translation(10.0, 0.0, 0.0))];
        let moment = Arc::new(LidarSnapshot::new(0, scans, &GroundConfig::default(), 0));
        let view = LidarView { moment, vehicle_from_moment: Transform::translation(-10.0, 0.0, 0.0) };
        // The LiDAR looks to the left: its (3, 4) is the vehicle's (-4, 3). The second and the third point are no
        // returns.
        let rays = view.rays();
        assert_eq!(rays.len(), 2);
        for (ray, range, end) in
            [(rays[0], 5.0, Point::new(-3.0, 3.0, 2.0)), (rays[1], 2.0, Point::new(1.0, 0.0, 0.0))]
        {
            assert!((ray.origin - Point::new(1.0, 0.0, 2.0)).norm() < 1e-12);
            assert!((ray.range - range).abs() < 1e-12 && (ray.direction.norm() - 1.0).abs() < 1e-12);
            assert!((ray.origin + ray.direction * ray.range - end).norm() < 1e-12);
        }
    }
}
