//! From what a forest says to a probability that means what it says.

use thiserror::Error;

/// A rising line through points of log odds and probability; level beyond its ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    points: Vec<(f64, f64)>,
}

/// Why points are no calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("expected points of rising log odds whose probabilities lie in [0, 1] and never fall")]
pub struct CalibrationError;

impl Calibration {
    /// A line through points, each of log odds and the probability there; at least one.
    ///
    /// # Errors
    /// No points, numbers that are not finite, log odds that don't rise, probabilities that fall or leave [0, 1].
    pub fn new(points: Vec<(f64, f64)>) -> Result<Self, CalibrationError> {
        let fine = |(log_odds, p): &(f64, f64)| log_odds.is_finite() && (0.0..=1.0).contains(p);
        let rises = points.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1 <= pair[1].1);
        if points.is_empty() || !rises || !points.iter().all(fine) {
            return Err(CalibrationError);
        }
        Ok(Self { points })
    }

    /// The line of nothing known: always one half.
    pub fn even() -> Self {
        Self { points: vec![(0.0, 0.5)] }
    }

    /// The points.
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// The probability at these log odds.
    pub fn probability(&self, log_odds: f64) -> f64 {
        let above = self.points.partition_point(|(x, _)| *x < log_odds);
        let (Some(&(x1, p1)), Some(&(x0, p0))) = (self.points.get(above), self.points[..above].last()) else {
            return if above == 0 { self.points[0].1 } else { self.points[above - 1].1 };
        };
        p0 + (p1 - p0) * (log_odds - x0) / (x1 - x0)
    }
}

/// A probability whose odds are multiplied.
pub(super) fn with_odds(probability: f64, factor: f64) -> f64 {
    let scaled = probability * factor;
    scaled / (1.0 - probability + scaled).max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_points_it_is_straight_and_beyond_them_level() {
        let line = Calibration::new(vec![(-1.0, 0.1), (1.0, 0.5), (2.0, 0.9)]).unwrap();
        let expected = [(-9.0, 0.1), (-1.0, 0.1), (0.0, 0.3), (1.0, 0.5), (1.5, 0.7), (2.0, 0.9), (9.0, 0.9)];
        for (log_odds, p) in expected {
            assert!((line.probability(log_odds) - p).abs() < 1e-12, "{log_odds}");
        }
        assert_eq!(Calibration::new(vec![(0.0, 0.25)]).unwrap().probability(3.0), 0.25);
    }

    #[test]
    fn odds_are_multiplied() {
        assert!((with_odds(0.75, 0.1) - 0.3 / 1.3).abs() < 1e-12, "3 to 1 becomes 3 to 10");
        assert_eq!([0.0, 1.0].map(|p| with_odds(p, 0.1)), [0.0, 1.0]);
        assert_eq!(with_odds(0.25, 1.0), 0.25);
    }

    #[test]
    fn what_falls_is_refused() {
        for points in [vec![], vec![(0.0, 0.5), (1.0, 0.4)], vec![(0.0, 0.5), (0.0, 0.5)], vec![(0.0, 1.5)]] {
            assert_eq!(Calibration::new(points), Err(CalibrationError));
        }
        assert!(Calibration::new(vec![(f64::NAN, 0.5)]).is_err());
    }
}
