//! Of what class the things are that cameras see where detections lie (docs/method.md, section 11).

use super::sought::{ON, Sought, Window};
use crate::scene::{ClassPixel, Detection, Frame, SegmentedImage, SegmentedView};
use crate::space::Transform;

/// What one pixel says.
struct Vote {
    class: u16,
    /// How likely the detection lies where the pixel shows something.
    weight: f64,
}

/// An image, and where its camera is.
struct Placed<'a> {
    image: &'a SegmentedImage,
    camera_from_vehicle: Transform,
}

impl<'a> Placed<'a> {
    fn new(view: &'a SegmentedView) -> Self {
        let camera_from_vehicle = view.moment.camera_from_vehicle * view.vehicle_from_image.inverse();
        Self { image: &view.moment, camera_from_vehicle }
    }
}

/// The class of what the cameras see at each detection of a frame, by the segmentations of their images: that of most
/// pixels around at whose depth the detection lies, each weighed by `exp(-m^2 / 2)`, with `m` its distance from the
/// detection across and in depth in standard deviations. Pixels on LiDAR points answer first, else those of the
/// calibrated depth, for the LiDAR knows it better. `None` for detections that `is_asked` doesn't ask for, by their
/// places in the scan, and where no such pixel says anything.
///
/// `stride` is that of the depth's lattice, px: `camera.stride`.
pub fn seen_classes(frame: &Frame, stride: usize, is_asked: impl Fn(usize) -> bool) -> Vec<Option<u16>> {
    let images: Vec<Placed> = frame.segmented.iter().map(Placed::new).collect();
    let mut classes = vec![None; frame.scan.len()];
    for (i, detection) in frame.scan.detections.iter().enumerate() {
        let Some(detection) = detection.as_ref().filter(|_| is_asked(i) && !images.is_empty()) else {
            continue;
        };
        classes[i] = seen_class(&images, &Sought::new(frame, detection).detection, stride);
    }
    classes
}

fn seen_class(images: &[Placed], detection: &Detection, stride: usize) -> Option<u16> {
    let (mut by_lidar, mut by_depth) = (Vec::new(), Vec::new());
    for Placed { image, camera_from_vehicle } in images {
        let seen = detection.moved(camera_from_vehicle);
        for view in &image.views {
            let Some(window) = Window::new(&seen, &view.view, stride) else { continue };
            add_votes(&window, view.by_lidar(window.at.pixel, window.half), &mut by_lidar);
            add_votes(&window, view.by_depth(window.at.pixel, window.half), &mut by_depth);
        }
    }
    most(&by_lidar).or_else(|| most(&by_depth))
}

/// The votes of those pixels at whose depth the detection lies.
fn add_votes<'a>(window: &Window, pixels: impl Iterator<Item = &'a ClassPixel>, votes: &mut Vec<Vote>) {
    for ClassPixel { pixel, depth, sigma, class } in pixels {
        let behind = window.behind(*depth, *sigma);
        if behind.abs() <= ON {
            let [right, down] = window.beside(*pixel);
            let weight = (-0.5 * (right * right + down * down + behind * behind)).exp();
            votes.push(Vote { class: *class, weight });
        }
    }
}

/// The class of the greatest weight; of equal ones the first.
fn most(votes: &[Vote]) -> Option<u16> {
    let mut sums: Vec<Vote> = Vec::new();
    for Vote { class, weight } in votes {
        match sums.iter_mut().find(|sum| sum.class == *class) {
            Some(sum) => sum.weight += weight,
            None => sums.push(Vote { class: *class, weight: *weight }),
        }
    }
    sums.iter().rev().max_by(|a, b| a.weight.total_cmp(&b.weight)).map(|sum| sum.class)
}
