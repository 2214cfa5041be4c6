//! Where a camera sees detections, things and the points of a LiDAR.

use crate::app::{App, ScanPlace, measurement};
use crate::http::{Answer, ApiError, Table, content};
use crate::labelled::SequenceLabels;
use ralf::sensors::{Camera, is_return};
use ralf::space::{EgoMotion, Point, placed};
use ralf_data::{ScanIndex, SequenceReader};
use serde::Deserialize;
use serde_json::{Map, Value, json};
use std::sync::Arc;

/// What moves is shown only where it is at the time of the image, or this near to it, ns.
const NEAR_NS: i64 = 150_000_000;

/// Which scan's detections.
#[derive(Debug, Deserialize)]
pub(crate) struct Projection {
    radar: String,
    scan: usize,
}

/// Which scan of which LiDAR.
#[derive(Debug, Deserialize)]
pub(crate) struct LidarProjection {
    lidar: String,
    scan: usize,
}

/// An image: its sequence, its camera, its number.
type ImageName<'a> = (&'a str, &'a str, usize);

/// A sequence with its labels, whose rig has the settings' overrides.
struct Scene<'a> {
    reader: &'a dyn SequenceReader,
    labels: Arc<SequenceLabels>,
}

/// A camera at the time of an image.
struct Shot<'a> {
    camera: &'a Camera,
    motion: &'a EgoMotion,
    t_ns: i64,
}

impl<'a> Scene<'a> {
    fn of(app: &'a App, sequence: &str) -> Result<Self, ApiError> {
        let (index, reader) = app.sequence(sequence)?;
        Ok(Self { reader, labels: app.labels(index)? })
    }

    fn shot(&self, (_, camera, image): ImageName) -> Result<Shot<'_>, ApiError> {
        let known = self.reader.sequence();
        let names = known.rig.cameras.iter().map(|camera| camera.name.as_str());
        let (camera, t_ns) = measurement("camera", names, &known.times.cameras, camera, image)?;
        Ok(Shot { camera: &self.labels.rig.cameras[camera], motion: &known.motion, t_ns })
    }
}

impl Shot<'_> {
    /// Column, row (px) and depth along the optical axis (m) of a point of the vehicle frame at some time, moved by the
    /// vehicle's motion since; `None` of one outside the image.
    fn sees(&self, t_ns: i64) -> impl Fn(&Point) -> Option<[f64; 3]> {
        let camera_from_there =
            self.camera.vehicle_from_camera.inverse() * self.motion.between(self.t_ns, t_ns);
        let limit = self.camera.intrinsics.limit();
        move |p| see(self.camera, &(camera_from_there * p), limit)
    }

    /// The same of a point of the odometry frame.
    fn sees_in_world(&self) -> impl Fn(&Point) -> Option<[f64; 3]> {
        let odom_from_camera = self.motion.odom_from_vehicle(self.t_ns) * self.camera.vehicle_from_camera;
        let camera_from_odom = odom_from_camera.inverse();
        let limit = self.camera.intrinsics.limit();
        move |p| see(self.camera, &(camera_from_odom * p), limit)
    }
}

/// Pixel and depth of a scan's detections in an image.
pub(crate) fn projection(app: &App, name: ImageName, asked: &Projection) -> Answer {
    let ScanPlace { t_ns, .. } = app.scan(name.0, &asked.radar, asked.scan)?;
    let scene = Scene::of(app, name.0)?;
    let shot = scene.shot(name)?;
    let sees = shot.sees(t_ns);
    let rows = scene.labels.table(&asked.radar, asked.scan)?;
    let [x, y, z] = [rows.get::<f32>("x")?, rows.get::<f32>("y")?, rows.get::<f32>("z")?];
    let points = x.iter().zip(y).zip(z);
    let seen: Vec<Option<[f64; 3]>> =
        points.map(|((x, y), z)| sees(&Point::from([*x, *y, *z].map(f64::from)))).collect();
    Ok(content("application/octet-stream", pixels(&seen, Table::new(rows.len())).finish(Map::new())))
}

