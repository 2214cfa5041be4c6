//! Camera matching: is there an object in the scaled depth images where the radar saw something? (paper, section 2.3;
//! docs/method.md, section 5)

use crate::config::CameraConfig;
use crate::scene::{
    Association, CalibratedImage, Frame, ImageView, Reference, Seen, Spread, ViewState, index_of,
};
use crate::sensors::{Elevation, Radar};
use crate::space::{Point, Transform};

/// What the cameras say of one detection.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CameraMatch {
    /// Mean mismatch with the nearest points, at most `camera.max_mismatch`; `None` where no view that is left sees the
    /// detection, or none has points.
    pub d: Option<f64>,
    /// A view that has failed would have seen it.
    pub in_failed_view: bool,
}

/// The mismatch of each detection with its nearest calibrated points, of the views of all cameras together that are
/// left.
pub fn match_detections(frame: &Frame, config: &CameraConfig) -> Vec<CameraMatch> {
    let images = if config.enabled { frame.images.as_slice() } else { &[] };
    let points = reference_cloud(frame.radar, images, config.depth_sigma);
    let index = index_of(points.iter().map(|point| &point.position), frame.radar.elevation);
    let mut association = Association::new(&index, frame.radar.elevation, config.neighbours);
    let images_from_vehicle: Vec<_> =
        images.iter().map(|view| (view.moment.as_ref(), view.vehicle_from_image.inverse())).collect();
    let mut matches = vec![CameraMatch::default(); frame.scan.len()];
    for (found, detection) in matches.iter_mut().zip(&frame.scan.detections) {
        let Some(detection) = detection else { continue };
        let seen = seen_by(&images_from_vehicle, &detection.position);
        found.in_failed_view = seen.failed;
        if seen.calibrated {
            let d = association.mean_mismatch(detection, &detection.position, |id| points[id as usize]);
            found.d = d.map(|d| d.min(config.max_mismatch));
        }
    }
    matches
}

/// The calibrated points in the vehicle frame at the radar scan's time, each with `Sigma_l = (depth_sigma Z)^2 u u^T`.
/// For a radar without elevation only those within its vertical field of view.
fn reference_cloud(radar: &Radar, images: &[ImageView], depth_sigma: f64) -> Vec<Reference> {
    let radar_from_vehicle = radar.vehicle_from_radar.inverse();
    let mut points = Vec::new();
    for image in images {
        let vehicle_from_image = image.vehicle_from_image;
        let rotation = vehicle_from_image.rotation.to_rotation_matrix();
        let views = &image.moment.views;
        for view in views.iter().filter(|view| view.report.state == ViewState::Calibrated) {
            points.extend(view.points.iter().map(|point| Reference {
                position: vehicle_from_image * point.position,
                spread: Spread::Ray(rotation * point.ray * (depth_sigma * point.depth)),
            }));
        }
    }
    if radar.elevation == Elevation::None {
        let sees = radar.sees_heights_of();
        points.retain(|point| sees(&(radar_from_vehicle * point.position)));
    }
    points
}

/// In which kinds of views of all images a point (vehicle frame at the radar scan's time) lies.
fn seen_by(images_from_vehicle: &[(&CalibratedImage, Transform)], p: &Point) -> Seen {
    let mut seen = Seen::default();
    for (moment, image_from_vehicle) in images_from_vehicle {
        let here = moment.sees(&(image_from_vehicle * p));
        seen.calibrated |= here.calibrated;
        seen.failed |= here.failed;
    }
    seen
}
