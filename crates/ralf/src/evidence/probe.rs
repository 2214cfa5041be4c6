//! Detections as the LiDAR window's scans are asked about them.

use crate::scene::{Detection, Frame};
use crate::sensors::Elevation;
use nalgebra::Vector3;

/// A radar without elevation is taken to have seen what it saw so high above the ground, m: the middle of what stands
/// on a road.
const SUPPOSED_HEIGHT: f64 = 0.7;
/// How well that is known, m.
const SUPPOSED_SIGMA: f64 = 0.4;

/// A detection in the vehicle frame of the LiDAR window.
#[derive(Debug, Clone, Copy)]
pub struct Probe {
    /// Where it lies, m, and how well that is known. Of a radar without elevation the height is supposed.
    pub detection: Detection,
    /// Height of the ground there, m; that of the vehicle where nobody saw the ground.
    pub ground: f64,
}

/// The frame's detections in the frame of its LiDAR window; `None` for those without a position. Empty without a
/// window.
pub(super) fn probes(frame: &Frame) -> Vec<Option<Probe>> {
    let Some(lidar) = &frame.lidar_window else { return Vec::new() };
    let window_from_vehicle = lidar.vehicle_from_window.inverse();
    let surface = lidar.window.ground();
    let mut probes = Vec::with_capacity(frame.scan.len());
    for detection in &frame.scan.detections {
        let Some(detection) = detection else {
            probes.push(None);
            continue;
        };
        let mut detection = detection.moved(&window_from_vehicle);
        let p = detection.position;
        let ground = surface.and_then(|surface| surface.height_at(p.x, p.y)).unwrap_or(0.0);
        if frame.radar.elevation == Elevation::None {
            detection.position.z = ground + SUPPOSED_HEIGHT;
            detection.axes.set_column(2, &Vector3::new(0.0, 0.0, SUPPOSED_SIGMA));
        }
        probes.push(Some(Probe { detection, ground }));
    }
    probes
}
