//! One world: the numbers that a seed draws from a family's ranges.

use super::calibration::Calibration;
use super::camera::{CameraModel, cameras};
use super::family::{Family, Mount, MountedLidar, PlaceKind, RadarRanges};
use super::lidar::{LidarModel, Optics};
use super::mixture::Mixture;
use super::radar::{Amplitude, Cell, Keeps, RadarModel, Spikiness, Waves, sensitivity_db};
use super::span::{Span, one_of, span};
use crate::random::{Purpose, Random};
use nalgebra::{Translation3, UnitQuaternion};
use ralf::space::Transform;

/// By how much the sine of an ambiguous angle is off: wavelength over the spacing of an array with gaps.
const AMBIGUITY: Span = span(0.25, 0.7);
/// What radars tell of an echo's strength, and how likely.
const AMPLITUDES: [(&[Amplitude], f64); 4] = [
    (&[Amplitude::Rcs], 0.5),
    (&[Amplitude::Rcs, Amplitude::Snr], 0.2),
    (&[Amplitude::Power], 0.15),
    (&[Amplitude::Rcs, Amplitude::Power], 0.15),
];

/// A vehicle with its sensors, and how the waves of its world behave. All sequences of a recording share it.
#[derive(Debug, Clone)]
pub(super) struct World {
    pub(super) mixture: Mixture,
    pub(super) seed: u64,
    pub(super) radars: Vec<RadarModel>,
    pub(super) lidars: Vec<LidarModel>,
    pub(super) cameras: Vec<CameraModel>,
    pub(super) waves: Waves,
    pub(super) calibration: Calibration,
}

impl World {
    /// The world of a seed.
    pub(super) fn new(mixture: Mixture, seed: u64) -> Self {
        let mut random = Random::new(seed, Purpose::World, 0, 0);
        let random = &mut random;
        let sensors = mixture.sensors;
        let waves = waves(mixture.waves, seed, random);
        let radars = radars(sensors, random);
        let lidars = lidars(sensors, seed, &radars, random);
        let cameras = cameras(&sensors.calibration, seed);
        let mut calibration = Calibration::new(&sensors.calibration, &radars, &lidars, seed);
        calibration.rig.cameras = cameras.iter().map(|camera| camera.declared.clone()).collect();
        Self { mixture, seed, radars, lidars, cameras, waves, calibration }
    }

    /// Where a sequence is driven.
    pub(super) fn place(&self, random: &mut Random) -> PlaceKind {
        one_of(self.mixture.places.places, random).unwrap_or(PlaceKind::Street)
    }
}

fn waves(family: &Family, seed: u64, random: &mut Random) -> Waves {
    let ranges = &family.waves;
    // A stream of their own: one more of these leaves a seed's sensors as they are.
    let growth = &mut Random::new(seed, Purpose::World, 1, 0);
    Waves {
        asphalt_db: ranges.asphalt.draw(random),
        texture_db: ranges.texture.draw(random),
        lumps: [ranges.lumps.draw(random), ranges.lump_strength.draw(random)],
        spikes: Spikiness {
            mean_db: ranges.spike_mean.draw(random),
            scale_db: ranges.spike_scale.draw(random),
            staying: ranges.spikes_stay.draw(random),
            shadow: ranges.spikes_shadow.draw(growth),
            on_grass: ranges.spikes_on_grass.draw(growth),
        },
        grass_db: ranges.grass.draw(growth),
        mirror_loss_db: ranges.mirror_loss.draw(random),
        mirror_heights: ranges.mirror_heights.draw(random),
        aside_db: ranges.aside.draw(random),
        own_front_db: ranges.own_front.draw(random),
        floor: ranges.floor.draw(random),
        floor_way: ranges.floor_way.draw(random),
        road_mirror: ranges.road_mirror.draw(random),
        window_loss_db: ranges.window_loss.draw(random),
        leaf_loss_db: ranges.leaf_loss.draw(random),
        strength_db: ranges.strength.draw(random),
        interference: ranges.interference.draw(random),
        bumper: ranges.bumper.count(random),
        rain: false,
    }
}

/// Nobody mounts exactly where another did.
fn mounted(mount: &Mount, slack: f64, pitch: f64, random: &mut Random) -> Transform {
    let place = mount.place.map(|value| value + random.between(-slack, slack));
    let yaw = (mount.yaw_deg + random.between(-5.0, 5.0) * slack / 0.2).to_radians();
    let rotation = UnitQuaternion::from_euler_angles(0.0, pitch.to_radians(), yaw);
    Transform::from_parts(Translation3::from(place), rotation)
}

