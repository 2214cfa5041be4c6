//! From the depth images of one camera image to a metric point cloud in the vehicle frame (docs/method.md, section 5).

use super::depth::RelativeDepth;
use super::monitor::{ViewReport, ViewState};
use super::projection::project_points;
use super::scaling::{ScaleSample, Scaling};
use crate::config::{CameraConfig, GroundConfig};
use crate::sensors::{Camera, DepthImage, DepthOutput, StraightView};
use crate::space::{Point, Vector};

/// A pixel whose depth is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraPoint {
    /// In the vehicle frame at the image's time, m.
    pub position: Point,
    /// `u`: the unit ray from the camera to the point, in the vehicle frame at the image's time.
    pub ray: Vector,
    /// `Z`: along the view's optical axis, m.
    pub depth: f64,
}

/// A view's points, and what was found about them.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedView {
    /// Whether it is used, and why not.
    pub report: ViewReport,
    /// The view's points, row by row; none where it has failed.
    pub points: Vec<CameraPoint>,
}

/// What surrounds an image when its depth is calibrated.
#[derive(Clone, Copy)]
pub struct Surroundings<'a> {
    /// Points of all LiDARs, the ground's too, in the vehicle frame at the image's time; `None` without a scan near
    /// enough.
    pub lidar: Option<&'a [Point]>,
    /// Height above the ground of a point in that frame, m; `None` where there is no ground.
    pub height: &'a dyn Fn(&Point) -> Option<f64>,
    /// Of the raw image ([`super::luminance`]).
    pub luminance: f64,
}

/// Calibrates the depth images of one camera image, one per straight view.
///
/// The error says what was expected and found where the depth images aren't those of the views; then all views of the
/// image have failed.
pub fn calibrate(
    camera: &Camera,
    views: &[StraightView],
    depth: &[DepthImage],
    output: DepthOutput,
    surroundings: &Surroundings<'_>,
    (config, ground): (&CameraConfig, &GroundConfig),
) -> Result<Vec<CalibratedView>, String> {
    check(views, depth)?;
    let calibrated = views.iter().zip(depth).map(|(view, image)| {
        let relative = RelativeDepth::new(image, output);
        let samples = surroundings.lidar.map(|points| {
            let camera_from_vehicle = camera.vehicle_from_camera.inverse();
            let seen = project_points(points, &camera_from_vehicle, view, config.occlusion_window);
            ScaleSample::usable(&seen, view, &relative)
        });
        let report = ViewReport::of(samples.as_deref(), surroundings.luminance, config);
        let scaling = samples
            .filter(|_| report.state == ViewState::Calibrated)
            .and_then(|samples| Scaling::fit(config.scaling, &samples, config.scale_neighbours));
        let keeps = |point: &CameraPoint| {
            let on_ground = (surroundings.height)(&point.position).is_some_and(|h| h < ground.camera_margin);
            point.depth <= config.max_depth && !on_ground
        };
        let points = scaling.map(|scaling| {
            let all = metric_points(camera, view, &relative, &scaling, config.stride);
            all.into_iter().filter(keeps).collect()
        });
        CalibratedView { report, points: points.unwrap_or_default() }
    });
    Ok(calibrated.collect())
}

/// The calibrated pixels `(floor(s/2) + a s, floor(s/2) + b s)` of a view, row by row.
fn metric_points(
    camera: &Camera,
    view: &StraightView,
    relative: &RelativeDepth<'_>,
    scaling: &Scaling,
    stride: usize,
) -> Vec<CameraPoint> {
    let every = |size: usize| (stride / 2..size).step_by(stride);
    let lattice = every(view.height).flat_map(|row| every(view.width).map(move |column| [column, row]));
    let with_depth = lattice.filter_map(|[column, row]| {
        Some(([column as f64, row as f64], relative.at(row * view.width + column)?))
    });
    let pixels: Vec<([f64; 2], f64)> = with_depth.collect();
    let vehicle_from_view =
        (camera.vehicle_from_camera.rotation * view.camera_from_view).to_rotation_matrix();
    let center = camera.vehicle_from_camera.translation.vector;
    let scales = scaling.at(pixels.iter().map(|(pixel, _)| *pixel));
    let points = pixels.iter().zip(scales).map(|((pixel, relative), scale)| {
        let depth = scale * relative;
        let along = vehicle_from_view * view.ray(*pixel);
        CameraPoint { position: Point::from(center + along * depth), ray: along.normalize(), depth }
    });
    points.collect()
}

fn check(views: &[StraightView], depth: &[DepthImage]) -> Result<(), String> {
    if views.len() != depth.len() {
        return Err(format!("{} depth images, one per view, found {}", views.len(), depth.len()));
    }
    for (index, (view, image)) in views.iter().zip(depth).enumerate() {
        let expected = [view.width, view.height];
        let found = [image.width, image.height];
        if found != expected || image.values.len() != view.width * view.height {
            let values = image.values.len();
            return Err(format!(
                "a depth image of {expected:?} px for view {index}, found {found:?} with {values} values"
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
