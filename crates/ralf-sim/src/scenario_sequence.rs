//! A sequence made from a scenario.

use super::camera::{self, Moment, Rays};
use super::lidar;
use super::odometry;
use super::path::Path;
use super::radar::{Detection, Mirror, View, radar_scan};
use super::random::{Purpose, Random};
use super::scenario::{CameraFailure, FailureKind, Scenario, ScenarioError};
use super::scene::Scene;
use super::simulation::{Simulation, time};
use super::site::Site;
use super::truth::Truth;
use super::vehicle::rig;
use ralf::label::Cause;
use ralf::sensors::{
    Camera, CameraImage, ClassImage, DepthImage, DepthOutput, LidarScan, RadarScan, Sequence, Source,
    SourceError, Timelines,
};
use ralf::space::{EgoMotion, Transform, Vector};
use std::sync::OnceLock;

/// Time of the first radar scan, ns.
const START_NS: i64 = 1_600_000_000_000_000_000;
/// Between scans of a radar, ns.
const RADAR_PERIOD_NS: i64 = 50_000_000;
/// The radars fire in turn, so as not to blind each other, ns.
const RADAR_STAGGER_NS: i64 = 5_000_000;
/// Time between two scans of the LiDAR, and two images, ns.
const OPTICAL_PERIOD_NS: i64 = 100_000_000;
/// The first image is this much later than the first LiDAR scan, ns.
const CAMERA_DELAY_NS: i64 = 12_000_000;
/// Mean number of detections over all radars.
const DETECTIONS: f64 = 1216.0;

/// A sequence made from a scenario and a seed.
#[derive(Debug)]
pub(super) struct ScenarioSequence {
    sequence: Sequence,
    scenario: Scenario,
    site: Site,
    mirrors: Vec<Mirror>,
    path: Path,
    seed: u64,
    /// Where each pixel of each camera looks, once it is known.
    rays: Vec<OnceLock<Rays>>,
}

impl ScenarioSequence {
    /// A sequence of so many scans of each radar.
    pub(super) fn new(
        name: &str,
        scenario: &Scenario,
        seed: u64,
        scans: usize,
    ) -> Result<Self, ScenarioError> {
        scenario.check()?;
        let rig = rig();
        let last_ns = scans as i64 * RADAR_PERIOD_NS;
        // A little longer, for the last LiDAR scan and image come after the last radar scan.
        let seconds = last_ns as f64 * 1e-9 + 1.0;
        let path = Path::new(&scenario.ego, seconds);
        let site = Site::new(scenario, seed);
        let every = |first: i64, period: i64, end: i64| -> Vec<i64> {
            (0..).map(|i| START_NS + first + i * period).take_while(|t| *t < START_NS + end).collect()
        };
        let optical = |delay| every(delay, OPTICAL_PERIOD_NS, last_ns + OPTICAL_PERIOD_NS / 2);
        let radar = |i: usize| {
            let first = i as i64 * RADAR_STAGGER_NS;
            every(first, RADAR_PERIOD_NS, first + last_ns)
        };
        let times = Timelines {
            radars: (0..rig.radars.len()).map(radar).collect(),
            lidars: vec![optical(0); rig.lidars.len()],
            cameras: vec![optical(CAMERA_DELAY_NS); rig.cameras.len()],
        };
        let motion = EgoMotion::new(odometry::samples(&path, START_NS, seconds, seed), vec![]).ok_or(
            ScenarioError::Value { key: "scans", expected: "at least one".into(), found: scans.to_string() },
        )?;
        let sequence = Sequence {
            name: name.to_owned(),
            title: scenario.title.clone(),
            rig,
            times,
            motion,
            depth_output: DepthOutput::Depth,
        };
        let mirrors = Mirror::all(&site);
        let rays = sequence.rig.cameras.iter().map(|_| OnceLock::new()).collect();
        Ok(Self { sequence, scenario: scenario.clone(), site, mirrors, path, seed, rays })
    }

