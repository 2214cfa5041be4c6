//! The likeliest values, and how well they are known.
//!
//! Quantities go together: a clock that is late and a place farther back put detections at the same places as long as
//! the speed is the same. So after each quantity for itself the search follows the axes of the likelihood's own bend,
//! and the standard deviations are those of all quantities together.

use super::evidence::{Evidence, KINDS, Parts, STRETCHES};
use super::quantity::{QUANTITIES, Values};
use nalgebra::{Matrix4, SymmetricEigen};

/// Rounds over the axes of the bend: so many, or until one brings hardly anything.
const ROUNDS: usize = 4;
/// Of a logarithm of likelihood: a tenth of a standard deviation.
const HARDLY: f64 = 0.005;
/// Of its prior standard deviation, a quantity is looked for within so much.
const WIDEST: f64 = 2.0;
/// Differences are taken over so much of each quantity: degrees, m, ms. Less is lost in the steps of the LiDAR's grid.
const REACH: [f64; 4] = [0.5, 0.08, 0.08, 20.0];
/// Along an axis of the bend a search ends at this part of a standard deviation.
const FINEST: f64 = 0.2;

/// Which quantities may be changed; the others stay as they are.
pub(super) type Open = [bool; 4];

/// Values, and how likely they are.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) values: Values,
    pub(super) posterior: f64,
}

impl Place {
    pub(super) fn at(evidence: &Evidence, values: Values) -> Self {
        Self { values, posterior: evidence.posterior(&values) }
    }
}

/// The likeliest values, wherever they are.
pub(super) fn likeliest(evidence: &Evidence, start: &Values, open: Open) -> Place {
    let mut best = *start;
    for (i, quantity) in QUANTITIES.iter().enumerate().filter(|(i, _)| open[*i]) {
        best = anywhere(evidence, best, i, quantity.steps[0] / quantity.prior);
    }
    summit(evidence, Place::at(evidence, best), open)
}

/// Up from a place, along each quantity for itself and then along the axes of the bend.
pub(super) fn summit(evidence: &Evidence, mut place: Place, open: Open) -> Place {
    for _ in 0..ROUNDS {
        let before = place.posterior;
        for (i, quantity) in QUANTITIES.iter().enumerate().filter(|(i, _)| open[*i]) {
            let mut axis = Values::zeros();
            axis[i] = 1.0 / quantity.prior;
            place = along(evidence, place, &axis, quantity.steps);
        }
        place = Bend::at(evidence, &place, open).uphill(evidence, place);
        if place.posterior - before < HARDLY {
            break;
        }
    }
    place
}

/// The best value of one quantity within [`WIDEST`], in steps: rows of things stand one behind the other, and the wrong
/// one may be nearer. What tells the rows apart counts here, though it may be off.
fn anywhere(evidence: &Evidence, start: Values, quantity: usize, step: f64) -> Values {
    let steps = (WIDEST / step).ceil() as i32;
    let mut tried = vec![start];
    tried.extend((-steps..=steps).map(|i| {
        let mut values = start;
        values[quantity] = f64::from(i) * step;
        values
    }));
    let scored = tried.into_iter().map(|values| (evidence.rough_posterior(&values), values));
    scored.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(start, |(_, values)| values)
}

/// The best along a direction: in steps of which each is a quarter of the one before, from the first to the last, and
/// where both sides are lower at the vertex of the parabola through the three.
fn along(evidence: &Evidence, start: Place, direction: &Values, [first, last]: [f64; 2]) -> Place {
    let (mut best, mut step) = (start, first);
    while step >= last {
        let at = |side: f64| Place::at(evidence, best.values + direction * side);
        let higher = |tried: &Place| tried.posterior > best.posterior;
        let behind = at(-step);
        let ahead = if higher(&behind) { behind } else { at(step) };
        if higher(&ahead) {
            best = ahead;
            continue;
        }
        let bend = 2.0 * best.posterior - behind.posterior - ahead.posterior;
        let vertex = at(step / 2.0 * (ahead.posterior - behind.posterior) / bend);
        if higher(&vertex) {
            best = vertex;
        }
        step /= 4.0;
    }
    best
}

/// How the posterior falls off about its maximum, as independent axes.
pub(super) struct Bend {
    open: Open,
    /// Unit vectors, as columns.
    axes: Matrix4<f64>,
    /// Along each; 0 along quantities that aren't open. Never more than before anything was measured.
    variances: Values,
}

