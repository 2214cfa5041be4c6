//! How far two detections lie apart, in standard deviations.

use crate::scene::Detection;
use crate::space::Vector;
use nalgebra::Matrix2;
use std::f64::consts::PI;

/// How well places fit together at best: calibration, odometry and the size of what reflects, m.
pub(super) const ROOM: f64 = 0.1;

/// A detection as distances see it: its place, and its covariance worked out once.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot {
    /// m
    pub(super) place: Vector,
    /// xx, xy and yy, m^2.
    pub(super) horizontal: [f64; 3],
    /// xz, yz and zz, m^2.
    pub(super) vertical: [f64; 3],
    /// No variance in a horizontal direction is larger, m^2.
    pub(super) variance: f64,
}

impl Spot {
    pub(super) fn new(detection: &Detection) -> Self {
        let axes = &detection.axes;
        let product = |a: usize, b: usize| axes.row(a).dot(&axes.row(b));
        let horizontal = [product(0, 0), product(0, 1), product(1, 1)];
        Self {
            place: detection.position.coords,
            horizontal,
            vertical: [product(0, 2), product(1, 2), product(2, 2)],
            variance: horizontal[0] + horizontal[2],
        }
    }

    /// Where it lies, seen from above, m, as searches among many have it.
    pub(super) fn in_plan(&self) -> [f32; 2] {
        [self.place.x as f32, self.place.y as f32]
    }

    /// The same elsewhere.
    pub(super) fn moved(mut self, way: &Vector) -> Self {
        self.place += way;
        self
    }
}

/// A spot that goes on, and grows less certain.
#[derive(Debug, Clone, Copy)]
pub(super) struct DriftingSpot {
    /// At its own time.
    pub(super) spot: Spot,
    /// What changes: its place is a velocity, m/s, and its covariance, m^2/s^2, is what is added, times the square of
    /// the time.
    pub(super) drift: Spot,
}

impl DriftingSpot {
    /// The spot so many seconds later.
    pub(super) fn after(&self, seconds: f64) -> Spot {
        let Self { mut spot, drift } = *self;
        let squared = seconds * seconds;
        spot.place += drift.place * seconds;
        for entry in 0..3 {
            spot.horizontal[entry] += drift.horizontal[entry] * squared;
            spot.vertical[entry] += drift.vertical[entry] * squared;
        }
        spot.variance = spot.horizontal[0] + spot.horizontal[2];
        spot
    }
}

/// The Mahalanobis distance of two detections, `sqrt(h^T (Sigma_i + Sigma_j + (0.1 m)^2 I)^-1 h)`; of their horizontal
/// parts where `level`. `None` where it is more than a limit, which it mostly tells from the plane alone, and where it
/// can't be told.
pub(super) fn chi_within(limit: f64, a: &Spot, b: &Spot, level: bool) -> Option<f64> {
    // A hair more, so that rounding never decides.
    let most = 1.000_001 * limit * limit;
    let h = a.place - b.place;
    if h.xy().norm_squared() > most * (a.variance + b.variance + ROOM * ROOM) {
        return None;
    }
    let [xx, xy, yy] = [0, 1, 2].map(|entry| a.horizontal[entry] + b.horizontal[entry]);
    let (xx, yy) = (xx + ROOM * ROOM, yy + ROOM * ROOM);
    let determinant = xx * yy - xy * xy;
    let mut squared = (h.x * h.x * yy - 2.0 * h.x * h.y * xy + h.y * h.y * xx) / determinant;
    if squared > most {
        return None;
    }
    if !level {
        // What the height adds once the place in the plane is known.
        let [xz, yz, zz] = [0, 1, 2].map(|entry| a.vertical[entry] + b.vertical[entry]);
        let (by_x, by_y) = ((xz * yy - yz * xy) / determinant, (yz * xx - xz * xy) / determinant);
        let left = h.z - by_x * h.x - by_y * h.y;
        squared += left * left / (zz + ROOM * ROOM - by_x * xz - by_y * yz);
    }
    let chi = Some(squared).filter(|squared| squared.is_finite()).map(|squared| squared.max(0.0).sqrt());
    chi.filter(|chi| *chi <= limit)
}

