//! Compensated range rates in units of their scan's own spread.
//!
//! In most scans most detections stand still, so that their compensated rates show how well radar and odometry agree.

use super::statistics::median_of;
use std::f64::consts::SQRT_2;

/// The spread is never taken for less or more, m/s: no radar is better, and above is a scan of movers.
const SPREADS: [f64; 2] = [0.12, 0.30];
/// The same for the rates of one echo at two angles, m/s: below, nothing tells its detections apart from those of the
/// next cell of range rates, which of a radar that measures for some 30 ms is 0.06 m/s wide.
const NOISES: [f64; 2] = [0.03, 0.30];
/// What differs from standing still by more, in spreads, moves.
const MOVING: f64 = 3.0;
/// Rates of two detections agree if they differ by no more, in spreads of such a difference.
pub(super) const AGREEING: f64 = 2.0;

/// How far two range rates lie apart, in standard deviations of such a difference, of which each rate has one of
/// `sigma`; `None` where either was not measured.
pub(super) fn difference(a: f64, b: f64, sigma: f64) -> Option<f64> {
    Some((a - b).abs() / (SQRT_2 * sigma)).filter(|difference| difference.is_finite())
}

/// The compensated range rates of a scan, with their spread.
#[derive(Debug)]
pub(super) struct Rates {
    /// One per detection, m/s, positive when receding; NaN where none was measured.
    pub(super) values: Vec<f64>,
    /// m/s.
    spread: f64,
    /// How much rates of one echo scatter at most, m/s.
    noise: f64,
}

impl Rates {
    /// The spread is 1.48 times the median distance from the median, which of a normal distribution is the standard
    /// deviation, within 0.12 to 0.30 m/s.
    pub(super) fn new(values: Vec<f64>) -> Self {
        let middle = median_of(&values).unwrap_or(0.0);
        let distances: Vec<f64> = values.iter().map(|value| (value - middle).abs()).collect();
        let spread = 1.48 * median_of(&distances).unwrap_or(0.0);
        let [spread, noise] = [SPREADS, NOISES].map(|[least, most]| spread.clamp(least, most));
        Self { values, spread, noise }
    }

    /// m/s.
    pub(super) fn spread(&self) -> f64 {
        self.spread
    }

    /// How far a detection is from standing still, in spreads; `None` without a rate.
    pub(super) fn residual(&self, detection: usize) -> Option<f64> {
        Some(self.values[detection].abs() / self.spread).filter(|residual| residual.is_finite())
    }

    /// The rate of a detection that moves, m/s; 0 of one that stands still or has no rate.
    pub(super) fn motion(&self, detection: usize) -> f64 {
        let moves = self.residual(detection).is_some_and(|residual| residual > MOVING);
        if moves { self.values[detection] } else { 0.0 }
    }

    /// Whether two measured rates differ by no more than those of one echo, seen at two angles; not where either was
    /// not measured. What a radar tells apart doesn't hang on how well the vehicle's motion is known: the spread's
    /// lower bound doesn't count.
    pub(super) fn are_of_one_echo(&self, a: f64, b: f64) -> bool {
        (a - b).abs() <= AGREEING * SQRT_2 * self.noise
    }

    /// How far a detection's rate is from another rate, in spreads of such a difference; `None` where either was not
    /// measured.
    pub(super) fn difference(&self, detection: usize, other: f64) -> Option<f64> {
        difference(self.values[detection], other, self.spread)
    }

    /// Whether a detection's rate agrees with another; `None` where either was not measured.
    pub(super) fn agrees(&self, detection: usize, other: f64) -> Option<bool> {
        self.difference(detection, other).map(|difference| difference <= AGREEING)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_by_hand() {
        // Median 0.1; distances 0.1, 0.1, 0, 0.2, 9.9, of which 0.1 is the median: 0.148 m/s.
        let rates = Rates::new(vec![0.0, 0.2, 0.1, f64::NAN, 0.3, 10.0]);
        assert!((rates.residual(5).unwrap() - 10.0 / 0.148).abs() < 1e-9);
        assert_eq!(
            (rates.residual(3), rates.difference(3, 0.0), rates.agrees(0, f64::NAN)),
            (None, None, None)
        );
        assert_eq!((rates.motion(5), rates.motion(4), rates.motion(3)), (10.0, 0.0, 0.0));
        // 2 spreads of a difference are 0.4186 m/s.
        assert_eq!((rates.agrees(0, 0.418), rates.agrees(0, -0.419)), (Some(true), Some(false)));
    }

    #[test]
    fn a_radar_that_measures_finely_tells_echoes_apart() {
        // All stand still but for 0.01 m/s: 2 spreads of a difference are 0.085 m/s, and not 0.34.
        let fine = Rates::new(vec![0.0, 0.01, -0.01, 0.01, -0.01]);
        assert!(fine.are_of_one_echo(-4.0, -4.08) && !fine.are_of_one_echo(-4.0, -4.09));
        assert_eq!(fine.agrees(0, 0.33), Some(true), "things move less finely");
        // Where rates scatter by 0.148 m/s they do so at every angle.
        let coarse = Rates::new(vec![0.0, 0.1, -0.1, 0.1, -0.1]);
        assert!(coarse.are_of_one_echo(-4.0, -4.41) && !coarse.are_of_one_echo(-4.0, -4.42));
        assert!(!coarse.are_of_one_echo(f64::NAN, 0.0));
    }

    #[test]
    fn the_spread_has_bounds() {
        assert_eq!(Rates::new(vec![0.0; 4]).spread, 0.12);
        assert_eq!(Rates::new(vec![-9.0, 4.0, 7.0]).spread, 0.30);
        assert_eq!(Rates::new(vec![f64::NAN]).spread, 0.12);
    }
}
