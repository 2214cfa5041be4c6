//! Where a radar's scans together place what stands still.
//!
//! Each scan that saw a detection again measured its place anew, with errors of its own. Weighted by what each of them
//! knows, they tell the place better than any one does: across the ray above all, where a single scan is uncertain by
//! decimetres that LiDAR tells apart.

use super::distance::{ROOM, Spot};
use crate::scene::Detection;
use crate::space::{Point, Vector};
use nalgebra::Matrix3;

/// The variance of a height that nobody measures, m^2: so large that it has no say.
const UNKNOWN: f64 = 1e6;

/// A detection where the scans that saw it together place it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Joint {
    /// The mean of all places, each weighted by `(Sigma + (0.1 m)^2 I)^-1`, and how well it is known: the inverse of
    /// the sum of these weights. The detection itself where no other scan saw it.
    pub(super) detection: Detection,
    /// How far that lies from where the detection itself was measured, in standard deviations of the detection.
    pub(super) shift: f64,
    /// How far the places scatter about it: root mean square in standard deviations, of each axis; `None` of one place.
    pub(super) scatter: Option<f64>,
}

impl Joint {
    /// Whether other scans have a say in it.
    pub(super) fn is_of_several(&self) -> bool {
        self.scatter.is_some()
    }

    /// Of a detection by itself.
    pub(super) fn alone(detection: &Detection) -> Self {
        Self { detection: *detection, shift: 0.0, scatter: None }
    }

    /// Of a detection and of where other scans saw it `again`; horizontally, where the radar measures no elevation
    /// (`level`). Alone where the covariances are of no use.
    pub(super) fn new(detection: &Detection, again: &[&Spot], level: bool) -> Self {
        let alone = Self::alone(detection);
        if again.is_empty() { alone } else { Self::of_several(detection, again, level).unwrap_or(alone) }
    }

    fn of_several(detection: &Detection, again: &[&Spot], level: bool) -> Option<Self> {
        let own = Spot::new(detection);
        let known = |spot: &Spot| Some((spot.place - own.place, weight(spot, level)?));
        let own_weight = weight(&own, level)?;
        let mut all = vec![(Vector::zeros(), own_weight)];
        for spot in again {
            all.push(known(spot)?);
        }
        let (mut sum, mut weights) = (Vector::zeros(), Matrix3::zeros());
        for (h, weight) in &all {
            sum += weight * h;
            weights += weight;
        }
        let covariance = weights.try_inverse()?;
        let shift = covariance * sum;
        let squared = |h: Vector, weight: &Matrix3<f64>| h.dot(&(weight * h));
        let scattered: f64 = all.iter().map(|(h, weight)| squared(h - shift, weight)).sum();
        let axes = if level { 2 } else { 3 };
        Some(Self {
            detection: Detection {
                position: Point::from(own.place + shift),
                axes: covariance.cholesky()?.l(),
            },
            shift: squared(shift, &own_weight).sqrt(),
            scatter: Some((scattered / (axes * again.len()) as f64).sqrt()),
        })
    }
}

/// `(Sigma + (0.1 m)^2 I)^-1`, m^-2, of a detection whose height doesn't count where `level`.
fn weight(spot: &Spot, level: bool) -> Option<Matrix3<f64>> {
    let [xx, xy, yy] = spot.horizontal;
    let [xz, yz, zz] = if level { [0.0, 0.0, UNKNOWN] } else { spot.vertical };
    let covariance = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    (covariance + Matrix3::identity() * (ROOM * ROOM)).try_inverse()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    fn detection(place: [f64; 3], sigmas: [f64; 3]) -> Detection {
        Detection { position: Point::from(place), axes: Matrix3::from_diagonal(&Vector3::from(sigmas)) }
    }

    #[test]
    fn two_places_by_hand() {
        let own = detection([10.0, 0.0, 1.0], [0.3, 0.7, 0.7]);
        let other = Spot::new(&detection([10.2, 1.0, 2.0], [0.3, 0.2, 0.7]));
        let joint = Joint::new(&own, &[&other], false);
        // Variances 0.1 and 0.1; 0.5 and 0.05; 0.5 and 0.5.
        let expected = [10.1, 1.0 / 0.05 / (1.0 / 0.5 + 1.0 / 0.05), 1.5];
        assert!((joint.detection.position - Point::from(expected)).norm() < 1e-12);
        let sigmas = [0.05f64, 1.0 / 22.0, 0.25].map(f64::sqrt);
        for (axis, sigma) in Matrix3::<f64>::identity().column_iter().zip(sigmas) {
            assert!((joint.detection.sigma_along(&axis.into()) - sigma).abs() < 1e-12);
        }
        let shift = 0.1f64.powi(2) / 0.1 + expected[1].powi(2) / 0.5 + 0.5f64.powi(2) / 0.5;
        assert!((joint.shift - shift.sqrt()).abs() < 1e-12);
        // Of two places the squares sum up to those of their difference over both variances.
        let scatter = 0.2f64.powi(2) / 0.2 + 1.0 / 0.55 + 1.0;
        assert!((joint.scatter.unwrap() - (scatter / 3.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn heights_that_nobody_measures_have_no_say() {
        let own = detection([10.0, 0.0, 0.0], [0.3, 0.7, 0.0]);
        let other = Spot::new(&detection([10.2, 1.0, 3.0], [0.3, 0.2, 0.0]));
        let joint = Joint::new(&own, &[&other], true);
        let scatter = 0.2f64.powi(2) / 0.2 + 1.0 / 0.55;
        assert!((joint.scatter.unwrap() - (scatter / 2.0).sqrt()).abs() < 1e-5);
        assert!((joint.shift - (0.1f64.powi(2) / 0.1 + (10.0 / 11.0f64).powi(2) / 0.5).sqrt()).abs() < 1e-5);
    }

    #[test]
    fn many_measurements_of_one_place_come_near_it() {
        let sigmas = [0.2, 0.6, 0.4];
        let beside = [[0.1, 0.5, -0.2], [-0.2, -0.4, 0.3], [0.1, -0.1, -0.1]];
        let all = beside.map(|[x, y, z]| detection([20.0 + x, 5.0 + y, 1.0 + z], sigmas));
        let again = [&Spot::new(&all[1]), &Spot::new(&all[2])];
        let joint = Joint::new(&all[0], &again, false);
        assert!((joint.detection.position - Point::new(20.0, 5.0, 1.0)).norm() < 1e-12);
        let sigma = joint.detection.sigma_along(&Vector::y());
        assert!((sigma - ((0.36f64 + 0.01) / 3.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn alone_it_stays_where_it_was_measured() {
        let own = detection([10.0, 0.0, 1.0], [0.3, 0.7, 0.7]);
        let lost = Spot::new(&detection([f64::NAN, 0.0, 1.0], [f64::NAN; 3]));
        for again in [&[][..], &[&lost]] {
            let joint = Joint::new(&own, again, false);
            assert_eq!(joint.detection.position, own.position);
            assert_eq!((joint.detection.axes, joint.shift, joint.scatter), (own.axes, 0.0, None));
        }
    }
}
