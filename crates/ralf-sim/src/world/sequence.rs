//! A sequence of a world as a source of measurements.

use super::draw::World;
use super::lidar::{self, Sweep};
use super::place::{Plan, plan};
use super::radar::{self, Detection, Waves};
use super::scene::{Moment, Site};
use super::terrain::Terrain;
use crate::camera;
use crate::path::Path;
use crate::random::{Purpose, Random};
use crate::scenario::ScenarioError;
use crate::simulation::{Last, Simulation, time};
use crate::truth::Truth;
use nalgebra::UnitQuaternion;
use ralf::label::Cause;
use ralf::sensors::{
    CameraImage, ClassImage, DepthImage, DepthOutput, LidarScan, RadarScan, Sequence, Source, SourceError,
    Timelines,
};
use ralf::space::{EgoMotion, Transform, Vector};
use std::f64::consts::TAU;
use std::sync::{Arc, OnceLock};

/// Time of the start, ns.
const START_NS: i64 = 1_700_000_000_000_000_000;
/// Half the step of the numerical derivative of the pose, s.
const HALF_STEP: f64 = 1e-3;

/// So long a drive nothing stands in the way, s, looked at in steps of so many s.
const LASTING: f64 = 15.0;
const STEP: f64 = 0.1;
/// Places of the vehicle along its axis, m, and half its width with some air.
const ALONG: [f64; 4] = [-0.8, 0.7, 2.2, 3.6];
const HALF_WIDTH: f64 = 1.15;

/// A sequence of a world.
#[derive(Debug)]
pub(super) struct WorldSequence {
    sequence: Sequence,
    world: Arc<World>,
    site: Site,
    ride: Ride,
    waves: Waves,
    /// Where each pixel of each camera looks, once it is known.
    rays: Vec<OnceLock<camera::Rays>>,
    last: Last<Detection>,
    /// Share of a LiDAR's rays that meet a drop.
    rain: f64,
    seed: u64,
}

/// How the vehicle really moves.
#[derive(Debug)]
struct Ride {
    path: Path,
    /// Amplitudes of pitch and roll on its springs (rad), and their phase.
    sway: [f64; 3],
}

impl Ride {
    /// In the site's frame.
    fn pose(&self, terrain: &Terrain, seconds: f64) -> Transform {
        let state = self.path.state(seconds);
        let [pitch, roll, phase] = self.sway;
        // A body swings at 1 to 1.5 Hz.
        let moving = (state.speed.abs() / 5.0).min(1.0);
        let [a, b] = [TAU * 1.3 * seconds + phase, TAU * 1.1 * seconds + 2.0 * phase];
        let sway = UnitQuaternion::from_euler_angles(roll * moving * b.sin(), pitch * moving * a.sin(), 0.0);
        let pose = terrain.pose([state.x, state.y, state.heading]);
        Transform::from_parts(pose.translation, pose.rotation * sway)
    }

    /// Velocity (m/s, in the site's frame) of a sensor of the vehicle.
    fn velocity(&self, terrain: &Terrain, mount: &Transform, seconds: f64) -> Vector {
        let place = |t: f64| (self.pose(terrain, t) * mount).translation.vector;
        (place(seconds + HALF_STEP) - place(seconds - HALF_STEP)) / (2.0 * HALF_STEP)
    }
}

