use super::*;
use crate::config::DepthScaling;
use crate::scene::Failure;
use crate::sensors::{Intrinsics, View};
use crate::space::transform_from_parts;

const WIDTH: usize = 96;
const HEIGHT: usize = 64;

/// A camera 2 m ahead of the origin and 1 m up, turned a little to the left by its extrinsics.
fn camera() -> Camera {
    let yaw = transform_from_parts([0.0; 3], [0.0, 0.0, f64::sin(0.1), f64::cos(0.1)]).unwrap();
    let ahead = transform_from_parts([2.0, 0.0, 1.0], [-0.5, 0.5, -0.5, 0.5]).unwrap();
    let view = |yaw: f64| View { yaw, pitch: 0.0, horizontal_fov: 1.2, width: WIDTH, height: HEIGHT };
    Camera {
        name: "front".into(),
        vehicle_from_camera: yaw * ahead,
        width: WIDTH,
        height: HEIGHT,
        intrinsics: Intrinsics::Pinhole { focal: [70.0; 2], center: [47.5, 31.5], distortion: [0.0; 5] },
        views: vec![view(0.0), view(1.5)],
    }
}

/// A slanted wall before a view: true depth of each pixel, and one LiDAR point per 3 by 3 pixels, in the vehicle frame.
fn wall(camera: &Camera, view: &StraightView) -> (Vec<f64>, Vec<Point>) {
    let depth = |pixel: [f64; 2]| 12.0 + 0.05 * pixel[0];
    let pixels = (0..HEIGHT).flat_map(|row| (0..WIDTH).map(move |column| [column as f64, row as f64]));
    let lidar = pixels.clone().filter(|[u, v]| u % 3.0 == 1.0 && v % 3.0 == 1.0).map(|pixel| {
        let p_camera = view.camera_from_view * (view.ray(pixel) * depth(pixel));
        camera.vehicle_from_camera * Point::from(p_camera)
    });
    (pixels.clone().map(depth).collect(), lidar.collect())
}

struct Scene {
    camera: Camera,
    views: Vec<StraightView>,
    depth: Vec<DepthImage>,
    lidar: Vec<Point>,
    truth: Vec<Vec<f64>>,
}

/// Both views look at walls; their depth images hold true depth passed through `relative`.
const LUMINANCE: f64 = 90.0;

fn scene(relative: impl Fn(f64) -> f64) -> Scene {
    let camera = camera();
    let views = camera.straight_views();
    let (truth, lidar): (Vec<_>, Vec<_>) = views.iter().map(|view| wall(&camera, view)).unzip();
    let image = |depth: &Vec<f64>| DepthImage {
        width: WIDTH,
        height: HEIGHT,
        values: depth.iter().map(|z| relative(*z) as f32).collect(),
    };
    let depth = truth.iter().map(image).collect();
    Scene { camera, views, depth, lidar: lidar.concat(), truth }
}

impl Scene {
    fn run(&self, output: DepthOutput, config: &CameraConfig) -> Vec<CalibratedView> {
        let no_ground = |_: &Point| None;
        let ground = GroundConfig::default();
        let lidar = Some(self.lidar.as_slice());
        let calibration = Calibration { lidar, height: &no_ground, output, camera: config, ground: &ground };
        calibrate(&self.camera, &self.views, &self.depth, LUMINANCE, &calibration).unwrap()
    }
}

fn config(scaling: DepthScaling) -> CameraConfig {
    CameraConfig { scaling, occlusion_window: 0.0, ..CameraConfig::default() }
}

