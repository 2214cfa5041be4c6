//! Fisheye cameras: images by ray casting, and what a depth network would make of their straight views.

mod depth;
mod paint;
mod render;

pub(super) use depth::{depth, true_depth};
pub(super) use render::{Rays, image, rays};

use super::scene::Scene;
use ralf::sensors::Camera;
use ralf::space::Transform;

/// A camera at a moment.
pub(super) struct Moment<'a> {
    pub(super) scene: Scene<'a>,
    pub(super) camera: &'a Camera,
    pub(super) site_from_camera: Transform,
}

/// Nothing is seen farther away, m.
const HORIZON: f64 = 250.0;