fn radars(family: &Family, random: &mut Random) -> Vec<RadarModel> {
    let ranges = &family.radars;
    let layouts: Vec<_> = ranges.layouts.iter().map(|layout| (*layout, 1.0)).collect();
    let layout = one_of(&layouts, random).unwrap_or_default();
    let upward = if random.chance(0.3) { 2.0 } else { 0.0 };
    let measures = random.chance(ranges.elevation);
    // Those along the vehicle's axis and those at its corners may be of two kinds.
    let along = radar(ranges, measures, random);
    let across = if random.chance(0.5) { along.clone() } else { radar(ranges, measures, random) };
    let turn_ns = along.period_ns / layout.len().max(1) as i64;
    let mut found = Vec::new();
    for (number, mount) in layout.iter().enumerate() {
        let kind = if mount.yaw_deg.abs() < 1.0 || mount.yaw_deg.abs() > 179.0 { &along } else { &across };
        let pitch = random.between(-1.0, 1.0) - upward;
        found.push(RadarModel {
            name: mount.name.to_owned(),
            vehicle_from_radar: mounted(mount, 0.1, pitch, random),
            first_ns: number as i64 * turn_ns,
            clock_ns: (random.between(-1.0, 1.0) * family.calibration.clock.draw(random) * 1e6) as i64,
            rcs_offset_db: random.between(-4.0, 4.0),
            ..kind.clone()
        });
    }
    found
}

/// A model of radar; name and place come later.
fn radar(ranges: &RadarRanges, elevation: bool, random: &mut Random) -> RadarModel {
    let side_lobe_db = ranges.side_lobe.draw(random);
    RadarModel {
        name: String::new(),
        vehicle_from_radar: Transform::identity(),
        elevation,
        fov: [ranges.fov_azimuth, ranges.fov_elevation].map(|span| span.draw(random).to_radians()),
        period_ns: (1e9 / ranges.rate.draw(random)).round() as i64,
        first_ns: 0,
        clock_ns: 0,
        sensitivity_db: sensitivity_db(ranges.car_range.draw(random)),
        max_range: ranges.max_range.draw(random),
        cell: Cell {
            range: ranges.range_cell.draw(random),
            azimuth: ranges.azimuth_cell.draw(random).to_radians(),
            elevation: ranges.elevation_cell.draw(random).to_radians(),
            doppler: ranges.doppler_cell.draw(random),
        },
        grouping: ranges.grouping.draw(random),
        accuracy: ranges.accuracy.draw(random),
        threshold_db: ranges.threshold.draw(random),
        doppler_interval: ranges.doppler_interval.draw(random),
        doppler_failure: ranges.doppler_failure.draw(random),
        side_lobe_db,
        accepted_db: side_lobe_db - ranges.accepted.draw(random),
        angle_failure: ranges.angle_failure.draw(random),
        ambiguity: AMBIGUITY.draw(random),
        room: ranges.room.count(random),
        keeps: one_of(ranges.keeps, random).unwrap_or(Keeps::Clearest),
        least_rcs_db: ranges.least_rcs.draw(random),
        false_alarms: ranges.false_alarms.ratio(random),
        rcs_offset_db: 0.0,
        amplitudes: one_of(&AMPLITUDES, random).unwrap_or_default().to_vec(),
    }
}

/// Whether LiDARs look where each radar does: nobody records radars whose surroundings nothing else sees.
fn look_along(layout: &[MountedLidar], radars: &[RadarModel]) -> bool {
    let sees = |MountedLidar { mount, pattern }: &MountedLidar, radar: &RadarModel| {
        let yaw = radar.vehicle_from_radar.rotation.euler_angles().2.to_degrees();
        let aside = (yaw - mount.yaw_deg + 180.0).rem_euclid(360.0) - 180.0;
        aside.abs() <= pattern.width / 2.0
    };
    radars.iter().all(|radar| layout.iter().any(|lidar| sees(lidar, radar)))
}

fn lidars(family: &Family, seed: u64, radars: &[RadarModel], random: &mut Random) -> Vec<LidarModel> {
    let ranges = &family.lidars;
    let layouts = ranges.layouts.iter().filter(|layout| look_along(layout, radars));
    let layouts: Vec<_> = layouts.map(|layout| (*layout, 1.0)).collect();
    let layout = one_of(&layouts, random).unwrap_or_default();
    let period_ns = (1e9 / ranges.rate.draw(random)).round() as i64;
    let rolling = random.chance(ranges.rolling);
    // Most drivers keep the times; data sets that are compensated often drop them.
    let timed = rolling && random.chance(0.6);
    let optics = Optics {
        sigma: ranges.sigma.draw(random),
        lost: ranges.lost.draw(random),
        glass: ranges.glass.draw(random),
        // As KITTI (0 to 1) or as nuScenes (0 to 255).
        scale: if random.chance(0.5) { 1.0 } else { 255.0 },
        rain: 0.0,
        seed,
    };
    let mut found = Vec::new();
    for MountedLidar { mount, pattern } in layout {
        found.push(LidarModel {
            name: mount.name.to_owned(),
            vehicle_from_lidar: mounted(mount, 0.15, random.between(-0.5, 0.5), random),
            pattern: *pattern,
            period_ns,
            rolling,
            timed,
            optics,
        });
    }
    found
}
