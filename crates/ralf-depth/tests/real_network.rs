//! A real network on the real images of a nuScenes key frame, against LiDAR: what its own tables promise.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails where things can't be had, or says that it is skipped"
)]

use ralf::scene::project_points;
use ralf::sensors::{CameraImage, StraightView, UndistortMap, ViewPoint, is_return};
use ralf::space::Point;
use ralf_data::{Recording, SequenceReader};
use ralf_depth::{DepthEstimator, NetworkError, OnnxModel};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// As the network's own description has it.
const CARD: &str = r#"
    input = { width = 48, height = 48 }
    fit = "squares"
    channels = "rgb"
    divide_by = 255
    mean = [0, 0, 0]
    std = [1, 1, 1]
    output = "disparity"
    flip = true
"#;

struct Real {
    network: PathBuf,
    recording: Recording,
}

impl Real {
    fn open() -> Option<Self> {
        let Some(data) = std::env::var_os("RALF_TEST_DATA").map(PathBuf::from) else {
            println!("skipped: RALF_TEST_DATA is not set");
            return None;
        };
        let recording = ralf_data::open(&data.join("nuscenes"), None).unwrap();
        Some(Self { network: data.join("depth-model/upydnet_kitti.onnx"), recording })
    }

    fn sequence(&self) -> &dyn SequenceReader {
        self.recording.sequences[0].as_ref()
    }

    /// A camera's straight view, and its image of the moment of a LiDAR scan.
    fn view(&self, name: &str, scan: usize) -> (StraightView, CameraImage) {
        let sequence = self.sequence().sequence();
        let index = sequence.rig.cameras.iter().position(|camera| camera.name == name).unwrap();
        let camera = &sequence.rig.cameras[index];
        let t_ns = sequence.times.lidars[0][scan];
        let times = &sequence.times.cameras[index];
        let image = (0..times.len()).min_by_key(|image| (times[*image] - t_ns).abs()).unwrap();
        let view = camera.straight_views().remove(0);
        let map = UndistortMap::new(&camera.intrinsics, camera.width, camera.height, &view);
        let image = map.apply(&self.sequence().image(index, image).unwrap()).unwrap();
        (view, image)
    }

    /// Where the camera sees the points of a LiDAR scan, 2 to 80 m deep.
    fn lidar(&self, name: &str, view: &StraightView, scan: usize) -> Vec<ViewPoint> {
        let sequence = self.sequence().sequence();
        let camera = sequence.rig.cameras.iter().find(|camera| camera.name == name).unwrap();
        let points = self.sequence().lidar_scan(0, scan).unwrap().points;
        let points: Vec<Point> =
            points.iter().filter(|p| is_return(p)).map(|p| Point::from(p.map(f64::from))).collect();
        let camera_from_lidar =
            camera.vehicle_from_camera.inverse() * sequence.rig.lidars[0].vehicle_from_lidar;
        let seen = project_points(&points, &camera_from_lidar, view, 6.0);
        seen.into_iter().filter(|point| (2.0..80.0).contains(&point.depth)).collect()
    }
}

/// The network with a card that lies elsewhere.
fn load(network: &Path, card: &str) -> Result<OnnxModel, NetworkError> {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("card.toml");
    std::fs::write(&file, card).unwrap();
    OnnxModel::load(network, Some(&file))
}

/// Ranks, equal values sharing their mean rank.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut below = 0;
    for tied in order.chunk_by(|a, b| values[*a] == values[*b]) {
        let rank = below as f64 + (tied.len() - 1) as f64 / 2.0;
        tied.iter().for_each(|index| ranks[*index] = rank);
        below += tied.len();
    }
    ranks
}

fn spearman(a: &[f64], b: &[f64]) -> f64 {
    let centred = |values: &[f64]| {
        let ranks = ranks(values);
        let mean = ranks.iter().sum::<f64>() / ranks.len() as f64;
        ranks.into_iter().map(|rank| rank - mean).collect::<Vec<_>>()
    };
    let (a, b) = (centred(a), centred(b));
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    dot(&a, &b) / (dot(&a, &a) * dot(&b, &b)).sqrt()
}

