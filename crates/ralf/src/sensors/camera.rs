//! A camera of the vehicle.

use super::bounds::check_size;
use super::image::CameraImage;
use super::intrinsics::Intrinsics;
use super::view::{StraightView, View};
use crate::space::Transform;

/// A camera: its mounting, its lens, and the straight views that are cut out of its image.
#[derive(Debug, Clone)]
pub struct Camera {
    /// Unique in its rig.
    pub name: String,
    /// Extrinsics, of the optical frame (x right, y down, z forward).
    pub vehicle_from_camera: Transform,
    /// Image width, px.
    pub width: usize,
    /// Image height, px.
    pub height: usize,
    /// How directions become pixels.
    pub intrinsics: Intrinsics,
    /// The straight views, as configured. Empty: one view along the axis, of the image's size.
    pub views: Vec<View>,
}

impl Camera {
    /// Refuses, with what was expected and found, values that no camera has: sizes, a lens whose numbers are none,
    /// views that see nothing. A lens that folds back is one: depth that is there already doesn't need it
    /// ([`Intrinsics::check`]).
    pub fn check(&self) -> Result<(), String> {
        check_size("an image", self.width, self.height)?;
        self.intrinsics.check_numbers()?;
        self.views.iter().try_for_each(View::check)
    }

    /// Refuses, with what was expected and found, an image of another size than the calibration's: nothing tells where
    /// in it a point lies.
    pub fn check_image(&self, image: &CameraImage) -> Result<(), String> {
        let ([width, height], pixels) = ([image.width, image.height], image.rgb.len());
        if [width, height] != [self.width, self.height] {
            let (own_width, own_height) = (self.width, self.height);
            return Err(format!(
                "an image of {own_width} x {own_height} px as calibrated, found {width} x {height} px"
            ));
        }
        if pixels != width * height {
            return Err(format!("{width} x {height} pixels, found {pixels}"));
        }
        Ok(())
    }

    /// The straight views; where none is configured one along the axis, of the image's size, with
    /// [`Intrinsics::focal_on_axis`].
    pub fn straight_views(&self) -> Vec<StraightView> {
        if self.views.is_empty() {
            let focal = self.intrinsics.focal_on_axis();
            return vec![StraightView::along_axis(self.width, self.height, focal)];
        }
        self.views.iter().map(StraightView::from).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_views_there_is_one_along_the_axis() {
        let intrinsics =
            Intrinsics::KannalaBrandt { focal: [330.0, 331.0], center: [650.0, 390.0], distortion: [0.0; 4] };
        let mut camera = Camera {
            name: "front".into(),
            vehicle_from_camera: Transform::identity(),
            width: 1280,
            height: 800,
            intrinsics,
            views: vec![],
        };
        let [only] = camera.straight_views()[..] else { panic!("one view") };
        assert_eq!((only.width, only.height, only.focal, only.center), (1280, 800, 330.0, [639.5, 399.5]));
        camera.views = vec![View { yaw: 0.5, pitch: 0.0, horizontal_fov: 1.0, width: 64, height: 48 }; 2];
        assert_eq!(camera.straight_views().len(), 2);
    }
}
