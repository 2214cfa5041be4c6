//! Which detections a person should look at: those that the method itself is in doubt of.

use crate::error::DataError;
use crate::result::Table;
use ralf::label::flag;

/// A plausibility this close to the threshold is uncertain.
pub const UNCERTAIN: f32 = 0.1;
/// Branches disagree where they lie on either side of the threshold and farther apart than this.
pub const DISAGREEING: f32 = 0.5;

/// The branches that may disagree.
const BRANCHES: [&str; 3] = ["w_lm", "w_cm", "w_tr"];

/// The doubtful detections of a scan. A floor detection is decided, whatever its branches say, and counts for neither.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Doubts {
    /// How many detections it has.
    pub detections: usize,
    /// Those whose plausibility is within [`UNCERTAIN`] of the threshold.
    pub uncertain: usize,
    /// Those of whose branches, as far as observed, one says plausible and another, lower by more than [`DISAGREEING`],
    /// doesn't.
    pub disagreeing: usize,
}

impl Doubts {
    /// The columns that are needed.
    pub const COLUMNS: [&str; 5] = ["w", "w_lm", "w_cm", "w_tr", "flags"];

    /// Counts the doubtful detections of a scan; plausibilities from `threshold` on are labelled plausible.
    ///
    /// # Errors
    /// A table that lacks one of [`Self::COLUMNS`].
    pub fn of(table: &Table, threshold: f32) -> Result<Self, DataError> {
        let (score, flags) = (table.get::<f32>("w")?, table.get::<u16>("flags")?);
        let mut branches: [&[f32]; 3] = [&[]; 3];
        for (branch, name) in branches.iter_mut().zip(BRANCHES) {
            *branch = table.get(name)?;
        }
        let mut doubts = Self { detections: table.len(), ..Self::default() };
        for (row, flags) in flags.iter().enumerate() {
            if flags & flag::GROUND != 0 {
                continue;
            }
            let observed = branches.iter().map(|branch| branch[row]).filter(|w| !w.is_nan());
            doubts.uncertain += usize::from(is_uncertain(score[row], *flags, threshold));
            doubts.disagreeing += usize::from(disagree(observed, threshold));
        }
        Ok(doubts)
    }
}

/// Whether a plausibility `w` is within [`UNCERTAIN`] of the threshold. A floor detection is decided.
pub fn is_uncertain(w: f32, flags: u16, threshold: f32) -> bool {
    flags & flag::GROUND == 0 && (w - threshold).abs() <= UNCERTAIN
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
        let found = Doubts::of(&table([0; 5]), 0.5).unwrap();
        assert_eq!(found, Doubts { detections: 5, uncertain: 3, disagreeing: 2 });
        // A floor detection is decided: the first no longer disagrees, the third is no longer uncertain.
        let floor = table([flag::GROUND, 0, flag::GROUND | flag::BLIND_SPOT, 2, 0]);
        assert_eq!(Doubts::of(&floor, 0.5).unwrap(), Doubts { detections: 5, uncertain: 1, disagreeing: 1 });
        let lacking = Schema::of(&Rig::default(), &[]).unwrap().only(&["w", "flags"]).unwrap();
        assert!(Doubts::of(&Table::empty(lacking), 0.5).is_err());
    }
}
