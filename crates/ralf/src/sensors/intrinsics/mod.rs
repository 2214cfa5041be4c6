//! Camera models: how a direction in the optical frame becomes a pixel, and a pixel a direction.
//!
//! Pixels are `[u, v]`, column and row, with the centres of pixels at integers, so an image covers
//! `-0.5 <= u < width - 0.5`. Models know no border: they hold outside the image as well, up to the angle off the axis
//! at which their polynomial folds back ([`Intrinsics::limit`]). Beyond it nothing is seen, so no far ray returns into
//! the image. A pinhole sees nothing behind itself; a fisheye may, except straight behind, where no direction leads
//! outward.

mod check;
mod kannala_brandt;
mod pinhole;
mod radial;
mod scaramuzza;

use crate::space::{Point, Vector};
use nalgebra::UnitVector3;
use scaramuzza::Scaramuzza;

/// A camera model with its parameters, in pixels. Pixel centres lie at integers.
#[derive(Debug, Clone, PartialEq)]
pub enum Intrinsics {
    /// Pinhole with Brown-Conrady distortion k1 k2 p1 p2 k3.
    Pinhole {
        /// Focal lengths.
        focal: [f64; 2],
        /// Principal point.
        center: [f64; 2],
        /// k1 k2 p1 p2 k3.
        distortion: [f64; 5],
    },
    /// Kannala-Brandt, as OpenCV's fisheye module has it.
    KannalaBrandt {
        /// Focal lengths.
        focal: [f64; 2],
        /// Principal point.
        center: [f64; 2],
        /// k1 k2 k3 k4.
        distortion: [f64; 4],
    },
    /// Scaramuzza's polynomial, as OCamCalib writes it: axes X down, Y right, Z backward.
    Scaramuzza {
        /// Radius (px) to z, ascending; empty where only the inverse is known.
        polynomial: Vec<f64>,
        /// Angle (rad) to radius (px), ascending.
        inverse_polynomial: Vec<f64>,
        /// Row and column, from 0.
        center: [f64; 2],
        /// c, d, e.
        affine: [f64; 3],
    },
}

impl Intrinsics {
    /// The largest angle off the axis that the model sees, rad: where its radius stops growing, a right angle at most
    /// for a pinhole.
    pub fn limit(&self) -> f64 {
        match *self {
            Self::Pinhole { distortion, .. } => pinhole::limit(distortion),
            Self::KannalaBrandt { distortion, .. } => kannala_brandt::limit(distortion),
            Self::Scaramuzza { .. } => self.scaramuzza().map_or(0.0, Scaramuzza::limit),
        }
    }

    /// The pixel `[u, v]` of a point in the optical frame, inside the image or not; `None` where it isn't seen.
    ///
    /// ```
    /// use ralf::sensors::Intrinsics;
    /// use ralf::space::Point;
    /// let lens = Intrinsics::Pinhole { focal: [500.0, 500.0], center: [319.5, 239.5], distortion: [0.0; 5] };
    /// assert_eq!(lens.project(&Point::new(1.0, 0.5, 2.0)), Some([569.5, 364.5]));
    /// assert_eq!(lens.project(&Point::new(1.0, 0.5, -2.0)), None);
    /// ```
    pub fn project(&self, p: &Point) -> Option<[f64; 2]> {
        self.project_within(p, self.limit())
    }

    /// [`Self::project`] with the limit ([`Self::limit`], rad) at hand, for many points: finding it costs as much as
    /// projecting dozens.
    pub fn project_within(&self, p: &Point, limit: f64) -> Option<[f64; 2]> {
        let pixel = match *self {
            Self::Pinhole { focal, center, distortion } => {
                scaled(focal, center, pinhole::project(p, limit, distortion)?)
            }
            Self::KannalaBrandt { focal, center, distortion } => {
                scaled(focal, center, kannala_brandt::project(p, limit, distortion)?)
            }
            Self::Scaramuzza { .. } => self.scaramuzza()?.project(p, limit)?,
        };
        pixel.iter().all(|value| value.is_finite()).then_some(pixel)
    }

    /// The direction in the optical frame that a pixel `[u, v]` looks in; `None` where no ray leads to it.
    pub fn back_project(&self, pixel: [f64; 2]) -> Option<UnitVector3<f64>> {
        self.back_project_within(pixel, self.limit())
    }

    /// The directions that all pixels of an image look in, row by row.
    pub fn rays(&self, width: usize, height: usize) -> Vec<Option<UnitVector3<f64>>> {
        let limit = self.limit();
        let pixels = (0..height).flat_map(|v| (0..width).map(move |u| [u as f64, v as f64]));
        pixels.map(|pixel| self.back_project_within(pixel, limit)).collect()
    }

