//! A camera's numbers: whether its lens is told for images of its size.

use crate::remedy::Remedy;
use crate::verdict::{Question, Verdict};
use ralf::sensors::Camera;
use ralf::space::Point;

/// The principal point lies this near the middle of an image, as a factor of half its width and of half its height.
/// Parts that are cut out may lie farther aside, but not by the same factor both ways.
const NEAR: f64 = 1.15;
/// What is one factor both ways: good lenses are a few percent off.
const ALIKE: f64 = 1.12;

const RESIZED: &str =
    "were its images made smaller or larger after it was calibrated? Its lens has to be, too";

/// A lens of images so many times as large or small: nothing that is projected into them lies where it should.
pub(super) fn judge(camera: &Camera) -> Option<Verdict> {
    let [x, y] = camera.intrinsics.project(&Point::new(0.0, 0.0, 1.0))?;
    let (width, height) = (camera.width as f64, camera.height as f64);
    let (across, down) = (2.0 * x / width, 2.0 * y / height);
    let is_aside = [across, down].iter().all(|factor| *factor > 0.0 && factor.ln().abs() > NEAR.ln());
    if !is_aside || (across / down).ln().abs() > ALIKE.ln() {
        return None;
    }
    let factor = (across * down).sqrt();
    let evidence = format!(
        "its lens is that of images {factor:.2} times as large: its axis meets those of {width} x {height} px at \
         ({x:.0}, {y:.0})"
    );
    Some(Verdict::doubt(&camera.name, Question::Bounds, evidence, Some(Remedy::LookInto(RESIZED))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::sensors::Intrinsics;
    use ralf::space::Transform;

    fn doubts(size: [usize; 2], center: [f64; 2]) -> bool {
        let (vehicle_from_camera, views, [width, height]) = (Transform::identity(), Vec::new(), size);
        let intrinsics = Intrinsics::Pinhole { focal: [900.0; 2], center, distortion: [0.0; 5] };
        let name = "camera_front".to_owned();
        judge(&Camera { name, vehicle_from_camera, width, height, intrinsics, views }).is_some()
    }

    #[test]
    fn images_that_were_resized_are_told_from_parts_that_were_cut_out() {
        // nuScenes, whole, at half the size and at four thirds.
        assert!(!doubts([1600, 900], [816.3, 491.5]));
        assert!(doubts([800, 450], [816.3, 491.5]));
        assert!(doubts([2133, 1200], [816.3, 491.5]));
        // Its lower half, its left half, and a corner.
        assert!(!doubts([1600, 450], [816.3, 41.5]));
        assert!(!doubts([800, 900], [816.3, 491.5]));
        assert!(!doubts([1600, 900], [-816.3, 491.5]));
    }
}
