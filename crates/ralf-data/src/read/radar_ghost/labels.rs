//! What is true of a detection, out of the data set's `label_id` (its page `label_convention.md`).
//!
//! Three numbers are special: 0 is everything that nobody looked at, -1 what nobody could label, -2 noise. All others
//! have four digits, CMTO: class, whether the detection belongs to the sequence's main object, where the wave came back
//! from last (T) and after how many bounces (O). A minus before them says that whoever labelled wasn't sure.

use crate::disk::label_file::Label;
use ralf::label::{ARTIFACT, Cause, UNLABELED};

/// What a `label_id` says: a SemanticKITTI id, and why the detection is an artifact.
///
/// Real is what came back directly (O = 1 with T = 1). An additional bounce or several of them (O = 2, 4, 6, or 0 for
/// "some") make a mirror image; noise is noise. Nothing is said of what may be real or not (O = 3), of groups of
/// people, of which nobody says where one ends, of what nobody was sure of, and of the background: much of it is real.
///
/// `None` for a number that the convention doesn't have.
pub(super) fn truth(label_id: i64, is_group: bool) -> Option<(u16, Cause)> {
    let unlabeled = (UNLABELED, Cause::Plausible);
    match label_id {
        0 | -1 => return Some(unlabeled),
        -2 => return Some((ARTIFACT, Cause::Noise)),
        _ => {}
    }
    let number = label_id.unsigned_abs();
    let digit = |place: u64| number / place % 10;
    let class = class_of(digit(1000)).filter(|_| number < 10_000)?;
    let (main, last, order) = (digit(100), digit(10), digit(1));
    if main > 1 || last > 3 || !matches!(order, 0..=4 | 6) {
        return None;
    }
    let is_unsure = label_id < 0 || is_group;
    Some(match (last, order) {
        _ if is_unsure => unlabeled,
        (1, 1) => (class, Cause::Plausible),
        (_, 0 | 2 | 4 | 6) => (ARTIFACT, Cause::Mirror),
        _ => unlabeled,
    })
}

/// SemanticKITTI's id of a class.
fn class_of(digit: u64) -> Option<u16> {
    const CLASSES: [u16; 5] = [30, 31, 10, 18, 32];
    CLASSES.get(usize::try_from(digit).ok()?.checked_sub(1)?).copied()
}

/// The label of a detection of this instance; what is no object belongs to none.
pub(super) fn label(id: u16, instance: u16) -> Label {
    Label { id, instance: if id == UNLABELED { 0 } else { instance } }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::label::class_name;

    /// The examples of the data set's page, and what the rest of it says.
    #[test]
    fn the_examples_of_the_convention() {
        let said = |label_id| {
            let (id, cause) = truth(label_id, false)?;
            Some((class_name(id)?, cause.name()))
        };
        let unlabeled = Some(("unlabeled", "none"));
        let mirror = Some(("outlier", "mirror"));
        for (label_id, expected) in [
            (0, unlabeled),
            (-1, unlabeled),
            (-2, Some(("outlier", "noise"))),
            (1111, Some(("person", "none"))),
            (1011, Some(("person", "none"))),
            (2111, Some(("bicyclist", "none"))),
            (3011, Some(("car", "none"))),
            (4011, Some(("truck", "none"))),
            (5011, Some(("motorcyclist", "none"))),
            (1112, mirror),
            (1124, mirror),
            (2100, mirror),
            (2126, mirror),
            (2132, mirror),
            (2000, mirror),
            (1113, unlabeled),
            (1121, unlabeled),
            (-1112, unlabeled),
            (-3011, unlabeled),
        ] {
            assert_eq!(said(label_id), expected, "{label_id}");
        }
        assert_eq!(truth(1111, true), truth(0, false));
        for unknown in
            [-3, 1, 11, 999, 6111, 1211, 1141, 1115, 1117, 11_111, i64::MAX, i64::MIN + 1, i64::MIN]
        {
            assert_eq!(truth(unknown, false), None, "{unknown}");
        }
    }
}
