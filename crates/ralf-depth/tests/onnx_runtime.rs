//! ONNX Runtime gives what rten gives. Its library is taken from where `ORT_DYLIB_PATH` says.
#![cfg(feature = "ort")]
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails where things can't be had, or says that it is skipped"
)]

use ralf::sensors::CameraImage;
use ralf_depth::{DepthEstimator, NetworkError, OnnxModel, Runtime};
use std::path::{Path, PathBuf};
use std::time::Instant;
use tempfile::TempDir;

const CARD: &str = "input = { width = 48, height = 48 }\nfit = \"squares\"\nchannels = \"rgb\"\ndivide_by = 255\n\
                    mean = [0, 0, 0]\nstd = [1, 1, 1]\noutput = \"disparity\"\nflip = true\n";

/// The folder of test data, where there is a library too.
fn data() -> Option<PathBuf> {
    for name in ["ORT_DYLIB_PATH", "RALF_TEST_DATA"] {
        if std::env::var_os(name).is_none() {
            println!("skipped: {name} is not set");
            return None;
        }
    }
    std::env::var_os("RALF_TEST_DATA").map(PathBuf::from)
}

fn load(runtime: Runtime, network: &Path) -> Result<OnnxModel, NetworkError> {
    let folder = TempDir::new().unwrap();
    let card = folder.path().join("card.toml");
    std::fs::write(&card, CARD).unwrap();
    OnnxModel::load_with(runtime, network, Some(&card))
}

fn images(data: &Path) -> Vec<CameraImage> {
    let recording = ralf_data::open(&data.join("nuscenes"), None).unwrap();
    let sequence = &recording.sequences[0];
    let cameras = 0..sequence.sequence().rig.cameras.len();
    cameras.map(|camera| sequence.image(camera, 0).unwrap()).collect()
}

#[test]
fn both_runtimes_agree_on_a_real_network() {
    let Some(data) = data() else { return };
    let network = data.join("depth-model/upydnet_kitti.onnx");
    let [rten, ort] = [Runtime::Rten, Runtime::OnnxRuntime].map(|runtime| load(runtime, &network).unwrap());
    assert_eq!(rten.fingerprint(), ort.fingerprint());
    for image in images(&data) {
        let timed = |model: &OnnxModel| {
            let start = Instant::now();
            (model.estimate(&image, 1.0).unwrap(), start.elapsed())
        };
        let ((a, rten_time), (b, ort_time)) = (timed(&rten), timed(&ort));
        let error = |(a, b): (&f32, &f32)| (a - b).abs() / a.abs().max(b.abs());
        let worst = a.values.iter().zip(&b.values).map(error).fold(0.0, f32::max);
        println!("relative difference {worst:.1e}; rten {rten_time:.0?}, ONNX Runtime {ort_time:.0?}");
        assert!(worst < 1e-3, "{worst}");
    }
}

#[test]
fn estimates_do_not_depend_on_how_many_run() {
    let Some(data) = data() else { return };
    let model = load(Runtime::OnnxRuntime, &data.join("depth-model/upydnet_kitti.onnx")).unwrap();
    let image = images(&data).swap_remove(0);
    let alone = model.estimate(&image, 1.0).unwrap();
    std::thread::scope(|scope| {
        let running: Vec<_> = (0..3).map(|_| scope.spawn(|| model.estimate(&image, 1.0).unwrap())).collect();
        running.into_iter().for_each(|one| assert!(one.join().unwrap() == alone));
    });
}

#[test]
fn a_damaged_file_is_an_error() {
    let Some(data) = data() else { return };
    let folder = TempDir::new().unwrap();
    let damaged = folder.path().join("damaged.onnx");
    let bytes = std::fs::read(data.join("depth-model/upydnet_kitti.onnx")).unwrap();
    std::fs::write(&damaged, &bytes[..bytes.len() / 2]).unwrap();
    let error = load(Runtime::OnnxRuntime, &damaged).unwrap_err().to_string();
    assert!(error.contains("damaged.onnx: ONNX Runtime cannot load it as an ONNX network"), "{error}");
}
