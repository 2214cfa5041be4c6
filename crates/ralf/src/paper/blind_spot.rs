//! Where the LiDAR cannot look (paper, equation 5; docs/method.md, section 6).

use crate::sensors::Lidar;
use crate::space::Point;

/// Whether a point (vehicle frame) lies below the lowest beam of every LiDAR of the rig. Without a LiDAR there is no
/// blind spot.
pub fn in_blind_spot(lidars: &[Lidar], p: &Point) -> bool {
    !lidars.is_empty() && lidars.iter().all(|lidar| is_below_lowest_beam(lidar, p))
}

fn is_below_lowest_beam(lidar: &Lidar, p: &Point) -> bool {
    let l = lidar.vehicle_from_lidar.translation.vector;
    let reach = (l.z - p.z) / lidar.lowest_beam.tan();
    (0.0..=l.z).contains(&p.z) && (p.x - l.x).hypot(p.y - l.y) <= reach
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::Transform;
    use std::f64::consts::FRAC_PI_4;

    fn lidar(x: f64, z: f64) -> Lidar {
        Lidar {
            name: "lidar".into(),
            vehicle_from_lidar: Transform::translation(x, 0.0, z),
            sigma_range: 0.03,
            lowest_beam: FRAC_PI_4,
            max_range: None,
        }
    }

    #[test]
    fn a_cone_below_the_lidar() {
        let roof = [lidar(1.0, 2.0)];
        // At 45 degrees the cone is as wide as the point lies below the LiDAR.
        for (p, expected) in [
            ([1.0, 0.0, 1.0], true),
            ([1.9, 0.0, 1.0], true),
            ([2.1, 0.0, 1.0], false),
            ([1.0, 1.99, 0.0], true),
            ([1.0, 0.0, -0.01], false),
            ([1.0, 0.0, 2.0], true),
            ([1.0, 0.0, 2.01], false),
        ] {
            assert_eq!(in_blind_spot(&roof, &Point::from(p)), expected, "{p:?}");
        }
    }

    #[test]
    fn several_lidars_leave_only_what_none_of_them_sees() {
        let both = [lidar(0.0, 2.0), lidar(2.0, 2.0)];
        assert!(in_blind_spot(&both, &Point::new(1.0, 0.0, 0.5)));
        assert!(!in_blind_spot(&both, &Point::new(-1.0, 0.0, 0.5)));
        assert!(!in_blind_spot(&[], &Point::new(1.0, 0.0, 0.5)));
    }
}