impl Bend {
    pub(super) fn at(evidence: &Evidence, place: &Place, open: Open) -> Self {
        let mut precision = Matrix4::identity();
        for i in (0..4).filter(|i| open[*i]) {
            for j in (0..=i).filter(|j| open[*j]) {
                let corner =
                    |a: f64, b: f64| evidence.posterior(&(place.values + reach(i) * a + reach(j) * b));
                let aside =
                    if i == j { 2.0 * place.posterior } else { corner(1.0, -1.0) + corner(-1.0, 1.0) };
                let mixed = corner(1.0, 1.0) + corner(-1.0, -1.0) - aside;
                precision[(i, j)] = -mixed / (4.0 * reach(i)[i] * reach(j)[j]);
                precision[(j, i)] = precision[(i, j)];
            }
        }
        let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(precision);
        let is_open = |axis: usize| (0..4).any(|i| open[i] && eigenvectors[(i, axis)].abs() > 1e-9);
        let variances = Values::from_fn(|i, _| if is_open(i) { 1.0 / eigenvalues[i].max(1.0) } else { 0.0 });
        Self { open, axes: eigenvectors, variances }
    }

    /// Up from a place along the axes.
    pub(super) fn uphill(&self, evidence: &Evidence, mut best: Place) -> Place {
        for (axis, variance) in self.axes.column_iter().zip(self.variances.iter()).filter(|(_, v)| **v > 0.0)
        {
            // Exactly 0 where nothing may change: an eigenvector is so but for rounding.
            let deviation =
                Values::from_fn(|i, _| if self.open[i] { axis[i] * variance.sqrt() } else { 0.0 });
            best = along(evidence, best, &deviation, [1.0, FINEST]);
        }
        best
    }

    fn covariance(&self) -> Matrix4<f64> {
        self.axes * Matrix4::from_diagonal(&self.variances) * self.axes.transpose()
    }
}

/// A step of one quantity.
fn reach(quantity: usize) -> Values {
    let mut step = Values::zeros();
    step[quantity] = REACH[quantity] / QUANTITIES[quantity].prior;
    step
}

/// How well values are known, in standard deviations; of what isn't open, those before anything was measured.
pub(super) struct Deviations {
    /// By chance: what measurements of the same kind scatter by.
    pub(super) chance: Values,
    /// By kinds of evidence, and drives, that contradict each other: more of the same takes nothing from it.
    pub(super) contradiction: Values,
}

/// Standard deviations of values that are the likeliest: from how the likelihood falls off about them, which knows
/// what goes together, and from how much parts of the evidence disagree (the sandwich of White, *Econometrica* 50,
/// 1982), which knows what the model doesn't: stretches of time, kinds, and drives, each of which has walls of its own.
pub(super) fn deviations(evidence: &Evidence, place: &Place, open: Open, by_behind: &Values) -> Deviations {
    let covariance = Bend::at(evidence, place, open).covariance();
    let slopes = slopes(evidence, &place.values, open);
    let [stretches, kinds, drives] =
        draws(&slopes, &evidence.observed()).map(|slopes| covariance * disagreement(&slopes) * covariance);
    let of = |variances: Matrix4<f64>| {
        Values::from_fn(|i, _| if open[i] { variances[(i, i)].max(0.0).sqrt().min(1.0) } else { 1.0 })
    };
    Deviations {
        chance: of(covariance + stretches + by_behind * by_behind.transpose()),
        contradiction: of(kinds + drives),
    }
}

/// What stretches of time, kinds of evidence, and drives pull at, of those that hold any: what nothing was measured of
/// pulls nowhere because it says nothing, and not because it agrees.
fn draws(slopes: &Parts<Values>, observed: &Parts<bool>) -> [Vec<Values>; 3] {
    let of_stretch = |stretch: usize| (0..KINDS).map(move |kind| (stretch, kind));
    let stretches = slopes.len();
    let of_kind = |kind: usize| (0..stretches).map(move |stretch| (stretch, kind));
    let of_drive = |drive: usize| (drive * STRETCHES..(drive + 1) * STRETCHES).flat_map(of_stretch);
    let is_observed = |(stretch, kind): &(usize, usize)| observed[*stretch][*kind];
    let sum = |parts: Vec<(usize, usize)>| {
        let found = parts.into_iter().filter(is_observed).map(|(stretch, kind)| slopes[stretch][kind]);
        found.reduce(|sum, slope| sum + slope)
    };
    [
        (0..stretches).filter_map(|stretch| sum(of_stretch(stretch).collect())).collect(),
        (0..KINDS).filter_map(|kind| sum(of_kind(kind).collect())).collect(),
        (0..stretches / STRETCHES).filter_map(|drive| sum(of_drive(drive).collect())).collect(),
    ]
}

