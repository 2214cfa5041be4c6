//! Refusing parameters that no camera has.

use super::{Intrinsics, Scaramuzza};

impl Intrinsics {
    /// Refuses, with what was expected and found, parameters that no camera with an image of this size (px) has.
    ///
    /// Besides numbers that aren't finite and focal lengths that aren't positive, these are polynomials that fold back
    /// before they reach the border: the point of the image's border that is nearest to the centre must have a
    /// direction.
    pub fn check(&self, width: usize, height: usize) -> Result<(), String> {
        if width < 2 || height < 2 {
            return Err(format!("an image of at least 2 x 2 px, found {width} x {height}"));
        }
        self.check_numbers()?;
        self.scaramuzza().map_or(Ok(()), check_scaramuzza)?;
        let [u, v] = self.nearest_border(width, height);
        match self.back_project([u, v]) {
            Some(_) => Ok(()),
            None => Err(format!(
                "a polynomial that reaches the image's border, found one that folds back at {:.1} deg, before the \
                 column {u} and row {v} of an image of {width} x {height} px",
                self.limit().to_degrees()
            )),
        }
    }

    /// Refuses, with what was expected and found, numbers that aren't finite, and focal lengths that aren't above 0.
    pub(in crate::sensors) fn check_numbers(&self) -> Result<(), String> {
        if let Some(found) = self.parameters().iter().find(|value| !value.is_finite()) {
            return Err(format!("finite camera parameters, found {found}"));
        }
        match self {
            Self::Pinhole { focal, .. } | Self::KannalaBrandt { focal, .. } => {
                let odd = focal.iter().find(|value| **value <= 0.0);
                odd.map_or(Ok(()), |found| Err(format!("focal lengths above 0, found {found}")))
            }
            Self::Scaramuzza { .. } => Ok(()),
        }
    }

    /// The point of an image's border that is nearest to the centre.
    fn nearest_border(&self, width: usize, height: usize) -> [f64; 2] {
        let [right, bottom] = [width as f64 - 0.5, height as f64 - 0.5];
        let [u, v] = self.center();
        let [inside_u, inside_v] = [u.clamp(-0.5, right), v.clamp(-0.5, bottom)];
        let corners = [[right, inside_v], [inside_u, -0.5], [inside_u, bottom]];
        let distance = |point: &[f64; 2]| (point[0] - u).hypot(point[1] - v);
        corners.into_iter().fold([-0.5, inside_v], |nearest, point| {
            if distance(&point) < distance(&nearest) { point } else { nearest }
        })
    }

    fn parameters(&self) -> Vec<f64> {
        match self {
            Self::Pinhole { focal, center, distortion } => [&focal[..], center, distortion].concat(),
            Self::KannalaBrandt { focal, center, distortion } => [&focal[..], center, distortion].concat(),
            Self::Scaramuzza { polynomial, inverse_polynomial, center, affine } => {
                [polynomial, inverse_polynomial, &center[..], affine].concat()
            }
        }
    }
}

fn check_scaramuzza(lens: Scaramuzza<'_>) -> Result<(), String> {
    if lens.inverse_polynomial.is_empty() {
        return Err("an inverse polynomial, found none".into());
    }
    if let Some(a0) = lens.polynomial.first().filter(|a0| **a0 >= 0.0) {
        return Err(format!("a0 below 0, for the axes are X down, Y right, Z backward, found {a0}"));
    }
    if lens.focal() <= 0.0 {
        return Err(format!(
            "an inverse polynomial that rises on the axis, found a slope of {}",
            lens.focal()
        ));
    }
    if lens.determinant() <= 0.0 {
        return Err(format!("affine parameters with c - d e above 0, found {}", lens.determinant()));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pinhole(focal: [f64; 2], distortion: [f64; 5]) -> Intrinsics {
        Intrinsics::Pinhole { focal, center: [319.5, 239.5], distortion }
    }

    fn scaramuzza(polynomial: &[f64], inverse_polynomial: &[f64], affine: [f64; 3]) -> Intrinsics {
        let [polynomial, inverse_polynomial] = [polynomial.to_vec(), inverse_polynomial.to_vec()];
        Intrinsics::Scaramuzza { polynomial, inverse_polynomial, center: [239.5, 319.5], affine }
    }

    fn refusal(intrinsics: &Intrinsics) -> String {
        intrinsics.check(640, 480).unwrap_err()
    }

    #[test]
    fn usual_cameras_pass() {
        assert_eq!(pinhole([500.0; 2], [-0.3, 0.1, 1e-3, 1e-3, 0.0]).check(640, 480), Ok(()));
        assert_eq!(scaramuzza(&[-300.0], &[471.0, 300.0], [1.0, 0.0, 0.0]).check(640, 480), Ok(()));
        assert_eq!(scaramuzza(&[], &[471.0, 300.0], [1.0, 0.0, 0.0]).check(640, 480), Ok(()));
    }

    #[test]
    fn what_no_camera_has_is_named() {
        assert!(refusal(&pinhole([500.0, 0.0], [0.0; 5])).contains("focal lengths above 0, found 0"));
        assert!(refusal(&pinhole([500.0, f64::NAN], [0.0; 5])).contains("found NaN"));
        assert!(refusal(&scaramuzza(&[-300.0], &[], [1.0, 0.0, 0.0])).contains("inverse polynomial"));
        assert!(refusal(&scaramuzza(&[300.0], &[471.0, 300.0], [1.0, 0.0, 0.0])).contains("a0 below 0"));
        assert!(refusal(&scaramuzza(&[], &[471.0, -300.0], [1.0, 0.0, 0.0])).contains("-300"));
        assert!(refusal(&scaramuzza(&[], &[471.0, 300.0], [0.0; 3])).contains("affine"));
        assert!(pinhole([500.0; 2], [0.0; 5]).check(0, 480).unwrap_err().contains("0 x 480"));
    }

    #[test]
    fn a_polynomial_that_folds_back_inside_the_image_is_refused() {
        // r - r^3 turns at r = 0.577, at a radius of 0.385: 192 px at f = 500, while the border is 240 px away.
        let folding = pinhole([500.0; 2], [-1.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(refusal(&folding).contains("folds back at 30.0 deg"), "{}", refusal(&folding));
        assert_eq!(pinhole([700.0; 2], [-1.0, 0.0, 0.0, 0.0, 0.0]).check(640, 480), Ok(()));
    }

    #[test]
    fn the_border_is_sought_from_a_centre_outside_too() {
        let at = |center| Intrinsics::KannalaBrandt { focal: [300.0; 2], center, distortion: [0.0; 4] };
        assert_eq!(at([319.5, 100.0]).nearest_border(640, 480), [319.5, -0.5]);
        assert_eq!(at([600.0, 240.0]).nearest_border(640, 480), [639.5, 240.0]);
        assert_eq!(at([700.0, -40.0]).nearest_border(640, 480), [639.5, -0.5]);
    }
}
