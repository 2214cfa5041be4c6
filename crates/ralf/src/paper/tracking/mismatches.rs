//! What the neighbouring scans say of each detection.

/// The mismatches of each detection with the neighbouring scans: side by side, for a list of its own for each detection
/// costs more than to fill it.
pub(super) struct Mismatches {
    /// Room for one per scan for each detection.
    values: Vec<f64>,
    /// How many each detection has.
    counts: Vec<usize>,
    scans: usize,
}

impl Mismatches {
    /// None so far, for so many detections and no more than so many scans.
    pub(super) fn new(detections: usize, scans: usize) -> Self {
        Self { values: vec![0.0; detections * scans], counts: vec![0; detections], scans }
    }

    /// One more for a detection.
    pub(super) fn push(&mut self, detection: usize, mismatch: f64) {
        let count = &mut self.counts[detection];
        self.values[detection * self.scans + *count] = mismatch;
        *count += 1;
    }

    /// Those of a detection.
    pub(super) fn of(&mut self, detection: usize) -> &mut [f64] {
        let first = detection * self.scans;
        &mut self.values[first..first + self.counts[detection]]
    }
}
