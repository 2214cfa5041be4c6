//! One world: the numbers that a seed draws from a family's ranges.

use super::calibration::Calibration;
use super::family::{Family, Mount, PlaceKind, RadarRanges};
use super::lidar::{LidarModel, Optics};
use super::radar::{Amplitude, Cell, RadarModel, Waves, sensitivity_db};
use super::span::{Span, one_of, span};
use crate::random::{Purpose, Random};
use nalgebra::{Translation3, UnitQuaternion};
use ralf::space::Transform;

/// A vehicle with its sensors, and how the waves of its world behave. All sequences of a recording share it.
#[derive(Debug, Clone)]
pub(super) struct World {
    pub(super) family: &'static Family,
    pub(super) seed: u64,
    pub(super) radars: Vec<RadarModel>,
    pub(super) lidars: Vec<LidarModel>,
    pub(super) waves: Waves,
    pub(super) calibration: Calibration,
}

impl World {
    /// The world of a seed.
    pub(super) fn new(family: &'static Family, seed: u64) -> Self {
        let mut random = Random::new(seed, Purpose::World, 0, 0);
        let random = &mut random;
        let waves = waves(family, random);
        let radars = radars(family, random);
        let lidars = lidars(family, seed, random);
        let calibration = Calibration::new(&family.calibration, &radars, &lidars, seed);
        Self { family, seed, radars, lidars, waves, calibration }
    }

    /// Where a sequence is driven.
    pub(super) fn place(&self, random: &mut Random) -> PlaceKind {
        one_of(self.family.places, random).unwrap_or(PlaceKind::Street)
    }
}

fn waves(family: &Family, random: &mut Random) -> Waves {
    let ranges = &family.waves;
    Waves {
        asphalt_db: ranges.asphalt.draw(random),
        texture_db: ranges.texture.draw(random),
        mirror_loss_db: ranges.mirror_loss.draw(random),
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
fn mounted((_, place, yaw): &Mount, slack: f64, pitch: f64, random: &mut Random) -> Transform {
    let place = place.map(|value| value + random.between(-slack, slack));
    let yaw = (yaw + random.between(-5.0, 5.0) * slack / 0.2).to_radians();
    let rotation = UnitQuaternion::from_euler_angles(0.0, pitch.to_radians(), yaw);
    Transform::from_parts(Translation3::from(place), rotation)
}

fn radars(family: &Family, random: &mut Random) -> Vec<RadarModel> {
    let ranges = &family.radars;
    let layouts: Vec<_> = ranges.layouts.iter().map(|layout| (*layout, 1.0)).collect();
    let layout = one_of(&layouts, random).unwrap_or_default();
    let lowest = [0.0, 2.0][usize::from(random.chance(0.3))];
    let measures = random.chance(ranges.elevation);
    // Those along the vehicle's axis and those at its corners may be of two kinds.
    let along = radar(ranges, measures, random);
    let across = if random.chance(0.5) { along.clone() } else { radar(ranges, measures, random) };
    let turn_ns = along.period_ns / layout.len().max(1) as i64;
    let mut found = Vec::new();
    for (number, mount) in layout.iter().enumerate() {
        let kind = if mount.2.abs() < 1.0 || mount.2.abs() > 179.0 { &along } else { &across };
        let pitch = random.between(-1.0, 1.0) - lowest;
        found.push(RadarModel {
            name: mount.0.to_owned(),
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
    let amplitudes = [
        (vec![Amplitude::Rcs], 0.5),
        (vec![Amplitude::Rcs, Amplitude::Snr], 0.2),
        (vec![Amplitude::Power], 0.15),
        (vec![Amplitude::Rcs, Amplitude::Power], 0.15),
    ];
    let mut draw = |span: Span| span.draw(random);
    let fov = [draw(ranges.fov_azimuth).to_radians(), draw(ranges.fov_elevation).to_radians()];
    let cell = Cell {
        range: draw(ranges.range_cell),
        azimuth: draw(ranges.azimuth_cell).to_radians(),
        elevation: draw(ranges.elevation_cell).to_radians(),
        doppler: draw(ranges.doppler_cell),
    };
    let sensitivity_db = sensitivity_db(draw(ranges.car_range));
    let period_ns = (1e9 / draw(ranges.rate)).round() as i64;
    let [accuracy, threshold_db, max_range] =
        [draw(ranges.accuracy), draw(ranges.threshold), draw(ranges.max_range)];
    let [doppler_interval, doppler_failure] = [draw(ranges.doppler_interval), draw(ranges.doppler_failure)];
    let [side_lobe_db, angle_failure] = [draw(ranges.side_lobe), draw(ranges.angle_failure)];
    let accepted_db = draw(ranges.accepted);
    let [ambiguity, false_alarms] = [draw(span(0.25, 0.7)), draw(ranges.false_alarms)];
    let room = ranges.room.count(random);
    let chosen = one_of(&[(0, 0.5), (1, 0.2), (2, 0.15), (3, 0.15)], random).unwrap_or(0);
    let amplitudes = amplitudes.into_iter().nth(chosen).map(|(columns, _)| columns).unwrap_or_default();
    RadarModel {
        name: String::new(),
        vehicle_from_radar: Transform::identity(),
        elevation,
        fov,
        period_ns,
        first_ns: 0,
        clock_ns: 0,
        sensitivity_db,
        max_range,
        cell,
        accuracy,
        threshold_db,
        doppler_interval,
        doppler_failure,
        side_lobe_db,
        accepted_db,
        angle_failure,
        ambiguity,
        room,
        false_alarms,
        rcs_offset_db: 0.0,
        amplitudes,
    }
}

fn lidars(family: &Family, seed: u64, random: &mut Random) -> Vec<LidarModel> {
    let ranges = &family.lidars;
    let layouts: Vec<_> = ranges.layouts.iter().map(|layout| (*layout, 1.0)).collect();
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
    for (mount, pattern) in layout {
        found.push(LidarModel {
            name: mount.0.to_owned(),
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
