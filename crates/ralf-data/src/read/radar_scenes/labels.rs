//! What is true of a detection, out of `label_id`.
//!
//! RadarScenes' authors labelled what moves by itself: eleven classes, and `STATIC` for all the rest, which holds
//! walls, road, mirror images and noise alike. The programs of clutter-ds overwrite these labels with three: `CLUTTER`
//! is what moves and belongs to no object, `MOVING_OBJECT` is what does, and `STATIONARY` holds the road, which is an
//! artifact here. So nothing is said of `STATIC` and `STATIONARY`.

use ralf::label::{ARTIFACT, PLAUSIBLE, UNLABELED};

/// Whose labels a sequence has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Convention {
    /// RadarScenes' own: 0 to 11.
    Authors,
    /// Those of clutter-ds: 0 to 2.
    ClutterDs,
}

impl Convention {
    /// The one that all of a sequence's labels are of. Every sequence of the authors has detections that stand still,
    /// which are 11 and nothing else.
    pub(super) fn of(label_ids: &[i64]) -> Self {
        let is_clutter = !label_ids.is_empty() && label_ids.iter().all(|id| (0..=2).contains(id));
        if is_clutter { Self::ClutterDs } else { Self::Authors }
    }

    /// A SemanticKITTI id for a `label_id`; `None` for a number that the convention doesn't have.
    pub(super) fn class(self, label_id: i64) -> Option<u16> {
        /// Cars, large vehicles, trucks, buses, trains, bicycles, motorcycles, pedestrians, groups of them, animals,
        /// others, all moving; what stands.
        const AUTHORS: [u16; 12] =
            [252, 259, 258, 257, 256, 253, 255, 254, 254, PLAUSIBLE, PLAUSIBLE, UNLABELED];
        const CLUTTER_DS: [u16; 3] = [ARTIFACT, PLAUSIBLE, UNLABELED];
        let classes = match self {
            Self::Authors => &AUTHORS[..],
            Self::ClutterDs => &CLUTTER_DS,
        };
        classes.get(usize::try_from(label_id).ok()?).copied()
    }

    /// What labels are called that this convention has, for people.
    pub(super) fn expected(self) -> &'static str {
        match self {
            Self::Authors => "a class from 0 to 11",
            Self::ClutterDs => "a label from 0 to 2",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::label::class_name;

    #[test]
    fn movers_are_plausible_and_nothing_is_said_of_what_stands() {
        let name = |id| Convention::Authors.class(id).and_then(class_name);
        let names: Vec<_> = (0..12).map(|id| name(id).unwrap()).collect();
        let expected = [
            "moving-car",
            "moving-other-vehicle",
            "moving-truck",
            "moving-bus",
            "moving-on-rails",
            "moving-bicyclist",
            "moving-motorcyclist",
            "moving-person",
            "moving-person",
            "other-object",
            "other-object",
            "unlabeled",
        ];
        assert_eq!(names, expected);
        assert_eq!((name(12), name(-1)), (None, None));
        let clutter = [0, 1, 2, 3].map(|id| Convention::ClutterDs.class(id));
        assert_eq!(clutter, [Some(ARTIFACT), Some(PLAUSIBLE), Some(UNLABELED), None]);
    }

    #[test]
    fn the_labels_tell_whose_they_are() {
        assert_eq!(Convention::of(&[0, 2, 11, 7]), Convention::Authors);
        assert_eq!(Convention::of(&[2, 2, 0, 1]), Convention::ClutterDs);
        assert_eq!(Convention::of(&[]), Convention::Authors);
    }
}
