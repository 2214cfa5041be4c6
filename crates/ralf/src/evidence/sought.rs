//! Where cameras look for a detection: the window of a view that it fills.

use crate::scene::{Detection, Frame};
use crate::sensors::{Elevation, StraightView, ViewPoint};
use crate::space::{Point, Vector};
use nalgebra::Matrix3;

/// Pixels around a detection are looked at as far as so many of its standard deviations.
const AROUND: f64 = 2.5;
/// And no farther than so many pixels of the lattice: a near detection fills a view.
const FARTHEST: f64 = 6.0;
/// How well a place is known at best, m.
const ROOM: f64 = 0.1;
/// What a radar without elevation detects is sought at this height above the ground, m, so far up and down.
const LEVEL: [f64; 2] = [1.0, 0.4];
/// A detection lies at a depth that differs by no more, in standard deviations.
pub(super) const ON: f64 = 2.0;

/// A detection, where cameras can look for it.
pub(super) struct Sought {
    /// At a likely height, where the radar measures none.
    pub(super) detection: Detection,
    /// The ground below it.
    pub(super) ground: Point,
}

/// A detection in a view.
pub(super) struct Window {
    /// Its place.
    pub(super) at: ViewPoint,
    /// Half of the window's width and height, px.
    pub(super) half: [f64; 2],
    /// How well its depth is known, m.
    pub(super) sigma: f64,
}

impl Sought {
    pub(super) fn new(frame: &Frame, detection: &Detection) -> Self {
        let mut ground = detection.position;
        ground.z = frame.ground.as_ref().map_or(0.0, |surface| ground.z - surface.height(&ground));
        let mut detection = *detection;
        if frame.radar.elevation == Elevation::None {
            detection.position.z = ground.z + LEVEL[0];
            let up = Vector::z() * LEVEL[1];
            let [range, azimuth] = [0, 1].map(|axis| detection.axes.column(axis).into_owned());
            detection.axes = Matrix3::from_columns(&[range, azimuth, up]);
        }
        Self { detection, ground }
    }
}

impl Window {
    /// The window of a detection of the camera's optical frame, at least `stride` px to each side; `None` outside the
    /// view.
    pub(super) fn new(seen: &Detection, straight: &StraightView, stride: usize) -> Option<Self> {
        let at = straight.project(&seen.position)?;
        let [right, down, forward] =
            [Vector::x(), Vector::y(), Vector::z()].map(|axis| straight.camera_from_view * axis);
        let (stride, sigma) = (stride as f64, seen.sigma_along(&forward).hypot(ROOM));
        let half = [right, down].map(|across| {
            let pixels = AROUND * straight.focal * seen.sigma_along(&across) / at.depth;
            pixels.clamp(stride, FARTHEST * stride)
        });
        Some(Self { at, half, sigma })
    }

    /// How far a pixel lies to the right and below, in standard deviations, of which the window has so many to each
    /// side.
    pub(super) fn beside(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let [width, height] = self.half;
        [AROUND * (u - self.at.pixel[0]) / width, AROUND * (v - self.at.pixel[1]) / height]
    }

    /// How far the detection lies behind a depth, in standard deviations of both.
    pub(super) fn behind(&self, depth: f64, sigma: f64) -> f64 {
        (self.at.depth - depth) / self.sigma.hypot(sigma)
    }
}
