//! The best question to ask of some rows.

use super::Parameters;
use super::bins::ABSENT;
use super::histogram::{Histogram, Sum};

/// Fewest second derivatives of a leaf.
const LEAST_HESSIAN: f64 = 1e-3;
/// A gain that is worth a question.
const LEAST_GAIN: f64 = 1e-9;

/// Between which answers a leaf must stay, so that monotone questions above it stay monotone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Bounds {
    pub(super) const NONE: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
}

/// A question, by bins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Question {
    pub(super) feature: usize,
    /// Bins up to this one get a yes.
    pub(super) bin: u8,
    pub(super) absent_is_yes: bool,
    pub(super) gain: f64,
    /// Of the rows that get a yes.
    pub(super) yes: Sum,
    /// Of those that don't.
    pub(super) no: Sum,
    pub(super) bounds_yes: Bounds,
    pub(super) bounds_no: Bounds,
}

impl Question {
    /// Whether a bin gets a yes.
    pub(super) fn is_yes(&self, code: u8) -> bool {
        if code == ABSENT { self.absent_is_yes } else { code <= self.bin }
    }
}

/// What a leaf answers to rows of this sum.
pub(super) fn answer(sum: &Sum, bounds: &Bounds, l2: f64) -> f64 {
    (-sum.gradient / (sum.hessian + l2)).clamp(bounds.low, bounds.high)
}

/// How much an answer lowers the loss, twice.
fn drop_in_loss(sum: &Sum, answer: f64, l2: f64) -> f64 {
    -(2.0 * sum.gradient * answer + (sum.hessian + l2) * answer * answer)
}

/// What is asked about: the rows of a leaf.
pub(super) struct Asked<'a> {
    pub(super) parameters: &'a Parameters,
    pub(super) histogram: &'a Histogram,
    /// The features that may be asked for, in the histogram's order.
    pub(super) features: &'a [usize],
    /// Bins that hold values, by feature.
    pub(super) bins: &'a dyn Fn(usize) -> usize,
    pub(super) monotone: &'a [i8],
    pub(super) sum: Sum,
    pub(super) bounds: Bounds,
}

impl Asked<'_> {
    /// The question that lowers the loss most; the first of several. `None` where none is worth it.
    pub(super) fn best(&self) -> Option<Question> {
        let mut best: Option<Question> = None;
        for (place, feature) in self.features.iter().copied().enumerate() {
            let sums = self.histogram.of_feature(place);
            let absent = sums[usize::from(ABSENT)];
            let mut values = Sum::default();
            let last = (self.bins)(feature) - 1;
            for (bin, sum) in sums.iter().enumerate().take(last) {
                values = values.plus(*sum);
                // Where nothing is absent, absence follows the larger part.
                let larger = values.rows * 2 >= self.sum.rows;
                let ways: &[bool] = if absent.rows > 0 { &[true, false] } else { &[larger] };
                for absent_is_yes in ways.iter().copied() {
                    let yes = if absent_is_yes { values.plus(absent) } else { values };
                    let found = self.question(feature, yes);
                    if let Some(found) = found.filter(|found| best.is_none_or(|best| found.gain > best.gain))
                    {
                        best = Some(Question { bin: bin as u8, absent_is_yes, ..found });
                    }
                }
            }
        }
        best
    }

    /// A question to a feature whose yes gets this sum; `None` where it isn't allowed or worth it.
    fn question(&self, feature: usize, yes: Sum) -> Option<Question> {
        let Parameters { l2, rows_per_leaf, .. } = *self.parameters;
        let no = self.sum.minus(yes);
        let small = |sum: &Sum| sum.rows < rows_per_leaf || sum.hessian < LEAST_HESSIAN;
        if small(&yes) || small(&no) {
            return None;
        }
        let (answer_yes, answer_no) = (answer(&yes, &self.bounds, l2), answer(&no, &self.bounds, l2));
        let (mut bounds_yes, mut bounds_no) = (self.bounds, self.bounds);
        let middle = (answer_yes + answer_no) / 2.0;
        match self.monotone[feature] {
            1 if answer_yes > answer_no => return None,
            -1 if answer_yes < answer_no => return None,
            1 => (bounds_yes.high, bounds_no.low) = (middle, middle),
            -1 => (bounds_yes.low, bounds_no.high) = (middle, middle),
            _ => {}
        }
        let whole = drop_in_loss(&self.sum, answer(&self.sum, &self.bounds, l2), l2);
        let gain = drop_in_loss(&yes, answer_yes, l2) + drop_in_loss(&no, answer_no, l2) - whole;
        (gain > LEAST_GAIN).then_some(Question {
            feature,
            bin: 0,
            absent_is_yes: false,
            gain,
            yes,
            no,
            bounds_yes,
            bounds_no,
        })
    }
}
