//! How far two detections lie apart, in standard deviations.

use crate::scene::Detection;
use nalgebra::{Matrix2, Matrix3};
use std::f64::consts::PI;

/// How well places fit together at best: calibration, odometry and the size of what reflects, m.
pub(super) const ROOM: f64 = 0.1;

/// The Mahalanobis distance of two detections, `sqrt(h^T (Sigma_i + Sigma_j + (0.1 m)^2 I)^-1 h)`; of their horizontal
/// parts where `level`. Infinite where it can't be told.
pub(super) fn chi(a: &Detection, b: &Detection, level: bool) -> f64 {
    let h = a.position - b.position;
    let covariance = a.axes * a.axes.transpose()
        + b.axes * b.axes.transpose()
        + Matrix3::from_diagonal_element(ROOM * ROOM);
    let squared = if level {
        let horizontal = h.fixed_rows::<2>(0).into_owned();
        let inverse = covariance.fixed_view::<2, 2>(0, 0).into_owned().try_inverse();
        inverse.map(|inverse| horizontal.dot(&(inverse * horizontal)))
    } else {
        covariance.try_inverse().map(|inverse| h.dot(&(inverse * h)))
    };
    squared.filter(|squared| squared.is_finite()).map_or(f64::INFINITY, |squared| squared.max(0.0).sqrt())
}

/// [`chi`] where it is no more than a limit. It mostly tells from the plane alone that it is more.
pub(super) fn chi_within(limit: f64, a: &Detection, b: &Detection, level: bool) -> Option<f64> {
    let variance = horizontal_variance(a) + horizontal_variance(b) + ROOM * ROOM;
    let away = (a.position - b.position).xy().norm_squared();
    // A hair more, so that rounding never decides.
    if away > 1.000_001 * limit * limit * variance {
        return None;
    }
    Some(chi(a, b, level)).filter(|chi| *chi <= limit)
}

/// No variance in a horizontal direction is larger, m^2.
pub(super) fn horizontal_variance(detection: &Detection) -> f64 {
    detection.axes.fixed_rows::<2>(0).norm_squared()
}

/// The area, m^2, in which detections as uncertain as this one lie within a distance `chi` of it, seen from above.
pub(super) fn area_within(chi: f64, detection: &Detection) -> f64 {
    let horizontal = detection.axes.fixed_rows::<2>(0);
    let covariance = 2.0 * horizontal * horizontal.transpose() + Matrix2::from_diagonal_element(ROOM * ROOM);
    PI * chi * chi * covariance.determinant().max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::Point;
    use nalgebra::Vector3;

    fn detection(place: [f64; 3], sigmas: [f64; 3]) -> Detection {
        Detection { position: Point::from(place), axes: Matrix3::from_diagonal(&Vector3::from(sigmas)) }
    }

    #[test]
    fn a_distance_by_hand() {
        let a = detection([10.0, 0.0, 0.0], [0.3, 1.0, 2.0]);
        let b = detection([11.0, 2.0, 6.0], [0.4, 1.0, 2.0]);
        // Variances 0.09 + 0.16 + 0.01 = 0.26, 2.01 and 8.01: 1 / 0.26 + 4 / 2.01 + 36 / 8.01.
        assert!((chi(&a, &b, false).powi(2) - (1.0 / 0.26 + 4.0 / 2.01 + 36.0 / 8.01)).abs() < 1e-12);
        assert!((chi(&a, &b, true).powi(2) - (1.0 / 0.26 + 4.0 / 2.01)).abs() < 1e-12);
        assert_eq!(chi_within(2.0, &a, &b, true), Some(chi(&a, &b, true)).filter(|chi| *chi <= 2.0));
        assert_eq!(chi_within(3.0, &a, &b, true), Some(chi(&a, &b, true)));
        assert_eq!(chi_within(2.0, &a, &detection([30.0, 0.0, 0.0], [0.3; 3]), true), None);
        assert_eq!(chi(&a, &detection([f64::NAN, 0.0, 0.0], [1.0; 3]), false), f64::INFINITY);
        assert!((horizontal_variance(&a) - 1.09).abs() < 1e-12);
        // Twice its own variances and 0.01: 0.19 and 2.01.
        assert!((area_within(2.0, &a) - 4.0 * PI * (0.19 * 2.01f64).sqrt()).abs() < 1e-9);
    }
}
