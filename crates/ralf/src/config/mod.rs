//! Every setting of the labeler (docs/method.md, section 12). `config/default.toml` says what each one means, with its
//! default, unit and range; a new setting is its line there, its field here, and its use.

mod error;
pub mod exact;
mod page;
mod read;
mod sensors;

pub use error::{ConfigError, in_words};
pub use read::read_toml;
pub use sensors::SensorOverride;

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// All settings. Every key of the file is optional, and unknown keys are refused.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "toml::Table")]
pub struct Config {
    /// Seed of every random choice.
    pub seed: u64,
    /// Which method labels: the paper's, or a trained model.
    pub method: Method,
    /// Which measurements belong together.
    pub sync: SyncConfig,
    /// The ground, and what lies on it.
    pub ground: GroundConfig,
    /// LiDAR matching.
    pub lidar: LidarConfig,
    /// Camera matching.
    pub camera: CameraConfig,
    /// Tracking.
    pub tracking: TrackingConfig,
    /// Fusion and label.
    pub fusion: FusionConfig,
    /// What evidence looks at.
    pub evidence: EvidenceConfig,
    /// The method that learns.
    pub learned: LearnedConfig,
    /// By sensor name: what replaces the recording's own values.
    pub sensors: BTreeMap<String, SensorOverride>,
}

/// The settings' tables, none of whose keys may lack. It reads what [`Config`] is made of.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Complete {
    seed: u64,
    method: Method,
    sync: SyncConfig,
    ground: GroundConfig,
    lidar: LidarConfig,
    camera: CameraConfig,
    tracking: TrackingConfig,
    fusion: FusionConfig,
    evidence: EvidenceConfig,
    learned: LearnedConfig,
    #[serde(default)]
    sensors: BTreeMap<String, SensorOverride>,
}

impl From<Complete> for Config {
    fn from(complete: Complete) -> Self {
        let Complete {
            seed,
            method,
            sync,
            ground,
            lidar,
            camera,
            tracking,
            fusion,
            evidence,
            learned,
            sensors,
        } = complete;
        Self { seed, method, sync, ground, lidar, camera, tracking, fusion, evidence, learned, sensors }
    }
}

/// Which method labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// The paper's method.
    Paper,
    /// A [model](crate::learned), from all evidence.
    Learned,
}

/// `learned`: the method that learns.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table `learned`")]
pub struct LearnedConfig {
    /// Where a larger share of the evidence is unlike what the model was trained on, the paper's method answers.
    pub max_novelty: f64,
    /// The odds of what only the radar tells of are multiplied by this.
    pub unconfirmed: f64,
    /// The share of detections that is plausible in recordings like these, in (0, 1); 0 is what the model expects
    /// ([`Model::expects`](crate::learned::Model::expects)).
    pub share: f64,
    /// Whether each scan tells how many of its movers are real (docs/learned.md).
    pub movers: bool,
    /// Whether it is told what each group of evidence adds.
    pub reasons: bool,
}

/// `sync`: which measurements belong together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table `sync`")]
pub struct SyncConfig {
    /// Largest time between a radar scan (or an image) and the LiDAR scan used with it, ms.
    pub lidar_tolerance_ms: f64,
    /// Largest time between a radar scan and an image, ms.
    pub camera_tolerance_ms: f64,
}

/// Which ground the recording has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum GroundModel {
    /// No ground: nothing is removed.
    None,
    /// z = 0 of the vehicle frame.
    Flat,
    /// One plane by RANSAC (the paper's).
    Plane,
    /// A plane per concentric sector.
    Polar,
    /// A surface that follows slopes, ramps and kerbs.
    Local,
}

/// `ground`: the ground, and what lies on it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table `ground`")]
pub struct GroundConfig {
    /// Which ground.
    pub model: GroundModel,
    /// Largest tilt of the plane, degrees.
    pub max_tilt_deg: f64,
    /// Largest distance of the plane from the vehicle's origin, m.
    pub max_offset: f64,
    /// A point this close to the plane belongs to it, m.
    pub inlier_distance: f64,
    /// How often the plane that was drawn may give way to the one fitted to its points, where that has more of them;
    /// 0 is the paper's.
    pub climbs: usize,
    /// LiDAR points lower than this above the ground are ground, m.
    pub lidar_margin: f64,
    /// Camera points lower than this above the ground are ground, m.
    pub camera_margin: f64,
    /// Detections lower than this above the ground are floor detections, m.
    pub radar_clearance: f64,
    /// Standard deviations of its own height that a floor detection must lie below the clearance; 0 is the paper's.
    pub radar_sigmas: f64,
}

