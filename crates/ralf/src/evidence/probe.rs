//! Detections as the LiDAR window's scans are asked about them.

use crate::scene::{Detection, Frame, GroundSurface, LidarWindowView};
use crate::sensors::Elevation;
use crate::space::Transform;
use nalgebra::{Matrix3, Vector3};

/// A radar without elevation is taken to have seen what it saw so high above the ground, m: the middle of what stands
/// on a road.
const SUPPOSED_HEIGHT: f64 = 0.7;
/// How well that is known, m.
const SUPPOSED_SIGMA: f64 = 0.4;

/// LiDAR and radar don't see the same spot of an object: uncertainty of a point's place as the detection's own, m.
pub(super) const SAME_SPOT: f64 = 0.1;

/// A detection in the vehicle frame of the LiDAR window.
#[derive(Debug, Clone, Copy)]
pub struct Probe {
    /// Where it lies, m, and how well that is known. Of a radar without elevation the height is supposed.
    pub detection: Detection,
    /// Height of the ground there, m; that of the vehicle where nobody saw the ground.
    pub ground: f64,
}

impl Probe {
    /// `(Sigma + (0.1 m)^2 I)^-1`, m^-2: LiDAR and radar don't see the same spot of an object.
    pub fn precision(&self) -> Matrix3<f64> {
        let axes = &self.detection.axes;
        let covariance = axes * axes.transpose() + Matrix3::identity() * SAME_SPOT.powi(2);
        // A covariance that is not finite makes all distances 0 rather than a run end.
        covariance.try_inverse().unwrap_or_else(Matrix3::zeros)
    }
}

/// Detections of a frame's radar in the frame of its LiDAR window; `None` for those without a position. Empty without a
/// window.
pub(super) fn probes<'d>(
    frame: &Frame,
    detections: impl Iterator<Item = Option<&'d Detection>>,
) -> Vec<Option<Probe>> {
    let Some(lidar) = &frame.lidar_window else { return Vec::new() };
    let probing = Probing::new(frame, lidar);
    detections.map(|detection| detection.map(|detection| probing.probe(detection))).collect()
}

/// What makes probes of detections.
pub(super) struct Probing<'a> {
    ground: Option<&'a GroundSurface>,
    elevation: Elevation,
    window_from_vehicle: Transform,
    rotation: Matrix3<f64>,
}

impl<'a> Probing<'a> {
    /// For detections of a frame's radar, to be asked about in a LiDAR window.
    pub(super) fn new(frame: &Frame, lidar: &'a LidarWindowView) -> Self {
        let window_from_vehicle = lidar.vehicle_from_window.inverse();
        let rotation = window_from_vehicle.rotation.to_rotation_matrix().into_inner();
        let ground = lidar.window.ground();
        Self { ground, elevation: frame.radar.elevation, window_from_vehicle, rotation }
    }

    /// A detection of the vehicle frame in the window's.
    pub(super) fn probe(&self, detection: &Detection) -> Probe {
        let mut detection = detection.turned(&self.window_from_vehicle, &self.rotation);
        let p = detection.position;
        let ground = self.ground.and_then(|surface| surface.height_at(p.x, p.y)).unwrap_or(0.0);
        if self.elevation == Elevation::None {
            detection.position.z = ground + SUPPOSED_HEIGHT;
            detection.axes.set_column(2, &Vector3::new(0.0, 0.0, SUPPOSED_SIGMA));
        }
        Probe { detection, ground }
    }
}
