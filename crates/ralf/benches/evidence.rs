//! What the evidence on a radar scan costs, piece by piece, on a street that is driven through: 72k LiDAR points a scan
//! at 10 Hz, 1,216 detections a scan at 16.7 Hz, of which four in five are artifacts. One thread. Run with
//! `cargo bench -p ralf-radar --bench evidence`.

#![allow(clippy::expect_used, reason = "a bench that can't be set up should say so")]

use divan::{Bencher, black_box};
use ralf::config::Config;
use ralf::evidence::{PIECES, Surroundings, observe};
use ralf::learned::{LearnedLabeler, Model};
use ralf::scene::{Frame, FrameWindow, LidarSnapshot, LidarWindow};
use ralf::sensors::{Elevation, Lidar, LidarScan, MemorySource, Radar, Reliability, Source};
use ralf::space::{EgoMotion, OdometrySample, Spherical, Transform};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::sync::{Arc, LazyLock};

const BEAMS: usize = 64;
const AZIMUTHS: usize = 1125;
const DETECTIONS: usize = 1216;
const RADAR_SCANS: usize = 35;
const RADAR_NS: i64 = 60_000_000;
const LIDAR_SCANS: usize = 22;
const LIDAR_NS: i64 = 100_000_000;
const SPEED: f64 = 10.0;
const LIDAR_HEIGHT: f64 = 1.8;

fn main() {
    divan::main();
}

/// How far a ray from the LiDAR goes that has driven so far: to the road, to a wall at either side, to a parked car or
/// to the street's end.
fn range(driven: f64, azimuth: f64, elevation: f64) -> f64 {
    let (sin, cos) = azimuth.sin_cos();
    let flat = elevation.cos();
    let road = if elevation < 0.0 { LIDAR_HEIGHT / -elevation.sin() } else { f64::INFINITY };
    let wall = 12.0 / (sin.abs() * flat).max(1e-9);
    let car = 6.0 / (sin.abs() * flat).max(1e-9);
    let along = driven + car * flat * cos;
    let height = LIDAR_HEIGHT + car * elevation.sin();
    let parked = along.rem_euclid(9.0) < 4.5 && (0.2..1.5).contains(&height);
    let end = 70.0 / (cos.abs() * flat).max(1e-9);
    if parked { car.min(road) } else { wall.min(road).min(end) }
}

fn lidar_scan(scan: usize) -> LidarScan {
    let mut random = Pcg64Mcg::seed_from_u64(scan as u64);
    let t_ns = scan as i64 * LIDAR_NS;
    let driven = SPEED * t_ns as f64 * 1e-9;
    let mut points = Vec::with_capacity(BEAMS * AZIMUTHS);
    for step in 0..AZIMUTHS {
        for beam in 0..BEAMS {
            let azimuth = step as f64 / AZIMUTHS as f64 * std::f64::consts::TAU;
            let elevation = (-24.8 + 26.8 * beam as f64 / BEAMS as f64).to_radians();
            let range = range(driven, azimuth, elevation) + random.random_range(-0.03..0.03);
            let p = Spherical { range, azimuth, elevation }.to_cartesian();
            points.push([p.x as f32, p.y as f32, p.z as f32]);
        }
    }
    LidarScan { t_ns, intensity: vec![10.0; points.len()], points, ..LidarScan::default() }
}

/// One in five detections on walls and cars, the others anywhere.
fn radar_scan(scan: usize) -> (i64, Vec<Vec<f32>>) {
    let mut random = Pcg64Mcg::seed_from_u64(1000 + scan as u64);
    let t_ns = scan as i64 * RADAR_NS;
    let driven = SPEED * t_ns as f64 * 1e-9;
    let mut columns = vec![Vec::new(); 5];
    for i in 0..DETECTIONS {
        let azimuth = random.random_range(-1.4..1.4);
        let elevation: f64 = random.random_range(-0.02..0.1);
        let range = match i % 5 {
            0 => range(driven, azimuth, elevation).min(75.0),
            _ => random.random_range(2.0..75.0),
        };
        let p = Spherical { range, azimuth, elevation }.to_cartesian();
        let values =
            [p.x, p.y, p.z + LIDAR_HEIGHT, random.random_range(-3.0..3.0), random.random_range(-20.0..20.0)];
        columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value as f32));
    }
    (t_ns, columns)
}

fn radar() -> Radar {
    Radar {
        name: "radar".into(),
        fields: ["x", "y", "z", "doppler", "rcs"].map(str::to_owned).to_vec(),
        vehicle_from_radar: Transform::identity(),
        elevation: Elevation::Measured,
        fov_azimuth: 2.8,
        fov_elevation: 0.35,
        sigma_range: 0.1,
        sigma_azimuth: 0.01,
        sigma_elevation: 0.02,
        reliability: Reliability::default(),
    }
}

fn lidar() -> Lidar {
    Lidar {
        name: "lidar".into(),
        vehicle_from_lidar: Transform::translation(0.0, 0.0, LIDAR_HEIGHT),
        sigma_range: 0.03,
        lowest_beam: 0.43,
        max_range: None,
    }
}

fn street() -> MemorySource {
    let odometry = OdometrySample { t_ns: 0, velocity: SPEED, yaw_rate: 0.0 };
    let motion = EgoMotion::new(vec![odometry], vec![]).expect("there is odometry");
    let street = MemorySource::new("street", motion).expect("a motion");
    let street = street.with_radar(radar(), (0..RADAR_SCANS).map(radar_scan).collect());
    let lidar_scans = (0..LIDAR_SCANS).map(lidar_scan).collect();
    street.and_then(|street| street.with_lidar(lidar(), lidar_scans)).expect("scans in order")
}

