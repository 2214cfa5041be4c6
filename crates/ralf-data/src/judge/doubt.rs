//! Which detections a person should look at: those that the method itself is in doubt of.

use crate::error::DataError;
use crate::result::Table;
use ralf::config::{Config, Method};
use ralf::label::flag;

/// A plausibility this close to the threshold is uncertain.
pub const UNCERTAIN: f32 = 0.1;
/// Branches disagree where they lie on either side of the threshold and farther apart than this.
pub const DISAGREEING: f32 = 0.5;

/// A plausibility of the paper's method this far from the threshold leaves no doubt.
pub const SURE: f32 = 0.3;

/// How a run's plausibilities tell which of its labels are wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certainty {
    /// Plausibilities from here on are labelled plausible.
    pub threshold: f32,
    /// Whether a model answered, whose plausibilities are probabilities.
    pub calibrated: bool,
}

impl Certainty {
    /// That of a run with these settings.
    pub fn of(settings: &Config) -> Self {
        let calibrated = settings.method == Method::Learned;
        Self { threshold: settings.fusion.threshold as f32, calibrated }
    }

    /// How much a label is expected to be wrong, 0 to 1. Of a probability `p` that is `1 - p` where the label says
    /// plausible and `p` elsewhere (with a threshold of 1/2 the smaller of the two); of the paper's plausibility,
    /// which is none, `max(0, 1 - |w - w0| / SURE)`, and nothing of a floor detection, which is decided.
    pub fn expected_error(&self, w: f32, flags: u16) -> f32 {
        if self.is_probability(flags) {
            return if w >= self.threshold { 1.0 - w } else { w };
        }
        if self.is_decided(flags) {
            return 0.0;
        }
        (1.0 - (w - self.threshold).abs() / SURE).max(0.0)
    }

    /// Whether the label is an artifact's whatever `w` is: a floor detection's, where the paper's method answered. A
    /// model knows of the floor, and may believe what is on it.
    pub fn is_decided(&self, flags: u16) -> bool {
        flags & flag::GROUND != 0 && !self.is_probability(flags)
    }

    /// Whether no threshold calls it plausible: it is unobserved, or [decided](Self::is_decided).
    pub fn never_passes(&self, flags: u16) -> bool {
        flags & flag::UNOBSERVED != 0 || self.is_decided(flags)
    }

    /// Whether a plausibility `w` is within [`UNCERTAIN`] of the threshold, and the label not decided.
    pub fn is_uncertain(&self, w: f32, flags: u16) -> bool {
        !self.is_decided(flags) && (w - self.threshold).abs() <= UNCERTAIN
    }

    /// Whether a model answered for a detection with these flags.
    fn is_probability(&self, flags: u16) -> bool {
        self.calibrated && flags & flag::PAPER == 0
    }
}

/// The branches that may disagree.
const BRANCHES: [&str; 3] = ["w_lm", "w_cm", "w_tr"];

/// The doubtful detections of a scan. What is decided ([`Certainty::is_decided`]) counts for neither.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Doubts {
    /// How many detections it has.
    pub detections: usize,
    /// Those whose plausibility is within [`UNCERTAIN`] of the threshold.
    pub uncertain: usize,
    /// Those of whose branches, as far as observed, one says plausible and another, lower by more than [`DISAGREEING`],
    /// doesn't.
    pub disagreeing: usize,
    /// How many wrong labels are expected: the sum of [`Certainty::expected_error`].
    pub expected_errors: f64,
}

impl Doubts {
    /// The columns that are needed.
    pub const COLUMNS: [&str; 5] = ["w", "w_lm", "w_cm", "w_tr", "flags"];

    /// Counts the doubtful detections of a scan.
    ///
    /// # Errors
    /// A table that lacks one of [`Self::COLUMNS`].
    pub fn of(table: &Table, certainty: &Certainty) -> Result<Self, DataError> {
        let (score, flags) = (table.get::<f32>("w")?, table.get::<u16>("flags")?);
        let mut branches: [&[f32]; 3] = [&[]; 3];
        for (branch, name) in branches.iter_mut().zip(BRANCHES) {
            *branch = table.get(name)?;
        }
        let mut doubts = Self { detections: table.len(), ..Self::default() };
        for (row, flags) in flags.iter().enumerate() {
            doubts.expected_errors += f64::from(certainty.expected_error(score[row], *flags));
            if certainty.is_decided(*flags) {
                continue;
            }
            let observed = branches.iter().map(|branch| branch[row]).filter(|w| !w.is_nan());
            doubts.uncertain += usize::from(certainty.is_uncertain(score[row], *flags));
            doubts.disagreeing += usize::from(disagree(observed, certainty.threshold));
        }
        Ok(doubts)
    }
}

