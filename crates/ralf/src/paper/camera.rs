//! Camera matching: the mismatch of each detection with its nearest calibrated camera points (paper, section 2.3;
//! docs/method.md, section 5).

use crate::config::CameraConfig;
use crate::scene::{
    Association, Detections, ImageMoment, ImageView, Located, Reference, Seen, Spread, ViewState, index_of,
};
use crate::sensors::{Elevation, Radar};
use crate::space::{Point, Transform};

/// What the cameras say of one detection.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CameraMatch {
    /// Mean mismatch with the nearest points; `None` where no view that is left sees the detection, or none has points.
    pub d: Option<f64>,
    /// A view that has failed would have seen it.
    pub in_failed_view: bool,
}

/// The mismatch of each detection with the points of all views that are left, of all cameras together.
pub fn match_detections(
    radar: &Radar,
    detections: &Detections,
    images: &[ImageView],
    config: &CameraConfig,
) -> Vec<CameraMatch> {
    let points = points_of_views(radar, images, config.depth_sigma);
    let index = index_of(points.iter().map(|point| &point.position), radar.elevation);
    let mut association = Association::new(&index, radar.elevation, config.neighbours);
    let images_from_vehicle: Vec<_> =
        images.iter().map(|view| (view.moment.as_ref(), view.vehicle_from_image.inverse())).collect();
    let mut answer = |detection: &Located| {
        let seen = seen_by(&images_from_vehicle, &detection.position);
        let reference = |id: u32| points[id as usize];
        let d = seen.calibrated.then(|| association.mean_mismatch(detection, &detection.position, reference));
        CameraMatch { d: d.flatten(), in_failed_view: seen.failed }
    };
    let located = detections.located.iter();
    located.map(|detection| detection.as_ref().map(&mut answer).unwrap_or_default()).collect()
}

/// The calibrated points in the vehicle frame at the radar scan's time, each with `Sigma_l = (depth_sigma Z)^2 u u^T`.
/// Of a radar without elevation only those within its vertical field of view.
fn points_of_views(radar: &Radar, images: &[ImageView], depth_sigma: f64) -> Vec<Reference> {
    let radar_from_vehicle = radar.vehicle_from_radar.inverse();
    let mut points = Vec::new();
    for ImageView { moment, vehicle_from_image } in images {
        let rotation = vehicle_from_image.rotation.to_rotation_matrix();
        let calibrated = moment.views.iter().filter(|view| view.report.state == ViewState::Calibrated);
        points.extend(calibrated.flat_map(|view| &view.points).map(|point| Reference {
            position: vehicle_from_image * point.position,
            spread: Spread::Ray(rotation * point.ray * (depth_sigma * point.depth)),
        }));
    }
    if radar.elevation == Elevation::None {
        points.retain(|point| radar.sees_height_of(&(radar_from_vehicle * point.position)));
    }
    points
}

/// In which kinds of views of all images a point (vehicle frame at the radar scan's time) lies.
fn seen_by(images_from_vehicle: &[(&ImageMoment, Transform)], p: &Point) -> Seen {
    images_from_vehicle.iter().fold(Seen::default(), |seen, (moment, image_from_vehicle)| {
        let here = moment.sees(&(image_from_vehicle * p));
        Seen { calibrated: seen.calibrated || here.calibrated, failed: seen.failed || here.failed }
    })
}
