//! Kannala-Brandt, as OpenCV's fisheye module has it: with `theta` the angle off the axis,
//!
//! ```text
//! theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)
//! (x', y') = theta_d (x, y) / hypot(x, y)      u = fx x' + cx      v = fy y' + cy
//! ```

use super::radial::{first_fold, invert, polynomial};
use super::{angle_off_axis, direction};
use crate::space::{Point, Vector};
use std::f64::consts::PI;

/// The angle up to which `theta_d` grows.
pub(super) fn limit(distortion: [f64; 4]) -> f64 {
    first_fold(PI, |theta| distorted(theta, distortion).1)
}

/// `(x', y')` of a point.
pub(super) fn project(p: &Point, limit: f64, distortion: [f64; 4]) -> Option<[f64; 2]> {
    let (theta, [x, y]) = angle_off_axis(p)?;
    let radius = distorted(theta, distortion).0;
    (theta <= limit).then_some([radius * x, radius * y])
}

/// The ray of `(x', y')`.
pub(super) fn back_project([x, y]: [f64; 2], limit: f64, distortion: [f64; 4]) -> Option<Vector> {
    let theta = invert(x.hypot(y), limit, |theta| distorted(theta, distortion))?;
    Some(direction(theta, [x, y]))
}

/// `theta_d` and its slope.
fn distorted(theta: f64, [k1, k2, k3, k4]: [f64; 4]) -> (f64, f64) {
    polynomial(&[0.0, 1.0, 0.0, k1, 0.0, k2, 0.0, k3, 0.0, k4], theta)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    #[test]
    fn numbers_worked_out_by_hand() {
        // 45 degrees to the right and down along the diagonal: theta_d is shared by both axes alike.
        let distortion = [0.05, -0.01, 0.002, -0.0003];
        let square = FRAC_PI_4 * FRAC_PI_4;
        let factor =
            1.0 + 0.05 * square - 0.01 * square.powi(2) + 0.002 * square.powi(3) - 0.0003 * square.powi(4);
        let expected = FRAC_PI_4 * factor / 2.0_f64.sqrt();
        let found = project(&Point::new(1.0, 1.0, 2.0_f64.sqrt()), limit(distortion), distortion).unwrap();
        assert!((found[0] - expected).abs() < 1e-14 && (found[1] - expected).abs() < 1e-14);
    }

    #[test]
    fn it_sees_beyond_a_right_angle_and_not_beyond_the_fold() {
        assert_eq!(limit([0.0; 4]), PI);
        let [x, y] = project(&Point::new(2.0, 0.0, -2.0), PI, [0.0; 4]).unwrap();
        assert!((x - 3.0 * FRAC_PI_4).abs() < 1e-14 && y == 0.0);
        // theta - 0.1 theta^3 turns at sqrt(1 / 0.3) = 104.6 degrees.
        let folding = [-0.1, 0.0, 0.0, 0.0];
        let limit = limit(folding);
        assert!((limit - (1.0_f64 / 0.3).sqrt()).abs() < 1e-12 && limit > FRAC_PI_2);
        assert!(project(&Point::new(1.0, 0.0, -0.2), limit, folding).is_some());
        assert!(project(&Point::new(1.0, 0.0, -0.3), limit, folding).is_none());
        assert!(back_project([distorted(limit, folding).0 + 1e-9, 0.0], limit, folding).is_none());
    }
}