    fn detections(&self, radar: usize, scan: usize) -> Result<Vec<Detection>, SourceError> {
        let t_ns = time("radar", &self.sequence.times.radars, radar, scan)?;
        let sensor = &self.sequence.rig.radars[radar];
        let vehicle = self.pose(t_ns);
        let state = self.path.state(seconds(t_ns));
        let lever = sensor.vehicle_from_radar.translation.vector;
        let own = Vector::new(state.speed, 0.0, 0.0) + Vector::new(0.0, 0.0, state.yaw_rate).cross(&lever);
        let view = View {
            scene: &Scene::new(&self.site, seconds(t_ns)),
            radar: sensor,
            site_from_radar: vehicle * sensor.vehicle_from_radar,
            velocity: vehicle.rotation * own,
        };
        let size = DETECTIONS / self.sequence.rig.radars.len() as f64;
        let random = &mut Random::new(self.seed, Purpose::Radar, radar, scan);
        Ok(view.scan(&self.mirrors, size, self.scenario.plausible_share, random))
    }

    /// A camera, and what surrounds it at the time of an image.
    fn moment(
        &self,
        camera: usize,
        image: usize,
    ) -> Result<(&Camera, Moment<'_, Scene<'_>>, i64), SourceError> {
        let t_ns = time("camera", &self.sequence.times.cameras, camera, image)?;
        let sensor = &self.sequence.rig.cameras[camera];
        let scene = Scene::new(&self.site, seconds(t_ns));
        let site_from_camera = self.pose(t_ns) * sensor.vehicle_from_camera;
        Ok((sensor, Moment { scene, camera: sensor, site_from_camera }, t_ns))
    }

    /// How a camera fails at a time, if it does.
    fn failure(&self, camera: usize, t_ns: i64) -> Option<FailureKind> {
        let name = &self.sequence.rig.cameras[camera].name;
        let holds = |failure: &&CameraFailure| {
            failure.camera == *name && (failure.from_s..failure.until_s).contains(&seconds(t_ns))
        };
        self.scenario.failure.iter().find(holds).map(|failure| failure.kind)
    }

    fn pose(&self, t_ns: i64) -> Transform {
        self.path.site_from_vehicle(&self.site.ground, seconds(t_ns))
    }
}

impl Simulation for ScenarioSequence {
    fn truth(&self, radar: usize, scan: usize) -> Result<Vec<Truth>, SourceError> {
        Ok(self.detections(radar, scan)?.iter().map(|detection| detection.truth).collect())
    }

    fn causes(&self) -> &'static [Cause] {
        &Cause::ALL[..=Cause::Noise as usize]
    }

    fn remove_cameras(&mut self) {
        self.sequence.rig.cameras.clear();
        self.sequence.times.cameras.clear();
        self.rays.clear();
    }

    fn true_radar(&self, radar: usize) -> Option<(Transform, i64)> {
        self.sequence.rig.radars.get(radar).map(|radar| (radar.vehicle_from_radar, 0))
    }

    fn true_pose(&self, t_ns: i64) -> Transform {
        self.pose(START_NS).inv_mul(&self.pose(t_ns))
    }

    fn true_depth(&self, camera: usize, image: usize) -> Result<Vec<DepthImage>, SourceError> {
        Ok(camera::true_depth(&self.moment(camera, image)?.1))
    }

    fn true_classes(&self, camera: usize, image: usize) -> Result<Vec<ClassImage>, SourceError> {
        Ok(camera::true_classes(&self.moment(camera, image)?.1))
    }
}

/// Since the start.
fn seconds(t_ns: i64) -> f64 {
    (t_ns - START_NS) as f64 * 1e-9
}

