//! A radar scan's detections with their uncertainty, moved into the vehicle frame.

use super::doppler::Doppler;
use super::farthest::Farthest;
use super::mismatch::Spread;
use super::strength::Strength;
use crate::sensors::{Elevation, Radar, RadarScan};
use crate::space::{EgoMotion, Point, Spherical, Transform, Vector};
use nalgebra::{Matrix3, Vector3};
use std::sync::OnceLock;

/// A detection: where it lies, and how well that is known.
#[derive(Debug, Clone, Copy)]
pub struct Detection {
    /// `p_i`, m, in the frame of whoever holds it: mostly the vehicle frame at the scan's time.
    pub position: Point,
    /// A square root of the covariance `Sigma_i`: the columns of `R J diag(s_r, s_phi, s_theta)`, m.
    pub axes: Matrix3<f64>,
}

impl Detection {
    /// The same detection in another frame.
    pub fn moved(&self, to_from_here: &Transform) -> Self {
        self.turned(to_from_here, to_from_here.rotation.to_rotation_matrix().matrix())
    }

    /// The same with the transform's rotation, which is worked out once for many.
    pub(crate) fn turned(&self, to_from_here: &Transform, rotation: &Matrix3<f64>) -> Self {
        Self { position: to_from_here * self.position, axes: rotation * self.axes }
    }

    /// Where it lies, seen from above, m, as searches among many have it.
    pub(crate) fn in_plan(&self) -> [f32; 2] {
        [self.position.x as f32, self.position.y as f32]
    }

    /// Where it lies, m, as nets have it.
    pub fn place(&self) -> [f32; 3] {
        self.position.coords.map(|metres| metres as f32).into()
    }

    /// The covariance `Sigma_i`.
    pub fn spread(&self) -> Spread {
        Spread::Axes(self.axes)
    }

    /// The trace of `Sigma_i`, m^2: the variance in no direction is larger.
    pub fn total_variance(&self) -> f64 {
        self.axes.norm_squared()
    }

    /// The standard deviation along a direction of unit length, m.
    pub fn sigma_along(&self, direction: &Vector) -> f64 {
        self.axes.tr_mul(direction).norm()
    }
}

/// One scan of one radar in the vehicle frame at the scan's time.
#[derive(Debug, Clone)]
pub struct LocatedScan {
    /// The scan as measured, in the radar's frame.
    pub measured: RadarScan,
    /// One per row of the scan, in the vehicle frame; `None` where the coordinates are not finite.
    pub detections: Vec<Option<Detection>>,
    doppler: OnceLock<Option<Doppler>>,
    strength: OnceLock<Option<Strength>>,
    farthest: OnceLock<Farthest>,
}

impl LocatedScan {
    /// Moves a radar's scan into the vehicle frame, with the covariance that the radar's uncertainties give (paper,
    /// equations 1 to 3; docs/method.md, section 3).
    pub fn new(radar: &Radar, scan: RadarScan) -> Self {
        let rotation = radar.vehicle_from_radar.rotation.to_rotation_matrix();
        let sigma_elevation = match radar.elevation {
            Elevation::Measured => radar.sigma_elevation,
            Elevation::None => 0.0,
        };
        let sigmas =
            Matrix3::from_diagonal(&Vector3::new(radar.sigma_range, radar.sigma_azimuth, sigma_elevation));
        let locate = |(position, spherical): (&Point, &Spherical)| {
            position.iter().all(|v| v.is_finite()).then(|| Detection {
                position: radar.vehicle_from_radar * position,
                axes: rotation.matrix() * spherical.jacobian() * sigmas,
            })
        };
        let detections = scan.positions.iter().zip(&scan.spherical).map(locate).collect();
        Self {
            measured: scan,
            detections,
            doppler: OnceLock::new(),
            strength: OnceLock::new(),
            farthest: OnceLock::new(),
        }
    }

    /// The range rates of the detections, worked out once for all frames that the scan belongs to; `None` where the
    /// radar, which is that of the scan, measures none.
    pub fn doppler(&self, radar: &Radar, motion: &EgoMotion) -> Option<&Doppler> {
        self.doppler.get_or_init(|| Doppler::new(radar, &self.measured, motion)).as_ref()
    }

    /// How strong the echoes were, worked out once; `None` where the radar, which is that of the scan, doesn't measure
    /// it.
    pub fn strength(&self, radar: &Radar) -> Option<&Strength> {
        self.strength.get_or_init(|| Strength::new(radar, &self.measured)).as_ref()
    }

    /// How far the radar, which is that of the scan, saw in it, worked out once.
    pub(super) fn farthest(&self, radar: &Radar) -> &Farthest {
        self.farthest.get_or_init(|| Farthest::new(radar, &self.measured))
    }

    /// The detections in another frame; `None` where the coordinates are not finite.
    pub fn moved(&self, to_from_here: &Transform) -> impl Iterator<Item = Option<Detection>> {
        let rotation = to_from_here.rotation.to_rotation_matrix().into_inner();
        let moved = move |detection: &Detection| detection.turned(to_from_here, &rotation);
        self.detections.iter().map(move |detection| detection.as_ref().map(&moved))
    }

    /// Time of the scan, ns.
    pub fn t_ns(&self) -> i64 {
        self.measured.t_ns
    }

    /// How many detections the scan has, those without a position too.
    pub fn len(&self) -> usize {
        self.detections.len()
    }

    /// Whether the radar saw nothing.
    pub fn is_empty(&self) -> bool {
        self.detections.is_empty()
    }
}
