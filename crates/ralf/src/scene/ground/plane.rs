//! A plane that can be a ground.

use crate::config::GroundConfig;
use crate::space::{Point, Vector};
use nalgebra::Matrix3;

/// The points `p` with `normal . p = offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// The normal, of unit length, upward.
    pub normal: Vector,
    /// Distance of the plane from the frame's origin along the normal, m.
    pub offset: f64,
}

impl Plane {
    /// z = 0.
    pub const HORIZONTAL: Self = Self { normal: Vector::new(0.0, 0.0, 1.0), offset: 0.0 };

    /// The plane through a point with a normal of any length and sign. `None` where the normal has no direction.
    pub fn through(p: &Point, normal: Vector) -> Option<Self> {
        let normal = normal.try_normalize(1e-12)?;
        let normal = if normal.z < 0.0 { -normal } else { normal };
        Some(Self { normal, offset: normal.dot(&p.coords) })
    }

    /// Height of a point above the plane along the normal, m.
    pub fn height(&self, p: &Point) -> f64 {
        self.normal.dot(&p.coords) - self.offset
    }

    /// Whether the settings allow this plane to be the ground: neither too steep nor too far from the vehicle's origin.
    pub(super) fn is_admissible(&self, config: &GroundConfig) -> bool {
        self.normal.z >= config.max_tilt_deg.to_radians().cos() && self.offset.abs() <= config.max_offset
    }
}

/// The sums from which the plane of orthogonal least squares follows.
#[derive(Debug, Clone, Default)]
pub(super) struct PlaneSums {
    count: f64,
    sum: Vector,
    /// Of xx, yy and zz.
    squares: Vector,
    /// Of xy, yz and zx.
    products: Vector,
}

impl PlaneSums {
    pub(super) fn add(&mut self, p: Vector) {
        *self = self.with(p);
    }

    /// With one point more.
    #[inline]
    pub(super) fn with(&self, p: Vector) -> Self {
        Self {
            count: self.count + 1.0,
            sum: self.sum + p,
            squares: self.squares + p.component_mul(&p),
            products: self.products + p.component_mul(&p.yzx()),
        }
    }

    /// The plane whose summed squared distances from the points are least. `None` for fewer than three points.
    pub(super) fn plane(&self) -> Option<Plane> {
        if self.count < 3.0 {
            return None;
        }
        let mean = self.sum / self.count;
        let ([xx, yy, zz], [xy, yz, zx]) = (self.squares.into(), self.products.into());
        let squares: Matrix3<f64> = Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz);
        let covariance = squares / self.count - mean * mean.transpose();
        let eigen = covariance.symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        Plane::through(&Point::from(mean), eigen.eigenvectors.column(least).into_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn least_squares_finds_the_plane_of_its_points(
            (a, b, c) in (-0.2..0.2, -0.2..0.2, -0.4..0.4),
            places in prop::collection::vec((-50.0..50.0, -50.0..50.0), 10..50),
        ) {
            let mut sums = PlaneSums::default();
            for (x, y) in &places {
                sums.add(Vector::new(*x, *y, a * x + b * y + c));
            }
            let plane = sums.plane().unwrap();
            for (x, y) in places {
                prop_assert!(plane.height(&Point::new(x, y, a * x + b * y + c)).abs() < 1e-6);
            }
            prop_assert!((plane.height(&Point::new(0.0, 0.0, c + 5.0)) - 5.0 * plane.normal.z).abs() < 1e-6);
        }
    }

    #[test]
    fn two_points_are_no_plane() {
        let mut sums = PlaneSums::default();
        sums.add(Vector::x());
        sums.add(Vector::y());
        assert!(sums.plane().is_none());
    }
}
