//! One revolution of a sketched LiDAR.

use super::moment::{Met, Moment};
use super::relief::Relief;
use super::ride::Ride;
use super::rig::LidarModel;
use crate::random::Random;
use crate::shape::Ray;
use ralf::sensors::LidarScan;
use ralf::space::{Point, Vector};
use std::f64::consts::TAU;

/// Nothing nearer is told, m.
const NEAREST: f64 = 0.8;
/// Weaker echoes than this share of what comes back from white at the usual range are lost.
const FAINTEST: f64 = 0.1;
/// How often a ray that meets an edge ends between what lies before and what behind it.
const MIXED: f64 = 0.08;

/// A LiDAR in its drive.
pub(super) struct Sweep<'a> {
    pub(super) lidar: &'a LidarModel,
    pub(super) ride: &'a Ride,
    pub(super) relief: &'a Relief,
    /// The middle of the turn, s after the start.
    pub(super) seconds: f64,
    pub(super) rains: bool,
}

/// Points as they lie in a file: moved to the middle of the turn as the driver knows how.
pub(super) fn scan(moment: &Moment<'_>, sweep: &Sweep<'_>, t_ns: i64, random: &mut Random) -> LidarScan {
    let Sweep { lidar, ride, relief, seconds, .. } = *sweep;
    let turn = lidar.period_ns as f64 * 1e-9;
    let middle = ride.pose(relief, seconds) * lidar.vehicle_from_lidar;
    let mut scan = LidarScan { t_ns, ..LidarScan::default() };
    // What the driver believes of the own motion is a little off.
    let drift = Vector::new(random.normal(0.05), random.normal(0.05), random.normal(0.05));
    let mut before: Vec<Option<f64>> = vec![None; lidar.elevations.len()];
    for column in 0..lidar.columns {
        let share = column as f64 / lidar.columns as f64;
        let later = (share - 0.5) * turn;
        let pose = ride.pose(relief, seconds + later) * lidar.vehicle_from_lidar;
        let azimuth = lidar.start - TAU * share;
        for (row, elevation) in lidar.elevations.iter().enumerate() {
            let aside = if row % 2 == 0 { lidar.stagger } else { -lidar.stagger };
            let own = direction(azimuth + aside, *elevation);
            if lidar.is_blocked(&own) {
                continue;
            }
            let ray = Ray { origin: pose.translation.vector.into(), direction: pose.rotation * own };
            let met = moment.cast(&ray, lidar.max_range, later, random);
            let edge = std::mem::replace(&mut before[row], met.map(|met| met.distance));
            let Some((range, intensity)) = echo(sweep, met, edge, random) else { continue };
            let place: Point = middle.inverse() * (ray.origin + ray.direction * range);
            let told = place + drift * later;
            scan.points.push([told.x as f32, told.y as f32, told.z as f32]);
            scan.intensity.push(intensity as f32);
        }
    }
    scan
}

fn direction(azimuth: f64, elevation: f64) -> Vector {
    let (sin, cos) = azimuth.sin_cos();
    let (up, level) = elevation.sin_cos();
    Vector::new(level * cos, level * sin, up)
}

/// Range and intensity of what comes back, if anything does.
fn echo(sweep: &Sweep<'_>, met: Option<Met>, edge: Option<f64>, random: &mut Random) -> Option<(f64, f64)> {
    let lidar = sweep.lidar;
    let clear = met.map_or(lidar.max_range, |met| met.distance);
    if sweep.rains && random.chance(lidar.rain) {
        let drop = random.exponential(3.0) + random.exponential(3.0);
        if (1.0..clear).contains(&drop) {
            return Some((drop, 3.0));
        }
    }
    let Met { distance, cosine, reflectance, ground } = met?;
    let fading = (random.exponential(1.0) + random.exponential(1.0) + random.exponential(1.0)) / 3.0;
    let power = reflectance * cosine.powf(0.6) * (lidar.bright_range / distance.max(5.0)).powi(2) * fading;
    // Water sends a flat ray on.
    let shiny = ground && random.chance(lidar.wet * (distance / 25.0).min(1.0));
    if distance < NEAREST || power < FAINTEST || shiny || random.chance(lidar.lost) {
        return None;
    }
    let mixed = edge.filter(|edge| (0.5..4.0).contains(&(edge - distance).abs()) && random.chance(MIXED));
    let range = match mixed {
        Some(edge) => distance + random.uniform() * (edge - distance),
        None => distance + random.normal(lidar.sigma * (0.6 + 0.4 / cosine.clamp(0.15, 1.0))),
    };
    let intensity = reflectance * cosine.sqrt() * (1.0 + random.normal(0.1)) * 100.0;
    Some((range, intensity.clamp(0.0, 255.0)))
}