/// Whether branches lie on either side of the threshold, far apart.
fn disagree(observed: impl Iterator<Item = f32>, threshold: f32) -> bool {
    let (mut lowest, mut highest) = (f32::INFINITY, f32::NEG_INFINITY);
    for w in observed {
        (lowest, highest) = (lowest.min(w), highest.max(w));
    }
    highest >= threshold && lowest < threshold && highest - lowest > DISAGREEING
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::result::{Schema, Values};
    use ralf::sensors::Rig;

    #[test]
    fn doubts_are_counted_by_hand_and_floor_detections_are_decided() {
        let schema = Schema::of(&Rig::default(), &[]).unwrap().only(&Doubts::COLUMNS).unwrap();
        let table = |flags: [u16; 5]| {
            let decimals: [[f32; 5]; 4] = [
                [0.55, 0.61, 0.5, 0.4, 0.25],
                [0.9, 0.9, f32::NAN, 0.4, 0.5],
                [f32::NAN, 0.8, f32::NAN, 0.3, f32::NAN],
                [0.3, 0.2, f32::NAN, 0.45, 0.0],
            ];
            let mut values: Vec<Values> = decimals.map(|column| Values::F32(column.to_vec())).to_vec();
            values.push(Values::U16(flags.to_vec()));
            Table::new(schema.clone(), values).unwrap()
        };
        // Uncertain: 0.55, 0.5, 0.4. Disagreeing: the first two; 0.5 apart is not more than 0.5.
        let certainty = Certainty { threshold: 0.5, calibrated: false };
        let counted = |flags| {
            let found = Doubts::of(&table(flags), &certainty).unwrap();
            (found.detections, found.uncertain, found.disagreeing, found.expected_errors)
        };
        let (detections, uncertain, disagreeing, errors) = counted([0; 5]);
        assert_eq!((detections, uncertain, disagreeing), (5, 3, 2));
        // 1 less 0.05, 0.11, 0, 0.1 and 0.25 of 0.3.
        assert!((errors - (5.0 - 0.51 / 0.3)).abs() < 1e-5, "{errors}");
        // A floor detection is decided: the first no longer disagrees, the third is no longer uncertain.
        let (_, uncertain, disagreeing, errors) =
            counted([flag::GROUND, 0, flag::GROUND | flag::BLIND_SPOT, 2, 0]);
        assert_eq!((uncertain, disagreeing), (1, 1));
        assert!((errors - (3.0 - 0.46 / 0.3)).abs() < 1e-5, "{errors}");
        let lacking = Schema::of(&Rig::default(), &[]).unwrap().only(&["w", "flags"]).unwrap();
        assert!(Doubts::of(&Table::empty(lacking), &certainty).is_err());
    }

    #[test]
    fn a_probability_says_itself_how_likely_the_label_is_wrong_unless_the_paper_answered() {
        let certainty = Certainty { threshold: 0.5, calibrated: true };
        let found = [(0.9, 0), (0.5, 0), (0.2, flag::GROUND), (0.2, flag::PAPER), (0.8, flag::PAPER)]
            .map(|(w, flags)| certainty.expected_error(w, flags));
        for (found, expected) in found.into_iter().zip([0.1, 0.5, 0.2, 0.0, 0.0]) {
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
        let sure = [flag::GROUND, flag::GROUND | flag::PAPER, flag::PAPER].map(|of| certainty.is_decided(of));
        assert_eq!(sure, [false, true, false]);
        assert!(certainty.is_uncertain(0.55, flag::GROUND) && !certainty.is_uncertain(0.65, 0));
        // At another threshold the label may be the less likely one.
        let certainty = Certainty { threshold: 0.4, calibrated: true };
        assert!((certainty.expected_error(0.45, 0) - 0.55).abs() < 1e-6);
    }
}
