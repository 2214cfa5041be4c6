//! Evidence from LiDAR on made-up recordings, with numbers worked out by hand and searches without any shortcut.

mod ground;
mod map;
mod rays;

use crate::support::Memory;
use ralf::config::Config;
use ralf::evidence::{self, Column};
use ralf::scene::FrameWindow;

/// The evidence on a scan of the first radar.
fn observe(memory: &Memory, scan: usize) -> Vec<Column> {
    let mut config = Config::default();
    // Every second LiDAR scan at 10 Hz: what was worked out by hand is of these.
    config.evidence.lidar_scans = 12;
    let mut window = FrameWindow::new(memory, &memory.sequence.rig, &config).with_evidence();
    evidence::observe(&window.frame(0, scan).unwrap(), &config)
}

fn column<'a>(columns: &'a [Column], name: &str) -> &'a [Option<f64>] {
    &columns.iter().find(|column| column.feature.name == name).expect("a column of this name").values
}

#[track_caller]
fn close(found: Option<f64>, expected: f64, tolerance: f64) {
    let found = found.expect("a value");
    assert!((found - expected).abs() <= tolerance, "found {found}, expected {expected}");
}
