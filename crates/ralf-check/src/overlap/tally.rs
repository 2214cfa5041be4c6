//! How many of the points that were asked about lie on something, moment by moment.

use crate::statistics::paired_sigmas;

/// An alternative is better by this factor at least: a smaller gain is no fault that harms labels.
const GAIN: f64 = 1.08;
/// And by so many standard errors: with some forty alternatives a sensor, chance comes this far once in a thousand
/// recordings.
const SIGMAS: f64 = 4.0;
/// Fewer points than this say nothing.
const FEWEST: f64 = 150.0;
/// A share below this is that of things that don't see the same.
const LEAST: f64 = 0.1;

/// What sees the same lies on it more often than by chance by this factor: right recordings from 1.35 on, but for those
/// most of whose detections lie on open ground.
const ABOVE_CHANCE: f64 = 1.2;

/// Counts per moment. Every moment weighs as much as it holds points.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Tally {
    /// Points on something, and points.
    pub(crate) moments: Vec<[f64; 2]>,
}

impl Tally {
    pub(crate) fn points(&self) -> f64 {
        self.moments.iter().fold(0.0, |sum, [_, n]| sum + n)
    }

    /// Share of the points that lie on something; 0 of none.
    pub(crate) fn share(&self) -> f64 {
        let near: f64 = self.moments.iter().map(|[near, _]| near).sum();
        if self.points() > 0.0 { near / self.points() } else { 0.0 }
    }

    /// Whether there are enough points to judge.
    pub(crate) fn is_enough(&self) -> bool {
        self.points() >= FEWEST
    }

    /// Whether there are enough points, and enough of them lie on something to tell one place from another.
    pub(crate) fn tells(&self) -> bool {
        self.is_enough() && self.share() > LEAST
    }

    /// Whether clearly more lies on something than of another tally, which tells chance.
    pub(crate) fn is_above_chance(&self, chance: &Self) -> bool {
        self.share() > ABOVE_CHANCE * chance.share()
    }

    /// By how many standard errors another tally of the same moments has the larger share: the smaller of what binomial
    /// counts say and of what the differences from moment to moment say, where there are enough moments for the latter.
    pub(crate) fn sigmas_to(&self, other: &Self) -> f64 {
        let share = |[near, n]: &[f64; 2]| if *n > 0.0 { near / n } else { 0.0 };
        let (p, n) = (self.share(), self.points().max(1.0));
        let binomial = (other.share() - p) / (p.max(1.0 / n) * (1.0 - p).max(1.0 / n) / n).sqrt();
        let pairs = self.moments.iter().zip(&other.moments);
        let differences: Vec<f64> = pairs.map(|(now, then)| share(then) - share(now)).collect();
        if differences.len() < 5 { binomial } else { binomial.min(paired_sigmas(&differences)) }
    }

    /// Whether another tally is so much better that chance is no reason.
    pub(crate) fn is_beaten_by(&self, other: &Self) -> bool {
        self.is_beaten_by_factor(other, GAIN)
    }

    /// The same where the gain has to be this factor at least.
    pub(crate) fn is_beaten_by_factor(&self, other: &Self, gain: f64) -> bool {
        self.is_enough()
            && other.share() > LEAST
            && other.share() > gain * self.share()
            && self.sigmas_to(other) > SIGMAS
    }

    /// Both together, moment after moment.
    pub(crate) fn joined(mut self, other: Self) -> Self {
        self.moments.extend(other.moments);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tally(near: &[f64]) -> Tally {
        Tally { moments: near.iter().map(|near| [*near, 100.0]).collect() }
    }

    #[test]
    fn a_clear_gain_beats_and_a_small_or_a_lucky_one_does_not() {
        let now = tally(&[30.0, 32.0, 28.0, 31.0, 29.0, 30.0]);
        assert_eq!(now.share(), 0.3);
        assert!(now.is_beaten_by(&tally(&[50.0, 55.0, 49.0, 52.0, 51.0, 50.0])));
        assert!(!now.is_beaten_by(&tally(&[32.0, 34.0, 30.0, 33.0, 31.0, 32.0])), "a gain of 7 %");
        assert!(!now.is_beaten_by(&tally(&[30.0, 32.0, 28.0, 31.0, 29.0, 90.0])), "one moment alone");
        assert!(!tally(&[30.0]).is_beaten_by(&tally(&[90.0])), "100 points");
        assert!(!Tally::default().is_beaten_by(&Tally::default()));
    }
}
