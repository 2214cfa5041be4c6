//! A sketched sequence as a source of measurements.

use super::lidar::{self, Sweep};
use super::moment::Stage;
use super::places::{Place, Site};
use super::radar::{self, Echo, View, Weather};
use super::ride::Ride;
use super::rig::Sensors;
use super::scene::Scene;
use crate::random::{Purpose, Random};
use crate::scenario::ScenarioError;
use crate::simulation::{Last, Simulation, time};
use crate::truth::Truth;
use ralf::label::Cause;
use ralf::sensors::{
    CameraImage, ClassImage, DepthImage, DepthOutput, LidarScan, RadarScan, Sequence, Source, SourceError,
    Timelines,
};
use ralf::space::Transform;
use std::sync::Arc;

/// Time of the start, ns.
const START_NS: i64 = 1_710_000_000_000_000_000;
/// So long a drive nothing stands in the way, s; it is cleared for so many m ahead, behind and to a side.
const LASTING: f64 = 14.0;
const CLEAR: [f64; 3] = [4.2, 1.3, 1.35];
/// The ground has spots so far beside the way, and one in so many is much stronger, dB.
const BESIDE: f64 = 38.0;
const STRONG: (f64, f64) = (0.006, 14.0);
/// Bursts of interference last so long, s.
const BURST: f64 = 0.4;
/// What is lower or higher than this is driven over or under, m.
const IN_THE_WAY: [f64; 2] = [0.3, 1.9];

/// A sequence.
#[derive(Debug)]
pub(super) struct SketchSequence {
    sequence: Sequence,
    sensors: Arc<Sensors>,
    stage: Stage,
    ride: Ride,
    /// x, y (m) and strength (dBsm).
    ground: Vec<[f64; 3]>,
    rains: bool,
    last: Last<Echo>,
    seed: u64,
}

impl SketchSequence {
    pub(super) fn new(
        place: Place,
        sensors: Arc<Sensors>,
        seed: u64,
        index: usize,
        scans: usize,
    ) -> Result<Self, ScenarioError> {
        let seed = seed.wrapping_mul(1_000_033).wrapping_add(index as u64 + 1);
        let random = &mut Random::new(seed, Purpose::Placement, 0, 0);
        let Site { mut scene, way, speed } = place.site(random);
        let ground = ground(&scene, &way, random);
        let ride = Ride::new(way, speed, random);
        clear_the_way(&mut scene, &ride);
        let stage = Stage::new(scene);
        let times = timelines(&sensors, scans);
        let last = times.radars.iter().flatten().max().map_or(0, |last| last - START_NS);
        let said = &mut Random::new(seed, Purpose::Odometry, 0, 0);
        let motion = ride.said(&stage.scene.relief, START_NS, 2.0 + last as f64 * 1e-9, said);
        let motion = motion.filter(|_| scans > 0).ok_or(ScenarioError::Value {
            key: "scans",
            expected: "at least one".into(),
            found: scans.to_string(),
        })?;
        let rains = sensors.rains;
        let sequence = Sequence {
            name: format!("{index:02}"),
            title: format!("{}{}", place.name(), if rains { ", rain" } else { "" }),
            rig: sensors.said.clone(),
            times,
            motion,
            depth_output: DepthOutput::Depth,
        };
        Ok(Self { sequence, sensors, stage, ride, ground, rains, last: Last::default(), seed })
    }

    fn echoes(&self, radar: usize, scan: usize) -> Result<Arc<Vec<Echo>>, SourceError> {
        self.last.or_made(radar, scan, || self.measured(radar, scan))
    }

    fn measured(&self, radar: usize, scan: usize) -> Result<Vec<Echo>, SourceError> {
        let t_ns = time("radar", &self.sequence.times.radars, radar, scan)?;
        let model = &self.sensors.radars[radar];
        let relief = &self.stage.scene.relief;
        let moment = self.stage.at(seconds(t_ns));
        let view = View {
            moment: &moment,
            radar: model,
            site_from_radar: self.ride.pose(relief, seconds(t_ns)) * model.vehicle_from_radar,
            velocity: self.ride.velocity(relief, &model.vehicle_from_radar, seconds(t_ns)),
            ground: &self.ground,
        };
        let weather = Weather { rains: self.rains, burst: self.burst(radar, seconds(t_ns)) };
        Ok(radar::scan(&view, &weather, &mut Random::new(self.seed, Purpose::Radar, radar, scan)))
    }

    /// Azimuth (rad) and mean number of what another radar does to this one at a time.
    fn burst(&self, radar: usize, seconds: f64) -> Option<[f64; 2]> {
        let model = &self.sensors.radars[radar];
        let random = &mut Random::new(self.seed, Purpose::Scatterers, radar, (seconds / BURST) as usize);
        let scans = BURST / (model.period_ns as f64 * 1e-9);
        let [likely, mean] = model.bursts;
        let [wide, _] = model.half_view;
        let begins = random.chance((likely * scans).min(1.0));
        begins.then(|| [random.between(-wide, wide), mean * random.between(0.4, 1.4)])
    }
}

