//! Evidence from a camera that looks at two walls, with numbers worked out by hand.

use crate::support::{Memory, radar};
use ralf::config::Config;
use ralf::evidence::{self, Column};
use ralf::scene::{CalibratedImage, Calibration, FrameWindow, ImageId, ImageView, ViewState};
use ralf::sensors::{Camera, CameraImage, DepthImage, DepthOutput, Elevation, Intrinsics};
use ralf::space::{Point, Transform, transform_from_parts};
use std::sync::Arc;

const WIDTH: usize = 201;
const HEIGHT: usize = 151;

fn config() -> Config {
    let settings = ["ground.model=none", "camera.scaling=none", "camera.min_samples=2", "camera.stride=8"];
    Config::from_toml("", &settings).unwrap()
}

/// 1.5 m above the vehicle's origin, looking ahead.
fn camera() -> Camera {
    Camera {
        name: "front".into(),
        vehicle_from_camera: transform_from_parts([0.0, 0.0, 1.5], [-0.5, 0.5, -0.5, 0.5]).unwrap(),
        width: WIDTH,
        height: HEIGHT,
        intrinsics: Intrinsics::Pinhole { focal: [100.0; 2], center: [100.0, 75.0], distortion: [0.0; 5] },
        views: vec![],
    }
}

/// To the left a wall 10 m ahead, to the right one 30 m ahead; grass to the left, asphalt to the right.
fn image(camera: &Camera, config: &Config) -> ImageView {
    let left = |i: usize| i % WIDTH < 100;
    let rgb = (0..WIDTH * HEIGHT).map(|i| if left(i) { [50, 100, 50] } else { [90; 3] }).collect();
    let values = (0..WIDTH * HEIGHT).map(|i| if left(i) { 10.0 } else { 30.0 }).collect();
    let content = (
        CameraImage { width: WIDTH, height: HEIGHT, rgb },
        vec![DepthImage { width: WIDTH, height: HEIGHT, values }],
    );
    let lidar: Vec<Point> =
        (-9..9).map(|k| Point::new(if k < 0 { 30.0 } else { 10.0 }, f64::from(k) + 0.5, 1.5)).collect();
    let calibration = Calibration {
        lidar: Some(&lidar),
        height: &|_| None,
        output: DepthOutput::Metric,
        camera: &config.camera,
        ground: &config.ground,
    };
    let moment =
        CalibratedImage::new(camera, ImageId { camera: 0, image: 0, t_ns: 0 }, Ok(content), &calibration);
    assert!(
        moment.views.iter().all(|view| view.report.state == ViewState::Calibrated),
        "{:?}",
        moment.views[0].report
    );
    ImageView { moment: Arc::new(moment), vehicle_from_image: Transform::identity() }
}

fn observe(elevation: Elevation, detections: Vec<[f32; 3]>) -> Vec<Column> {
    let (config, camera) = (config(), camera());
    let mut memory = Memory::new(0.0).radar(radar(elevation), vec![(0, Some(detections))]);
    memory.sequence.rig.cameras.push(camera.clone());
    memory.sequence.times.cameras.push(Vec::new());
    let mut window = FrameWindow::new(&memory, &memory.sequence.rig, &config).with_evidence();
    let mut frame = window.frame(0, 0).unwrap();
    frame.images = vec![image(&camera, &config)];
    evidence::observe(&frame, &config)
}

#[track_caller]
fn close(columns: &[Column], name: &str, expected: &[Option<f64>]) {
    let found =
        &columns.iter().find(|column| column.feature.name == name).expect("a column of this name").values;
    let near = |(found, expected): (&Option<f64>, &Option<f64>)| match (found, expected) {
        (Some(found), Some(expected)) => (found - expected).abs() < 1e-4 * expected.abs().max(1.0),
        (found, expected) => found.is_none() && expected.is_none(),
    };
    assert!(found.iter().zip(expected).all(near), "{name}: found {found:?}, expected {expected:?}");
}

