//! The one distance that all branches share (paper, algorithm 1 and equation 4; docs/method.md, section 3).

use crate::space::{Point, Vector};
use nalgebra::Matrix3;

/// `eps`, m^2.
const EPSILON: f64 = 1e-6;
/// Points closer than this are the same: `m = 0`, m.
const SAME_PLACE: f64 = 1e-9;

/// The uncertainty of a point, as a square root `L` of its covariance: `Sigma = L L^T`, in the frame of the point.
///
/// That `h^T Sigma h / |h|^2` is the paper's sum of squared partial derivatives of `d = |h|` follows in two lines: the
/// gradient of `d` by the point is `h / |h|`, so by a measured quantity `a` it is `dd/da = (h / |h|) . dp/da`; and
/// `Sigma` is the sum over `a` of `(dp/da)(dp/da)^T sigma_a^2`, so that `h^T Sigma h / |h|^2` is the sum of
/// `(dd/da)^2 sigma_a^2`. The columns of `L` are the `(dp/da) sigma_a`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spread {
    /// Along one ray only: `s u` of a LiDAR or camera point.
    Ray(Vector),
    /// A column per measured coordinate: `R J diag(s)` of a radar detection.
    Axes(Matrix3<f64>),
}

impl Spread {
    /// `h^T Sigma h`.
    #[inline]
    fn along(&self, h: &Vector) -> f64 {
        match self {
            Self::Ray(ray) => ray.dot(h).powi(2),
            Self::Axes(axes) => axes.tr_mul(h).norm_squared(),
        }
    }
}

/// A point that a detection is compared with.
#[derive(Debug, Clone, Copy)]
pub struct Reference {
    /// `q_l`, in the vehicle frame at the radar scan's time, m.
    pub position: Point,
    /// `Sigma_l`, in the same frame.
    pub spread: Spread,
}

/// `m(i, l) = |h| / sqrt(h^T (Sigma_i + Sigma_l) h / |h|^2 + eps)`, dimensionless.
///
/// ```
/// use nalgebra::{Matrix3, Vector3};
/// use ralf::scene::{Spread, mismatch};
/// // 2 m apart, each end uncertain by 0.3 and 0.4 m along the line between: 2 / 0.5 = 4 standard deviations.
/// let detection = Spread::Axes(Matrix3::from_diagonal(&Vector3::new(0.3, 9.0, 9.0)));
/// let reference = Spread::Ray(Vector3::new(0.4, 0.0, 0.0));
/// assert!((mismatch(&Vector3::new(2.0, 0.0, 0.0), &detection, &reference) - 4.0).abs() < 1e-4);
/// ```
#[inline]
pub fn mismatch(h: &Vector, detection: &Spread, reference: &Spread) -> f64 {
    let distance_squared = h.norm_squared();
    if distance_squared < SAME_PLACE * SAME_PLACE {
        return 0.0;
    }
    let variance = (detection.along(h) + reference.along(h)) / distance_squared;
    (distance_squared / (variance + EPSILON)).sqrt()
}

/// Farther apart than this, m, two points have a mismatch above the cap, if their variances in no direction sum up to
/// more than the given one, m^2.
pub fn reach_of_cap(cap: f64, variance: f64) -> f64 {
    // Searches round to `f32`.
    const ROUNDING: f64 = 1.001;
    cap * (variance + EPSILON).sqrt() * ROUNDING
}

/// `w = exp(-beta d)`.
pub fn plausibility(beta: f64, d: f64) -> f64 {
    (-beta * d).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::Spherical;
    use nalgebra::{Rotation3, Vector3};
    use proptest::prelude::*;

    fn vector(limit: f64) -> impl Strategy<Value = Vector> {
        prop::array::uniform3(-limit..limit).prop_map(|[x, y, z]| Vector3::new(x, y, z))
    }

    proptest! {
        /// The paper's equation 4, its partial derivatives by finite differences.
        #[test]
        fn is_the_papers_error_propagation(
            (range, azimuth, elevation) in (1.0..80.0, -1.4..1.4, -0.4..0.4),
            mounting in vector(3.0),
            offset in vector(20.0).prop_filter("apart", |v| v.norm() > 0.5),
            ray in vector(1.0).prop_filter("a ray", |v| v.norm() > 0.1).prop_map(|v| v.normalize()),
            sigmas in prop::array::uniform3(0.001..0.3),
            sigma_lidar in 0.001..0.2,
        ) {
            let measured = Spherical { range, azimuth, elevation };
            let vehicle_from_radar = Rotation3::new(mounting);
            let p = vehicle_from_radar * measured.to_cartesian();
            let q = p + offset;
            let d = |moved: Spherical, along_ray: f64| {
                (vehicle_from_radar * moved.to_cartesian() - (q + ray * along_ray)).norm()
            };
            let step = 1e-6;
            let derivatives = [
                d(Spherical { range: range + step, ..measured }, 0.0) - d(Spherical { range: range - step, ..measured }, 0.0),
                d(Spherical { azimuth: azimuth + step, ..measured }, 0.0) - d(Spherical { azimuth: azimuth - step, ..measured }, 0.0),
                d(Spherical { elevation: elevation + step, ..measured }, 0.0) - d(Spherical { elevation: elevation - step, ..measured }, 0.0),
                d(measured, step) - d(measured, -step),
            ];
            let sigmas_all = [sigmas[0], sigmas[1], sigmas[2], sigma_lidar];
            let variance: f64 = derivatives.iter().zip(sigmas_all).map(|(dd, s): (&f64, f64)| (dd / (2.0 * step) * s).powi(2)).sum();
            let expected = offset.norm() / (variance + EPSILON).sqrt();

            let axes = vehicle_from_radar.matrix() * measured.jacobian() * Matrix3::from_diagonal(&Vector3::from(sigmas));
            let found = mismatch(&(p - q), &Spread::Axes(axes), &Spread::Ray(ray * sigma_lidar));
            prop_assert!((found - expected).abs() < 1e-4 * expected, "{found} {expected}");
        }
    }

    #[test]
    fn the_same_place_is_no_mismatch() {
        let nothing = Spread::Ray(Vector::zeros());
        assert_eq!(mismatch(&Vector::zeros(), &nothing, &nothing), 0.0);
        // Without any uncertainty epsilon alone is left: 1 m is 1000 of its roots.
        assert!((mismatch(&Vector::x(), &nothing, &nothing) - 1000.0).abs() < 1e-9);
    }

    #[test]
    fn plausibility_falls_from_one() {
        assert_eq!(plausibility(0.2, 0.0), 1.0);
        assert!((plausibility(0.2, 5.0) - (-1.0f64).exp()).abs() < 1e-15);
    }
}