#[test]
fn every_scaling_finds_the_wall() {
    use DepthOutput::{Depth, Disparity, Metric};
    use DepthScaling::{Huber, Local, None, Ransac};
    for (scaling, output) in
        [(Local, Depth), (Ransac, Disparity), (Huber, Depth), (None, Metric), (Local, Disparity)]
    {
        let scene = scene(|z| match output {
            Depth => z / 3.0,
            Disparity => 500.0 / z,
            Metric => z,
        });
        for (index, view) in scene.run(output, &config(scaling)).iter().enumerate() {
            assert_eq!(view.report.state, ViewState::Calibrated, "{scaling:?} {:?}", view.report);
            assert!(view.report.residual.unwrap() < 1e-5, "{scaling:?} {:?}", view.report);
            // Pixels 4, 12, 20, ... of both axes, row by row.
            assert_eq!(view.points.len(), (WIDTH / 8) * (HEIGHT / 8));
            for (i, point) in view.points.iter().enumerate() {
                let [column, row] = [4 + 8 * (i % (WIDTH / 8)), 4 + 8 * (i / (WIDTH / 8))];
                let depth = scene.truth[index][row * WIDTH + column];
                assert!((point.depth / depth - 1.0).abs() < 1e-5, "{scaling:?} {point:?} {depth}");
                let p_camera = scene.camera.vehicle_from_camera.inverse() * point.position;
                let seen = scene.views[index].project(&p_camera).unwrap();
                assert!((seen.pixel[0] - column as f64).hypot(seen.pixel[1] - row as f64) < 1e-9);
                let center = Point::from(scene.camera.vehicle_from_camera.translation.vector);
                assert!(((point.position - center).normalize() - point.ray).norm() < 1e-12);
            }
        }
    }
}

#[test]
fn the_low_and_the_far_are_left_out() {
    let scene = scene(|z| z);
    let height = |p: &Point| Some(p.z);
    let config = CameraConfig { max_depth: 15.0, ..config(DepthScaling::Local) };
    let ground = GroundConfig::default();
    let Scene { camera, views, depth, .. } = &scene;
    let all = scene.run(DepthOutput::Depth, &config);
    let output = DepthOutput::Depth;
    let lidar = Some(scene.lidar.as_slice());
    let calibration = Calibration { lidar, height: &height, output, camera: &config, ground: &ground };
    let kept = calibrate(camera, views, depth, LUMINANCE, &calibration).unwrap();
    for (all, kept) in all.iter().zip(&kept) {
        assert!(all.points.iter().all(|point| point.depth <= 15.0));
        let high: Vec<_> = all.points.iter().filter(|p| p.position.z >= 0.3).copied().collect();
        assert!(high.len() < all.points.len() && !high.is_empty());
        assert_eq!(kept.points, high);
    }
}

#[test]
fn pixels_without_depth_and_points_without_place_are_passed_over() {
    let mut scene = scene(|z| z);
    scene.lidar.push(Point::new(f64::NAN, 1.0, 1.0));
    for (i, value) in scene.depth[0].values.iter_mut().enumerate() {
        *value = [*value, f32::NAN, 0.0, -1.0][i / WIDTH % 4];
    }
    let found = scene.run(DepthOutput::Depth, &config(DepthScaling::Local));
    // Rows 4, 12, ... are divisible by four, so their pixels keep their depth; of the LiDAR's rows 1, 4, 7, ... a
    // quarter.
    assert_eq!(found[0].points.len(), found[1].points.len());
    assert!(found[0].report.samples < found[1].report.samples / 3);
    scene.depth[0].values.fill(f32::NAN);
    let found = scene.run(DepthOutput::Depth, &config(DepthScaling::Local));
    assert_eq!(found[0].report.state, ViewState::Failed(Failure::FewSamples));
    assert!(found[0].points.is_empty() && !found[1].points.is_empty());
}

#[test]
fn without_a_scan_all_views_have_failed() {
    let Scene { camera, views, depth, .. } = scene(|z| z);
    let (config, ground) = (config(DepthScaling::None), GroundConfig::default());
    let output = DepthOutput::Metric;
    let calibration =
        Calibration { lidar: None, height: &|_| None, output, camera: &config, ground: &ground };
    let found = calibrate(&camera, &views, &depth, LUMINANCE, &calibration).unwrap();
    assert!(
        found.iter().all(|v| v.report.state == ViewState::Failed(Failure::NoScan) && v.points.is_empty())
    );
}

#[test]
fn depth_images_of_other_views_are_refused() {
    let Scene { camera, views, mut depth, .. } = scene(|z| z);
    let (config, ground) = (config(DepthScaling::Local), GroundConfig::default());
    let output = DepthOutput::Depth;
    let calibration =
        Calibration { lidar: None, height: &|_| None, output, camera: &config, ground: &ground };
    let refusal =
        |depth: &[DepthImage]| calibrate(&camera, &views, depth, LUMINANCE, &calibration).unwrap_err();
    let error = refusal(&depth[..1]);
    assert!(error.contains("2 depth images") && error.contains("found 1"), "{error}");
    depth[1].width = 64;
    let error = refusal(&depth);
    assert!(error.contains("96 x 64 px for view 1, found 64 x 64 px"), "{error}");
}
