//! How much a scan needs a person.
//!
//! Of a scan's detections, `u` is the share whose plausibility lies within [`UNCERTAIN`] of the threshold `w0`,
//! and `d` the share whose branches disagree: of `w_lm`, `w_cm`, `w_tr`, as far as observed, one says plausible
//! and another, lower by more than [`DISAGREEING`], doesn't. A floor detection is decided, whatever its
//! branches say, and counts for neither. `c` is the share of failed cameras among those that were asked. Then
//!
//! `need = 1 - (1 - u) (1 - d) (1 - c CAMERA_WEIGHT)`,
//!
//! which is 0 where nothing is doubtful, 1 where everything is, and grows with each of the three.

pub use ralf_data::judge::{DISAGREEING, Doubts, UNCERTAIN};

/// What a failed camera counts beside doubtful detections.
pub const CAMERA_WEIGHT: f64 = 0.25;

/// How much one scan needs a person, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct ScanNeed {
    /// The radar's place in the rig.
    pub radar: usize,
    /// The scan's number.
    pub scan: usize,
    /// When it was made.
    pub t_ns: i64,
    /// Its doubtful detections.
    pub doubts: Doubts,
    /// Cameras that were asked and failed.
    pub cameras_failed: usize,
    /// Cameras that were asked.
    pub cameras_asked: usize,
}

impl ScanNeed {
    /// From 0 to 1.
    pub fn need(&self) -> f64 {
        let share = |part: usize, whole: usize| if whole == 0 { 0.0 } else { part as f64 / whole as f64 };
        let Doubts { detections, uncertain, disagreeing } = self.doubts;
        let sure = 1.0 - share(uncertain, detections);
        let agreeing = 1.0 - share(disagreeing, detections);
        let seeing = 1.0 - CAMERA_WEIGHT * share(self.cameras_failed, self.cameras_asked);
        1.0 - sure * agreeing * seeing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn need_is_between_nothing_and_everything() {
        let scan = |uncertain, disagreeing, cameras_failed| ScanNeed {
            radar: 0,
            scan: 0,
            t_ns: 0,
            doubts: Doubts { detections: 10, uncertain, disagreeing },
            cameras_failed,
            cameras_asked: 2,
        };
        assert_eq!(scan(0, 0, 0).need(), 0.0);
        assert_eq!(scan(10, 0, 0).need(), 1.0);
        assert!((scan(5, 2, 1).need() - (1.0 - 0.5 * 0.8 * 0.875)).abs() < 1e-12);
        assert_eq!(ScanNeed { doubts: Doubts::default(), cameras_asked: 0, ..scan(0, 0, 0) }.need(), 0.0);
    }
}