static STREET: LazyLock<MemorySource> = LazyLock::new(street);
static CONFIG: LazyLock<Config> = LazyLock::new(Config::default);

fn frame() -> Frame<'static> {
    let mut window = FrameWindow::new(&*STREET, &STREET.sequence().rig, &CONFIG).with_evidence();
    window.frame(0, RADAR_SCANS / 2).expect("the street can be read")
}

/// The pieces by the names of their first columns.
fn pieces() -> impl Iterator<Item = &'static str> {
    PIECES.iter().map(|piece| piece.features[0].name)
}

/// One piece, where what it shares with others is there.
#[divan::bench(args = pieces())]
fn piece(bencher: Bencher, name: &str) {
    let frame = frame();
    let surroundings = Surroundings::new(&frame, &CONFIG);
    let piece = PIECES.iter().find(|piece| piece.features[0].name == name).expect("a piece");
    (piece.observe)(&surroundings);
    bencher.bench_local(|| (piece.observe)(black_box(&surroundings)));
}

/// What is worked out once for each of the LiDAR scans of a window: rays by direction, lowest and standing points.
#[divan::bench]
fn lidar_scan_once(bencher: Bencher) {
    let lidar = lidar();
    bencher
        .with_inputs(|| {
            let scan = Arc::new(STREET.lidar_scan(0, LIDAR_SCANS / 2).expect("a scan"));
            let parts = vec![(&lidar, scan, Transform::identity())];
            LidarSnapshot::new(0, parts, &CONFIG.ground, 0)
        })
        .bench_local_values(|moment| {
            moment.standing_points();
            moment.sweeps()[0].rays().len()
        });
}

/// What is worked out once for each window: ground surface, static map and terrain.
#[divan::bench]
fn lidar_window_once(bencher: Bencher) {
    let frame = frame();
    let views = &frame.lidar_window.as_ref().expect("a window").window.views;
    let known = &frame.lidar_window.as_ref().expect("a window").window;
    known.map();
    known.terrain();
    bencher.bench_local(|| {
        let window = LidarWindow::new(0, views.clone());
        window.terrain();
        window.map().points.len()
    });
}

/// All pieces with what they share within a scan; LiDAR scans and window are there.
#[divan::bench]
fn whole_scan(bencher: Bencher) {
    let frame = frame();
    observe(&frame, &CONFIG);
    bencher.bench_local(|| observe(black_box(&frame), &CONFIG));
}

/// The shipped model, whose limits let it answer for all detections, though the street is unlike what it knows.
fn learned_config(reasons: bool) -> Config {
    let mut config = Config::default();
    config.learned.max_novelty = 1.0;
    config.learned.reasons = reasons;
    config
}

/// What the shipped model makes of the evidence, the paper's method with it; evidence is there.
#[divan::bench(args = ["without reasons", "with reasons"])]
fn learned(bencher: Bencher, reasons: &str) {
    let frame = frame();
    let columns = observe(&frame, &CONFIG);
    let config = learned_config(reasons == "with reasons");
    let model = Model::shipped().expect("a model");
    let labeler = LearnedLabeler::new(&config, &model).expect("a model of this program");
    bencher.bench_local(|| labeler.label(black_box(&frame), &columns));
}

/// The same without reasons, of the shipped model's trees alone.
#[divan::bench]
fn learned_trees_alone(bencher: Bencher) {
    let frame = frame();
    let columns = observe(&frame, &CONFIG);
    let config = learned_config(false);
    let mut model = Model::shipped().expect("a model");
    model.net = None;
    let labeler = LearnedLabeler::new(&config, &model).expect("a model of this program");
    bencher.bench_local(|| labeler.label(black_box(&frame), &columns));
}

const FIRST: usize = 8;
const SCANS: usize = 20;

/// What is asked of a frame.
type Ask<'a> = &'a dyn Fn(&Frame);

/// Twenty scans in a row in the midst of a drive, the one before them is there; with all that is made for them, new
/// LiDAR scans and windows too.
fn in_a_row(bencher: Bencher, config: &Config, ask: Ask) {
    let before = || {
        let mut window = FrameWindow::new(&*STREET, &STREET.sequence().rig, config).with_evidence();
        ask(&window.frame(0, FIRST - 1).expect("the street can be read"));
        window
    };
    bencher.with_inputs(before).bench_local_refs(|window| {
        for scan in FIRST..FIRST + SCANS {
            ask(&window.frame(0, scan).expect("the street can be read"));
        }
    });
}

/// Evidence on [`in_a_row`]: twenty times what a scan costs.
#[divan::bench(sample_count = 20)]
fn twenty_scans(bencher: Bencher) {
    in_a_row(bencher, &CONFIG, &|frame| {
        black_box(observe(frame, &CONFIG));
    });
}

/// The same with labels of the shipped model, and reasons.
#[divan::bench(sample_count = 20)]
fn twenty_scans_learned(bencher: Bencher) {
    let config = learned_config(true);
    let model = Model::shipped().expect("a model");
    let labeler = LearnedLabeler::new(&config, &model).expect("a model of this program");
    in_a_row(bencher, &config, &|frame| {
        black_box(labeler.label(frame, &observe(frame, &config)));
    });
}