/// The residual of a detection straight ahead at a distance, m, from a wall; the radar knows its range by 0.3 m, and
/// the rays to it by so much less that nothing of it counts in depth but for one part in a hundred.
fn residual(detection: f64, wall: f64) -> f64 {
    (detection - wall) / 0.3f64.hypot(0.1).hypot(0.1 * wall)
}

#[test]
fn before_on_and_behind_by_hand() {
    // To the left: behind the near wall, on it. To the right: before the far wall. Behind the camera, and nowhere.
    let places =
        vec![[20.0, 2.0, 1.5], [10.2, 1.0, 1.5], [20.0, -0.9, 1.5], [-20.0, 0.9, 1.5], [f32::NAN, 0.0, 0.0]];
    let found = observe(Elevation::Measured, places);
    let expected = [residual(20.0, 10.0), residual(10.2, 10.0), residual(20.0, 30.0)];
    let columns: Vec<Option<f64>> = expected.iter().copied().map(Some).chain([None, None]).collect();
    let (residuals, least): (Vec<_>, Vec<_>) = columns.iter().map(|r| (*r, r.map(f64::abs))).unzip();
    for (name, expected) in [("camera_residual", residuals), ("camera_least", least)] {
        let found = &found.iter().find(|column| column.feature.name == name).unwrap().values;
        for (found, expected) in found.iter().zip(expected) {
            match (found, expected) {
                (Some(found), Some(expected)) => {
                    assert!((found - expected).abs() < 0.01 * expected.abs(), "{name} {found} {expected}");
                }
                (found, expected) => assert_eq!(*found, expected),
            }
        }
    }
    close(&found, "camera_hidden", &[Some(1.0), Some(0.0), Some(0.0), None, None]);
    close(&found, "camera_on", &[Some(0.0), Some(1.0), Some(0.0), None, None]);
    close(&found, "camera_through", &[Some(0.0), Some(0.0), Some(1.0), None, None]);
}

#[test]
fn a_detection_between_two_walls_has_pixels_of_both() {
    // 20 m ahead and 1 cm to the left: column 99.95. Its azimuth is known by 0.2 m, which are 1 px: 2.5 of these are
    // less than one step of the lattice, so that columns 92 and 100 lie around it, and rows 68 and 76 around row 75.
    let found = observe(Elevation::Measured, vec![[20.0, 0.01, 1.5]]);
    close(&found, "camera_hidden", &[Some(0.5)]);
    close(&found, "camera_through", &[Some(0.5)]);
}

#[test]
fn grass_below_a_detection_is_greener_than_the_image() {
    // Excess green is 0.5 of grass and 0 of asphalt; 12 of the 25 columns of the lattice are grass: the median is 0.
    let found = observe(Elevation::Measured, vec![[20.0, 8.0, 1.0], [20.0, -8.0, 1.0], [1.0, 0.0, 1.5]]);
    close(&found, "camera_excess_green", &[Some(0.5), Some(0.0), None]);
}

#[test]
fn a_radar_without_elevation_is_sought_a_metre_above_the_ground() {
    // In the radar's plane these lie on the ground, 1.5 m below the camera; the walls are there as well at 1 m.
    let found = observe(Elevation::None, vec![[10.2, 1.0, 7.0], [2.0, 0.4, 7.0]]);
    close(&found, "camera_on", &[Some(1.0), Some(0.0)]);
    close(&found, "camera_through", &[Some(0.0), Some(1.0)]);
}

#[test]
fn without_an_image_nothing_is_seen() {
    let memory = Memory::new(0.0).radar(radar(Elevation::Measured), vec![(0, Some(vec![[9.0, 0.0, 0.0]]))]);
    let config = config();
    let frame = FrameWindow::new(&memory, &memory.sequence.rig, &config).frame(0, 0).unwrap();
    let found = evidence::observe(&frame, &config);
    let of_camera: Vec<&Column> = found.iter().filter(|column| column.feature.group == "Camera").collect();
    assert!(!of_camera.is_empty() && of_camera.iter().all(|column| column.values == [None]));
}
