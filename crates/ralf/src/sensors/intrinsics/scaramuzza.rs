//! Scaramuzza's polynomial, as OCamCalib's `cam2world` and `world2cam` have it.
//!
//! Its axes are X down the rows, Y along the columns to the right, Z backward, so the camera looks along -Z: optical
//! `(x, y, z) = (Y, X, -Z)`. With `theta` the angle off the axis (its own is `theta - pi / 2`) and `(X', Y')` a place
//! around the centre,
//!
//! ```text
//! to the image:    (X', Y') = rho (X, Y) / hypot(X, Y),  rho = sum b_i (theta - pi/2)^i
//!                  row = c X' + d Y' + xc,  column = e X' + Y' + yc
//! from the image:  direction (X', Y', sum a_i hypot(X', Y')^i)
//! ```

use super::radial::{first_fold, invert, polynomial};
use super::{angle_off_axis, direction};
use crate::space::{Point, Vector};
use std::f64::consts::{FRAC_PI_2, PI};

/// The parameters, as [`super::Intrinsics::Scaramuzza`] explains them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scaramuzza<'a> {
    pub(super) polynomial: &'a [f64],
    pub(super) inverse_polynomial: &'a [f64],
    pub(super) center: [f64; 2],
    pub(super) affine: [f64; 3],
}

impl Scaramuzza<'_> {
    /// The angle up to which the inverse polynomial grows.
    pub(super) fn limit(self) -> f64 {
        first_fold(PI, |theta| self.radius(theta).1)
    }

    /// Pixels per radian on the axis: `|a0|`, or where only the inverse polynomial is known its slope there, which is
    /// the same.
    pub(super) fn focal(self) -> f64 {
        self.polynomial.first().map_or_else(|| self.radius(0.0).1, |a0| a0.abs())
    }

    /// Column and row of a point.
    pub(super) fn project(self, p: &Point, limit: f64) -> Option<[f64; 2]> {
        let (theta, [column, row]) = angle_off_axis(p)?;
        let rho = self.radius(theta).0;
        (theta <= limit).then(|| self.pixel(rho * row, rho * column))
    }

    /// The ray of a pixel: by the direct polynomial, or where that is unknown by inverting the inverse one.
    pub(super) fn back_project(self, pixel: [f64; 2], limit: f64) -> Option<Vector> {
        let [down, right] = self.around_center(pixel);
        let rho = down.hypot(right);
        let theta = if self.polynomial.is_empty() {
            invert(rho, limit, |theta| self.radius(theta))?
        } else {
            rho.atan2(-polynomial(self.polynomial, rho).0)
        };
        (theta <= limit).then(|| direction(theta, [right, down]))
    }

    /// `c - d e`: how the affine part changes areas.
    pub(super) fn determinant(self) -> f64 {
        let [c, d, e] = self.affine;
        c - d * e
    }

    /// `rho` at an angle off the axis, and its slope.
    fn radius(self, theta: f64) -> (f64, f64) {
        polynomial(self.inverse_polynomial, theta - FRAC_PI_2)
    }

    /// Column and row of `(X', Y')`.
    fn pixel(self, down: f64, right: f64) -> [f64; 2] {
        let ([c, d, e], [row, column]) = (self.affine, self.center);
        [e * down + right + column, c * down + d * right + row]
    }

    /// `(X', Y')` of column and row.
    fn around_center(self, [u, v]: [f64; 2]) -> [f64; 2] {
        let ([c, d, e], [row, column]) = (self.affine, self.center);
        let (right, down) = (u - column, v - row);
        [(down - d * right) / self.determinant(), (c * right - e * down) / self.determinant()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_the_axis_the_inverse_polynomials_slope_is_the_focal_length() {
        // theta + pi/2 times 300, as a polynomial in theta: an equidistant lens.
        let inverse = [300.0 * FRAC_PI_2, 300.0];
        let lens = Scaramuzza {
            polynomial: &[],
            inverse_polynomial: &inverse,
            center: [100.0, 120.0],
            affine: [1.0, 0.0, 0.0],
        };
        assert_eq!(lens.focal(), 300.0);
        assert_eq!(Scaramuzza { polynomial: &[-310.0, 0.0], ..lens }.focal(), 310.0);
        // 90 degrees to the right, and down.
        let limit = lens.limit();
        let [right, down] = [Point::new(1.0, 0.0, 0.0), Point::new(0.0, 1.0, 0.0)];
        assert_eq!(lens.project(&right, limit), Some([120.0 + 300.0 * FRAC_PI_2, 100.0]));
        assert_eq!(lens.project(&down, limit), Some([120.0, 100.0 + 300.0 * FRAC_PI_2]));
    }

    #[test]
    fn the_affine_part_is_undone() {
        let lens = Scaramuzza {
            polynomial: &[],
            inverse_polynomial: &[],
            center: [10.0, 20.0],
            affine: [1.1, 0.2, -0.3],
        };
        let [u, v] = lens.pixel(3.0, -4.0);
        assert!((u - (-0.3 * 3.0 - 4.0 + 20.0)).abs() < 1e-12 && (v - (3.3 - 0.8 + 10.0)).abs() < 1e-12);
        let [down, right] = lens.around_center([u, v]);
        assert!((down - 3.0).abs() < 1e-12 && (right + 4.0).abs() < 1e-12);
    }
}
