//! How far behind the fronts of things radars hear them: bushes and rows of cars reflect within and between, too.
//!
//! A radar that looks at things on one side alone seems mounted so much nearer to them. But what all radars of a
//! vehicle do, whatever way they look, is no matter of mountings.

use super::evidence::Evidence;
use super::quantity::Values;
use super::search::{Bend, Open, Place};

/// Distances that are tried, m, so far apart and so many.
const FIRST: f64 = -0.1;
const STEP: f64 = 0.1;
const TRIED: usize = 6;
const LAST: f64 = FIRST + STEP * (TRIED - 1) as f64;
/// How far one expects it to be from 0 before anything is measured, m.
const PRIOR: f64 = 0.2;
/// Radars of a vehicle, which look at different things, differ by so much, m.
const APART: f64 = 0.05;

/// How far behind things radars hear them, m, and its standard deviation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Behind {
    pub(super) metres: f64,
    deviation: f64,
}

/// What a radar's correction would be, and how likely all is, by distance.
pub(super) struct Way {
    values: Vec<Values>,
    posteriors: Vec<f64>,
}

impl Way {
    /// From the likeliest values at no distance, along the axes that are independent there.
    pub(super) fn of(evidence: &mut Evidence, mut place: Place, open: Open) -> Self {
        let mut way = Self { values: Vec::new(), posteriors: Vec::new() };
        let bend = Bend::at(evidence, &place, open);
        for behind in (0..TRIED).map(|i| FIRST + i as f64 * STEP) {
            evidence.behind = behind;
            place = bend.uphill(evidence, Place::at(evidence, place.values));
            way.posteriors.push(place.posterior);
            way.values.push(place.values);
        }
        way
    }

    /// The correction if things are heard so far behind, m.
    pub(super) fn at(&self, behind: f64) -> Values {
        let place = (behind.clamp(FIRST, LAST) - FIRST) / STEP;
        let first = (place as usize).min(TRIED - 2);
        let [near, far] = [self.values[first], self.values[first + 1]];
        near + (far - near) * (place - first as f64)
    }

    /// How much the correction changes with one standard deviation of the distance.
    pub(super) fn by_deviation(&self, Behind { metres, deviation }: Behind) -> Values {
        let [less, more] = [metres - deviation, metres + deviation].map(|behind| behind.clamp(FIRST, LAST));
        (self.at(more) - self.at(less)) * (deviation / (more - less))
    }
}

impl Behind {
    /// One distance for all radars of a vehicle.
    pub(super) fn of(ways: &[&Way]) -> Self {
        let (metres, deviation) = peak(|i| ways.iter().map(|way| way.posteriors[i]).sum());
        Self { metres, deviation: deviation.hypot(APART) }
    }
}

/// The likeliest distance and its standard deviation, by the logarithm of how likely each is that was tried: as a
/// parabola falls off, through the likeliest and those beside it.
fn peak(log: impl Fn(usize) -> f64) -> (f64, f64) {
    let at = |i: usize| FIRST + i as f64 * STEP;
    let logs: Vec<f64> = (0..TRIED).map(|i| log(i) - (at(i) / PRIOR).powi(2) / 2.0).collect();
    let best = (0..TRIED).max_by(|a, b| logs[*a].total_cmp(&logs[*b])).unwrap_or(1);
    let middle = best.clamp(1, TRIED - 2);
    let [before, highest, after] = [logs[middle - 1], logs[middle], logs[middle + 1]];
    let bend = 2.0 * highest - before - after;
    // Less than what was expected falls off: likelihoods that have no maximum here.
    if bend * PRIOR * PRIOR < 0.99 * STEP * STEP {
        return (at(best), PRIOR);
    }
    let ahead = (after - before) / (2.0 * bend);
    (at(middle) + STEP * ahead.clamp(-1.0, 1.0), STEP / bend.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_measured_sharply_counts_and_what_is_not_is_near_nothing() {
        let at = |i: usize| FIRST + i as f64 * STEP;
        let measured = |place: f64, sigma: f64| peak(|i| -((at(i) - place) / sigma).powi(2) / 2.0);
        let (behind, deviation) = measured(0.17, 0.03);
        // Of two that are known to 0.03 and 0.2: their weighted mean.
        let weight = 0.2_f64.powi(2) / (0.2_f64.powi(2) + 0.03_f64.powi(2));
        assert!((behind - 0.17 * weight).abs() < 1e-9 && (deviation - 0.03 * weight.sqrt()).abs() < 1e-9);
        let (behind, deviation) = peak(|_| 5.0);
        assert!(behind.abs() < 1e-9 && (deviation - PRIOR).abs() < 1e-9, "{behind} {deviation}");
        assert_eq!(peak(|i| 20.0 * at(i).powi(2)), (LAST, PRIOR), "what grows ever faster");
        assert_eq!(measured(2.0, 0.05).0, LAST, "no farther than what is tried");
    }
}
