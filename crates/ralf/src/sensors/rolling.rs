//! A revolution of a LiDAR takes its time, and the vehicle drives on meanwhile: points go where the scan's moment has
//! them.

use crate::sensors::{LidarScan, is_return};
use crate::space::{EgoMotion, Transform, placed};

impl LidarScan {
    /// The scan motion-corrected to its time, of points that lie where they were measured: each in the LiDAR's frame at
    /// its own time. A point `p` of time `t` goes to `L^-1 T(t_ns <- t) L p`, with `L` the mounting
    /// `vehicle_from_lidar` and `T` the vehicle's pose at `t` in the vehicle frame at `t_ns`.
    ///
    /// What stands still then lies where one shot would have seen it. Things that move by themselves stay where they
    /// were at the points' own times, which the scan keeps. A scan without times is left as it is.
    ///
    /// ```
    /// use ralf::sensors::LidarScan;
    /// use ralf::space::{EgoMotion, OdometrySample, Transform};
    ///
    /// // At 30 m/s a post ahead is measured 40 ms before the scan's time: by then it is 1.2 m nearer.
    /// let ahead = OdometrySample { t_ns: 0, velocity: 30.0, yaw_rate: 0.0 };
    /// let motion = EgoMotion::new(vec![ahead], vec![]).unwrap();
    /// let points = vec![[21.2, 0.0, 0.0]];
    /// let scan = LidarScan { points, times: Some(vec![-0.04]), intensity: vec![0.0], ..Default::default() };
    /// let corrected = scan.motion_corrected(&Transform::identity(), &motion);
    /// assert!((corrected.points[0][0] - 20.0).abs() < 1e-5);
    /// ```
    pub fn motion_corrected(mut self, vehicle_from_lidar: &Transform, motion: &EgoMotion) -> Self {
        let Some(times) = &self.times else { return self };
        let lidar_from_vehicle = vehicle_from_lidar.inverse();
        // Whole columns of beams are fired at once.
        let mut column = None;
        for (point, &time) in self.points.iter_mut().zip(times).filter(|(point, _)| is_return(point)) {
            let moved = match column {
                Some((known, moved)) if known == time => moved,
                _ => {
                    let measured_ns = self.t_ns.saturating_add((f64::from(time) * 1e9).round() as i64);
                    lidar_from_vehicle * motion.between(self.t_ns, measured_ns) * vehicle_from_lidar
                }
            };
            column = Some((time, moved));
            let place = placed(&moved, point);
            *point = [place.x as f32, place.y as f32, place.z as f32];
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{OdometrySample, Point, Vector, transform_from_parts};

    /// 20 m/s in a bend to the left, 0.5 rad/s.
    fn bend() -> EgoMotion {
        EgoMotion::new(vec![OdometrySample { t_ns: 0, velocity: 20.0, yaw_rate: 0.5 }], vec![]).unwrap()
    }

    #[test]
    fn what_stands_still_is_seen_in_one_place_from_a_bend() {
        let vehicle_from_lidar = transform_from_parts([1.2, 0.3, 1.9], [0.0, 0.0, 0.6, 0.8]).unwrap();
        let (motion, t_ns) = (bend(), 7_000_000_000);
        let post = Point::new(60.0, -25.0, 1.0);
        let times = vec![-0.05, -0.05, -0.0125, 0.0, 0.049];
        let seen_at = |time: &f32| {
            let then = t_ns + (f64::from(*time) * 1e9).round() as i64;
            let lidar_from_odom = (motion.odom_from_vehicle(then) * vehicle_from_lidar).inverse();
            let seen = lidar_from_odom * post;
            [seen.x as f32, seen.y as f32, seen.z as f32]
        };
        let points: Vec<[f32; 3]> = times.iter().map(seen_at).collect();
        let spread = Vector::from(points[0].map(f64::from)) - Vector::from(points[4].map(f64::from));
        assert!(spread.norm() > 1.0, "the vehicle has moved on by {spread}");
        let scan = LidarScan { t_ns, points, times: Some(times), ..LidarScan::default() };
        let corrected = scan.motion_corrected(&vehicle_from_lidar, &motion);
        for point in &corrected.points {
            let off = Vector::from(point.map(f64::from)) - Vector::from(seen_at(&0.0).map(f64::from));
            assert!(off.norm() < 1e-4, "{off}");
        }
        assert_eq!(corrected.times.unwrap().len(), 5);
    }

    #[test]
    fn what_is_no_return_and_what_has_no_time_stays() {
        let points = vec![[0.0; 3], [f32::NAN, 1.0, 1.0], [5.0, 0.0, 0.0]];
        let scan = LidarScan { points, times: Some(vec![0.05; 3]), ..LidarScan::default() };
        let corrected = scan.clone().motion_corrected(&Transform::identity(), &bend());
        assert_eq!(corrected.points[0], [0.0; 3]);
        assert!(corrected.points[1][0].is_nan() && corrected.points[2] != [5.0, 0.0, 0.0]);
        let untimed = LidarScan { times: None, ..scan }.motion_corrected(&Transform::identity(), &bend());
        assert_eq!(untimed.points[2], [5.0, 0.0, 0.0]);
    }
}
