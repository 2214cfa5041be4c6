//! The sensors of a sketched recording: as they are, and as the recording says they are. All ranges are chosen, about
//! what data sheets of such sensors say.

use super::places::Place;
use crate::mounting::off;
use crate::random::Random;
use nalgebra::{Translation3, UnitQuaternion};
use ralf::sensors::{Elevation, Lidar, Radar, Reliability, Rig};
use ralf::space::{Transform, Vector};
use std::f64::consts::PI;

/// What mountings are off by at most, each way: degrees and m.
const OFF: [f64; 2] = [0.2, 0.02];
/// Elevation of a radar that measures none is said to be so uncertain, rad.
const UNKNOWN: f64 = 0.087;

/// A radar. Levels are in dB above noise.
#[derive(Debug, Clone)]
pub(super) struct RadarModel {
    pub(super) name: String,
    /// Where it really sits.
    pub(super) vehicle_from_radar: Transform,
    pub(super) elevation: bool,
    /// Half the field of view in azimuth and elevation, rad.
    pub(super) half_view: [f64; 2],
    /// Standard deviations of a usual range (m), azimuth and elevation (rad).
    pub(super) sigmas: [f64; 3],
    pub(super) max_range: f64,
    /// Of a cell: m and m/s.
    pub(super) cell: [f64; 2],
    /// Half the unambiguous interval of range rates, m/s.
    pub(super) half_interval: f64,
    /// Where 0 dBsm are 13 dB above noise, m.
    pub(super) reach: f64,
    /// Detections that a scan has room for.
    pub(super) room: usize,
    pub(super) period_ns: i64,
    pub(super) first_ns: i64,
    /// Names of the columns.
    pub(super) fields: &'static [&'static str],
    /// False alarms of a scan.
    pub(super) noise: f64,
    /// How likely a burst of interference begins in a scan, and how many detections it makes.
    pub(super) bursts: [f64; 2],
    /// Drops that are heard in a scan where it rains.
    pub(super) drops: f64,
    /// What is folded back from beyond the farthest range loses so much.
    pub(super) fold_db: f64,
    /// How often a thing is seen mirrored in the ground.
    pub(super) ground_mirror: f64,
    /// The ground is heard up to here, m.
    pub(super) ground_range: f64,
    /// What every mirror takes besides its own.
    pub(super) mirror_db: f64,
    /// How often a range rate is taken for another.
    pub(super) wrong_rate: f64,
    /// How often two things of a cell are told as one between them.
    pub(super) merged: f64,
    /// Ranges of spurious tones, m.
    pub(super) spurs: [f64; 3],
    /// Returns of the own bumper in a scan, and at which azimuths, rad.
    pub(super) bumper: f64,
    pub(super) bumper_at: [f64; 3],
    /// Share of low parts of vehicles that send waves under the floor, and how much longer the way is there on
    /// average, m.
    pub(super) under_floor: [f64; 2],
    /// Side lobes: by how much the sine of the azimuth is off, and how far below they lie.
    pub(super) lobes: Vec<[f64; 2]>,
    /// The same in range, below.
    pub(super) range_lobe_db: f64,
    /// Weaker than the strongest of its cell by more than this is hidden.
    pub(super) dynamic_db: f64,
    /// Share of what is detected that the sensor hands on.
    pub(super) handed_on: f64,
}

/// A LiDAR.
#[derive(Debug, Clone)]
pub(super) struct LidarModel {
    pub(super) vehicle_from_lidar: Transform,
    /// rad, from the lowest on.
    pub(super) elevations: Vec<f64>,
    pub(super) columns: usize,
    pub(super) period_ns: i64,
    /// Azimuth at which a turn begins, and by how much every second beam looks aside, rad.
    pub(super) start: f64,
    pub(super) stagger: f64,
    pub(super) sigma: f64,
    /// Share of rays that are lost for no reason.
    pub(super) lost: f64,
    /// How much of the ground is under water, and how often a ray meets a drop.
    pub(super) wet: f64,
    pub(super) rain: f64,
    /// Up to here what is white comes back, m.
    pub(super) bright_range: f64,
    pub(super) max_range: f64,
}

impl LidarModel {
    /// Whether the own roof is in the way: what is below so much behind the sensor's own height.
    pub(super) fn is_blocked(&self, direction: &Vector) -> bool {
        let own = self.vehicle_from_lidar.rotation * direction;
        let place = self.vehicle_from_lidar.translation.vector;
        let roof = 1.5_f64.min(place.z - 0.15);
        if own.z >= 0.0 {
            return false;
        }
        let met = place + own * ((place.z - roof) / -own.z);
        (-0.9..3.6).contains(&met.x) && met.y.abs() < 0.9
    }
}

