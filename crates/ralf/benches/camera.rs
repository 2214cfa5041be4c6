//! The camera branch: straightening images and calibrating depth. One thread.

use divan::{Bencher, black_box};
use ralf::config::{CameraConfig, GroundConfig};
use ralf::scene::{Calibration, calibrate, project_points};
use ralf::sensors::{
    Camera, CameraImage, DepthImage, DepthOutput, Intrinsics, StraightView, UndistortMap, View,
};
use ralf::space::{Point, Transform};

fn main() {
    divan::main();
}

fn lens(width: usize, height: usize) -> Intrinsics {
    let center = [width as f64 / 2.0, height as f64 / 2.0];
    Intrinsics::KannalaBrandt { focal: [330.0; 2], center, distortion: [0.05, -0.01, 0.0, 0.0] }
}

fn view(yaw: f64, width: usize, height: usize) -> View {
    View { yaw, pitch: 0.0, horizontal_fov: 1.6, width, height }
}

/// Four raw images of 1280 x 800 px, each straightened to a view of a size.
fn undistort(bencher: Bencher, width: usize, height: usize) {
    let rgb = (0..1280 * 800).map(|i: usize| [i as u8, (i / 3) as u8, (i / 1280) as u8]).collect();
    let image = CameraImage { width: 1280, height: 800, rgb };
    let map = UndistortMap::new(&lens(1280, 800), 1280, 800, &StraightView::from(&view(0.0, width, height)));
    bencher.bench(|| {
        for _ in 0..4 {
            black_box(map.apply(black_box(&image)).ok());
        }
    });
}

#[divan::bench]
fn undistort_four_to_1280x800(bencher: Bencher) {
    undistort(bencher, 1280, 800);
}

#[divan::bench]
fn undistort_four_to_640x480(bencher: Bencher) {
    undistort(bencher, 640, 480);
}

#[divan::bench]
fn map_of_1280x800(bencher: Bencher) {
    let view = StraightView::from(&view(0.0, 1280, 800));
    bencher.bench(|| UndistortMap::new(black_box(&lens(1280, 800)), 1280, 800, &view));
}

/// What one image brings: a camera, its views, their depth, and LiDAR points in scan lines of which the wanted number
/// falls into each view.
struct Image {
    camera: Camera,
    views: Vec<StraightView>,
    depth: Vec<DepthImage>,
    lidar: Vec<Point>,
}

impl Image {
    fn new(views: Vec<View>, beams: usize, points_per_beam: usize) -> Self {
        let camera = Camera {
            name: "front".into(),
            vehicle_from_camera: Transform::identity(),
            width: 1280,
            height: 960,
            intrinsics: lens(1280, 960),
            views,
        };
        let views = camera.straight_views();
        let depth = views.iter().map(|view| DepthImage {
            width: view.width,
            height: view.height,
            values: (0..view.width * view.height).map(|i| 0.5 + (i % 977) as f32 * 1e-3).collect(),
        });
        let depth = depth.collect();
        // In the optical frame: beams are rows, most of them below the horizon.
        let lidar = views.iter().flat_map(|view| {
            let at = move |beam: usize, point: usize| {
                let share = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
                let y = (share(beam, beams) * 0.8 - 0.2) * view.height as f64 / view.focal;
                let x = (share(point, points_per_beam) - 0.5) * view.width as f64 / view.focal;
                let z = 8.0 + 2.0 * (x * 9.0).sin();
                view.camera_from_view * Point::new(x * z, y * z, z)
            };
            (0..beams).flat_map(move |beam| (0..points_per_beam).map(move |point| at(beam, point)))
        });
        let lidar = lidar.collect();
        Self { camera, views, depth, lidar }
    }

    fn calibrate(&self, bencher: Bencher) {
        let config = CameraConfig { max_residual: 1e3, ..CameraConfig::default() };
        let ground = GroundConfig::default();
        let Self { camera, views, depth, lidar } = self;
        bencher.bench(|| {
            let calibration = Calibration {
                lidar: Some(lidar),
                height: &|p| Some(p.z),
                output: DepthOutput::Depth,
                camera: &config,
                ground: &ground,
            };
            calibrate(camera, views, depth, 90.0, &calibration)
        });
    }
}

/// 19,200 pixels by 10,000 samples.
#[divan::bench]
fn calibrate_1280x960(bencher: Bencher) {
    Image::new(vec![view(0.0, 1280, 960)], 40, 250).calibrate(bencher);
}

#[divan::bench]
fn calibrate_four_320x240(bencher: Bencher) {
    Image::new((0..4).map(|i| view(1.6 * f64::from(i), 320, 240)).collect(), 40, 250).calibrate(bencher);
}

/// 10,000 points, with the search for occluded ones.
#[divan::bench]
fn project_1280x960(bencher: Bencher) {
    let image = Image::new(vec![view(0.0, 1280, 960)], 40, 250);
    bencher.bench(|| project_points(&image.lidar, &Transform::identity(), &image.views[0], 6.0));
}
