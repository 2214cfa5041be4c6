//! What a segmentation says of an image's pixels whose depth is known.

use super::grid::PixelGrid;
use super::moment::{CalibratedImage, ImageId};
use super::projection::project_points;
use crate::config::CameraConfig;
use crate::label::truth_of;
use crate::sensors::{Camera, ClassImage, StraightView};
use crate::space::{Point, Transform};
use std::sync::Arc;

/// A pixel whose depth and class are known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassPixel {
    /// Column and row, sub-pixel.
    pub pixel: [f64; 2],
    /// `Z`: along the view's optical axis, m.
    pub depth: f64,
    /// How well that is known, m.
    pub sigma: f64,
    /// SemanticKITTI id of a class that can be plausible.
    pub class: u16,
}

/// One straight view of an image, with those of its pixels whose depth and class are known.
#[derive(Debug)]
pub struct SegmentedStraightView {
    /// Its geometry.
    pub view: StraightView,
    /// Where a LiDAR point lies that the camera sees.
    lidar: ClassPixels,
    /// Where the depth image was calibrated.
    depth: ClassPixels,
}

/// An image's segmentation at the image's time.
#[derive(Debug)]
pub struct SegmentedImage {
    /// Which image.
    pub id: ImageId,
    /// One per straight view.
    pub views: Vec<SegmentedStraightView>,
    /// From the vehicle frame at the image's time to the camera's optical frame.
    pub camera_from_vehicle: Transform,
}

/// A segmentation seen from a radar scan.
#[derive(Debug, Clone)]
pub struct SegmentedView {
    /// The image with its segmentation.
    pub moment: Arc<SegmentedImage>,
    /// From the vehicle frame at the image's time to that at the radar scan's.
    pub vehicle_from_image: Transform,
}

impl SegmentedImage {
    /// The segmentation of an image, one class image per straight view, with the points of all LiDARs, the ground's
    /// too, in the vehicle frame at the image's time, and with its calibrated depth, where it has any. Views whose
    /// depth has failed say nothing.
    ///
    /// Pixels of classes that no plausible detection has (the ground, the sky, what is not labelled) are left out. The
    /// error says what was expected and found where the class images aren't those of the views.
    pub fn new(
        camera: &Camera,
        id: ImageId,
        classes: &[ClassImage],
        lidar: &[Point],
        calibrated: Option<&CalibratedImage>,
        config: &CameraConfig,
    ) -> Result<Self, String> {
        let straight = camera.straight_views();
        check(&straight, classes)?;
        let camera_from_vehicle = camera.vehicle_from_camera.inverse();
        let mut views = Vec::with_capacity(straight.len());
        for (place, (view, image)) in straight.into_iter().zip(classes).enumerate() {
            let is_left = calibrated.is_none_or(|calibrated| calibrated.is_left(place));
            let lidar = if is_left { lidar } else { &[] };
            let seen = project_points(lidar, &camera_from_vehicle, &view, config.occlusion_window);
            let seen =
                seen.iter().filter_map(|point| class_pixel(&view, image, point.pixel, point.depth, 0.0));
            let (lidar, depth) = (ClassPixels::new(seen.collect()), ClassPixels::new(Vec::new()));
            views.push(SegmentedStraightView { view, lidar, depth });
        }
        for (place, lattice) in calibrated.into_iter().flat_map(CalibratedImage::lattices) {
            let (segmented, image) = (&mut views[place], &classes[place]);
            let known = lattice.known().filter_map(|(pixel, depth)| {
                class_pixel(&segmented.view, image, pixel, depth, config.depth_sigma * depth)
            });
            segmented.depth = ClassPixels::new(known.collect());
        }
        Ok(Self { id, views, camera_from_vehicle })
    }
}

impl SegmentedStraightView {
    /// The pixels that the LiDAR tells the depth of, at most so many columns and rows, px, from a place in the view.
    pub fn by_lidar(&self, place: [f64; 2], half: [f64; 2]) -> impl Iterator<Item = &ClassPixel> {
        self.lidar.around(place, half)
    }

    /// The pixels of calibrated depth, at most so many columns and rows, px, from a place in the view.
    pub fn by_depth(&self, place: [f64; 2], half: [f64; 2]) -> impl Iterator<Item = &ClassPixel> {
        self.depth.around(place, half)
    }
}

/// Pixels, sorted for the search.
#[derive(Debug)]
struct ClassPixels {
    grid: PixelGrid,
    pixels: Vec<ClassPixel>,
}

impl ClassPixels {
    fn new(pixels: Vec<ClassPixel>) -> Self {
        let places: Vec<[f64; 2]> = pixels.iter().map(|pixel| pixel.pixel).collect();
        Self { grid: PixelGrid::balanced(&places), pixels }
    }

    fn around(
        &self,
        [u, v]: [f64; 2],
        [half_width, half_height]: [f64; 2],
    ) -> impl Iterator<Item = &ClassPixel> {
        let rows = self.grid.row(v - half_height)..=self.grid.row(v + half_height);
        let of_row = move |row| self.grid.places(self.grid.buckets(row, u - half_width, u + half_width));
        let near = rows.flat_map(of_row).map(|place| &self.pixels[place.index]);
        near.filter(move |found| {
            (found.pixel[0] - u).abs() <= half_width && (found.pixel[1] - v).abs() <= half_height
        })
    }
}

fn class_pixel(
    view: &StraightView,
    image: &ClassImage,
    pixel: [f64; 2],
    depth: f64,
    sigma: f64,
) -> Option<ClassPixel> {
    let class = u16::from(*image.ids.get(view.pixel_index(pixel)?)?);
    (truth_of(class) == Some(true)).then_some(ClassPixel { pixel, depth, sigma, class })
}

fn check(views: &[StraightView], classes: &[ClassImage]) -> Result<(), String> {
    if views.len() != classes.len() {
        return Err(format!("expected {} class images, one per view, found {}", views.len(), classes.len()));
    }
    for (index, (view, image)) in views.iter().zip(classes).enumerate() {
        let ([width, height], ids) = ([view.width, view.height], image.ids.len());
        if [image.width, image.height] != [width, height] || ids != width * height {
            return Err(format!(
                "expected a class image of {width} x {height} px for view {index}, found {} x {} px with {ids} ids",
                image.width, image.height
            ));
        }
    }
    Ok(())
}
