//! Networks: loaded, and run over a small view.

#![no_main]

use libfuzzer_sys::fuzz_target;
use ralf::sensors::CameraImage;
use ralf_depth::{DepthEstimator, OnnxModel};
use std::sync::LazyLock;
use tempfile::TempDir;

const CARD: &str = "input = { size = 16, multiple_of = 4, side = \"short\" }\nfit = \"stretch\"\nchannels = \"rgb\"\n\
    divide_by = 255\nmean = [0, 0, 0]\nstd = [1, 1, 1]\noutput = \"disparity\"\n";

static FOLDER: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("net.toml"), CARD).unwrap();
    folder
});

fuzz_target!(|data: &[u8]| {
    let file = FOLDER.path().join("net.onnx");
    std::fs::write(&file, data).unwrap();
    let Ok(model) = OnnxModel::load(&file, None) else { return };
    let view = CameraImage { width: 24, height: 16, rgb: vec![[90, 120, 60]; 24 * 16] };
    let _ = model.estimate(&view, 20.0);
});
