//! Where LiDAR rays pass through: what a radar sees there is no surface that the LiDAR knows.

use ralf::scene::LidarView;
use ralf::space::Point;
use std::f64::consts::PI;

/// Width of a sector of azimuth, degrees.
const SECTOR_DEG: f64 = 0.5;
const SECTORS: usize = 720;
/// A ray belongs to a place if it passes within this above or below it, m.
const WITHIN: f64 = 0.5;
/// A ray ends at a place if it ends within this before or behind it, and passes if it ends farther behind, m.
const NEAR: f64 = 1.0;
/// So many rays have to pass.
const ENOUGH: usize = 3;

/// A ray in the plane of its azimuth.
struct Ray {
    /// Height over horizontal distance.
    slope: f64,
    /// Horizontal distance at which it ends, m.
    end: f64,
}

/// The rays of the first LiDAR of a view, by azimuth.
pub(super) struct RayFan {
    origin: Point,
    sectors: Vec<Vec<Ray>>,
}

/// Which heights count as a detection's, m.
pub(super) enum Heights {
    /// About the detection's own.
    About(f64),
    /// From one height to another: its elevation isn't known.
    Between(f64, f64),
}

impl RayFan {
    /// `None` where there is no ray.
    pub(super) fn new(view: &LidarView) -> Option<Self> {
        let rays = view.rays();
        let origin = rays.first()?.origin;
        let mut sectors: Vec<Vec<Ray>> = (0..SECTORS).map(|_| Vec::new()).collect();
        // Those of one LiDAR come one after the other.
        for ray in rays.iter().take_while(|ray| ray.origin == origin) {
            let level = ray.direction.xy().norm();
            if level > 1e-6 {
                let place = sector(ray.direction.x, ray.direction.y);
                sectors[place].push(Ray { slope: ray.direction.z / level, end: ray.range * level });
            }
        }
        Some(Self { origin, sectors })
    }

    /// Whether rays pass through a place and none ends there; `None` where no ray comes so far.
    pub(super) fn is_free(&self, place: &Point, heights: &Heights) -> Option<bool> {
        let away = place - self.origin;
        let distance = away.xy().norm();
        let middle = sector(away.x, away.y);
        let (mut pass, mut end) = (0, 0);
        for step in [SECTORS - 1, 0, 1] {
            for ray in &self.sectors[(middle + step) % SECTORS] {
                let height = self.origin.z + ray.slope * distance;
                let belongs = match *heights {
                    Heights::About(own) => (height - own).abs() <= WITHIN,
                    Heights::Between(low, high) => (low..=high).contains(&height),
                };
                if belongs && ray.end >= distance - NEAR {
                    if ray.end <= distance + NEAR { end += 1 } else { pass += 1 }
                }
            }
        }
        (pass + end > 0).then_some(pass >= ENOUGH && end == 0)
    }
}

fn sector(x: f64, y: f64) -> usize {
    let degrees = (y.atan2(x) + PI).to_degrees();
    ((degrees / SECTOR_DEG) as usize).min(SECTORS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::config::GroundConfig;
    use ralf::scene::LidarSnapshot;
    use ralf::sensors::{Lidar, LidarScan};
    use ralf::space::Transform;
    use std::sync::Arc;

    /// A LiDAR 2 m high that sees a wall 20 m ahead, with rays a degree apart.
    #[test]
    fn before_a_wall_there_is_free_space_and_behind_it_nobody_knows() {
        let mut points = Vec::new();
        for azimuth in -10..=10 {
            for elevation in -5..=2 {
                let [phi, theta] = [azimuth, elevation].map(|angle| f64::from(angle).to_radians());
                points.push([20.0, 20.0 * phi.tan(), 20.0 / phi.cos() * theta.tan()].map(|v: f64| v as f32));
            }
        }
        let lidar = Lidar {
            name: "roof".into(),
            vehicle_from_lidar: Transform::translation(0.0, 0.0, 2.0),
            sigma_range: 0.03,
            lowest_beam: 0.4,
            max_range: None,
        };
        let scan = Arc::new(LidarScan { points, ..Default::default() });
        let scans = vec![(&lidar, scan, Transform::identity())];
        let moment = Arc::new(LidarSnapshot::new(0, scans, &GroundConfig::default(), 0));
        let fan = RayFan::new(&LidarView { moment, vehicle_from_moment: Transform::identity() }).unwrap();
        let at = |x: f64, y: f64, z: f64| fan.is_free(&Point::new(x, y, z), &Heights::About(z));
        assert_eq!(at(10.0, 0.1, 1.7), Some(true));
        assert_eq!(at(19.5, 0.1, 1.7), Some(false), "at the wall");
        assert_eq!(at(30.0, 0.1, 1.7), None, "behind the wall");
        assert_eq!(at(10.0, 0.1, 9.0), None, "above all rays");
        assert_eq!(at(0.0, 10.0, 1.7), None, "where it doesn't look");
        let level =
            |x: f64, low: f64, high: f64| fan.is_free(&Point::new(x, 0.1, 0.0), &Heights::Between(low, high));
        assert_eq!(
            (level(10.0, 0.3, 1.8), level(19.5, 0.3, 1.8), level(10.0, 5.0, 6.0)),
            (Some(true), Some(false), None)
        );
    }
}
