//! Laying a scan onto surfaces: iterated least squares in which far points count little.

use super::voxels::Voxels;
use nalgebra::{Matrix6, SMatrix, Translation3, UnitQuaternion, Vector6};
use ralf::space::{Point, Transform, Vector};

/// Rounds at most.
const ROUNDS: usize = 40;
/// A round that moves by less is the last: m and rad.
const SETTLED: f64 = 1e-4;
/// The distance at which a point counts a quarter (Geman-McClure), m: wide at first, so that a guess that is half a
/// metre off is pulled in, then down to what walls and noise give.
const SCALES: [f64; 2] = [0.8, 0.15];
/// Of the scale, per round.
const NARROWING: f64 = 0.8;
/// A point this far from a surface lies half on it, m.
const ON: f64 = 0.08;
/// Holds directions in place of which nothing is seen, as a share of all weights.
const DAMPING: f64 = 1e-6;

/// Where a scan was laid.
#[derive(Debug, Clone, Copy)]
pub(super) struct Laid {
    pub(super) pose: Transform,
    /// How well its points near surfaces lie on them: 1 without noise, 0.5 at 8 cm.
    pub(super) on: f64,
    /// Share of its points that are near surfaces at all.
    pub(super) seen: f64,
}

/// Lays points (vehicle frame, m) onto surfaces, from a guess of the vehicle's pose.
pub(super) fn lay(points: &[Point], surfaces: &Voxels, guess: &Transform) -> Laid {
    let mut pose = *guess;
    let mut scale = SCALES[0];
    for _ in 0..ROUNDS {
        let Some(step) = step(points, surfaces, &pose, scale) else { break };
        pose = moved(&pose, &step);
        if step.norm() < SETTLED && scale <= SCALES[1] {
            break;
        }
        scale = (scale * NARROWING).max(SCALES[1]);
    }
    judged(points, surfaces, pose)
}

/// The step of one round: turn (rad) and move (m) about the vehicle, odom frame. `None` where nothing holds.
fn step(points: &[Point], surfaces: &Voxels, pose: &Transform, scale: f64) -> Option<Vector6<f64>> {
    let (mut normal, mut right) = (Matrix6::zeros(), Vector6::zeros());
    for point in points {
        let place = pose * point;
        let Some(surface) = surfaces.nearest(&place) else { continue };
        let off = surface.across * (place - surface.mean);
        let weight = (scale * scale / (scale * scale + off.norm_squared())).powi(2);
        let arm = place - Point::from(pose.translation.vector);
        let mut jacobian = SMatrix::<f64, 3, 6>::zeros();
        jacobian.fixed_view_mut::<3, 3>(0, 0).copy_from(&(-arm.cross_matrix()));
        jacobian.fixed_view_mut::<3, 3>(0, 3).fill_with_identity();
        let held = surface.across * jacobian;
        normal += held.transpose() * jacobian * weight;
        right -= jacobian.transpose() * off * weight;
    }
    let trace = normal.trace();
    normal += Matrix6::identity() * (DAMPING * trace);
    if trace > 0.0 { normal.cholesky().map(|factors| factors.solve(&right)) } else { None }
}

fn moved(pose: &Transform, step: &Vector6<f64>) -> Transform {
    let turn = UnitQuaternion::from_scaled_axis(Vector::new(step[0], step[1], step[2]));
    let place = pose.translation.vector + Vector::new(step[3], step[4], step[5]);
    Transform::from_parts(Translation3::from(place), turn * pose.rotation)
}

fn judged(points: &[Point], surfaces: &Voxels, pose: Transform) -> Laid {
    let (mut near, mut on) = (0.0, 0.0);
    for place in points.iter().map(|point| pose * point) {
        let Some(surface) = surfaces.nearest(&place) else { continue };
        let off = (surface.across * (place - surface.mean)).norm_squared();
        near += 1.0;
        on += ON * ON / (ON * ON + off);
    }
    Laid { pose, on: on / f64::max(near, 1.0), seen: near / points.len().max(1) as f64 }
}
