//! One LiDAR scan, with the ground that the run saw in it.

use super::{matrix, time};
use crate::app::{App, measurement};
use crate::http::{Answer, ApiError, Table, content};
use crate::labelled::SequenceLabels;
use ralf::scene::{FrameWindow, LidarView};
use ralf::sensors::is_return;
use ralf::space::Point;
use ralf_data::SequenceReader;
use serde_json::Map;

/// The points of a scan in the vehicle frame at its time; those without return are absent.
pub(crate) fn cloud(app: &App, sequence: &str, lidar: &str, scan: usize) -> Answer {
    let (index, reader) = app.sequence(sequence)?;
    let known = reader.sequence();
    let names = known.rig.lidars.iter().map(|lidar| lidar.name.as_str());
    let (lidar, t_ns) = measurement("lidar", names, &known.times.lidars, lidar, scan)?;
    let labels = app.labels(index)?;
    let make = || table(reader, &labels, (lidar, scan), t_ns).map(|bytes| (labels.stamp.clone(), bytes));
    let made = app.clouds.get((index, lidar, scan), |(stamp, _)| labels.is_of(stamp), make)?;
    Ok(content("application/octet-stream", made.1.clone()))
}

fn table(
    reader: &dyn SequenceReader,
    labels: &SequenceLabels,
    (lidar, scan): (usize, usize),
    t_ns: i64,
) -> Result<Vec<u8>, ApiError> {
    let cloud = reader.lidar_scan(lidar, scan)?;
    let vehicle_from_lidar = &labels.rig.lidars[lidar].vehicle_from_lidar;
    let place =
        |point: &[f32; 3]| is_return(point).then(|| vehicle_from_lidar * Point::from(point.map(f64::from)));
    let places: Vec<Option<Point>> = cloud.points.iter().map(place).collect();
    let view = FrameWindow::new(reader, &labels.rig, &labels.settings).lidar_view(t_ns)?;
    let is_ground = |place: &Option<Point>| {
        let height = place.as_ref().zip(view.as_ref()).and_then(|(p, view)| height(view, p));
        u8::from(height.is_some_and(|height| height < labels.settings.ground.lidar_margin))
    };
    let mut table = Table::new(places.len());
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        table.f32(name, places.iter().map(|place| place.as_ref().map_or(f32::NAN, |p| p[axis] as f32)));
    }
    let intensity = |row: usize| cloud.intensity.get(row).copied().unwrap_or(f32::NAN);
    table.f32("intensity", (0..places.len()).map(intensity));
    table.u8("ground", places.iter().map(is_ground));
    let more = Map::from_iter([
        ("t_ns".to_owned(), time(t_ns)),
        ("odom_from_vehicle".to_owned(), matrix(&reader.sequence().motion.odom_from_vehicle(t_ns))),
    ]);
    Ok(table.finish(more))
}

/// Height above the ground, m; `None` where there is no ground.
fn height(view: &LidarView, p: &Point) -> Option<f64> {
    let moment_from_vehicle = view.vehicle_from_moment.inverse();
    view.moment.ground().map(|ground| ground.height(&(moment_from_vehicle * p)))
}
