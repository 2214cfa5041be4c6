//! Transforms and spherical coordinates (docs/method.md, section 1); the parent says which frames there are.

use nalgebra::{Isometry3, Matrix3, Point3, Quaternion, Translation3, UnitQuaternion, Vector3};
use std::f64::consts::{FRAC_PI_2, PI};

/// A rigid transform, named by its direction: `a_from_b` takes points of frame b to frame a.
pub type Transform = Isometry3<f64>;
/// A point, in the frame that its name or documentation gives, m.
pub type Point = Point3<f64>;
/// A displacement, in the frame that its name or documentation gives, m.
pub type Vector = Vector3<f64>;

/// Where a point that a sensor measured lies in the frame that the transform leads to, m.
pub fn placed(there_from_sensor: &Transform, point: &[f32; 3]) -> Point {
    there_from_sensor * Point::from(point.map(f64::from))
}

/// Spherical coordinates in the frame of the sensor that measured them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spherical {
    /// Distance `r` from the sensor, m.
    pub range: f64,
    /// `phi = atan2(y, x)`, rad, positive to the left.
    pub azimuth: f64,
    /// `theta = asin(z / r)`, rad, positive up.
    pub elevation: f64,
}

impl Spherical {
    /// The spherical coordinates of a point in the sensor's frame. The origin has elevation 0.
    ///
    /// ```
    /// use ralf::space::{Point, Spherical};
    /// let s = Spherical::from_cartesian(&Point::new(0.0, 2.0, 0.0));
    /// assert_eq!((s.range, s.azimuth, s.elevation), (2.0, std::f64::consts::FRAC_PI_2, 0.0));
    /// ```
    pub fn from_cartesian(p: &Point) -> Self {
        let range = p.coords.norm();
        let elevation = if range > 0.0 { (p.z / range).clamp(-1.0, 1.0).asin() } else { 0.0 };
        Self { range, azimuth: p.y.atan2(p.x), elevation: if range.is_nan() { f64::NAN } else { elevation } }
    }

    /// The same place in angles of at most half a turn, and a quarter of one up and down: radars tell azimuths of 0 to
    /// 2 pi, too. What is such already, or isn't finite, keeps its bits; `position` is the place.
    pub(crate) fn principal(self, position: &Point) -> Self {
        // Half a turn in 32 bits is a little more than half a turn.
        let is_other =
            self.range < 0.0 || self.azimuth.abs() > PI + 1e-6 || self.elevation.abs() > FRAC_PI_2 + 1e-6;
        if is_other { Self::from_cartesian(position) } else { self }
    }

    /// The point in the sensor's frame.
    pub fn to_cartesian(self) -> Point {
        let (sin_phi, cos_phi) = self.azimuth.sin_cos();
        let (sin_theta, cos_theta) = self.elevation.sin_cos();
        Point::new(self.range * cos_theta * cos_phi, self.range * cos_theta * sin_phi, self.range * sin_theta)
    }

    /// `J`: the partial derivatives of [`Self::to_cartesian`] by range, azimuth and elevation, one column each.
    pub fn jacobian(self) -> Matrix3<f64> {
        let r = self.range;
        let (sin_phi, cos_phi) = self.azimuth.sin_cos();
        let (sin_theta, cos_theta) = self.elevation.sin_cos();
        Matrix3::new(
            cos_theta * cos_phi,
            -r * cos_theta * sin_phi,
            -r * sin_theta * cos_phi,
            cos_theta * sin_phi,
            r * cos_theta * cos_phi,
            -r * sin_theta * sin_phi,
            sin_theta,
            0.0,
            r * cos_theta,
        )
    }
}

/// Refuses, with what was expected and found, a transform that isn't rigid: numbers that aren't finite, and rotations
/// whose quaternion's length isn't within 1 % of 1.
pub fn check_rigid(transform: &Transform) -> Result<(), String> {
    let length = transform.rotation.quaternion().norm();
    let numbers = transform.translation.vector.iter().chain([&length]);
    if let Some(found) = numbers.into_iter().find(|value| !value.is_finite()) {
        return Err(format!("finite numbers, found {found}"));
    }
    if (length - 1.0).abs() < LENGTH_WITHIN {
        Ok(())
    } else {
        Err(format!("a rotation of length 1, found {length}"))
    }
}

/// A quaternion that was written with few decimals is a rotation all the same.
const LENGTH_WITHIN: f64 = 0.01;

/// A transform from a translation (m) and a quaternion in the order x, y, z, w.
///
/// `None` unless all numbers are finite and the quaternion's length is within 1 % of 1; it is then normalised.
pub fn transform_from_parts(translation: [f64; 3], quaternion_xyzw: [f64; 4]) -> Option<Transform> {
    let [x, y, z, w] = quaternion_xyzw;
    let quaternion = Quaternion::new(w, x, y, z);
    let usable = translation.iter().all(|v| v.is_finite()) && (quaternion.norm() - 1.0).abs() < LENGTH_WITHIN;
    usable.then(|| {
        Transform::from_parts(Translation3::from(translation), UnitQuaternion::from_quaternion(quaternion))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn spherical() -> impl Strategy<Value = Spherical> {
        (0.5..200.0, -3.1..3.1, -1.5..1.5).prop_map(|(range, azimuth, elevation)| Spherical {
            range,
            azimuth,
            elevation,
        })
    }

    proptest! {
        #[test]
        fn cartesian_and_back(s in spherical()) {
            let back = Spherical::from_cartesian(&s.to_cartesian());
            prop_assert!((back.range - s.range).abs() < 1e-9);
            prop_assert!((back.azimuth - s.azimuth).abs() < 1e-9);
            prop_assert!((back.elevation - s.elevation).abs() < 1e-7);
        }

        #[test]
        fn another_turn_or_a_range_below_zero_is_the_same_place(s in spherical()) {
            let (half, whole) = (PI, 2.0 * PI);
            let others = [
                Spherical { azimuth: s.azimuth + whole, ..s },
                Spherical { azimuth: s.azimuth - whole, ..s },
                Spherical { range: -s.range, azimuth: s.azimuth + half, elevation: -s.elevation },
            ];
            for other in others {
                let found = other.principal(&other.to_cartesian());
                prop_assert!((found.range - s.range).abs() < 1e-9);
                prop_assert!((found.azimuth - s.azimuth).abs() < 1e-9);
                prop_assert!((found.elevation - s.elevation).abs() < 1e-7);
            }
            prop_assert_eq!(s.principal(&s.to_cartesian()), s);
        }

        #[test]
        fn jacobian_is_the_finite_difference(s in spherical()) {
            let step = 1e-6;
            let shifted = [
                Spherical { range: s.range + step, ..s },
                Spherical { azimuth: s.azimuth + step, ..s },
                Spherical { elevation: s.elevation + step, ..s },
            ];
            for (column, moved) in shifted.into_iter().enumerate() {
                let difference = (moved.to_cartesian() - s.to_cartesian()) / step;
                prop_assert!((difference - s.jacobian().column(column)).norm() < 1e-3);
            }
        }
    }

    #[test]
    fn a_quaternion_of_length_zero_is_no_rotation() {
        assert!(transform_from_parts([0.0; 3], [0.0; 4]).is_none());
        assert!(transform_from_parts([f64::NAN, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]).is_none());
        assert!(transform_from_parts([1.0, 2.0, 3.0], [0.0, 0.0, 0.0, 1.001]).is_some());
    }
}
