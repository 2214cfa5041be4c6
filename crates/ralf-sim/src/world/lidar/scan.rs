//! One revolution.

use super::LidarModel;
use crate::random::Random;
use crate::shape::Ray;
use crate::world::scene::Moment;
use ralf::sensors::LidarScan;
use ralf::space::{Point, Transform, Vector};

/// Things are moved anew after so many firings.
const FIRINGS: usize = 8;

/// The vehicle's motion during a revolution.
pub(crate) struct Sweep<'a> {
    /// Time of the scan, s after the start: the middle of the revolution.
    pub(crate) seconds: f64,
    /// The vehicle's true pose in the site's frame at a time.
    pub(crate) site_from_vehicle: &'a dyn Fn(f64) -> Transform,
}

/// Points as they lie in a file: where the world stands still they are moved to the scan's time without an error, and
/// what moves is drawn where it was when its ray was sent.
pub(crate) fn scan(
    moment: &mut Moment<'_>,
    lidar: &LidarModel,
    sweep: &Sweep<'_>,
    t_ns: i64,
    random: &mut Random,
) -> LidarScan {
    let mut scan = LidarScan { t_ns, ..LidarScan::default() };
    let azimuths = lidar.pattern.azimuths();
    let elevations: Vec<(f64, f64)> =
        lidar.pattern.elevations().iter().map(|angle| angle.sin_cos()).collect();
    let turn = lidar.period_ns as f64 * 1e-9 * lidar.pattern.width / 360.0;
    let pose_at = |seconds: f64| (sweep.site_from_vehicle)(seconds) * lidar.vehicle_from_lidar;
    let lidar_from_site = pose_at(sweep.seconds).inverse();
    let mut site_from_lidar = pose_at(sweep.seconds);
    let mut times = Vec::new();
    for (step, azimuth) in azimuths.iter().enumerate() {
        if lidar.rolling && step % FIRINGS == 0 {
            let share = (step as f64 + 0.5 * FIRINGS as f64) / azimuths.len() as f64 - 0.5;
            moment.move_to(sweep.seconds + share * turn);
            site_from_lidar = pose_at(moment.seconds);
        }
        let (sin, cos) = azimuth.sin_cos();
        for (sin_up, cos_up) in &elevations {
            let own = Vector::new(cos_up * cos, cos_up * sin, *sin_up);
            let direction = site_from_lidar.rotation * own;
            let ray = Ray { origin: site_from_lidar.translation.vector.into(), direction };
            if let Some((range, intensity)) = echo(moment, lidar, &ray, random) {
                let place: Point = lidar_from_site * (ray.origin + direction * range);
                scan.points.push([place.x as f32, place.y as f32, place.z as f32]);
                scan.intensity.push(intensity as f32);
                times.push((moment.seconds - sweep.seconds) as f32);
            }
        }
    }
    scan.times = lidar.timed.then_some(times);
    scan
}

/// Range and intensity of a ray's echo, if it comes back.
fn echo(moment: &Moment<'_>, lidar: &LidarModel, ray: &Ray, random: &mut Random) -> Option<(f64, f64)> {
    let limit = lidar.pattern.max_range;
    let optics = &lidar.optics;
    let hit = moment.cast(ray, limit, |solid, crossing| {
        optics.stop(solid, crossing, &(ray.origin + ray.direction * crossing.enter), random)
    });
    let clear = hit.map_or(limit, |hit| hit.distance);
    if let Some(distance) = optics.drop(clear, random) {
        return Some((distance, 0.02 * optics.scale));
    }
    let hit = hit?;
    optics.echo(&hit, -hit.normal.dot(&ray.direction), limit, random).filter(|(range, _)| *range > 0.4)
}
