//! Where a camera sees the detections of a scan.

use crate::app::{App, measurement};
use crate::http::{Answer, Table, content};
use ralf::sensors::Camera;
use ralf::space::Point;
use serde::Deserialize;
use serde_json::Map;

/// Which scan's detections.
#[derive(Debug, Deserialize)]
pub(crate) struct Projection {
    radar: String,
    scan: usize,
}

/// Pixel and depth of a scan's detections in an image, moved by the vehicle's motion between the two times.
pub(crate) fn projection(
    app: &App,
    sequence: &str,
    camera: &str,
    image: usize,
    asked: &Projection,
) -> Answer {
    let place = app.scan(sequence, &asked.radar, asked.scan)?;
    let known = place.reader.sequence();
    let names = known.rig.cameras.iter().map(|camera| camera.name.as_str());
    let (camera, t_ns) = measurement("camera", names, &known.times.cameras, camera, image)?;
    let labels = app.labels(place.sequence)?;
    let rows = labels.table(&asked.radar, asked.scan)?;
    let camera = &known.rig.cameras[camera];
    let camera_from_scan = camera.vehicle_from_camera.inverse() * known.motion.between(t_ns, place.t_ns);
    let [x, y, z] = [rows.get::<f32>("x")?, rows.get::<f32>("y")?, rows.get::<f32>("z")?];
    let points = x.iter().zip(y).zip(z);
    let seen: Vec<Option<[f64; 3]>> = points
        .map(|((x, y), z)| see(camera, &(camera_from_scan * Point::from([*x, *y, *z].map(f64::from)))))
        .collect();
    let mut table = Table::new(rows.len());
    for (i, name) in ["u", "v", "depth"].into_iter().enumerate() {
        table.f32(name, seen.iter().map(|seen| seen.map_or(f32::NAN, |seen| seen[i] as f32)));
    }
    Ok(content("application/octet-stream", table.finish(Map::new())))
}

/// Column, row (px) and depth along the optical axis (m) of a point of the camera's frame; `None` outside the image.
fn see(camera: &Camera, p: &Point) -> Option<[f64; 3]> {
    let inside = |value: f64, size: usize| value >= -0.5 && value < size as f64 - 0.5;
    let [u, v] = camera.intrinsics.project(p)?;
    (inside(u, camera.width) && inside(v, camera.height)).then_some([u, v, p.z])
}