/// Pixel, depth and height of those returns of a LiDAR scan that lie in an image: the farthest come first, so that who
/// draws one after the other has the nearest on top. What stands before what isn't told.
pub(crate) fn lidar_projection(app: &App, name: ImageName, asked: &LidarProjection) -> Answer {
    let scene = Scene::of(app, name.0)?;
    let known = scene.reader.sequence();
    let names = known.rig.lidars.iter().map(|lidar| lidar.name.as_str());
    let (lidar, t_ns) = measurement("lidar", names, &known.times.lidars, &asked.lidar, asked.scan)?;
    let vehicle_from_lidar = &scene.labels.rig.lidars[lidar].vehicle_from_lidar;
    let shot = scene.shot(name)?;
    let sees = shot.sees(t_ns);
    let points = scene.reader.lidar_scan(lidar, asked.scan)?.points;
    let returns = points.iter().filter(|point| is_return(point));
    let mut seen: Vec<([f64; 3], f32)> = returns
        .filter_map(|point| {
            let place = placed(vehicle_from_lidar, point);
            Some((sees(&place)?, place.z as f32))
        })
        .collect();
    seen.sort_by(|(a, _), (b, _)| b[2].total_cmp(&a[2]));
    let (places, heights): (Vec<_>, Vec<f32>) = seen.into_iter().map(|(place, z)| (Some(place), z)).unzip();
    let mut table = pixels(&places, Table::new(places.len()));
    table.f32("z", heights);
    Ok(content("application/octet-stream", table.finish(Map::new())))
}

/// Pixel and depth of a thing's detections that lie in an image: of all scans if it stands still, and where it moves
/// only of those at about the time of the image.
pub(crate) fn thing_projection(app: &App, name: ImageName, thing: u32) -> Answer {
    let scene = Scene::of(app, name.0)?;
    let things = scene.labels.things(scene.reader)?;
    if thing as usize >= things.count() {
        return Err(ApiError::unknown("thing", thing, &format!("a number below {}", things.count())));
    }
    let shot = scene.shot(name)?;
    let sees = shot.sees_in_world();
    let mut scans: Vec<ScanIndex> = Vec::new();
    let (mut scan_of, mut points, mut seen) = (Vec::new(), Vec::new(), Vec::new());
    for row in things.rows_of_thing(thing) {
        let sighting = &things.sightings()[row];
        let is_near = (sighting.t_ns - shot.t_ns).abs() <= NEAR_NS;
        let Some(place) = sees(&Point::from(sighting.place)).filter(|_| is_near || !sighting.moves()) else {
            continue;
        };
        let (scan, point) = things.place_of(row);
        if scans.last() != Some(&scan) {
            scans.push(scan);
        }
        scan_of.push(scans.len() as u32 - 1);
        points.push(point as u32);
        seen.push(Some(place));
    }
    let radars = &scene.reader.sequence().rig.radars;
    let told = |at: &ScanIndex| json!({ "radar": radars[at.radar].name, "scan": at.scan });
    let scans: Value = scans.iter().map(told).collect();
    let mut table = pixels(&seen, Table::new(seen.len()));
    table.u32("scan", scan_of);
    table.u32("point", points);
    let more = Map::from_iter([("scans".to_owned(), scans)]);
    Ok(content("application/octet-stream", table.finish(more)))
}

/// Columns u, v and depth; absent outside the image.
fn pixels(seen: &[Option<[f64; 3]>], mut table: Table) -> Table {
    for (i, name) in ["u", "v", "depth"].into_iter().enumerate() {
        table.f32(name, seen.iter().map(|seen| seen.map_or(f32::NAN, |seen| seen[i] as f32)));
    }
    table
}

/// Column, row (px) and depth along the optical axis (m) of a point of the camera's frame; `None` outside the image.
/// `limit` is the largest angle that the lens sees, rad.
fn see(camera: &Camera, p: &Point, limit: f64) -> Option<[f64; 3]> {
    let inside = |value: f64, size: usize| value >= -0.5 && value < size as f64 - 0.5;
    let [u, v] = camera.intrinsics.project_within(p, limit)?;
    (inside(u, camera.width) && inside(v, camera.height)).then_some([u, v, p.z])
}
