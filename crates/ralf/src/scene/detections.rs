//! A radar scan's detections with their uncertainty, moved into the vehicle frame.

use super::mismatch::Spread;
use crate::sensors::{Elevation, Radar, RadarScan};
use crate::space::{Point, Transform, Vector};
use nalgebra::{Matrix3, Vector3};

/// Where a detection lies, and how well that is known.
#[derive(Debug, Clone, Copy)]
pub struct Located {
    /// `p_i`, m.
    pub position: Point,
    /// A square root of `Sigma_i`: the columns of `R J diag(s_r, s_phi, s_theta)`.
    pub axes: Matrix3<f64>,
}

impl Located {
    /// The same detection in another frame.
    pub fn moved(&self, to_from_here: &Transform) -> Self {
        let rotation = to_from_here.rotation.to_rotation_matrix();
        Self { position: to_from_here * self.position, axes: rotation.matrix() * self.axes }
    }

    /// `Sigma_i`.
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
pub struct Detections {
    /// The scan as measured.
    pub scan: RadarScan,
    /// One per detection; `None` where its coordinates are not finite.
    pub located: Vec<Option<Located>>,
}

impl Detections {
    /// Moves a radar's scan into the vehicle frame.
    pub fn locate(radar: &Radar, scan: RadarScan) -> Self {
        let rotation = radar.vehicle_from_radar.rotation.to_rotation_matrix();
        let sigma_elevation = match radar.elevation {
            Elevation::Measured => radar.sigma_elevation,
            Elevation::None => 0.0,
        };
        let sigmas =
            Matrix3::from_diagonal(&Vector3::new(radar.sigma_range, radar.sigma_azimuth, sigma_elevation));
        let locate = |(position, spherical): (&Point, &crate::space::Spherical)| {
            position.iter().all(|v| v.is_finite()).then(|| Located {
                position: radar.vehicle_from_radar * position,
                axes: rotation.matrix() * spherical.jacobian() * sigmas,
            })
        };
        let located = scan.positions.iter().zip(&scan.spherical).map(locate).collect();
        Self { scan, located }
    }

    /// Time of the scan, ns.
    pub fn t_ns(&self) -> i64 {
        self.scan.t_ns
    }
}