/// No detection is within a distance `chi` that is farther away than this, m, seen from above, and whose horizontal
/// variance is no larger than the given one, m^2.
pub(super) fn farthest_within(chi: f64, spot: &Spot, max_variance: f64) -> f32 {
    // Searches round to `f32`.
    const ROUNDING: f64 = 1.001;
    (ROUNDING * chi * (spot.variance + max_variance + ROOM * ROOM).sqrt()) as f32
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
    use nalgebra::{Matrix3, Vector3};
    use proptest::prelude::*;

    fn chi(a: &Spot, b: &Spot, level: bool) -> f64 {
        chi_within(f64::INFINITY, a, b, level).unwrap_or(f64::INFINITY)
    }

    fn detection(place: [f64; 3], sigmas: [f64; 3]) -> Detection {
        Detection { position: Point::from(place), axes: Matrix3::from_diagonal(&Vector3::from(sigmas)) }
    }

    fn spot(place: [f64; 3], sigmas: [f64; 3]) -> Spot {
        Spot::new(&detection(place, sigmas))
    }

    proptest! {
        #[test]
        fn a_distance_is_what_the_inverse_of_the_covariance_gives(
            places in prop::array::uniform6(-2.0f64..2.0), axes in prop::array::uniform9(-0.7f64..0.7),
            other in prop::array::uniform9(-0.7f64..0.7), level in any::<bool>(), limit in 0.5f64..6.0,
        ) {
            let [a, b] = [(0, axes), (3, other)].map(|(first, axes)| Detection {
                position: Point::new(places[first], places[first + 1], places[first + 2]),
                axes: Matrix3::from_row_slice(&axes),
            });
            let covariance = a.axes * a.axes.transpose() + b.axes * b.axes.transpose() + Matrix3::identity() * 0.01;
            let h = a.position - b.position;
            let size = if level { 2 } else { 3 };
            let (covariance, h) = (covariance.view((0, 0), (size, size)).into_owned(), h.rows(0, size).into_owned());
            let expected = h.dot(&(covariance.try_inverse().unwrap() * &h)).sqrt();
            let (a, b) = (Spot::new(&a), Spot::new(&b));
            prop_assert!((chi(&a, &b, level) - expected).abs() < 1e-8 * expected.max(1.0));
            let within = chi_within(limit, &a, &b, level);
            prop_assert_eq!(within, Some(chi(&a, &b, level)).filter(|chi| *chi <= limit));
        }
    }

    #[test]
    fn a_distance_by_hand() {
        let a = spot([10.0, 0.0, 0.0], [0.3, 1.0, 2.0]);
        let b = spot([11.0, 2.0, 6.0], [0.4, 1.0, 2.0]);
        // Variances 0.09 + 0.16 + 0.01 = 0.26, 2.01 and 8.01: 1 / 0.26 + 4 / 2.01 + 36 / 8.01.
        assert!((chi(&a, &b, false).powi(2) - (1.0 / 0.26 + 4.0 / 2.01 + 36.0 / 8.01)).abs() < 1e-12);
        assert!((chi(&a, &b, true).powi(2) - (1.0 / 0.26 + 4.0 / 2.01)).abs() < 1e-12);
        assert_eq!(chi_within(2.0, &a, &b, true), Some(chi(&a, &b, true)).filter(|chi| *chi <= 2.0));
        assert_eq!(chi_within(3.0, &a, &b, true), Some(chi(&a, &b, true)));
        assert_eq!(chi_within(2.0, &a, &spot([30.0, 0.0, 0.0], [0.3; 3]), true), None);
        assert_eq!(chi(&a, &spot([f64::NAN, 0.0, 0.0], [1.0; 3]), false), f64::INFINITY);
        assert!((a.variance - 1.09).abs() < 1e-12);
        // Twice its own variances and 0.01: 0.19 and 2.01.
        assert!(
            (area_within(2.0, &detection([10.0, 0.0, 0.0], [0.3, 1.0, 2.0]))
                - 4.0 * PI * (0.19 * 2.01f64).sqrt())
            .abs()
                < 1e-9
        );
    }
}
