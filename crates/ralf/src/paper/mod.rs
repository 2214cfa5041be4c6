//! The method of the paper, and nothing else: each detection is compared with the LiDAR's points, with the cameras' and
//! with the neighbouring radar scans, and the answers are fused into a plausibility and a label. Begin with
//! [`Labeler::label`].

mod blind_spot;
pub mod camera;
mod fusion;
mod labeler;
pub mod lidar;
pub mod tracking;

pub use blind_spot::in_blind_spot;
pub use fusion::{optical, prioritize};
pub use labeler::{DetectionLabel, Labeler};
