//! What a radar scan costs, stage by stage, on a street like the paper's: 72k LiDAR points, 1,216 detections of which
//! four in five are artifacts, K = 5, n_b = 5. Run with `cargo bench -p ralf-radar --bench scan`; one thread.

#![allow(clippy::expect_used, reason = "a bench that can't be set up should say so")]

use divan::{Bencher, black_box};
use nalgebra::UnitQuaternion;
use ralf::config::Config;

use ralf::paper::{Labeler, lidar, tracking};
use ralf::scene::{
    CalibratedImage, Calibration, Frame, FrameWindow, Ground, ImageId, ImageView, LidarSnapshot, LidarView,
};
use ralf::sensors::{
    Camera, CameraImage, DepthImage, DepthOutput, Elevation, Intrinsics, Lidar, LidarScan, Radar, RadarScan,
    Reliability, Rig, Sequence, Source, SourceError, Timelines,
};
use ralf::space::{EgoMotion, NeighborIndex, OdometrySample, Point, Spherical, Transform, Vector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f32::consts::PI;
use std::f64::consts::{FRAC_PI_2, PI as PI64};
use std::sync::{Arc, LazyLock};

const POINTS: usize = 72_000;
const DETECTIONS: usize = 1216;
const SCANS: usize = 11;
const SCAN_NS: i64 = 60_000_000;

fn main() {
    divan::main();
}

/// A street of 120 m with walls on both sides, parked cars and poles, and gardens with trees behind openings in the
/// walls.
fn street(seed: u64) -> Vec<[f32; 3]> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut point = |i: usize| {
        let along = random.random_range(-60.0f32..60.0);
        match i % 10 {
            // Returns from the ground grow rarer with the distance.
            0..5 => {
                let (r, phi) =
                    (3.0 + 45.0 * random.random_range(0.0f32..1.0).powi(3), random.random_range(-PI..PI));
                [r * phi.cos(), (r * phi.sin()).clamp(-9.0, 9.0), random.random_range(-0.03..0.03)]
            }
            5 => {
                let tree = |n: i32| ((n * 37) % 120 - 60) as f32;
                let n = random.random_range(0..60);
                let (x, y) = (tree(n), tree(n * n + 7));
                [
                    x + random.random_range(-1.5..1.5),
                    y + random.random_range(-1.5..1.5),
                    random.random_range(0.3..5.0),
                ]
            }
            6..8 => [along, if along > 0.0 { 9.0 } else { -9.0 }, random.random_range(0.0..6.0)],
            8 => [
                (along / 6.0).round() * 6.0 + random.random_range(-2.0..2.0),
                6.0,
                random.random_range(0.2..1.5),
            ],
            _ => [(along / 15.0).round() * 15.0, -7.0, random.random_range(0.0..5.0)],
        }
    };
    (0..POINTS).map(&mut point).collect()
}

/// One in five detections on the street's surfaces, the others anywhere.
fn detections(radar: &Radar, scan: usize) -> RadarScan {
    let mut random = Pcg64Mcg::seed_from_u64(99);
    let surfaces = street(7);
    let mut columns = vec![Vec::new(); 3];
    for i in 0..DETECTIONS {
        let [x, y, z] = match i % 5 {
            0 => surfaces[random.random_range(0..POINTS as u32) as usize],
            _ => {
                let mut noise = Pcg64Mcg::seed_from_u64((i * SCANS + scan) as u64);
                [
                    noise.random_range(-60.0..60.0),
                    noise.random_range(-60.0..60.0),
                    noise.random_range(0.0..3.0),
                ]
            }
        };
        let s = Spherical::from_cartesian(&Point::new(x.into(), y.into(), z.into()));
        [s.range, s.azimuth, s.elevation]
            .iter()
            .zip(&mut columns)
            .for_each(|(value, column)| column.push(*value as f32));
    }
    RadarScan::new(radar, scan as i64 * SCAN_NS, columns).expect("columns fit the radar")
}

struct Street {
    sequence: Sequence,
    lidar: LidarScan,
    scans: Vec<RadarScan>,
}

