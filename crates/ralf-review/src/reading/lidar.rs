//! One LiDAR scan, with the ground that the run saw in it.

use super::{matrix, time};
use crate::app::{App, measurement};
use crate::cache::Cache;
use crate::http::{Answer, ApiError, Table, content};
use crate::labelled::{SequenceLabels, Stamp};
use ralf::scene::{FrameWindow, LidarView};
use ralf::sensors::is_return;
use ralf::space::{Point, placed};
use ralf_data::SequenceReader;
use serde::Deserialize;
use serde_json::Map;

/// The points of a scan in the vehicle frame at its time; those without return are absent.
pub(crate) fn cloud(app: &App, sequence: &str, lidar: &str, scan: usize) -> Answer {
    kept(app, &app.clouds, (sequence, lidar, scan), table)
}

/// What is made of a LiDAR and its scan, out of a cache or for it, as long as the labels are the same.
pub(super) fn kept(
    app: &App,
    cache: &Cache<(usize, usize, usize), (Stamp, Vec<u8>)>,
    (sequence, lidar, scan): (&str, &str, usize),
    table: impl FnOnce(&dyn SequenceReader, &SequenceLabels, (usize, usize)) -> Result<Vec<u8>, ApiError>,
) -> Answer {
    let (index, reader) = app.sequence(sequence)?;
    let (lidar, _) = lidar_scan(reader, lidar, scan)?;
    let labels = app.labels(index)?;
    let make = || table(reader, &labels, (lidar, scan)).map(|bytes| (labels.stamp.clone(), bytes));
    let made = cache.get((index, lidar, scan), |(stamp, _)| labels.is_of(stamp), make)?;
    Ok(content("application/octet-stream", made.1.clone()))
}

/// A place of the world, and how far around it is looked.
#[derive(Debug, Clone, Copy, Deserialize)]
pub(crate) struct Near {
    /// In the odometry frame, m.
    x: f64,
    y: f64,
    /// Level with the ground, m.
    radius: f64,
}

/// As far as anything is looked at that moves, m.
const FARTHEST: f64 = 30.0;

/// The points of a scan that lie near a place, as [`cloud`] has all of them.
pub(crate) fn near(app: &App, (sequence, lidar, scan): (&str, &str, usize), near: Near) -> Answer {
    let Near { x, y, radius } = near;
    if !(x.is_finite() && y.is_finite() && radius > 0.0 && radius <= FARTHEST) {
        return Err(ApiError::Malformed(format!(
            "query: expected a place and a radius up to {FARTHEST} m, found {x}, {y}, {radius}"
        )));
    }
    let (index, reader) = app.sequence(sequence)?;
    let (lidar, t_ns) = lidar_scan(reader, lidar, scan)?;
    let labels = app.labels(index)?;
    let found = seen(reader, &labels, (lidar, scan), t_ns)?;
    let odom_from_vehicle = reader.sequence().motion.odom_from_vehicle(t_ns);
    let is_near = |seen: &Seen| {
        let place = odom_from_vehicle * seen.place;
        (place.x - x).hypot(place.y - y) <= radius
    };
    let kept: Vec<Option<Seen>> = found.into_iter().flatten().filter(is_near).map(Some).collect();
    Ok(content("application/octet-stream", finished(reader, &kept, t_ns)))
}

fn lidar_scan(reader: &dyn SequenceReader, lidar: &str, scan: usize) -> Result<(usize, i64), ApiError> {
    let known = reader.sequence();
    let names = known.rig.lidars.iter().map(|lidar| lidar.name.as_str());
    measurement("lidar", names, &known.times.lidars, lidar, scan)
}

fn table(
    reader: &dyn SequenceReader,
    labels: &SequenceLabels,
    (lidar, scan): (usize, usize),
) -> Result<Vec<u8>, ApiError> {
    let t_ns = reader.sequence().times.lidars[lidar][scan];
    Ok(finished(reader, &seen(reader, labels, (lidar, scan), t_ns)?, t_ns))
}

/// Returns as a table, with where the vehicle was.
fn finished(reader: &dyn SequenceReader, found: &[Option<Seen>], t_ns: i64) -> Vec<u8> {
    let more = Map::from_iter([
        ("t_ns".to_owned(), time(t_ns)),
        ("odom_from_vehicle".to_owned(), matrix(&reader.sequence().motion.odom_from_vehicle(t_ns))),
    ]);
    points(found, Table::new(found.len())).finish(more)
}

/// A return of a LiDAR.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    /// In the vehicle frame, m.
    pub(super) place: Point,
    pub(super) intensity: f32,
    /// Whether it lies on the ground, as the run saw it.
    pub(super) ground: bool,
}

/// The returns of a scan in the vehicle frame at its time; `None` of a ray without one.
pub(super) fn seen(
    reader: &dyn SequenceReader,
    labels: &SequenceLabels,
    (lidar, scan): (usize, usize),
    t_ns: i64,
) -> Result<Vec<Option<Seen>>, ApiError> {
    let cloud = reader.lidar_scan(lidar, scan)?;
    let vehicle_from_lidar = &labels.rig.lidars[lidar].vehicle_from_lidar;
    let view = FrameWindow::new(reader, &labels.rig, &labels.settings).lidar_view(t_ns)?;
    let height = view.as_ref().and_then(height_in);
    let of_ray = |(row, point): (usize, &[f32; 3])| {
        let place = is_return(point).then(|| placed(vehicle_from_lidar, point))?;
        let height = height.as_ref().map(|height| height(&place));
        let ground = height.is_some_and(|height| height < labels.settings.ground.lidar_margin);
        Some(Seen { place, intensity: cloud.intensity.get(row).copied().unwrap_or(f32::NAN), ground })
    };
    Ok(cloud.points.iter().enumerate().map(of_ray).collect())
}

/// Returns as columns; those that are none are absent.
pub(super) fn points(found: &[Option<Seen>], mut table: Table) -> Table {
    let number = |of: &dyn Fn(&Seen) -> f32| -> Vec<f32> {
        found.iter().map(|seen| seen.as_ref().map_or(f32::NAN, of)).collect()
    };
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        table.f32(name, number(&|seen| seen.place[axis] as f32));
    }
    table.f32("intensity", number(&|seen| seen.intensity));
    table.u8("ground", found.iter().map(|seen| u8::from(seen.is_some_and(|seen| seen.ground))));
    table
}

/// The height of a place above the ground, m; `None` where there is no ground.
fn height_in(view: &LidarView) -> Option<impl Fn(&Point) -> f64> {
    let moment_from_vehicle = view.vehicle_from_moment.inverse();
    view.moment.ground().map(|ground| move |p: &Point| ground.height(&(moment_from_vehicle * p)))
}
