//! The metrics of one confusion matrix (paper, equations 10 to 14).

use super::Confusion;
use serde::Serialize;

/// What a confusion matrix says, each value in `[0, 1]` (`mcc` in `[-1, 1]`) and `None` where it has no meaning.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Rates {
    /// Share of the detections that are labelled right; `None` without detections.
    pub accuracy: Option<f64>,
    /// Mean over the classes that the truth holds.
    pub precision: Option<f64>,
    /// Mean over the classes that the truth holds.
    pub recall: Option<f64>,
    /// F1 of plausible detections.
    pub f1_plausible: Option<f64>,
    /// F1 of artifacts.
    pub f1_artifact: Option<f64>,
    /// Intersection over union of plausible detections.
    pub iou_plausible: Option<f64>,
    /// Intersection over union of artifacts.
    pub iou_artifact: Option<f64>,
    /// Mean over the classes that the truth holds.
    pub mean_iou: Option<f64>,
    /// Share of what is labelled plausible that is so.
    pub precision_plausible: Option<f64>,
    /// Share of what is plausible that is labelled so.
    pub recall_plausible: Option<f64>,
    /// Matthews' correlation coefficient; `None` where truth or labels hold one class only.
    pub mcc: Option<f64>,
}

impl Rates {
    /// How many metrics there are.
    pub(super) const COUNT: usize = 11;

    /// The metrics of one confusion matrix.
    pub fn new(counts: &Confusion) -> Self {
        let (plausible, artifact) = (ClassRates::new(counts), ClassRates::new(&counts.swapped()));
        let mean = |rate: fn(&ClassRates) -> f64| {
            mean_of_present([plausible, artifact].map(|c| c.as_ref().map(rate)))
        };
        Self {
            accuracy: (counts.total() > 0).then(|| ratio(counts.tp + counts.tn, counts.total())),
            precision: mean(|class| class.precision),
            recall: mean(|class| class.recall),
            f1_plausible: plausible.map(|class| class.f1),
            f1_artifact: artifact.map(|class| class.f1),
            iou_plausible: plausible.map(|class| class.iou),
            iou_artifact: artifact.map(|class| class.iou),
            mean_iou: mean(|class| class.iou),
            precision_plausible: plausible.map(|class| class.precision),
            recall_plausible: plausible.map(|class| class.recall),
            mcc: matthews_correlation(counts),
        }
    }

    /// Each metric's mean over the scans that have it.
    pub fn mean(scans: impl IntoIterator<Item = Self>) -> Self {
        let mut sums = [(0.0, 0_u32); Self::COUNT];
        for scan in scans {
            for ((sum, scans), value) in sums.iter_mut().zip(scan.to_array()) {
                *sum += value.unwrap_or(0.0);
                *scans += u32::from(value.is_some());
            }
        }
        Self::from_array(sums.map(|(sum, scans)| (scans > 0).then(|| sum / f64::from(scans))))
    }

    /// In the order of the fields.
    fn to_array(self) -> [Option<f64>; Self::COUNT] {
        [
            self.accuracy,
            self.precision,
            self.recall,
            self.f1_plausible,
            self.f1_artifact,
            self.iou_plausible,
            self.iou_artifact,
            self.mean_iou,
            self.precision_plausible,
            self.recall_plausible,
            self.mcc,
        ]
    }

    fn from_array(values: [Option<f64>; Self::COUNT]) -> Self {
        let [accuracy, precision, recall, f1_plausible, f1_artifact, iou_plausible, iou_artifact, ..] =
            values;
        let [.., mean_iou, precision_plausible, recall_plausible, mcc] = values;
        Self {
            accuracy,
            precision,
            recall,
            f1_plausible,
            f1_artifact,
            iou_plausible,
            iou_artifact,
            mean_iou,
            precision_plausible,
            recall_plausible,
            mcc,
        }
    }
}

/// The metrics of one class.
#[derive(Debug, Clone, Copy)]
struct ClassRates {
    precision: f64,
    recall: f64,
    f1: f64,
    iou: f64,
}