impl WorldSequence {
    /// The sequence of a number, with so many scans of each radar.
    pub(super) fn new(world: Arc<World>, index: usize, scans: usize) -> Result<Self, ScenarioError> {
        let seed = world.seed.wrapping_mul(1_000_003).wrapping_add(index as u64 + 1);
        let mut random = Random::new(seed, Purpose::Placement, 0, 0);
        let random = &mut random;
        let kind = world.place(random);
        let mut plan = plan(kind, &world.mixture.places.motion, random);
        let rains = random.chance(world.mixture.waves.waves.rain);
        let sway = [random.between(0.0, 0.006), random.between(0.0, 0.004), random.between(0.0, TAU)];
        let times = timelines(&world, scans);
        let seconds =
            2.0 + times.radars.iter().flatten().max().map_or(0, |last| last - START_NS) as f64 * 1e-9;
        let phase = random.between(0.0, TAU);
        let ride = Ride { path: path(&plan, seconds, phase), sway };
        clear_the_way(&mut plan, phase);
        let title = format!("{}: {}{}", world.mixture, plan.title, if rains { ", rain" } else { "" });
        let terrain = Terrain::new(&plan.ramps, plan.patches, plan.base, seed);
        let motion = motion(&world, &ride, &terrain, seconds, seed).ok_or(ScenarioError::Value {
            key: "scans",
            expected: "at least one".into(),
            found: scans.to_string(),
        })?;
        let sequence = Sequence {
            name: format!("{index:02}"),
            title,
            rig: world.calibration.rig.clone(),
            times,
            motion,
            depth_output: DepthOutput::Depth,
        };
        let waves = Waves { rain: rains, ..world.waves };
        let rain = if rains { random.between(0.002, 0.02) } else { 0.0 };
        let rays = sequence.rig.cameras.iter().map(|_| OnceLock::new()).collect();
        Ok(Self {
            sequence,
            site: Site::new(terrain, plan.items, seed),
            world,
            ride,
            waves,
            rays,
            last: Last::default(),
            rain,
            seed,
        })
    }

    /// A camera, and what surrounds it at the time of an image.
    fn seen_by(&self, camera: usize, image: usize) -> Result<camera::Moment<'_, Moment<'_>>, SourceError> {
        let t_ns = time("camera", &self.sequence.times.cameras, camera, image)?;
        let model = &self.world.cameras[camera];
        let pose = self.ride.pose(&self.site.terrain, seconds(t_ns));
        Ok(camera::Moment {
            scene: self.site.at(seconds(t_ns)),
            camera: &model.declared,
            site_from_camera: pose * model.vehicle_from_camera,
        })
    }

    fn detections(&self, radar: usize, scan: usize) -> Result<Arc<Vec<Detection>>, SourceError> {
        self.last.or_made(radar, scan, || self.measured(radar, scan))
    }

    fn measured(&self, radar: usize, scan: usize) -> Result<Vec<Detection>, SourceError> {
        let t_ns = time("radar", &self.sequence.times.radars, radar, scan)?;
        let model = &self.world.radars[radar];
        let seconds = seconds(t_ns - model.clock_ns);
        let terrain = &self.site.terrain;
        let site_from_radar = self.ride.pose(terrain, seconds) * model.vehicle_from_radar;
        let velocity = self.ride.velocity(terrain, &model.vehicle_from_radar, seconds);
        let random = &mut Random::new(self.seed, Purpose::Radar, radar, scan);
        Ok(radar::scan(&self.site.at(seconds), model, &self.waves, site_from_radar, velocity, random))
    }
}

/// When each sensor delivers, by its own clock.
fn timelines(world: &World, scans: usize) -> Timelines {
    let of_radar = |radar: &radar::RadarModel| {
        let first = START_NS + radar.first_ns + radar.clock_ns;
        (0..scans as i64).map(|scan| first + scan * radar.period_ns).collect()
    };
    let radars: Vec<Vec<i64>> = world.radars.iter().map(of_radar).collect();
    let end = radars.iter().flatten().max().copied().unwrap_or(START_NS);
    let until_end = |first_ns: i64, period_ns: i64| -> Vec<i64> {
        let times = (0..).map(|i| START_NS + first_ns + i * period_ns);
        times.take_while(|t| *t < end + period_ns / 2).collect()
    };
    let lidars = world.lidars.iter().map(|lidar| until_end(0, lidar.period_ns)).collect();
    let cameras = world.cameras.iter().map(|camera| until_end(camera.first_ns, camera.period_ns)).collect();
    Timelines { radars, lidars, cameras }
}