/// How far parts of the evidence pull apart: the covariance of a sum of as many that are drawn as these were. A single
/// one contradicts nothing.
fn disagreement(slopes: &[Values]) -> Matrix4<f64> {
    if slopes.len() < 2 {
        return Matrix4::zeros();
    }
    let count = slopes.len() as f64;
    let mean = slopes.iter().sum::<Values>() / count;
    let about_mean = slopes.iter().map(|slope| (slope - mean) * (slope - mean).transpose());
    about_mean.sum::<Matrix4<f64>>() * (count / (count - 1.0))
}

/// How each part of the evidence would have the values changed.
fn slopes(evidence: &Evidence, values: &Values, open: Open) -> Parts<Values> {
    let mut slopes = vec![[Values::zeros(); KINDS]; evidence.stretches()];
    for i in (0..4).filter(|i| open[*i]) {
        let [behind, ahead] = [-1.0, 1.0].map(|side| evidence.likelihoods(&(values + reach(i) * side)));
        let ends = behind.iter().flatten().zip(ahead.iter().flatten());
        for (slope, (behind, ahead)) in slopes.iter_mut().flatten().zip(ends) {
            slope[i] = (ahead - behind) / (2.0 * reach(i)[i]);
        }
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Kinds that pull by these slopes at the first quantity in every other stretch of time; nothing else is observed.
    fn pulling(slopes: &[f64]) -> [Vec<Values>; 3] {
        let mut parts = vec![[Values::zeros(); KINDS]; STRETCHES];
        let mut observed = vec![[false; KINDS]; STRETCHES];
        for stretch in (0..STRETCHES).step_by(2) {
            for (kind, slope) in slopes.iter().enumerate() {
                parts[stretch][kind][0] = *slope;
                observed[stretch][kind] = true;
            }
        }
        draws(&parts, &observed)
    }

    #[test]
    fn what_nothing_was_measured_of_is_no_draw() {
        let half = (STRETCHES / 2) as f64;
        let [stretches, kinds, drives] = pulling(&[3.0, -1.0]);
        assert_eq!((stretches.len(), kinds.len()), (STRETCHES / 2, 2));
        assert_eq!(disagreement(&stretches), Matrix4::zeros(), "all stretches pull alike");
        assert_eq!((drives.len(), disagreement(&drives)), (1, Matrix4::zeros()), "a drive alone");
        // Two draws of 3 and -1, each of so many stretches: twice the sum of squares about their mean.
        assert_eq!(disagreement(&kinds)[(0, 0)], 2.0 * 2.0 * (2.0 * half).powi(2));
    }

    #[test]
    fn drives_that_pull_apart_are_as_many_draws() {
        let mut parts = vec![[Values::zeros(); KINDS]; 2 * STRETCHES];
        parts[..STRETCHES].iter_mut().for_each(|kinds| kinds[1][0] = 1.0);
        parts[STRETCHES..].iter_mut().for_each(|kinds| kinds[1][0] = -2.0);
        let [_, _, drives] = draws(&parts, &vec![[true; KINDS]; 2 * STRETCHES]);
        let [one, other] = [STRETCHES as f64, -2.0 * STRETCHES as f64];
        assert_eq!(drives.iter().map(|slopes| slopes[0]).collect::<Vec<_>>(), [one, other]);
        assert_eq!(disagreement(&drives)[(0, 0)], (one - other).powi(2));
    }

    #[test]
    fn one_kind_alone_contradicts_nothing() {
        let [_, kinds, _] = pulling(&[3.0]);
        assert_eq!((kinds.len(), disagreement(&kinds)), (1, Matrix4::zeros()));
        assert_eq!(disagreement(&[]), Matrix4::zeros());
    }

    #[test]
    fn a_kind_that_was_observed_and_pulls_nowhere_is_a_draw() {
        let half = (STRETCHES / 2) as f64;
        let [_, kinds, _] = pulling(&[3.0, 0.0, -3.0]);
        assert_eq!(disagreement(&kinds)[(0, 0)], 1.5 * 2.0 * (3.0 * half).powi(2));
    }
}
