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

use ralf::label::flag;
use ralf_data::result::{Columns, ScanTable};

/// A plausibility this close to the threshold is uncertain.
pub const UNCERTAIN: f32 = 0.1;
/// Branches disagree where they lie on either side of the threshold and farther apart than this.
pub const DISAGREEING: f32 = 0.5;
/// What a failed camera counts beside doubtful detections.
pub const CAMERA_WEIGHT: f64 = 0.25;

/// The branches that may disagree.
const BRANCHES: [&str; 3] = ["w_lm", "w_cm", "w_tr"];

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

/// The doubtful detections of a scan.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Doubts {
    /// How many detections it has.
    pub detections: usize,
    /// Those whose plausibility is near the threshold.
    pub uncertain: usize,
    /// Those whose branches disagree.
    pub disagreeing: usize,
}

impl Doubts {
    pub(crate) fn of(columns: &Columns, table: &ScanTable, threshold: f32) -> Self {
        let column = |name: &str| {
            let at = columns.names().position(|known| known == name);
            at.map_or(&[][..], |at| table.decimals[at].as_slice())
        };
        let (score, branches) = (column("w"), BRANCHES.map(column));
        let mut doubts = Self { detections: table.len(), ..Self::default() };
        for (row, flags) in table.flags.iter().enumerate() {
            if flags & flag::GROUND != 0 {
                continue;
            }
            let observed =
                branches.iter().filter_map(|branch| branch.get(row).copied()).filter(|w| !w.is_nan());
            doubts.uncertain +=
                usize::from(score.get(row).is_some_and(|w| (w - threshold).abs() <= UNCERTAIN));
            doubts.disagreeing += usize::from(disagree(observed, threshold));
        }
        doubts
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
    use ralf::sensors::Rig;

    #[test]
    fn doubts_are_counted_by_hand_and_floor_detections_are_decided() {
        let columns = Columns::of(&Rig::default()).unwrap();
        // d_lm d_cm d_tr w_lm w_cm w_tr w_opt w of five detections.
        let rows: [[f32; 5]; 4] = [
            [0.9, 0.9, f32::NAN, 0.4, 0.5],
            [f32::NAN, 0.8, f32::NAN, 0.3, f32::NAN],
            [0.3, 0.2, f32::NAN, 0.45, 0.0],
            [0.55, 0.61, 0.5, 0.4, 0.25],
        ];
        let mut decimals = vec![vec![f32::NAN; 5]; columns.count()];
        for (name, values) in ["w_lm", "w_cm", "w_tr", "w"].into_iter().zip(rows) {
            let at = columns.names().position(|known| known == name).unwrap();
            decimals[at] = values.to_vec();
        }
        let table = ScanTable { decimals, label: vec![1; 5], flags: vec![0; 5], ..ScanTable::default() };
        // Uncertain: 0.55, 0.5, 0.4. Disagreeing: the first two; 0.5 apart is not more than 0.5.
        let found = Doubts::of(&columns, &table, 0.5);
        assert_eq!(found, Doubts { detections: 5, uncertain: 3, disagreeing: 2 });
        // A floor detection is decided: the first no longer disagrees, the third is no longer uncertain.
        let floor =
            ScanTable { flags: vec![flag::GROUND, 0, flag::GROUND | flag::BLIND_SPOT, 2, 0], ..table };
        let found = Doubts::of(&columns, &floor, 0.5);
        assert_eq!(found, Doubts { detections: 5, uncertain: 1, disagreeing: 1 });
    }

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
