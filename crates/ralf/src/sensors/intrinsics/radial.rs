//! What all models share: a radius in the image that grows with the angle off the axis, up to where the polynomial
//! folds back.

/// Steps in which a polynomial's slope is looked at; a fold narrower than one of them does no harm.
const STEPS: usize = 256;

/// `c[0] + c[1] x + c[2] x^2 + ...` and its derivative.
pub(super) fn polynomial(coefficients: &[f64], x: f64) -> (f64, f64) {
    coefficients.iter().rev().fold((0.0, 0.0), |(value, slope), c| (value * x + c, slope * x + value))
}

/// The largest argument in `0..=end` up to which the slope stays above 0; 0 where it doesn't even begin so.
pub(super) fn first_fold(end: f64, slope: impl Fn(f64) -> f64) -> f64 {
    let at = |step: usize| end * step as f64 / STEPS as f64;
    let rises = |x: f64| slope(x) > 0.0;
    let Some(folded) = (0..=STEPS).find(|step| !rises(at(*step))) else { return end };
    if folded == 0 {
        return 0.0;
    }
    let (mut low, mut high) = (at(folded - 1), at(folded));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if rises(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// The `x` in `0..=end` at which a rising function reaches `target`, by Newton's method within a shrinking bracket.
///
/// `function` gives value and slope. A target below the value at 0 is reached at 0; one above the value at `end`
/// nowhere.
pub(super) fn invert(target: f64, end: f64, function: impl Fn(f64) -> (f64, f64)) -> Option<f64> {
    let (at_zero, at_end) = (function(0.0), function(end));
    if target.is_nan() || target > at_end.0 {
        return None;
    }
    if target <= at_zero.0 {
        return Some(0.0);
    }
    let (mut low, mut high) = (0.0, end);
    let mut x = ((target - at_zero.0) / at_zero.1).min(end);
    for _ in 0..200 {
        let (value, slope) = function(x);
        if value > target {
            high = x;
        } else {
            low = x;
        }
        let newton = x - (value - target) / slope;
        let next = if low <= newton && newton <= high { newton } else { 0.5 * (low + high) };
        let done = (next - x).abs() <= 4.0 * f64::EPSILON * x.abs();
        x = next;
        if done {
            break;
        }
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_and_its_slope() {
        // 1 + 2 x + 3 x^2 at 2, and 2 + 6 x.
        assert_eq!(polynomial(&[1.0, 2.0, 3.0], 2.0), (17.0, 14.0));
        assert_eq!(polynomial(&[], 2.0), (0.0, 0.0));
    }

    #[test]
    fn the_first_fold_of_x_minus_x_cubed() {
        let fold = first_fold(1.0, |x| 1.0 - 3.0 * x * x);
        assert!((fold - (1.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert_eq!(first_fold(2.0, |_| 1.0), 2.0);
        assert_eq!(first_fold(2.0, |_| -1.0), 0.0);
        assert_eq!(first_fold(2.0, |_| f64::NAN), 0.0);
    }

    #[test]
    fn what_is_inverted_is_reached() {
        let function = |x: f64| (x - x * x * x / 4.0 + 0.1, 1.0 - 0.75 * x * x);
        let end = first_fold(3.0, |x| function(x).1);
        for target in [0.1, 0.1 + 1e-12, 0.2, 0.5, 0.8, function(end).0] {
            let x = invert(target, end, function).unwrap();
            assert!((function(x).0 - target).abs() < 1e-12, "{target} at {x}");
        }
        assert_eq!(invert(0.0, end, function), Some(0.0), "below the value at 0");
        assert_eq!(invert(function(end).0 + 1e-9, end, function), None, "beyond the fold");
        assert_eq!(invert(f64::NAN, end, function), None);
    }
}
