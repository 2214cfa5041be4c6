//! What of a correction is proposed.

use super::evidence::Evidence;
use super::quantity::{QUANTITIES, Quantity, Values};
use super::search::{Deviations, Open, likeliest};

/// A correction is proposed when it is so many of the standard deviations that chance gives.
const SIGMAS: f64 = 3.0;
/// And so many of those that are told: what one recording in twenty shows that is right is no reason to change it.
const TOLD_SIGMAS: f64 = 2.0;

/// How well a quantity is known in its unit, with what more measurements would not take away.
pub(super) fn told(deviations: &Deviations, quantity: usize) -> f64 {
    let measured = deviations.chance[quantity].hypot(deviations.contradiction[quantity]).min(1.0);
    let Quantity { prior, systematic, .. } = QUANTITIES[quantity];
    (measured * prior).hypot(systematic)
}

/// Quantities that say nothing are left alone, the least telling one first; what goes together with them is sought
/// again without. What can't be judged here stays as it was found.
pub(super) fn proposed(
    evidence: &Evidence,
    likeliest_of_all: Values,
    deviations: &Deviations,
    mut open: Open,
) -> Values {
    let mut values = likeliest_of_all;
    while let Some(least) = idle(&values, deviations, open).or_else(|| hardly_missed(evidence, &values, open))
    {
        values = without(evidence, &values, open, least);
        open[least] = false;
    }
    values
}

/// The least telling quantity of those that are smaller than what is proposed.
fn idle(values: &Values, deviations: &Deviations, open: Open) -> Option<usize> {
    let in_sigmas = |i: &usize| values[*i].abs() / deviations.chance[*i];
    let is_idle = |i: &usize| {
        let least = QUANTITIES[*i].smallest.max(TOLD_SIGMAS * told(deviations, *i));
        in_sigmas(i) < SIGMAS || values[*i].abs() * QUANTITIES[*i].prior < least
    };
    let idle = (0..4).filter(|i| open[*i]).filter(is_idle);
    idle.min_by(|a, b| in_sigmas(a).total_cmp(&in_sigmas(b)))
}

/// The quantity without which values are least less likely, if that is less than so many standard deviations mean:
/// farther from its maximum a likelihood may fall off less than about it.
fn hardly_missed(evidence: &Evidence, values: &Values, open: Open) -> Option<usize> {
    let highest = evidence.posterior(values);
    let gain = |i: usize| highest - evidence.posterior(&without(evidence, values, open, i));
    let gains = (0..4).filter(|i| open[*i]).map(|i| (i, gain(i)));
    let hardly = gains.filter(|(_, gain)| *gain < SIGMAS * SIGMAS / 2.0);
    hardly.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
}

/// The likeliest values without a quantity.
fn without(evidence: &Evidence, values: &Values, mut open: Open, quantity: usize) -> Values {
    let mut start = *values;
    (start[quantity], open[quantity]) = (0.0, false);
    likeliest(evidence, &start, open)
}
