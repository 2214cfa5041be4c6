//! One camera image with its calibrated views, shared by all radars that use it.

use super::calibrate::{CalibratedView, Calibration, calibrate};
use super::greenness::Greenness;
use super::lattice::DepthLattice;
use super::monitor::{Failure, ViewReport, ViewState, luminance};
use crate::sensors::{Camera, CameraImage, DepthImage, StraightView};
use crate::space::{Point, Transform};
use std::sync::Arc;

/// Names an image of a sequence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ImageId {
    /// The camera's index in the rig.
    pub camera: usize,
    /// The image's number.
    pub image: usize,
    /// Time of the image, ns.
    pub t_ns: i64,
}

/// An image's views in the vehicle frame at the image's time.
#[derive(Debug)]
pub struct CalibratedImage {
    /// Which image.
    pub id: ImageId,
    /// One per straight view.
    pub views: Vec<CalibratedView>,
    /// Why all views have failed, where image or depth can't be used at all.
    pub problem: Option<String>,
    /// How green the raw image is; `None` where it can't be used.
    pub greenness: Option<Greenness>,
    straight_views: Vec<StraightView>,
    camera_from_vehicle: Transform,
}

/// An image seen from a radar scan.
#[derive(Debug, Clone)]
pub struct ImageView {
    /// The image with its calibrated views.
    pub moment: Arc<CalibratedImage>,
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

impl CalibratedImage {
    /// Calibrates the views of an image. What can't be used makes failed views, not an error: the other cameras go on.
    pub fn new(camera: &Camera, id: ImageId, content: ImageWithDepth, calibration: &Calibration) -> Self {
        let straight_views = camera.straight_views();
        let greenness = content.as_ref().ok().and_then(|(image, _)| Greenness::new(image));
        let (views, problem) = match calibrated(camera, &straight_views, content, calibration) {
            Ok(views) => (views, None),
            Err(problem) => (vec![CalibratedView::unusable(); straight_views.len()], Some(problem)),
        };
        let camera_from_vehicle = camera.vehicle_from_camera.inverse();
        Self { id, views, problem, greenness, straight_views, camera_from_vehicle }
    }

    /// The views that are left, each with its geometry.
    pub fn calibrated_views(&self) -> impl Iterator<Item = (&StraightView, &CalibratedView)> {
        let views = self.straight_views.iter().zip(&self.views);
        views.filter(|(_, view)| view.report.state == ViewState::Calibrated)
    }

    /// Whether the view of this place is left.
    pub(super) fn is_left(&self, place: usize) -> bool {
        self.views.get(place).is_some_and(|view| view.report.state == ViewState::Calibrated)
    }

    /// The calibrated depths of the views that are left, each with the view's place.
    pub(super) fn lattices(&self) -> impl Iterator<Item = (usize, &DepthLattice)> {
        let views = self.views.iter().enumerate();
        views
            .filter(|(_, view)| view.report.state == ViewState::Calibrated)
            .map(|(at, view)| (at, &view.lattice))
    }

    /// From the vehicle frame at the image's time to the camera's optical frame.
    pub fn camera_from_vehicle(&self) -> &Transform {
        &self.camera_from_vehicle
    }

    /// In which kinds of views a point (vehicle frame at the image's time) lies.
    pub fn sees(&self, p: &Point) -> Seen {
        let p_camera = self.camera_from_vehicle * p;
        let mut seen = Seen::default();
        for (straight, view) in self.straight_views.iter().zip(&self.views) {
            if straight.project(&p_camera).is_none() {
                continue;
            }
            match view.report.state {
                ViewState::Calibrated => seen.calibrated = true,
                ViewState::Failed(_) => seen.failed = true,
            }
        }
        seen
    }
}

fn calibrated(
    camera: &Camera,
    views: &[StraightView],
    content: ImageWithDepth,
    calibration: &Calibration,
) -> Result<Vec<CalibratedView>, String> {
    let (image, depth) = content?;
    camera.check_image(&image).map_err(|reason| format!("expected {reason}"))?;
    calibrate(camera, views, &depth, luminance(&image), calibration)
        .map_err(|error| format!("expected {error}"))
}

impl CalibratedView {
    /// A view whose image or depth can't be used.
    fn unusable() -> Self {
        let state = ViewState::Failed(Failure::Unusable);
        let report = ViewReport { state, residual: None, samples: 0, luminance: 0.0 };
        Self { report, points: Vec::new(), lattice: DepthLattice::default() }
    }
}
