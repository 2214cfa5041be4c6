//! What one scan around saw where a detection would be by then.

use super::chance::SAME;
use super::going;
use super::rates::AGREEING;

/// Nothing farther is looked for, in standard deviations.
pub(super) const FARTHEST: f64 = 3.0;
/// Nor anything farther than this, m, whatever the radar's uncertainty is said to be.
pub(super) const REACH: f32 = 8.0;

/// One detection with its range rate in one of the same radar's scans around that could have seen it where it would be,
/// be it that it stands still or that it moves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting {
    /// Distance `chi` from the nearest detection there whose range rate agrees, in standard deviations; infinite where
    /// none is nearer than [`FARTHEST`].
    pub(super) chi: f64,
    /// The least difference of range rates from those of the detections there, in standard deviations; infinite where
    /// nothing is nearer than [`FARTHEST`].
    pub(super) rate_difference: f64,
    /// Which detection that nearest one is, of those that were searched, where there is one.
    pub(super) nearest: u32,
}

impl Meeting {
    pub(super) const NOBODY: Self =
        Self { chi: f64::INFINITY, rate_difference: f64::INFINITY, nearest: u32::MAX };

    /// A detection, by its place among those searched, at a distance `chi` from where this one would be; `difference`
    /// is that of their rates, in standard deviations.
    pub(super) fn meet(&mut self, at: usize, chi: f64, difference: Option<f64>) {
        let Some(difference) = difference else { return };
        self.rate_difference = self.rate_difference.min(difference);
        if difference <= AGREEING && chi < self.chi {
            self.chi = chi;
            self.nearest = at as u32;
        }
    }
}

/// How well a way to go fits what was met.
pub(super) fn fit(met: &[Meeting]) -> [f64; 2] {
    let again = met.iter().filter(|meeting| meeting.chi <= SAME).count();
    let distance: f64 = met.iter().map(|meeting| meeting.chi.min(FARTHEST)).sum();
    going::fit(again, met.len(), distance / met.len().max(1) as f64)
}
