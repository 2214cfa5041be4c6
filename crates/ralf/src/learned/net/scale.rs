//! From a feature's value to a score: evidence has units, long tails and values that many share; scores have neither.

use thiserror::Error;

/// A rising line through points of a feature's value and its score; level beyond its ends.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scale {
    points: Vec<(f32, f32)>,
    /// The points' values, looked at side by side; what fills up the last of them is infinite.
    values: Vec<[f32; LANES]>,
}

/// Values that are looked at side by side: of some thirty points that is quicker than halving them.
const LANES: usize = 8;

/// Why points are no scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("expected pairs of finite numbers whose first rises and whose second never falls")]
pub struct ScaleError;

impl Scale {
    /// A line through points. Of none, every score is 0.
    ///
    /// # Errors
    /// Numbers that are not finite, values that don't rise, scores that fall.
    pub fn new(points: Vec<(f32, f32)>) -> Result<Self, ScaleError> {
        let is_finite = |(value, score): &(f32, f32)| value.is_finite() && score.is_finite();
        let rises = points.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1 <= pair[1].1);
        if !(rises && points.iter().all(is_finite)) {
            return Err(ScaleError);
        }
        let value_at = |at: usize| points.get(at).map_or(f32::INFINITY, |(value, _)| *value);
        let values = (0..points.len()).step_by(LANES);
        let values = values.map(|begin| std::array::from_fn(|lane| value_at(begin + lane))).collect();
        Ok(Self { points, values })
    }

    /// The points.
    pub fn points(&self) -> &[(f32, f32)] {
        &self.points
    }

    /// The score of a value, which is not NaN.
    pub fn score(&self, value: f32) -> f32 {
        let below = |few: &[f32; LANES]| few.iter().map(|point| u32::from(*point <= value)).sum::<u32>();
        let above = (self.values.iter().map(below).sum::<u32>() as usize).min(self.points.len());
        match (above.checked_sub(1).map(|below| self.points[below]), self.points.get(above)) {
            (Some((from, low)), Some((to, high))) => low + (high - low) * ((value - from) / (to - from)),
            (Some((_, score)), None) | (None, Some(&(_, score))) => score,
            (None, None) => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scores_lie_on_the_line_and_no_farther_than_its_ends() {
        let scale = Scale::new(vec![(0.0, -1.0), (2.0, 1.0), (10.0, 1.5)]).unwrap();
        let found = [-5.0, 0.0, 0.5, 2.0, 6.0, 99.0, f32::INFINITY].map(|value| scale.score(value));
        assert_eq!(found, [-1.0, -1.0, -0.5, 1.0, 1.25, 1.5, 1.5]);
        assert_eq!(Scale::new(vec![]).unwrap().score(3.0), 0.0);
    }

    #[test]
    fn what_does_not_rise_is_refused() {
        for points in [[(0.0, 0.0), (0.0, 1.0)], [(0.0, 1.0), (1.0, 0.0)], [(0.0, 0.0), (f32::NAN, 1.0)]] {
            assert_eq!(Scale::new(points.to_vec()), Err(ScaleError));
        }
    }
}
