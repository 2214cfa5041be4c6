//! Pinhole with Brown-Conrady distortion, as OpenCV has it: with `x = X / Z`, `y = Y / Z`, `r^2 = x^2 + y^2`,
//!
//! ```text
//! x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)      u = fx x' + cx
//! y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y      v = fy y' + cy
//! ```

use super::radial::{first_fold, invert, polynomial};
use crate::space::{Point, Vector};
use nalgebra::{Matrix2, Vector2};
use std::f64::consts::FRAC_PI_2;

/// Rays further off the axis than this are folded back by the radial polynomial, or lie behind the camera.
pub(super) fn limit([k1, k2, _, _, k3]: [f64; 5]) -> f64 {
    let slope = [1.0, 3.0 * k1, 5.0 * k2, 7.0 * k3];
    first_fold(FRAC_PI_2, |angle| polynomial(&slope, angle.tan().powi(2)).0)
}

/// The distorted place of a point in the plane Z = 1.
pub(super) fn project(p: &Point, limit: f64, distortion: [f64; 5]) -> Option<[f64; 2]> {
    let plane = Vector2::new(p.x / p.z, p.y / p.z);
    let inside = p.z > 0.0 && plane.norm() <= limit.tan();
    inside.then(|| distort(plane, distortion).0.into())
}

/// The ray whose distorted place in the plane Z = 1 is the given one: the radial part first, by itself, then all of
/// it by Newton's method with steps that are halved until they help.
pub(super) fn back_project(target: [f64; 2], limit: f64, distortion: [f64; 5]) -> Option<Vector> {
    let (target, widest) = (Vector2::from(target), limit.tan());
    let radius = target.norm();
    if radius == 0.0 && distortion[2..4] == [0.0; 2] {
        return Some(Vector::z());
    }
    // With tangential distortion the rim is not round: a start at the rim may still lead inside.
    let start = invert(radius, widest, |r| radial(r, distortion)).unwrap_or(widest);
    let mut plane = if radius > 0.0 { target * (start / radius) } else { target };
    let (mut image, mut jacobian) = distort(plane, distortion);
    for _ in 0..50 {
        let step = jacobian.try_inverse()? * (target - image);
        let Some(next) = shortened(plane, step, (target - image).norm(), target, distortion) else { break };
        plane = next;
        (image, jacobian) = distort(plane, distortion);
    }
    let met = (image - target).norm() <= 1e-11 * (1.0 + radius);
    let inside = plane.norm() <= widest && jacobian.determinant() > 0.0;
    (met && inside).then(|| Vector::new(plane.x, plane.y, 1.0))
}

/// The point at the end of a step, or of half of it and so on, that comes nearer to the target than `error`.
fn shortened(
    plane: Vector2<f64>,
    step: Vector2<f64>,
    error: f64,
    target: Vector2<f64>,
    distortion: [f64; 5],
) -> Option<Vector2<f64>> {
    let shorter = std::iter::successors(Some(step), |step| Some(step * 0.5)).take(10);
    shorter.map(|step| plane + step).find(|next| (distort(*next, distortion).0 - target).norm() < error)
}

/// `r (1 + k1 r^2 + k2 r^4 + k3 r^6)` and its slope.
fn radial(r: f64, [k1, k2, _, _, k3]: [f64; 5]) -> (f64, f64) {
    polynomial(&[0.0, 1.0, 0.0, k1, 0.0, k2, 0.0, k3], r)
}

/// `(x', y')` and its partial derivatives by x and y.
fn distort(plane: Vector2<f64>, [k1, k2, p1, p2, k3]: [f64; 5]) -> (Vector2<f64>, Matrix2<f64>) {
    let (x, y) = (plane.x, plane.y);
    let square = plane.norm_squared();
    let (scale, slope) = polynomial(&[1.0, k1, k2, k3], square);
    let image = Vector2::new(
        x * scale + 2.0 * p1 * x * y + p2 * (square + 2.0 * x * x),
        y * scale + p1 * (square + 2.0 * y * y) + 2.0 * p2 * x * y,
    );
    let mixed = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y;
    let jacobian = Matrix2::new(
        scale + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x,
        mixed,
        mixed,
        scale + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x,
    );
    (image, jacobian)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_worked_out_by_hand() {
        // x = 0.5, y = -0.25, r^2 = 0.3125, radial 1 + 0.1 * 0.3125 - 0.05 * 0.3125^2 + 0.02 * 0.3125^3.
        let distortion = [0.1, -0.05, 0.001, -0.002, 0.02];
        let scale = 1.0 + 0.03125 - 0.0048828125 + 0.0006103515625;
        let expected = [
            0.5 * scale + 2.0 * 0.001 * -0.125 - 0.002 * (0.3125 + 0.5),
            -0.25 * scale + 0.001 * (0.3125 + 0.125) + 2.0 * -0.002 * -0.125,
        ];
        let found = project(&Point::new(1.0, -0.5, 2.0), limit(distortion), distortion).unwrap();
        assert!((Vector2::from(found) - Vector2::from(expected)).norm() < 1e-14);
    }

    #[test]
    fn rays_that_the_polynomial_folds_back_are_not_seen() {
        // r - 0.3 r^3 turns at r = sqrt(1 / 0.9), and would bring a ray at r = 1.8 back to the centre.
        let distortion = [-0.3, 0.0, 0.0, 0.0, 0.0];
        let limit = limit(distortion);
        assert!((limit.tan() - (1.0_f64 / 0.9).sqrt()).abs() < 1e-9);
        assert!(project(&Point::new(1.0, 0.0, 1.0), limit, distortion).is_some());
        assert!(project(&Point::new(1.8, 0.0, 1.0), limit, distortion).is_none());
        let rim = radial(limit.tan(), distortion).0;
        assert!(back_project([rim - 1e-6, 0.0], limit, distortion).is_some());
        assert!(back_project([rim + 1e-6, 0.0], limit, distortion).is_none());
    }

    #[test]
    fn the_jacobian_is_the_finite_difference() {
        let (distortion, at, step) = ([0.1, -0.05, 0.01, -0.02, 0.02], Vector2::new(0.4, -0.7), 1e-7);
        let (image, jacobian) = distort(at, distortion);
        for (column, moved) in [Vector2::new(step, 0.0), Vector2::new(0.0, step)].into_iter().enumerate() {
            let difference = (distort(at + moved, distortion).0 - image) / step;
            assert!((difference - jacobian.column(column)).norm() < 1e-6);
        }
    }
}
