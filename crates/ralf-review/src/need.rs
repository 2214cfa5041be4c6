//! How much a scan needs a person: how many of its labels are expected to be wrong, as far as nobody has said so yet.

use ralf_data::ScanIndex;
pub use ralf_data::judge::{Certainty, DISAGREEING, Doubts, UNCERTAIN};

/// How much one scan needs a person, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct ScanNeed {
    /// Which scan.
    pub scan: ScanIndex,
    /// When it was made.
    pub t_ns: i64,
    /// Its doubtful detections, before anybody said anything.
    pub doubts: Doubts,
    /// Cameras that were asked and failed.
    pub cameras_failed: usize,
}