impl Source for ScenarioSequence {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let detections = self.detections(radar, scan)?;
        let t_ns = self.sequence.times.radars[radar][scan];
        Ok(radar_scan(&self.sequence.rig.radars[radar], t_ns, &detections)?)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        let t_ns = time("lidar", &self.sequence.times.lidars, lidar, scan)?;
        let sensor = &self.sequence.rig.lidars[lidar];
        let scene = Scene::new(&self.site, seconds(t_ns));
        let random = &mut Random::new(self.seed, Purpose::Lidar, lidar, scan);
        Ok(lidar::scan(&scene, sensor, &(self.pose(t_ns) * sensor.vehicle_from_lidar), t_ns, random))
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        let (sensor, moment, t_ns) = self.moment(camera, image)?;
        let rays = self.rays[camera].get_or_init(|| camera::rays(sensor));
        let random = &mut Random::new(self.seed, Purpose::Image, camera, image);
        Ok(camera::image(&moment, rays, self.failure(camera, t_ns), random))
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        let (_, moment, t_ns) = self.moment(camera, image)?;
        let random = &mut Random::new(self.seed, Purpose::Depth, camera, image);
        Ok(Some(camera::depth(&moment, self.failure(camera, t_ns), random)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Ray;
    use crate::{Kind, presets};
    use ralf::space::{Point, Spherical};

    fn tiny() -> ScenarioSequence {
        let text = presets::find("tiny").unwrap().sequences[0].text();
        ScenarioSequence::new("tiny", &Scenario::from_toml(&text).unwrap(), 5, 6).unwrap()
    }

    #[test]
    fn plausible_detections_lie_on_objects_within_the_noise() {
        let sequence = tiny();
        for radar in 0..4 {
            let sensor = &sequence.sequence.rig.radars[radar];
            let scan = sequence.radar_scan(radar, 5).unwrap();
            let site_from_radar = sequence.pose(scan.t_ns) * sensor.vehicle_from_radar;
            for (detection, found) in sequence.detections(radar, 5).unwrap().iter().zip(&scan.spherical) {
                let origin = Spherical::from_cartesian(&detection.origin);
                assert!((found.range - origin.range).abs() < 6.0 * sensor.sigma_range);
                assert!((found.azimuth - origin.azimuth).abs() < 6.0 * sensor.sigma_azimuth);
                assert!((found.elevation - origin.elevation).abs() < 6.0 * sensor.sigma_elevation);
                let p = site_from_radar * detection.origin;
                let on = |object: &crate::site::Object| {
                    let own =
                        object.pose(&sequence.site.ground, seconds(scan.t_ns)).inverse_transform_point(&p);
                    let half = object.size / 2.0;
                    own.x.abs() < half.x + 0.2 && own.y.abs() < half.y + 0.2 && own.z < object.size.z + 0.3
                };
                let real = detection.truth.cause == Cause::Plausible;
                assert!(!real || sequence.site.objects.iter().any(on), "{:?} at {p}", detection.truth);
            }
        }
    }

    #[test]
    fn lidar_points_lie_on_surfaces() {
        let sequence = tiny();
        let scan = sequence.lidar_scan(0, 1).unwrap();
        let scene = Scene::new(&sequence.site, seconds(scan.t_ns));
        let sensor = &sequence.sequence.rig.lidars[0];
        let site_from_lidar = sequence.pose(scan.t_ns) * sensor.vehicle_from_lidar;
        assert!(scan.points.len() > 20_000, "{}", scan.points.len());
        let (mut solid, mut off) = (0, 0);
        for point in &scan.points {
            let own = Vector::new(point[0].into(), point[1].into(), point[2].into());
            let origin = Point::from(site_from_lidar.translation.vector);
            let ray = Ray { origin, direction: site_from_lidar.rotation * own.normalize() };
            let hit = scene.cast(&ray, 130.0);
            let lets_rays_in = |kind| matches!(kind, Kind::Tree | Kind::Hedge | Kind::Fence | Kind::Grass);
            if hit.is_none_or(|hit| lets_rays_in(hit.kind())) {
                continue;
            }
            solid += 1;
            off += usize::from(hit.is_none_or(|hit| (hit.distance - own.norm()).abs() > 0.15));
        }
        // A rounded ray may just miss an edge.
        assert!(solid > 15_000 && off * 1000 < solid, "{off} of {solid}");
    }
}
