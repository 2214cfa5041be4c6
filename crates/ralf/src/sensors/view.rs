//! Straight (pinhole) views cut out of a camera's image (docs/method.md, section 5), and how points are seen in them.

use super::bounds::check_size;
use crate::space::{Point, Vector};
use nalgebra::UnitQuaternion;
use std::f64::consts::PI;

/// A straight (pinhole) view, as configured: finite angles, a field of view below pi, at least one pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Turned by this about the camera's vertical, rad, positive to the left; applied first.
    pub yaw: f64,
    /// Then about the horizontal that was turned along, rad, positive down: as a pan-tilt head does it.
    pub pitch: f64,
    /// Full horizontal angle, rad.
    pub horizontal_fov: f64,
    /// px.
    pub width: usize,
    /// px.
    pub height: usize,
}

/// A straight view ready for use: square pixels, `u = f x / z + c_u`, `v = f y / z + c_v` in its own optical frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StraightView {
    /// px.
    pub width: usize,
    /// px.
    pub height: usize,
    /// `f`, px.
    pub focal: f64,
    /// `(c_u, c_v)`: the middle of the view.
    pub center: [f64; 2],
    /// From the view's optical frame (x right, y down, z forward) to the camera's; they share the projection centre.
    pub camera_from_view: UnitQuaternion<f64>,
}

/// Where a point appears in a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewPoint {
    /// Column and row, sub-pixel.
    pub pixel: [f64; 2],
    /// `Z`: along the view's optical axis, m, above 0.
    pub depth: f64,
}

impl View {
    /// Refuses, with what was expected and found, a view that shows nothing.
    pub(super) fn check(&self) -> Result<(), String> {
        check_size("a view", self.width, self.height)?;
        if let Some(found) = [self.yaw, self.pitch].iter().find(|angle| !angle.is_finite()) {
            return Err(format!("finite angles of a view, found {found}"));
        }
        if self.horizontal_fov > 0.0 && self.horizontal_fov < PI {
            return Ok(());
        }
        let found = self.horizontal_fov.to_degrees();
        Err(format!("a view's horizontal field above 0 and below 180 deg, found {found}"))
    }
}

impl From<&View> for StraightView {
    /// `f = width / 2 / tan(horizontal_fov / 2)`.
    fn from(view: &View) -> Self {
        let yaw = UnitQuaternion::from_axis_angle(&Vector::y_axis(), -view.yaw);
        let pitch = UnitQuaternion::from_axis_angle(&Vector::x_axis(), -view.pitch);
        let focal = view.width as f64 / 2.0 / (view.horizontal_fov / 2.0).tan();
        Self { camera_from_view: yaw * pitch, ..Self::along_axis(view.width, view.height, focal) }
    }
}

impl StraightView {
    pub(super) fn along_axis(width: usize, height: usize, focal: f64) -> Self {
        let center = [(width as f64 - 1.0) / 2.0, (height as f64 - 1.0) / 2.0];
        Self { width, height, focal, center, camera_from_view: UnitQuaternion::identity() }
    }

    /// Where a point of the camera's optical frame appears; `None` unless it lies before the view and has a nearest
    /// pixel (`-0.5 <= u < width - 0.5`, and so for v).
    pub fn project(&self, p_camera: &Point) -> Option<ViewPoint> {
        self.project_own(&(self.camera_from_view.inverse() * p_camera))
    }

    /// [`Self::project`] for a point of the view's own optical frame.
    pub(crate) fn project_own(&self, p: &Point) -> Option<ViewPoint> {
        if p.z.is_nan() || p.z <= 0.0 {
            return None;
        }
        let pixel = [self.focal * p.x / p.z + self.center[0], self.focal * p.y / p.z + self.center[1]];
        self.pixel_index(pixel).is_some().then_some(ViewPoint { pixel, depth: p.z })
    }

