//! The LiDAR: rays that end on surfaces, with noise, drop-outs, and leaves that let some through.

use super::kind::Kind;
use super::random::Random;
use super::scene::Scene;
use super::shape::{Crossing, Ray};
use super::vehicle::lidar_channels;
use ralf::sensors::{Lidar, LidarScan};
use ralf::space::{Transform, Vector};
use std::f64::consts::TAU;

/// Firings per revolution: every 0.2 degrees.
const STEPS: usize = 1800;
/// Where no maximum is known, m.
const USUAL_MAX_RANGE: f64 = 120.0;

/// One revolution, channel by channel.
pub(super) fn scan(
    scene: &Scene<'_>,
    lidar: &Lidar,
    site_from_lidar: &Transform,
    t_ns: i64,
    random: &mut Random,
) -> LidarScan {
    let mut scan = LidarScan { t_ns, ..LidarScan::default() };
    let limit = lidar.max_range.unwrap_or(USUAL_MAX_RANGE);
    for elevation in lidar_channels() {
        let (sin_theta, cos_theta) = elevation.sin_cos();
        for step in 0..STEPS {
            let (sin_phi, cos_phi) = (TAU * step as f64 / STEPS as f64).sin_cos();
            let own = Vector::new(cos_theta * cos_phi, cos_theta * sin_phi, sin_theta);
            let origin = site_from_lidar.translation.vector.into();
            let ray = Ray { origin, direction: site_from_lidar.rotation * own };
            if let Some((range, intensity)) = echo(scene, &ray, limit, random) {
                let noisy = own * (range + random.normal(lidar.sigma_range));
                scan.points.push([noisy.x as f32, noisy.y as f32, noisy.z as f32]);
                scan.intensity.push(intensity as f32);
            }
        }
    }
    scan
}

/// Range and intensity (0 to 1) of a ray's echo, if it comes back.
fn echo(scene: &Scene<'_>, ray: &Ray, limit: f64, random: &mut Random) -> Option<(f64, f64)> {
    let hit = scene.cast_through(ray, limit, |kind, crossing| penetrates(kind, crossing, random))?;
    let facing = -hit.normal.dot(&ray.direction);
    let intensity = reflectance(hit.kind()) * facing.clamp(0.05, 1.0);
    // What comes back falls with the square of the range; grazing and dark surfaces are lost first.
    let lost = 0.01 + 0.5 * (hit.distance / limit).powi(2) * (1.0 - intensity);
    (!random.chance(lost)).then_some((hit.distance, intensity))
}

/// How far a ray comes; `None` where it passes through.
fn penetrates(kind: Kind, crossing: &Crossing, random: &mut Random) -> Option<f64> {
    let depth = match kind {
        Kind::Tree => random.exponential(0.4),
        Kind::Hedge => random.exponential(0.12),
        Kind::Grass => random.exponential(0.5),
        Kind::Fence if random.chance(0.55) => return None,
        _ => 0.0,
    };
    Some(crossing.enter + depth).filter(|distance| *distance <= crossing.leave)
}

fn reflectance(kind: Kind) -> f64 {
    match kind {
        Kind::Road => 0.15,
        Kind::Sidewalk | Kind::Garage | Kind::Wall | Kind::Bridge => 0.35,
        Kind::Marking => 0.8,
        Kind::Grass | Kind::Hedge | Kind::Tree => 0.4,
        Kind::Building => 0.5,
        Kind::Car => 0.3,
        Kind::Pedestrian | Kind::Fence | Kind::Pole => 0.45,
        Kind::Truck | Kind::Cyclist | Kind::Rail | Kind::Container => 0.4,
        Kind::Sign => 0.9,
    }
}