/// A 4D radar in the vehicle's origin.
fn radar() -> Radar {
    Radar {
        name: "radar".into(),
        fields: ["range", "azimuth", "elevation"].map(str::to_owned).to_vec(),
        vehicle_from_radar: Transform::translation(0.0, 0.0, 0.0),
        elevation: Elevation::Measured,
        fov_azimuth: 2.8,
        fov_elevation: 0.35,
        sigma_range: 0.1,
        sigma_azimuth: 0.01,
        sigma_elevation: 0.02,
        reliability: Reliability::default(),
    }
}

impl Street {
    fn new() -> Self {
        let radar = radar();
        let lidar = Lidar {
            name: "lidar".into(),
            vehicle_from_lidar: Transform::translation(0.0, 0.0, 0.0),
            sigma_range: 0.03,
            lowest_beam: 0.43,
            max_range: None,
        };
        let scans: Vec<_> = (0..SCANS).map(|scan| detections(&radar, scan)).collect();
        let points = street(7);
        let standing = OdometrySample { t_ns: 0, velocity: 0.0, yaw_rate: 0.0 };
        let times = scans.iter().map(|scan| scan.t_ns).collect();
        let middle = SCANS as i64 / 2 * SCAN_NS;
        let sequence = Sequence {
            name: "street".into(),
            title: String::new(),
            rig: Rig { radars: vec![radar], lidars: vec![lidar], cameras: vec![] },
            times: Timelines { radars: vec![times], lidars: vec![vec![middle]], cameras: vec![] },
            motion: EgoMotion::new(vec![standing], vec![]).expect("there is odometry"),
            depth_output: DepthOutput::Depth,
        };
        let lidar = LidarScan {
            t_ns: middle,
            intensity: vec![0.0; points.len()],
            points,
            times: None,
            classes: None,
        };
        Self { sequence, lidar, scans }
    }
}

impl Source for Street {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }
    fn radar_scan(&self, _: usize, scan: usize) -> Result<RadarScan, SourceError> {
        Ok(self.scans[scan].clone())
    }
    fn lidar_scan(&self, _: usize, _: usize) -> Result<LidarScan, SourceError> {
        Ok(self.lidar.clone())
    }
    fn image(&self, _: usize, _: usize) -> Result<CameraImage, SourceError> {
        Err("no camera".into())
    }
    fn depth(&self, _: usize, _: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        Ok(None)
    }
}

static STREET: LazyLock<Street> = LazyLock::new(Street::new);
static CONFIG: LazyLock<Config> = LazyLock::new(|| {
    Config::from_toml("", &["lidar.neighbours=5", "camera.max_residual=1e9"]).expect("settings")
});

fn frame() -> Frame<'static> {
    let mut window = FrameWindow::new(&*STREET, &STREET.sequence.rig, &CONFIG);
    window.frame(0, SCANS / 2).expect("the street can be read")
}

/// RANSAC over all points.
#[divan::bench]
fn ground_plane(bencher: Bencher) {
    let points = &STREET.lidar.points;
    bencher.bench(|| Ground::fit(black_box(points), &CONFIG.ground, 0));
}

/// The grid over all points.
#[divan::bench]
fn index_build(bencher: Bencher) {
    let points = &STREET.lidar.points;
    let ids: Vec<u32> = (0..points.len() as u32).collect();
    bencher.bench(|| NeighborIndex::new(black_box(points), &ids));
}

/// 1,216 searches for 5 neighbours.
#[divan::bench]
fn index_query(bencher: Bencher) {
    let points = &STREET.lidar.points;
    let ids: Vec<u32> = (0..points.len() as u32).collect();
    let index = NeighborIndex::new(points, &ids);
    let queries: Vec<_> =
        STREET.scans[0].positions.iter().map(|p| [p.x as f32, p.y as f32, p.z as f32]).collect();
    let mut found = Vec::new();
    bencher.bench_local(|| {
        for query in &queries {
            index.nearest(black_box(*query), 5, &mut found);
        }
    });
}

