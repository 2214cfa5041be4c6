//! From the depth images of one camera image to a metric point cloud in the vehicle frame (docs/method.md, section 5).

use super::depth::RelativeDepth;
use super::lattice::DepthLattice;
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
    /// The view's points, row by row, without those on the ground and too far away; none where it has failed.
    pub points: Vec<CameraPoint>,
    /// The depth of all pixels that were calibrated, those on the ground and far away too; empty where it has failed.
    pub lattice: DepthLattice,
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
    /// Settings of the cameras.
    pub camera: &'a CameraConfig,
    /// Settings of the ground.
    pub ground: &'a GroundConfig,
}

/// Calibrates the depth images of one camera image, one per straight view. `luminance` is that of the raw image
/// ([`luminance`](super::luminance)).
///
/// The error says what was expected and found where the depth images aren't those of the views; then all views of the
/// image have failed.
pub fn calibrate(
    camera: &Camera,
    views: &[StraightView],
    depth: &[DepthImage],
    luminance: f64,
    calibration: &Calibration<'_>,
) -> Result<Vec<CalibratedView>, String> {
    check(views, depth)?;
    let views = views.iter().zip(depth);
    Ok(views.map(|(view, image)| calibrate_view(camera, view, image, luminance, calibration)).collect())
}

fn calibrate_view(
    camera: &Camera,
    view: &StraightView,
    image: &DepthImage,
    luminance: f64,
    calibration: &Calibration<'_>,
) -> CalibratedView {
    let Calibration { lidar, height, output, camera: config, ground } = *calibration;
    let relative = RelativeDepth::new(image, output);
    let samples = lidar.map(|points| {
        let camera_from_vehicle = camera.vehicle_from_camera.inverse();
        let seen = project_points(points, &camera_from_vehicle, view, config.occlusion_window);
        ScaleSample::usable(&seen, view, &relative)
    });
    let report = ViewReport::new(samples.as_deref(), luminance, config);
    let (mut points, mut lattice) = (Vec::new(), DepthLattice::default());
    if let (ViewState::Calibrated, Some(samples)) = (report.state, samples)
        && let Some(scaling) = Scaling::fit(config.scaling, &samples, config.scale_neighbours)
    {
        lattice = DepthLattice::new(view, config.stride);
        points = metric_points(camera, view, &relative, &scaling, &mut lattice);
        points.retain(|point| {
            let on_ground = height(&point.position).is_some_and(|h| h < ground.camera_margin);
            point.depth <= config.max_depth && !on_ground
        });
    }
    CalibratedView { report, points, lattice }
}

/// The calibrated pixels of a view, row by row; their depths are noted in the lattice.
fn metric_points(
    camera: &Camera,
    view: &StraightView,
    relative: &RelativeDepth<'_>,
    scaling: &Scaling,
    lattice: &mut DepthLattice,
) -> Vec<CameraPoint> {
    let with_depth = lattice
        .pixels()
        .filter_map(|[column, row]| Some(([column, row], relative.at(row * view.width + column)?)));
    let pixels: Vec<([usize; 2], f64)> = with_depth.collect();
    let places = || pixels.iter().map(|([column, row], _)| [*column as f64, *row as f64]);
    let vehicle_from_view =
        (camera.vehicle_from_camera.rotation * view.camera_from_view).to_rotation_matrix();
    let center = camera.vehicle_from_camera.translation.vector;
    let mut points = Vec::with_capacity(pixels.len());
    for (((pixel, relative), place), scale) in pixels.iter().zip(places()).zip(scaling.at(places())) {
        let depth = scale * relative;
        lattice.set(*pixel, depth);
        let along = vehicle_from_view * view.ray(place);
        points.push(CameraPoint {
            position: Point::from(center + along * depth),
            ray: along.normalize(),
            depth,
        });
    }
    points
}

fn check(views: &[StraightView], depth: &[DepthImage]) -> Result<(), String> {
    if views.len() != depth.len() {
        return Err(format!("{} depth images, one per view, found {}", views.len(), depth.len()));
    }
    for (index, (view, image)) in views.iter().zip(depth).enumerate() {
        let ([width, height], values) = ([view.width, view.height], image.values.len());
        if [image.width, image.height] != [width, height] || values != width * height {
            return Err(format!(
                "a depth image of {width} x {height} px for view {index}, found {} x {} px with {values} values",
                image.width, image.height
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
