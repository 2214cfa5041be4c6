//! A revolution of the LiDAR as it was measured.

use super::frames::time_of_point;
use crate::disk::laz;
use crate::error::DataError;
use crate::read::point_times::seconds_after;
use ralf::sensors::{Lidar, LidarScan};
use ralf::space::Point;
use std::path::Path;

/// Points nearer to the LiDAR than this are no returns, m: coordinates were rounded to 1 mm after they were moved to
/// the vehicle's frame.
const NO_RETURN_WITHIN: f64 = 0.005;

/// The points of a file in the LiDAR's frame, each where it was at its own time.
pub(super) fn rolling_scan(file: &Path, lidar: &Lidar, t_ns: i64) -> Result<LidarScan, DataError> {
    let lidar_from_vehicle = lidar.vehicle_from_lidar.inverse();
    let read = laz::read(file)?;
    let mut scan = LidarScan { t_ns, ..LidarScan::default() };
    let mut times = Vec::with_capacity(read.len());
    for (n, point) in read.iter().enumerate() {
        let time = seconds_after(time_of_point(file, point.gps_time)?, t_ns).map_err(|expected| {
            let found = format!("{} ns", point.gps_time);
            DataError::content(file, format!("point {n}, gps_time"), expected, found)
        })?;
        let place = lidar_from_vehicle * Point::from(point.place);
        let is_return = place.coords.norm() > NO_RETURN_WITHIN;
        scan.points.push(if is_return { [place.x as f32, place.y as f32, place.z as f32] } else { [0.0; 3] });
        scan.intensity.push(f32::from(point.intensity));
        times.push(time);
    }
    scan.times = Some(times);
    Ok(scan)
}
