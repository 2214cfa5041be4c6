//! A range that a number is drawn from.

use crate::random::Random;

/// From its lower to its upper end, evenly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    /// Lower end.
    pub(crate) low: f64,
    /// Upper end.
    pub(crate) high: f64,
}

/// From `low` to `high`.
pub(super) const fn span(low: f64, high: f64) -> Span {
    Span { low, high }
}

impl Span {
    pub(super) fn draw(self, random: &mut Random) -> f64 {
        random.between(self.low, self.high)
    }

    /// Evenly by its logarithm: of what spans decades.
    pub(super) fn ratio(self, random: &mut Random) -> f64 {
        random.between(self.low.ln(), self.high.ln()).exp()
    }

    /// An integer, both ends included.
    pub(super) fn count(self, random: &mut Random) -> usize {
        (self.low + (self.high - self.low + 1.0) * random.uniform()).floor() as usize
    }
}

/// One of several, each as likely as its weight says.
pub(super) fn one_of<T: Copy>(choices: &[(T, f64)], random: &mut Random) -> Option<T> {
    let all: f64 = choices.iter().map(|(_, weight)| weight).sum();
    let mut left = all * random.uniform();
    for (choice, weight) in choices {
        left -= weight;
        if left <= 0.0 {
            return Some(*choice);
        }
    }
    choices.last().map(|(choice, _)| *choice)
}