fn path(plan: &Plan, seconds: f64, phase: f64) -> Path {
    let (swing, period) = plan.drive.swing;
    let speed = |t: f64| plan.drive.speed * (1.0 + swing * (TAU * t / period + phase).sin());
    Path::along(plan.drive.start, &plan.drive.legs, seconds, speed)
}

/// Takes away what the vehicle would drive through.
fn clear_the_way(plan: &mut Plan, phase: f64) {
    let path = path(plan, LASTING, phase);
    let mut way = Vec::new();
    for step in 0..(LASTING / STEP) as usize {
        let state = path.state(step as f64 * STEP);
        let (sin, cos) = state.heading.sin_cos();
        way.extend(ALONG.map(|along| [state.x + along * cos, state.y + along * sin]));
    }
    plan.items.retain(|item| !way.iter().any(|place| item.is_in_the_way(*place, HALF_WIDTH)));
}

fn motion(world: &World, ride: &Ride, terrain: &Terrain, seconds: f64, seed: u64) -> Option<EgoMotion> {
    let pose = |t: f64| ride.pose(terrain, t);
    world.calibration.motion(&ride.path, &pose, START_NS, seconds, seed)
}

/// Since the start.
fn seconds(t_ns: i64) -> f64 {
    (t_ns - START_NS) as f64 * 1e-9
}

impl Simulation for WorldSequence {
    fn truth(&self, radar: usize, scan: usize) -> Result<Vec<Truth>, SourceError> {
        Ok(self.detections(radar, scan)?.iter().map(|detection| detection.truth).collect())
    }

    fn causes(&self) -> &'static [Cause] {
        &Cause::ALL
    }

    fn remove_cameras(&mut self) {
        self.sequence.rig.cameras.clear();
        self.sequence.times.cameras.clear();
        self.rays.clear();
    }

    fn true_radar(&self, radar: usize) -> Option<(Transform, i64)> {
        self.world.radars.get(radar).map(|model| (model.vehicle_from_radar, model.clock_ns))
    }

    fn true_pose(&self, t_ns: i64) -> Transform {
        let pose = |t: f64| self.ride.pose(&self.site.terrain, t);
        pose(0.0).inv_mul(&pose(seconds(t_ns)))
    }

    fn true_depth(&self, camera: usize, image: usize) -> Result<Vec<DepthImage>, SourceError> {
        Ok(camera::true_depth(&self.seen_by(camera, image)?))
    }

    fn true_classes(&self, camera: usize, image: usize) -> Result<Vec<ClassImage>, SourceError> {
        Ok(camera::true_classes(&self.seen_by(camera, image)?))
    }
}

impl Source for WorldSequence {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let detections = self.detections(radar, scan)?;
        let t_ns = self.sequence.times.radars[radar][scan];
        Ok(radar::radar_scan(&self.world.radars[radar], &self.sequence.rig.radars[radar], t_ns, &detections)?)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        let t_ns = time("lidar", &self.sequence.times.lidars, lidar, scan)?;
        let mut model = self.world.lidars[lidar].clone();
        model.optics.rain = self.rain;
        let sweep = Sweep {
            seconds: seconds(t_ns),
            site_from_vehicle: &|t: f64| self.ride.pose(&self.site.terrain, t),
        };
        let random = &mut Random::new(self.seed, Purpose::Lidar, lidar, scan);
        Ok(lidar::scan(&mut self.site.at(sweep.seconds), &model, &sweep, t_ns, random))
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        let seen = self.seen_by(camera, image)?;
        let random = &mut Random::new(self.seed, Purpose::Image, camera, image);
        let rays = self.rays[camera].get_or_init(|| camera::rays(seen.camera));
        Ok(camera::image(&seen, rays, None, random))
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        let random = &mut Random::new(self.seed, Purpose::Depth, camera, image);
        Ok(Some(camera::depth(&self.seen_by(camera, image)?, None, random)))
    }
}
