//! What of a correction is proposed.

use super::evidence::Evidence;
use super::quantity::{QUANTITIES, Quantity, Values};
use super::search::{Deviations, Open, Place, likeliest, summit};

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
    likeliest_of_all: Place,
    deviations: &Deviations,
    mut open: Open,
) -> Place {
    let mut place = likeliest_of_all;
    loop {
        let (least, rest) = match idle(&place.values, deviations, open) {
            Some(least) => (least, without(evidence, &place, open, least)),
            None => match hardly_missed(evidence, &place, open) {
                Some(hardly) => hardly,
                None => return place,
            },
        };
        (place, open[least]) = (rest, false);
    }
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

/// The quantity without which values are least less likely, if that is less than so many standard deviations mean, and
/// those without it: farther from its maximum a likelihood may fall off less than about it.
fn hardly_missed(evidence: &Evidence, place: &Place, open: Open) -> Option<(usize, Place)> {
    let left = (0..4).filter(|i| open[*i]).map(|i| (i, without(evidence, place, open, i)));
    let hardly = left.filter(|(_, left)| place.posterior - left.posterior < SIGMAS * SIGMAS / 2.0);
    hardly.max_by(|a, b| a.1.posterior.total_cmp(&b.1.posterior))
}

/// The likeliest values without a quantity: near those with it where it is small, anywhere else where it isn't.
fn without(evidence: &Evidence, place: &Place, mut open: Open, quantity: usize) -> Place {
    let mut start = place.values;
    let is_small = start[quantity].abs() * QUANTITIES[quantity].prior < QUANTITIES[quantity].steps[0];
    (start[quantity], open[quantity]) = (0.0, false);
    match is_small {
        true => summit(evidence, Place::at(evidence, start), open),
        false => likeliest(evidence, &start, open),
    }
}