    /// The place of the nearest pixel, row by row; `None` outside. Halfway between two it is the right or lower one.
    pub(crate) fn pixel_index(&self, [u, v]: [f64; 2]) -> Option<usize> {
        let inside = |value: f64, size: usize| value >= -0.5 && value < size as f64 - 0.5;
        // A sum may round up to the next whole number.
        let nearest = |value: f64, size: usize| ((value + 0.5) as usize).min(size - 1);
        (inside(u, self.width) && inside(v, self.height))
            .then(|| nearest(v, self.height) * self.width + nearest(u, self.width))
    }

    /// The ray of a pixel in the view's own optical frame, with z = 1.
    pub fn ray(&self, [u, v]: [f64; 2]) -> Vector {
        Vector::new((u - self.center[0]) / self.focal, (v - self.center[1]) / self.focal, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    fn turned(yaw: f64, pitch: f64) -> StraightView {
        StraightView::from(&View { yaw, pitch, horizontal_fov: FRAC_PI_2, width: 640, height: 480 })
    }

    #[test]
    fn focal_length_and_centre() {
        let view = turned(0.0, 0.0);
        assert!((view.focal - 320.0).abs() < 1e-12);
        assert_eq!(view.center, [319.5, 239.5]);
        let seen = view.project(&Point::new(1.0, -0.5, 4.0)).unwrap();
        assert!((seen.pixel[0] - 399.5).abs() < 1e-12 && (seen.pixel[1] - 199.5).abs() < 1e-12);
        assert_eq!(seen.depth, 4.0);
    }

    #[test]
    fn yaw_is_to_the_left_and_pitch_down_and_yaw_first() {
        let looks = |yaw, pitch| turned(yaw, pitch).camera_from_view * Vector::z();
        let (s, c) = FRAC_PI_4.sin_cos();
        assert!((looks(FRAC_PI_4, 0.0) - Vector::new(-s, 0.0, c)).norm() < 1e-12);
        assert!((looks(0.0, FRAC_PI_4) - Vector::new(0.0, s, c)).norm() < 1e-12);
        // A pan-tilt head: left by a right angle, then down towards the left, and the horizon stays level.
        assert!((looks(FRAC_PI_2, FRAC_PI_4) - Vector::new(-c, s, 0.0)).norm() < 1e-12);
        assert!((turned(FRAC_PI_2, 0.3).camera_from_view * Vector::x() - Vector::z()).norm() < 1e-12);
    }

    #[test]
    fn the_border_belongs_to_the_nearest_pixel() {
        let view = turned(0.0, 0.0);
        assert_eq!(view.pixel_index([-0.5, -0.5]), Some(0));
        assert_eq!(view.pixel_index([0.5, 0.0]), Some(1));
        assert_eq!(view.pixel_index([0.49, 0.0]), Some(0));
        assert_eq!(view.pixel_index([639.5_f64.next_down(), 479.5_f64.next_down()]), Some(640 * 480 - 1));
        let before = (-0.5_f64).next_down();
        for outside in [[before, 0.0], [0.0, before], [639.5, 0.0], [0.0, 479.5], [f64::NAN, 0.0]] {
            assert_eq!(view.pixel_index(outside), None, "{outside:?}");
        }
    }

    #[test]
    fn what_lies_behind_is_not_seen() {
        let view = turned(0.0, 0.0);
        assert!(view.project(&Point::new(0.0, 0.0, -1.0)).is_none());
        assert!(view.project(&Point::origin()).is_none());
        assert!(view.project(&Point::new(f64::NAN, 0.0, 1.0)).is_none());
        assert!(view.project(&Point::new(0.0, 0.0, f64::INFINITY)).is_none());
    }

    #[test]
    fn a_pixel_and_its_ray() {
        let view = turned(0.3, -0.2);
        for pixel in [[0.0, 0.0], [639.0, 479.0], [12.25, 400.5]] {
            let seen = view.project_own(&Point::from(view.ray(pixel) * 7.0)).unwrap();
            assert!((seen.pixel[0] - pixel[0]).hypot(seen.pixel[1] - pixel[1]) < 1e-10 && seen.depth == 7.0);
        }
    }
}
