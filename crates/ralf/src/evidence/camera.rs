//! Where the cameras look past a detection, at it, or at something before it, by their calibrated depth; and whether
//! grass grows below it.

use super::columns::{set, unobserved};
use super::sought::{ON, Sought, Window};
use super::{Feature, Piece, Surroundings, Values};
use crate::scene::{Detection, Frame, ImageView, median};
use crate::sensors::Camera;
use crate::space::{Point, Transform};

pub(super) const PIECE: Piece = Piece {
    features: &[
        feature(
            "camera_residual",
            "sigma",
            "how far the detection lies behind what the cameras see in its direction, negative before it, in standard \
             deviations of depth; the median of the pixels around",
        ),
        feature(
            "camera_least",
            "sigma",
            "least distance from what the cameras see in its direction, behind or before",
        ),
        feature(
            "camera_on",
            "1",
            "share of the pixels around at whose depth the detection lies, within two sigma",
        ),
        feature("camera_through", "1", "share of the pixels around that show something farther away"),
        feature("camera_hidden", "1", "share of the pixels around that show something nearer"),
        feature(
            "camera_excess_green",
            "1",
            "how much greener the image is where the ground below the detection is than in its median",
        ),
    ],
    observe,
};

const fn feature(name: &'static str, unit: &'static str, meaning: &'static str) -> Feature {
    Feature { name, unit, group: "Camera", meaning }
}

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let (frame, depth_sigma) = (surroundings.frame, surroundings.config.camera.depth_sigma);
    let images: Vec<Image> = frame.images.iter().map(|image| Image::new(frame, image, depth_sigma)).collect();
    let mut columns = unobserved(PIECE.features, frame.scan.len());
    let mut residuals = Vec::new();
    for (i, detection) in frame.scan.detections.iter().enumerate() {
        let Some(detection) = detection else { continue };
        let sought = Sought::new(frame, detection);
        residuals.clear();
        for image in &images {
            image.add_residuals(&sought.detection, &mut residuals);
        }
        let [middle, least, on, through, hidden] = summary(&residuals);
        let green = images.iter().find_map(|image| image.green_at(&sought.ground));
        set(&mut columns, i, [middle, least, on, through, hidden, green]);
    }
    columns
}

/// The median, the least, and the shares of those on, through and hidden; absent without residuals.
fn summary(residuals: &[f64]) -> [Option<f64>; 5] {
    let share = |holds: &dyn Fn(&f64) -> bool| {
        let count = residuals.iter().filter(|residual| holds(residual)).count();
        (!residuals.is_empty()).then(|| count as f64 / residuals.len() as f64)
    };
    [
        median(residuals.to_vec()),
        residuals.iter().map(|residual| residual.abs()).reduce(f64::min),
        share(&|residual| residual.abs() <= ON),
        share(&|residual| *residual < -ON),
        share(&|residual| *residual > ON),
    ]
}

/// An image, seen from the frame.
struct Image<'a> {
    view: &'a ImageView,
    camera: &'a Camera,
    /// The largest angle off the axis that the camera sees, rad.
    limit: f64,
    camera_from_vehicle: Transform,
    /// Relative standard deviation of calibrated depth.
    depth_sigma: f64,
}

impl<'a> Image<'a> {
    fn new(frame: &'a Frame, view: &'a ImageView, depth_sigma: f64) -> Self {
        let camera_from_vehicle = view.moment.camera_from_vehicle() * view.vehicle_from_image.inverse();
        let camera = &frame.rig.cameras[view.moment.id.camera];
        Self { view, camera, limit: camera.intrinsics.limit(), camera_from_vehicle, depth_sigma }
    }

    /// How much greener the raw image is where it shows a point (vehicle frame) than in its median.
    fn green_at(&self, p: &Point) -> Option<f64> {
        let pixel = self.camera.intrinsics.project_within(&(self.camera_from_vehicle * p), self.limit)?;
        self.view.moment.greenness.as_ref()?.over_median(pixel)
    }

    /// Adds how far a detection lies behind each pixel around, in standard deviations.
    fn add_residuals(&self, detection: &Detection, residuals: &mut Vec<f64>) {
        let seen = detection.moved(&self.camera_from_vehicle);
        for (straight, view) in self.view.moment.calibrated_views() {
            let Some(window) = Window::new(&seen, straight, view.lattice.stride()) else { continue };
            for depth in view.lattice.around(window.at.pixel, window.half) {
                residuals.push(window.behind(depth, self.depth_sigma * depth));
            }
        }
    }
}