/// Sensors as they are, and as they are said to be.
#[derive(Debug, Clone)]
pub(super) struct Sensors {
    pub(super) radars: Vec<RadarModel>,
    pub(super) lidar: LidarModel,
    pub(super) said: Rig,
    /// How likely it rains.
    pub(super) rains: bool,
}

/// Name, place (m) and yaw (degrees) of a radar.
type Mount = (&'static str, [f64; 3], f64);

const FRONT: Mount = ("front", [3.7, 0.0, 0.5], 0.0);
const REAR: Mount = ("rear", [-0.95, 0.0, 0.65], 180.0);
const CORNERS: [Mount; 4] = [
    ("front_left", [3.6, 0.75, 0.55], 45.0),
    ("front_right", [3.6, -0.75, 0.55], -45.0),
    ("rear_left", [-0.85, 0.75, 0.6], 138.0),
    ("rear_right", [-0.85, -0.75, 0.6], -138.0),
];
const LEFT: Mount = ("left", [1.6, 0.93, 0.75], 88.0);
const COLUMNS: [&[&str]; 4] = [
    &["range", "azimuth", "elevation", "doppler", "rcs", "snr"],
    &["x", "y", "z", "doppler", "rcs"],
    &["x", "y", "z", "doppler", "rcs", "snr"],
    &["x", "y", "z", "doppler", "snr"],
];

impl Sensors {
    /// What drives through such places.
    pub(super) fn new(place: Place, random: &mut Random) -> Self {
        let mounts: Vec<Mount> = match (place, random.chance(0.5)) {
            (Place::Quay, _) => CORNERS.to_vec(),
            (Place::Ring, true) => [FRONT].into_iter().chain(CORNERS).collect(),
            (Place::Ring, false) => vec![FRONT, REAR],
            (Place::Lane, _) => vec![FRONT, LEFT, REAR],
            (Place::Gardens, true) => vec![FRONT, REAR],
            (Place::Gardens, false) => vec![FRONT],
        };
        let rains = random.chance(if place == Place::Lane { 0.1 } else { 0.5 });
        let long = place == Place::Ring;
        let ahead = radar(place, long, random);
        let aside = radar(place, false, random);
        let radars: Vec<RadarModel> = mounts
            .iter()
            .enumerate()
            .map(|(number, mount)| {
                let model = if mount.2.abs() < 1.0 { &ahead } else { &aside };
                let mounted = mounted(mount, random);
                let turn_ns = model.period_ns / mounts.len() as i64;
                RadarModel {
                    name: mount.0.to_owned(),
                    vehicle_from_radar: mounted,
                    first_ns: number as i64 * turn_ns,
                    ..model.clone()
                }
            })
            .collect();
        let lidar = lidar(rains, random);
        let said = Rig {
            radars: radars.iter().map(|radar| said_radar(radar, random)).collect(),
            lidars: vec![said_lidar(&lidar, random)],
            cameras: Vec::new(),
        };
        Self { radars, lidar, said, rains }
    }
}

/// Nobody mounts exactly where another did.
fn mounted((_, place, yaw_deg): &Mount, random: &mut Random) -> Transform {
    let place = place.map(|value| value + random.normal(0.05));
    let [pitch_deg, yaw_deg] = [random.normal(0.8), yaw_deg + random.normal(2.0)];
    let turn = UnitQuaternion::from_euler_angles(0.0, pitch_deg.to_radians(), yaw_deg.to_radians());
    Transform::from_parts(Translation3::from(place), turn)
}

fn radar(place: Place, long: bool, random: &mut Random) -> RadarModel {
    let elevation = random.chance(if place == Place::Ring && !long { 0.3 } else { 0.85 });
    let half_view = half_view(long, random);
    let azimuth = random.between(0.6, 1.4) * if long { 0.5 } else { 1.0 };
    let sigmas = [random.between(0.07, 0.16), azimuth.to_radians(), (1.7 * azimuth).to_radians()];
    let max_range = if long { random.between(120.0, 200.0) } else { random.between(38.0, 80.0) };
    let ground = if long { [30.0, 60.0] } else { [14.0, 34.0] };
    RadarModel {
        name: String::new(),
        vehicle_from_radar: Transform::identity(),
        elevation,
        half_view,
        sigmas,
        max_range,
        cell: [random.between(0.25, 0.6), random.between(0.08, 0.2)],
        half_interval: if long { random.between(30.0, 60.0) } else { random.between(12.0, 40.0) },
        reach: if long { random.between(70.0, 110.0) } else { random.between(32.0, 52.0) },
        room: random.between(280.0, 620.0) as usize,
        period_ns: (1e9 / random.between(11.0, 15.0)) as i64,
        first_ns: 0,
        fields: COLUMNS[(random.uniform() * COLUMNS.len() as f64) as usize],
        noise: random.between(20.0, 150.0),
        bursts: [random.between(0.0, 0.08), random.between(60.0, 120.0)],
        drops: random.between(3.0, 70.0),
        fold_db: random.between(1.0, 8.0),
        ground_mirror: random.between(0.1, 0.4),
        ground_range: random.between(ground[0], ground[1]),
        mirror_db: random.between(0.0, 5.0),
        wrong_rate: random.between(0.0, 0.04),
        merged: random.between(0.1, 0.5),
        spurs: [0.0; 3].map(|_| random.between(2.0, max_range)),
        bumper: random.between(1.0, 7.0),
        bumper_at: [0.0; 3].map(|_| random.between(-half_view[0], half_view[0])),
        under_floor: [random.between(0.05, 0.4), random.between(1.5, 4.0)],
        lobes: lobes(random),
        range_lobe_db: random.between(22.0, 30.0),
        dynamic_db: random.between(14.0, 24.0),
        handed_on: random.between(0.7, 1.0),
    }
}

fn half_view(long: bool, random: &mut Random) -> [f64; 2] {
    let wide = if long { random.between(25.0, 50.0) } else { random.between(52.0, 76.0) };
    let high = if long { random.between(5.0, 9.0) } else { random.between(8.0, 20.0) };
    [wide.to_radians(), high.to_radians()]
}

/// The pattern of an array that is not quite calibrated: four lobes to either side.
fn lobes(random: &mut Random) -> Vec<[f64; 2]> {
    let ranges =
        [[0.1, 0.16, 15.0, 18.0], [0.2, 0.3, 17.0, 21.0], [0.38, 0.55, 17.0, 22.0], [0.7, 0.95, 20.0, 25.0]];
    let mut found = Vec::new();
    for [near, far, least, most] in ranges {
        let [aside, below] = [random.between(near, far), random.between(least, most)];
        found.extend([[aside, below], [-aside, below]]);
    }
    found
}

fn lidar(rains: bool, random: &mut Random) -> LidarModel {
    let count = [32, 40, 48, 64][(random.uniform() * 4.0) as usize];
    let (lowest, highest) = (random.between(-29.0, -20.0), random.between(6.0, 16.0));
    // Beams lie closer together about the horizon, or evenly.
    let bend = if random.chance(0.5) { 1.0 } else { random.between(1.1, 1.5) };
    let elevation = |beam: usize| {
        let share = 2.0 * beam as f64 / (count - 1) as f64 - 1.0;
        let bent = share.signum() * share.abs().powf(bend);
        (lowest + (highest - lowest) * (bent + 1.0) / 2.0).to_radians()
    };
    let place = [random.between(0.8, 1.4), random.normal(0.04), random.between(1.8, 2.4)];
    let mut tilt = || random.normal(0.8).to_radians();
    let turn = UnitQuaternion::from_euler_angles(tilt(), tilt(), tilt());
    LidarModel {
        vehicle_from_lidar: Transform::from_parts(Translation3::from(place), turn),
        elevations: (0..count).map(elevation).collect(),
        columns: random.between(36_000.0, 56_000.0) as usize / count,
        period_ns: 100_000_000,
        start: random.between(-PI, PI),
        stagger: if random.chance(0.5) { 0.0 } else { random.between(0.0, 0.02) },
        sigma: random.between(0.02, 0.035),
        lost: random.between(0.01, 0.05),
        wet: if rains { random.between(0.1, 0.8) } else { 0.0 },
        rain: if rains { random.between(0.0005, 0.004) } else { 0.0 },
        bright_range: random.between(45.0, 80.0),
        max_range: random.between(90.0, 160.0),
    }
}

fn said_radar(radar: &RadarModel, random: &mut Random) -> Radar {
    let [sigma_range, sigma_azimuth, sigma_elevation] = radar.sigmas;
    Radar {
        name: radar.name.clone(),
        fields: radar.fields.iter().map(|field| (*field).to_owned()).collect(),
        vehicle_from_radar: off(&radar.vehicle_from_radar, OFF[0], OFF[1], random),
        elevation: if radar.elevation { Elevation::Measured } else { Elevation::None },
        fov_azimuth: 2.0 * radar.half_view[0],
        fov_elevation: 2.0 * radar.half_view[1],
        sigma_range,
        sigma_azimuth,
        sigma_elevation: if radar.elevation { sigma_elevation } else { UNKNOWN },
        reliability: Reliability::default(),
    }
}

fn said_lidar(lidar: &LidarModel, random: &mut Random) -> Lidar {
    let lowest = lidar.elevations.first().map_or(UNKNOWN, |elevation| -elevation);
    Lidar {
        name: "top".to_owned(),
        vehicle_from_lidar: off(&lidar.vehicle_from_lidar, OFF[0] / 2.0, OFF[1] / 2.0, random),
        sigma_range: lidar.sigma,
        lowest_beam: lowest,
        max_range: Some(lidar.max_range),
    }
}
