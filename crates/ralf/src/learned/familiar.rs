//! How far evidence lies from what a model was trained on.

/// Share of the training rows below which absence counts as never seen.
const SELDOM: f32 = 1e-3;

/// What a feature was like in training.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// All values but the smallest thousandth are at least this.
    pub low: f32,
    /// All values but the largest thousandth are at most this.
    pub high: f32,
    /// The share of rows that lacked it.
    pub absent: f32,
    /// What it is worth to the model: the sum of what its questions gained.
    pub gain: f32,
}

impl Seen {
    /// Whether a value, or its absence (NaN), is unlike what was seen.
    fn is_strange(&self, value: f32) -> bool {
        if value.is_nan() { self.absent < SELDOM } else { value < self.low || value > self.high }
    }
}

/// The share of a model's evidence, by worth, that is unlike anything it was trained on; in [0, 1].
pub fn novelty(seen: &[Seen], row: &[f32]) -> f64 {
    let (mut strange, mut all) = (0.0, 0.0);
    for (seen, value) in seen.iter().zip(row) {
        let gain = f64::from(seen.gain);
        all += gain;
        // A sum rather than a branch, which is hard to foretell.
        strange += if seen.is_strange(*value) { gain } else { 0.0 };
    }
    if all > 0.0 { strange / all } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_never_seen_counts_by_its_worth() {
        let of = |low, high, absent, gain| Seen { low, high, absent, gain };
        let seen = [of(0.0, 1.0, 0.0, 3.0), of(-5.0, 5.0, 0.4, 1.0)];
        assert_eq!(novelty(&seen, &[0.5, 0.0]), 0.0);
        assert_eq!(novelty(&seen, &[1.5, f32::NAN]), 0.75);
        assert_eq!(novelty(&seen, &[f32::NAN, -6.0]), 1.0);
        assert_eq!(novelty(&[], &[]), 0.0);
    }
}