/// Correlation of disparity and 1 / depth over the LiDAR points between two columns.
fn agreement(disparity: &[f32], width: usize, points: &[ViewPoint], columns: [f64; 2]) -> f64 {
    let inside = points.iter().filter(|point| (columns[0]..columns[1] - 1.0).contains(&point.pixel[0]));
    let pairs = inside.map(|point| {
        let [column, row] = [point.pixel[0] - columns[0], point.pixel[1]].map(|pixel| pixel.round() as usize);
        (f64::from(disparity[row * width + column]), 1.0 / point.depth)
    });
    let (network, lidar): (Vec<f64>, Vec<f64>) = pairs.unzip();
    assert!(network.len() > 300, "{} points", network.len());
    spearman(&network, &lidar)
}

#[test]
fn the_centre_square_agrees_with_lidar_as_its_description_says() {
    let Some(real) = Real::open() else { return };
    let model = load(&real.network, CARD).unwrap();
    for (name, least) in [("CAM_FRONT", 0.95), ("CAM_FRONT_RIGHT", 0.92), ("CAM_BACK", 0.84)] {
        let (view, image) = real.view(name, 0);
        let left = (image.width - image.height) / 2;
        let kept = image.rgb.chunks(image.width).flat_map(|row| &row[left..left + image.height]);
        let square = CameraImage { width: image.height, height: image.height, rgb: kept.copied().collect() };
        let depth = model.estimate(&square, view.focal).unwrap();
        let columns = [left as f64, (left + image.height) as f64];
        let correlation = agreement(&depth.values, depth.width, &real.lidar(name, &view, 0), columns);
        println!("{name}: {correlation:.3}");
        assert!(correlation > least, "{name}: {correlation}");
    }
}

#[test]
fn whole_views_come_out_of_squares() {
    let Some(real) = Real::open() else { return };
    let model = load(&real.network, CARD).unwrap();
    for camera in &real.sequence().sequence().rig.cameras {
        let (view, image) = real.view(&camera.name, 0);
        let start = std::time::Instant::now();
        let depth = model.estimate(&image, view.focal).unwrap();
        let time = start.elapsed();
        assert_eq!((depth.width, depth.height, depth.values.len()), (1600, 900, 1600 * 900));
        let (least, most) = depth.values.iter().fold((f32::MAX, 0.0_f32), |(l, m), v| (l.min(*v), m.max(*v)));
        let points = real.lidar(&camera.name, &view, 0);
        let correlation = agreement(&depth.values, 1600, &points, [0.0, 1600.0]);
        println!("{}: {least:.1} to {most:.1}, {correlation:.3}, {time:.0?}", camera.name);
        // Squares from 5 to 62, those at the sides times what brings them to the middle one's scale.
        assert!(least > 2.5 && most < 124.0, "{}: {least} to {most}", camera.name);
        assert!(correlation > 0.75, "{}: {correlation}", camera.name);
    }
}

#[test]
fn estimates_do_not_depend_on_how_many_run() {
    let Some(real) = Real::open() else { return };
    let model = load(&real.network, CARD).unwrap();
    let (_, image) = real.view("CAM_FRONT", 0);
    let alone = model.estimate(&image, 1.0).unwrap();
    std::thread::scope(|scope| {
        let running: Vec<_> = (0..3).map(|_| scope.spawn(|| model.estimate(&image, 1.0).unwrap())).collect();
        running.into_iter().for_each(|one| assert!(one.join().unwrap() == alone));
    });
}

#[test]
fn damaged_files_and_cards_of_other_networks_are_errors() {
    let Some(real) = Real::open() else { return };
    let bytes = std::fs::read(&real.network).unwrap();
    let folder = TempDir::new().unwrap();
    let damaged = folder.path().join("damaged.onnx");
    let view = CameraImage { width: 48, height: 48, rgb: vec![[90, 120, 60]; 48 * 48] };
    for share in 0..40 {
        std::fs::write(&damaged, &bytes[..bytes.len() * share / 40]).unwrap();
        let error = load(&damaged, CARD).unwrap_err();
        assert!(error.to_string().contains("damaged.onnx"), "{error}");
        // Overwritten in part: whatever comes of it, it isn't a panic.
        let mut broken = bytes.clone();
        broken.iter_mut().skip(share * 977).step_by(4001).for_each(|byte| *byte = !*byte);
        std::fs::write(&damaged, &broken).unwrap();
        if let Ok(model) = load(&damaged, CARD) {
            drop(model.estimate(&view, 1.0));
        }
    }
    let error = load(&real.network, "preset = \"midas-small\"").unwrap_err().to_string();
    assert!(error.contains("input `img`: expected float32 [1, 3, 256, 256], as the card says"), "{error}");
    assert!(error.ends_with("found float32 [1, 3, 48, 48]"), "{error}");
}