    /// [`Self::back_project`] with the limit at hand, for many pixels.
    fn back_project_within(&self, pixel: [f64; 2], limit: f64) -> Option<UnitVector3<f64>> {
        let ray = match *self {
            Self::Pinhole { focal, center, distortion } => {
                pinhole::back_project(unscaled(focal, center, pixel), limit, distortion)?
            }
            Self::KannalaBrandt { focal, center, distortion } => {
                kannala_brandt::back_project(unscaled(focal, center, pixel), limit, distortion)?
            }
            Self::Scaramuzza { .. } => self.scaramuzza()?.back_project(pixel, limit)?,
        };
        ray.iter().all(|value| value.is_finite()).then(|| UnitVector3::new_normalize(ray))
    }

    /// Where the axis meets the image, `[u, v]`.
    pub fn center(&self) -> [f64; 2] {
        match *self {
            Self::Pinhole { center, .. } | Self::KannalaBrandt { center, .. } => center,
            Self::Scaramuzza { center: [row, column], .. } => [column, row],
        }
    }

    /// Pixels per radian on the axis, along the columns: `fx`; for Scaramuzza's model `|a0|`, or where only the inverse
    /// polynomial is known its slope `d rho / d theta` on the axis, to which `|a0|` is equal.
    pub fn focal_on_axis(&self) -> f64 {
        match *self {
            Self::Pinhole { focal, .. } | Self::KannalaBrandt { focal, .. } => focal[0],
            Self::Scaramuzza { .. } => self.scaramuzza().map_or(0.0, Scaramuzza::focal),
        }
    }

    /// The largest distance (px) between a pixel and the projection of its own direction, over a grid that covers an
    /// image and its border with `lines` by `lines` points (at least 2 by 2).
    ///
    /// Pixels without a direction are left out, and `None` means that there is no other; a pixel whose direction isn't
    /// seen makes the distance infinite. Scaramuzza's two polynomials are separate fits: here it is seen how well they
    /// agree.
    pub fn round_trip_error(&self, width: usize, height: usize, lines: usize) -> Option<f64> {
        let limit = self.limit();
        let steps = lines.max(2) - 1;
        let at = |size: usize, step: usize| size as f64 * step as f64 / steps as f64 - 0.5;
        let pixels = (0..=steps).flat_map(|row| (0..=steps).map(move |column| [column, row]));
        let errors = pixels.filter_map(|[column, row]| {
            let [u, v] = [at(width, column), at(height, row)];
            let direction = self.back_project_within([u, v], limit)?;
            let back = self.project_within(&Point::from(direction.into_inner()), limit);
            Some(back.map_or(f64::INFINITY, |back| (back[0] - u).hypot(back[1] - v)))
        });
        errors.reduce(f64::max)
    }

    fn scaramuzza(&self) -> Option<Scaramuzza<'_>> {
        match self {
            Self::Scaramuzza { polynomial, inverse_polynomial, center, affine } => {
                Some(Scaramuzza { polynomial, inverse_polynomial, center: *center, affine: *affine })
            }
            Self::Pinhole { .. } | Self::KannalaBrandt { .. } => None,
        }
    }
}

fn scaled(focal: [f64; 2], center: [f64; 2], [x, y]: [f64; 2]) -> [f64; 2] {
    [focal[0] * x + center[0], focal[1] * y + center[1]]
}

fn unscaled(focal: [f64; 2], center: [f64; 2], [u, v]: [f64; 2]) -> [f64; 2] {
    [(u - center[0]) / focal[0], (v - center[1]) / focal[1]]
}

/// The angle between a point's ray and the axis, rad, and the unit vector (x, y) that leads to it from the axis: (0, 0)
/// on the axis. `None` for the centre itself, straight behind it, and what isn't finite.
fn angle_off_axis(p: &Point) -> Option<(f64, [f64; 2])> {
    let off = p.x.hypot(p.y);
    if off == 0.0 {
        return (p.z > 0.0).then_some((0.0, [0.0, 0.0]));
    }
    (off.is_finite() && p.z.is_finite()).then(|| (off.atan2(p.z), [p.x / off, p.y / off]))
}

/// The ray at an angle off the axis towards (x, y) of any length; the axis where that is (0, 0).
fn direction(theta: f64, [x, y]: [f64; 2]) -> Vector {
    let off = x.hypot(y);
    if off > 0.0 {
        return Vector::new(theta.sin() * x / off, theta.sin() * y / off, theta.cos());
    }
    Vector::z()
}

#[cfg(test)]
mod tests;
