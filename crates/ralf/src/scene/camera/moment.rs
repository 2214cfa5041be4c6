//! One camera image with its calibrated views, shared by all radars that use it.

use super::calibrate::{CalibratedView, Surroundings, calibrate};
use super::monitor::{Failure, ViewReport, ViewState, luminance};
use crate::config::{CameraConfig, GroundConfig};
use crate::sensors::{Camera, CameraImage, DepthImage, DepthOutput, StraightView};
use crate::space::{Point, Transform};
use std::sync::Arc;

/// An image's views in the vehicle frame at the image's time.
#[derive(Debug)]
pub struct ImageMoment {
    /// The camera's place in the rig.
    pub camera: usize,
    /// The image's number.
    pub image: usize,
    /// Time of the image, ns.
    pub t_ns: i64,
    /// One per straight view.
    pub views: Vec<CalibratedView>,
    /// Why all views have failed, where image or depth can't be used at all.
    pub problem: Option<String>,
    straight_views: Vec<StraightView>,
    camera_from_vehicle: Transform,
}

/// An image seen from a radar scan.
#[derive(Debug, Clone)]
pub struct ImageView {
    /// The image with its calibrated views.
    pub moment: Arc<ImageMoment>,
    /// From the vehicle frame at the image's time to that at the radar scan's.
    pub vehicle_from_image: Transform,
}

/// An image and what a depth network gave for its views; or why they can't be had.
pub type ImageWithDepth = Result<(CameraImage, Vec<DepthImage>), String>;

/// Whether a point lies in views of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Seen {
    /// In one that is left.
    pub calibrated: bool,
    /// In one that has failed.
    pub failed: bool,
}

/// What an image is calibrated with.
#[derive(Clone, Copy)]
pub struct Calibration<'a> {
    /// Points of all LiDARs, the ground's too, in the vehicle frame at the image's time; `None` without a scan near
    /// enough.
    pub lidar: Option<&'a [Point]>,
    /// Height above the ground of a point in that frame, m; `None` where there is no ground.
    pub height: &'a dyn Fn(&Point) -> Option<f64>,
    /// What the depth images hold.
    pub output: DepthOutput,
    /// Settings.
    pub camera: &'a CameraConfig,
    /// Settings.
    pub ground: &'a GroundConfig,
}

impl ImageMoment {
    /// Calibrates the views of an image. What can't be used makes failed views, not an error: the other cameras go on.
    pub fn new(
        (index, camera): (usize, &Camera),
        (image, t_ns): (usize, i64),
        content: ImageWithDepth,
        calibration: &Calibration,
    ) -> Self {
        let straight_views = camera.straight_views();
        let (views, problem) = match calibrated(camera, &straight_views, content, calibration) {
            Ok(views) => (views, None),
            Err(problem) => (vec![CalibratedView::unusable(); straight_views.len()], Some(problem)),
        };
        let camera_from_vehicle = camera.vehicle_from_camera.inverse();
        Self { camera: index, image, t_ns, views, problem, straight_views, camera_from_vehicle }
    }

    /// In which kinds of views a point (vehicle frame at the image's time) lies.
    pub fn sees(&self, p: &Point) -> Seen {
        let p_camera = self.camera_from_vehicle * p;
        let views = self.straight_views.iter().zip(&self.views);
        let seeing = views.filter(|(straight, _)| straight.project(&p_camera).is_some());
        seeing.fold(Seen::default(), |seen, (_, view)| match view.report.state {
            ViewState::Calibrated => Seen { calibrated: true, ..seen },
            ViewState::Failed(_) => Seen { failed: true, ..seen },
        })
    }
}

fn calibrated(
    camera: &Camera,
    views: &[StraightView],
    content: ImageWithDepth,
    calibration: &Calibration,
) -> Result<Vec<CalibratedView>, String> {
    let (image, depth) = content?;
    if (image.width, image.height) != (camera.width, camera.height) {
        let (found, expected) = ((image.width, image.height), (camera.width, camera.height));
        return Err(format!("expected an image of {expected:?} px as calibrated, found {found:?}"));
    }
    let Calibration { lidar, height, output, camera: config, ground } = *calibration;
    let surroundings = Surroundings { lidar, height, luminance: luminance(&image) };
    calibrate(camera, views, &depth, output, &surroundings, (config, ground))
        .map_err(|error| format!("expected {error}"))
}

impl CalibratedView {
    /// A view whose image or depth can't be used.
    fn unusable() -> Self {
        let state = ViewState::Failed(Failure::Unusable);
        Self { report: ViewReport { state, residual: None, samples: 0, luminance: 0.0 }, points: Vec::new() }
    }
}