impl ClassRates {
    /// The rates of the positive class; `None` where the truth holds none of it.
    fn new(counts: &Confusion) -> Option<Self> {
        let Confusion { tp, fp, r#fn: missed, .. } = *counts;
        (tp + missed > 0).then(|| Self {
            // A class that is never predicted has precision 0.
            precision: if tp == 0 { 0.0 } else { ratio(tp, tp + fp) },
            recall: ratio(tp, tp + missed),
            f1: ratio(2 * tp, 2 * tp + fp + missed),
            iou: ratio(tp, tp + fp + missed),
        })
    }
}

fn ratio(part: u64, whole: u64) -> f64 {
    part as f64 / whole as f64
}

fn mean_of_present(values: [Option<f64>; 2]) -> Option<f64> {
    match values {
        [Some(first), Some(second)] => Some((first + second) / 2.0),
        [first, second] => first.or(second),
    }
}

fn matthews_correlation(counts: &Confusion) -> Option<f64> {
    let [tp, fp, tn, missed] = [counts.tp, counts.fp, counts.tn, counts.r#fn].map(|count| count as f64);
    let margins = (tp + fp) * (tp + missed) * (tn + fp) * (tn + missed);
    // The quotient of a perfect labelling may round to a hair above 1.
    (margins > 0.0).then(|| ((tp * tn - fp * missed) / margins.sqrt()).clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn rates(tp: u64, fp: u64, tn: u64, missed: u64) -> Rates {
        Rates::new(&Confusion { tp, fp, tn, r#fn: missed })
    }

    #[track_caller]
    fn near(found: Option<f64>, expected: f64, tolerance: f64) {
        let found = found.unwrap();
        assert!((found - expected).abs() < tolerance, "expected {expected}, found {found}");
    }

    /// The paper's table 4 with `y = 1` read as artifact: docs/method.md, section 9, says what must come out.
    #[test]
    fn the_papers_confusion_matrix_gives_the_papers_figures() {
        let paper = rates(430_418, 157_076, 2_432_440, 268_869);
        near(paper.accuracy, 0.8705, 5e-5);
        near(paper.precision, 0.816, 1e-3);
        near(paper.recall, 0.777, 1e-3);
        near(paper.f1_plausible, 0.669, 5e-4);
        near(paper.iou_plausible, 0.503, 5e-4);
        // 2432440 / (2432440 + 268869 + 157076)
        near(paper.iou_artifact, 0.850_98, 5e-6);
    }

    /// By hand: 10 detections, 4 plausible of which 3 are found, 6 artifacts of which 4 are found.
    #[test]
    fn a_small_matrix_worked_out_by_hand() {
        let found = rates(3, 2, 4, 1);
        let third = 1.0 / 3.0;
        let golden = [
            0.7,                        // (3 + 4) / 10
            (0.6 + 0.8) / 2.0,          // 3/5, 4/5
            (0.75 + 2.0 * third) / 2.0, // 3/4, 4/6
            2.0 * third,                // 6/9
            8.0 / 11.0,                 // 8/(8 + 1 + 2)
            0.5,                        // 3/6
            4.0 / 7.0,                  // 4/7
            (0.5 + 4.0 / 7.0) / 2.0,
            0.6,
            0.75,
            10.0 / (600.0_f64).sqrt(), // (12 - 2) / sqrt(5 * 4 * 6 * 5)
        ];
        for (found, golden) in found.to_array().into_iter().zip(golden) {
            near(found, golden, 1e-15);
        }
    }

    #[test]
    fn a_class_that_the_truth_lacks_has_no_value() {
        let no_artifacts = rates(3, 0, 0, 1);
        assert_eq!(
            (no_artifacts.f1_artifact, no_artifacts.iou_artifact, no_artifacts.mcc),
            (None, None, None)
        );
        assert_eq!((no_artifacts.precision, no_artifacts.recall), (Some(1.0), Some(0.75)));
        assert_eq!((no_artifacts.mean_iou, no_artifacts.accuracy), (Some(0.75), Some(0.75)));

        // Predicted although the truth holds none: still no value.
        let no_plausible = rates(0, 1, 3, 0);
        assert_eq!((no_plausible.precision_plausible, no_plausible.recall_plausible), (None, None));
        assert_eq!((no_plausible.f1_plausible, no_plausible.iou_plausible), (None, None));
        assert_eq!((no_plausible.precision, no_plausible.recall), (Some(1.0), Some(0.75)));
    }

    #[test]
    fn a_class_that_is_never_predicted_has_precision_0() {
        let found = rates(0, 0, 3, 1);
        assert_eq!((found.precision_plausible, found.recall_plausible), (Some(0.0), Some(0.0)));
        assert_eq!((found.f1_plausible, found.iou_plausible), (Some(0.0), Some(0.0)));
        assert_eq!((found.precision, found.mcc), (Some(0.375), None));
    }

    #[test]
    fn nothing_counted_says_nothing() {
        assert_eq!(rates(0, 0, 0, 0), Rates::default());
        assert_eq!(Rates::mean([]), Rates::default());
    }

    #[test]
    fn a_mean_leaves_out_the_scans_without_a_value() {
        let mean = Rates::mean([rates(3, 0, 0, 1), rates(1, 1, 1, 1), rates(0, 0, 0, 0)]);
        assert_eq!(mean.accuracy, Some(0.625)); // (0.75 + 0.5) / 2
        assert_eq!(mean.recall_plausible, Some(0.625));
        assert_eq!(mean.f1_artifact, Some(0.5));
        assert_eq!(mean.mcc, Some(0.0));
    }

    fn counts() -> impl Strategy<Value = Confusion> {
        let count = || prop_oneof![Just(0), 1..20u64, 1..5_000_000u64];
        (count(), count(), count(), count()).prop_map(|(tp, fp, tn, missed)| Confusion {
            tp,
            fp,
            tn,
            r#fn: missed,
        })
    }

    proptest! {
        #[test]
        fn values_are_bounded(counts in counts()) {
            let rates = Rates::new(&counts);
            for value in rates.to_array().into_iter().flatten() {
                prop_assert!((-1.0..=1.0).contains(&value), "{value}");
            }
            for value in (Rates { mcc: None, ..rates }).to_array().into_iter().flatten() {
                prop_assert!(value >= 0.0, "{value}");
            }
        }

        #[test]
        fn swapping_the_classes_swaps_their_values(counts in counts()) {
            let (one, other) = (Rates::new(&counts), Rates::new(&counts.swapped()));
            prop_assert_eq!((one.f1_plausible, one.iou_plausible), (other.f1_artifact, other.iou_artifact));
            prop_assert_eq!((one.f1_artifact, one.iou_artifact), (other.f1_plausible, other.iou_plausible));
            let of_both = |r: Rates| (r.accuracy, r.precision, r.recall, r.mean_iou, r.mcc.is_some());
            prop_assert_eq!(of_both(one), of_both(other));
            if let (Some(one), Some(other)) = (one.mcc, other.mcc) {
                prop_assert!((one - other).abs() < 1e-12);
            }
        }

        /// The relation between a class's F1 and its IoU: `F1 = 2 IoU / (1 + IoU)`.
        #[test]
        fn f1_and_iou_tell_the_same(counts in counts()) {
            let rates = Rates::new(&counts);
            if let (Some(f1), Some(iou)) = (rates.f1_plausible, rates.iou_plausible) {
                prop_assert!((f1 - 2.0 * iou / (1.0 + iou)).abs() < 1e-12);
            }
        }

        #[test]
        fn labels_that_are_the_truth_are_perfect(tp in 1..5_000_000u64, tn in 1..5_000_000u64) {
            let rates = Rates::new(&Confusion { tp, tn, ..Confusion::default() });
            prop_assert!(rates.to_array().into_iter().all(|value| value.is_some_and(|v| (v - 1.0).abs() < 1e-15)));
        }

        #[test]
        fn the_array_keeps_the_order(counts in counts()) {
            let rates = Rates::new(&counts);
            prop_assert_eq!(Rates::from_array(rates.to_array()), rates);
        }
    }
}
