//! The JSON files as they lie on disk. Keys that aren't needed are skipped.

use serde::Deserialize;
use std::collections::BTreeMap;

/// `sensors.json`: by `radar_` and the sensor's id.
pub(super) type Sensors = BTreeMap<String, Mounting>;

/// Where a radar is, relative to the middle of the rear axle, m, and where it looks, rad to the left.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub(super) struct Mounting {
    pub(super) id: i64,
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) yaw: f64,
}

/// `scenes.json` of a sequence.
#[derive(Debug, Deserialize)]
pub(super) struct SceneFile {
    /// `train` or `validation`.
    pub(super) category: Option<String>,
    /// By their time, us.
    pub(super) scenes: BTreeMap<String, Scene>,
}

/// A scan of one radar.
#[derive(Debug, Clone, Copy, Deserialize)]
pub(super) struct Scene {
    pub(super) sensor_id: i64,
    /// Its rows: the first, and the one after the last.
    pub(super) radar_indices: [usize; 2],
}