/// `lidar`: LiDAR matching.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table `lidar`")]
pub struct LidarConfig {
    /// Whether the branch is used.
    pub enabled: bool,
    /// `beta_lm`.
    pub beta: f64,
    /// `K`.
    pub neighbours: usize,
    /// Cap of `d_lm`.
    pub max_mismatch: f64,
    /// Also compare each detection with every point where its Doppler velocity takes it at the point's own time.
    pub dynamic: bool,
    /// So many LiDAR scans, the nearest in time, make the reference cloud of what stands still.
    pub scans: usize,
    /// None of these is farther than this from the nearest one, ms.
    pub reach_ms: f64,
}

/// How relative depth becomes metric.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DepthScaling {
    /// Each pixel by its nearest LiDAR points (the paper's).
    Local,
    /// One scale per view, by RANSAC.
    Ransac,
    /// One scale per view, by Huber's M-estimator.
    Huber,
    /// Metric depth as it is.
    None,
}

/// `camera`: camera matching.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table `camera`")]
pub struct CameraConfig {
    /// Whether the branch is used.
    pub enabled: bool,
    /// `beta_cm`.
    pub beta: f64,
    /// Nearest calibrated points per detection.
    pub neighbours: usize,
    /// Cap of `d_cm`.
    pub max_mismatch: f64,
    /// Every stride-th pixel of every stride-th row is calibrated.
    pub stride: usize,
    /// How relative depth becomes metric.
    pub scaling: DepthScaling,
    /// Projected LiDAR points that calibrate a pixel.
    pub scale_neighbours: usize,
    /// A LiDAR point behind a nearer one within this window is hidden, px.
    pub occlusion_window: f64,
    /// Relative standard deviation of calibrated depth.
    pub depth_sigma: f64,
    /// Calibrated points farther than this are left out, m.
    pub max_depth: f64,
    /// Median relative residual above which a view has failed.
    pub max_residual: f64,
    /// Projected LiDAR points below which a view has failed.
    pub min_samples: usize,
    /// Mean 8-bit luminance below which a view has failed.
    pub min_luminance: f64,
}

/// Whose scans a radar's detections are sought in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TrackingSources {
    /// The same radar's (the paper's).
    Same,
    /// Every radar's.
    All,
}

/// `tracking`: the neighbouring radar scans.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table `tracking`")]
pub struct TrackingConfig {
    /// Whether the branch is used.
    pub enabled: bool,
    /// `beta_tr`.
    pub beta: f64,
    /// `n_b`: scans before and after.
    pub scans: usize,
    /// Nearest detections in each scan.
    pub neighbours: usize,
    /// Bounds every `d_j`; the value of an empty scan.
    pub max_mismatch: f64,
    /// Whose scans.
    pub sources: TrackingSources,
    /// Also try each detection where its Doppler velocity takes it.
    pub dynamic: bool,
    /// Doppler-consistent tracking: each detection is sought where its Doppler velocity takes it alone, among those
    /// whose Doppler velocity agrees, in the scans that could have seen it there. Then `dynamic` says nothing.
    pub doppler: bool,
    /// Compensated Doppler velocities that differ by no more agree, m/s.
    pub doppler_tolerance: f64,
    /// With `doppler`: bounds every `d_j` in place of `max_mismatch`; the value of a scan that could have seen a
    /// detection and has none that agrees.
    pub absence: f64,
    /// Two scans in a row farther apart than this end the batch, ms.
    pub max_gap_ms: f64,
}

/// `fusion`: fusion and label.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table `fusion`")]
pub struct FusionConfig {
    /// `alpha`: the share of `w_opt`.
    pub alpha: f64,
    /// `w0`.
    pub threshold: f64,
}

/// `evidence`: what evidence looks at around a radar scan, beyond what the paper's method does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table `evidence`")]
pub struct EvidenceConfig {
    /// LiDAR scans so far before and after count, ms.
    pub lidar_reach_ms: f64,
    /// At most so many LiDAR scans: one in as many as that takes, counted from the recording's begin.
    pub lidar_scans: usize,
    /// All radars' scans so far before and after count, ms.
    pub radar_reach_ms: f64,
    /// At most so many scans of each radar, the nearest in time.
    pub radar_scans: usize,
    /// About so many detections of each radar: where these scans hold more, one in two, three, ... of them is taken.
    pub radar_detections: usize,
}

macro_rules! defaults {
    ($($section:ident: $name:ty),*) => {
        $(impl Default for $name {
            fn default() -> Self {
                page::CONFIG.$section.clone()
            }
        })*
    };
}
defaults!(
    sync: SyncConfig, ground: GroundConfig, lidar: LidarConfig, camera: CameraConfig, tracking: TrackingConfig,
    fusion: FusionConfig, evidence: EvidenceConfig, learned: LearnedConfig
);

impl Default for Config {
    fn default() -> Self {
        page::CONFIG.clone()
    }
}

/// A duration in the unit of timestamps.
pub fn nanoseconds(ms: f64) -> i64 {
    // Saturates: a tolerance of a million years means "any".
    (ms * 1e6).round() as i64
}