/// Spots of the ground beside the way.
fn ground(scene: &Scene, way: &super::way::Way, random: &mut Random) -> Vec<[f64; 3]> {
    let [mean, spread] = scene.ground.strength_db;
    let [from, to] = [-70.0, 200.0];
    let count = (scene.ground.density * (to - from) * 2.0 * BESIDE) as usize;
    let spot = |_| {
        let [x, y, _] = way.at(random.between(from, to), random.between(-BESIDE, BESIDE));
        let lump = if random.chance(STRONG.0) { STRONG.1 } else { 0.0 };
        [x, y, mean + random.normal(spread) + lump]
    };
    (0..count).map(spot).collect()
}

/// Takes away what the vehicle would drive through.
fn clear_the_way(scene: &mut Scene, ride: &Ride) {
    let way: Vec<[f64; 3]> = ride.places(LASTING).collect();
    let [ahead, behind, aside] = CLEAR;
    let mut gone = vec![false; scene.things.len()];
    for body in &scene.bodies {
        let thing = &scene.things[body.thing];
        let half = body.shape.half_size();
        let passed = body.center.z + half.z < IN_THE_WAY[0] || body.center.z - half.z > IN_THE_WAY[1];
        if thing.speed != 0.0 || passed {
            continue;
        }
        let [x, y, heading] = thing.start;
        let (sin, cos) = heading.sin_cos();
        for [own_x, own_y, own_heading] in &way {
            for along in [-behind, 0.0, ahead / 2.0, ahead] {
                let [px, py] = [own_x + along * own_heading.cos() - x, own_y + along * own_heading.sin() - y];
                let [u, v] = [cos * px + sin * py - body.center.x, cos * py - sin * px - body.center.y];
                gone[body.thing] |= u.abs() < half.x + aside && v.abs() < half.y + aside;
            }
        }
    }
    scene.bodies.retain(|body| !gone[body.thing]);
    scene.spots.retain(|spot| !gone[spot.thing]);
}

fn timelines(sensors: &Sensors, scans: usize) -> Timelines {
    let radars: Vec<Vec<i64>> = sensors
        .radars
        .iter()
        .map(|radar| {
            (0..scans as i64).map(|scan| START_NS + radar.first_ns + scan * radar.period_ns).collect()
        })
        .collect();
    let end = radars.iter().flatten().max().copied().unwrap_or(START_NS);
    let period_ns = sensors.lidar.period_ns;
    let turns = (0..).map(|turn| START_NS + turn * period_ns).take_while(|t| *t < end + period_ns / 2);
    Timelines { lidars: vec![turns.collect()], radars, cameras: Vec::new() }
}

/// Since the start.
fn seconds(t_ns: i64) -> f64 {
    (t_ns - START_NS) as f64 * 1e-9
}

impl Simulation for SketchSequence {
    fn truth(&self, radar: usize, scan: usize) -> Result<Vec<Truth>, SourceError> {
        Ok(radar::truth(&self.echoes(radar, scan)?))
    }

    fn causes(&self) -> &'static [Cause] {
        &Cause::ALL
    }

    fn remove_cameras(&mut self) {}

    fn true_radar(&self, radar: usize) -> Option<(Transform, i64)> {
        self.sensors.radars.get(radar).map(|model| (model.vehicle_from_radar, 0))
    }

    fn true_pose(&self, t_ns: i64) -> Transform {
        let pose = |t: f64| self.ride.pose(&self.stage.scene.relief, t);
        pose(0.0).inv_mul(&pose(seconds(t_ns)))
    }

    fn true_depth(&self, camera: usize, image: usize) -> Result<Vec<DepthImage>, SourceError> {
        Err(no_camera(camera, image))
    }

    fn true_classes(&self, camera: usize, image: usize) -> Result<Vec<ClassImage>, SourceError> {
        Err(no_camera(camera, image))
    }
}

fn no_camera(camera: usize, image: usize) -> SourceError {
    format!("camera {camera} has no measurement {image}").into()
}

impl Source for SketchSequence {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let echoes = self.echoes(radar, scan)?;
        let t_ns = self.sequence.times.radars[radar][scan];
        let said = &self.sequence.rig.radars[radar];
        Ok(radar::radar_scan(&self.sensors.radars[radar], said, t_ns, &echoes)?)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        let t_ns = time("lidar", &self.sequence.times.lidars, lidar, scan)?;
        let sweep = Sweep {
            lidar: &self.sensors.lidar,
            ride: &self.ride,
            relief: &self.stage.scene.relief,
            seconds: seconds(t_ns),
            rains: self.rains,
        };
        let random = &mut Random::new(self.seed, Purpose::Lidar, lidar, scan);
        Ok(lidar::scan(&self.stage.at(sweep.seconds), &sweep, t_ns, random))
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        Err(no_camera(camera, image))
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        Err(no_camera(camera, image))
    }
}
