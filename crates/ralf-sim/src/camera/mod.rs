//! Fisheye cameras: images by ray casting, and what networks would make of their straight views.

mod classes;
mod depth;
mod paint;
mod render;

pub(super) use classes::true_classes;
pub(super) use depth::{depth, true_depth};
pub(super) use paint::{asphalt, gravel, leaves, slabs, solid_colour};
pub(super) use render::{Rays, image, rays};

use super::shape::Ray;
use ralf::sensors::Camera;
use ralf::space::{Transform, Vector};

/// What cameras look at, at one moment.
pub(super) trait Visible {
    /// How far away the first surface is that a ray meets within `limit`, m.
    fn distance(&self, ray: &Ray, limit: f64) -> Option<f64>;

    /// That surface.
    fn surface(&self, ray: &Ray, limit: f64) -> Option<Painted>;

    /// The SemanticKITTI id of that surface.
    fn class(&self, ray: &Ray, limit: f64) -> Option<u16>;
}

/// A surface that a ray meets.
pub(super) struct Painted {
    /// m.
    pub(super) distance: f64,
    /// Outward, in the site's frame.
    pub(super) normal: Vector,
    /// In full light, 0 to 255.
    pub(super) colour: [f64; 3],
}

/// A camera at a moment.
pub(super) struct Moment<'a, S> {
    pub(super) scene: S,
    pub(super) camera: &'a Camera,
    pub(super) site_from_camera: Transform,
}

/// Nothing is seen farther away, m.
const HORIZON: f64 = 250.0;
