//! What nuScenes has besides the tables that others took over.

use crate::read::scene_tables::{Token, nanoseconds};
use serde::Deserialize;

/// `log.json`
#[derive(Deserialize)]
pub(super) struct LogRow {
    pub(super) token: Token,
    pub(super) date_captured: String,
    pub(super) location: String,
}

/// `can_bus/scene-NNNN_pose.json` of the CAN bus expansion.
#[derive(Deserialize)]
pub(super) struct CanPoseRow {
    #[serde(rename = "utime", deserialize_with = "nanoseconds")]
    pub(super) t_ns: i64,
    /// Vehicle frame, m/s.
    pub(super) vel: [f64; 3],
    /// Vehicle frame, rad/s.
    pub(super) rotation_rate: [f64; 3],
}
