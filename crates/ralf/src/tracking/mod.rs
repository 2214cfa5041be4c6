//! Tracking: what exists reoccurs in the neighbouring radar scans, clutter and noise do not (METHOD 7).

mod doppler;
mod matching;

pub use doppler::compensated_doppler;
pub use matching::{TrackingStep, match_detections};