/// Search and mismatch; ground and index are there.
#[divan::bench]
fn lidar_matching(bencher: Bencher) {
    let frame = frame();
    bencher.bench(|| lidar::match_detections(black_box(&frame), &CONFIG.lidar));
}

/// Ten neighbouring scans.
#[divan::bench]
fn tracking_matching(bencher: Bencher) {
    let frame = frame();
    bencher.bench(|| tracking::match_detections(black_box(&frame), &CONFIG.tracking));
}

/// An image of 320 x 240 with its depth.
static IMAGE: LazyLock<(CameraImage, Vec<DepthImage>)> = LazyLock::new(|| {
    let image = CameraImage { width: 320, height: 240, rgb: vec![[90; 3]; 320 * 240] };
    let values = (0..320 * 240).map(|i| 3.0 + (i % 320) as f32 * 0.05).collect();
    (image, vec![DepthImage { width: 320, height: 240, values }])
});

/// A camera ahead, to the left, back and to the right, each with one view of 320 x 240 and depth.
fn images(points: &[Point]) -> Vec<ImageView> {
    let views = [0.0, FRAC_PI_2, PI64, -FRAC_PI_2].map(|yaw| {
        let optical = UnitQuaternion::from_euler_angles(-FRAC_PI_2, 0.0, -FRAC_PI_2);
        let heading = UnitQuaternion::from_axis_angle(&Vector::z_axis(), yaw);
        let camera = Camera {
            name: "camera".into(),
            vehicle_from_camera: Transform::from_parts([0.0, 0.0, 1.0].into(), heading * optical),
            width: 320,
            height: 240,
            intrinsics: Intrinsics::Pinhole {
                focal: [160.0; 2],
                center: [159.5, 119.5],
                distortion: [0.0; 5],
            },
            views: vec![],
        };
        let calibration = Calibration {
            lidar: Some(points),
            height: &|p| Some(p.z),
            output: DepthOutput::Depth,
            camera: &CONFIG.camera,
            ground: &CONFIG.ground,
        };
        let moment = CalibratedImage::new(
            &camera,
            ImageId { camera: 0, image: 0, t_ns: 0 },
            Ok(IMAGE.clone()),
            &calibration,
        );
        ImageView { moment: Arc::new(moment), vehicle_from_image: Transform::identity() }
    });
    views.to_vec()
}

/// The same with four cameras: projection, monitor, calibration and camera matching besides. The made-up depth would
/// fail the monitor, so that its limit is lifted.
#[divan::bench]
fn whole_scan_with_four_views(bencher: Bencher) {
    let scan = Arc::new(STREET.lidar.clone());
    let frame = frame();
    let lidar = &STREET.sequence.rig.lidars[0];
    bencher.bench(|| {
        let mut frame = frame.clone();
        let parts = vec![(lidar, scan.clone(), Transform::identity())];
        let moment = Arc::new(LidarSnapshot::new(scan.t_ns, parts, &CONFIG.ground, CONFIG.seed));
        let view = LidarView { moment, vehicle_from_moment: Transform::identity() };
        frame.images = images(&view.all_points());
        frame.lidar = Some(view);
        let labels = Labeler::new(&CONFIG).expect("settings in range").label(&frame);
        assert!(labels.iter().any(|label| label.w_cm.is_some()));
        labels
    });
}

/// Ground, index, LiDAR matching, tracking, fusion; measurements are in memory.
#[divan::bench]
fn whole_scan(bencher: Bencher) {
    let scan = Arc::new(STREET.lidar.clone());
    let frame = frame();
    let lidar = &STREET.sequence.rig.lidars[0];
    bencher.bench(|| {
        let mut frame = frame.clone();
        let parts = vec![(lidar, scan.clone(), Transform::identity())];
        let moment = LidarSnapshot::new(scan.t_ns, parts, &CONFIG.ground, CONFIG.seed);
        frame.lidar.as_mut().expect("a LiDAR scan").moment = Arc::new(moment);
        Labeler::new(&CONFIG).expect("settings in range").label(&frame)
    });
}
