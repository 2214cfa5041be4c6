//! A radar's own velocity beside the one that the vehicle's motion gives it.

use super::Timed;
use crate::statistics::{Estimate, angle_estimate, estimate, median};
use nalgebra::Vector2;
use ralf::space::EgoMotion;
use ralf::space::Transform;

/// Below this speed a direction is noise, m/s.
pub(crate) const MOVING: f64 = 1.0;
/// The vehicle stands below this, m/s; range rates say that it moves above [`CREEPING`].
pub(crate) const STANDING: f64 = 0.1;
pub(crate) const CREEPING: f64 = 1.5;

/// How a radar's range rates go with the vehicle's motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DopplerFigures {
    /// Scans in which both are known and the vehicle moves.
    pub(crate) scans: usize,
    /// Median share of detections that stand still.
    pub(crate) inliers: f64,
    /// Measured speed over predicted one.
    pub(crate) ratio: Estimate,
    /// From the predicted to the measured direction, rad, in the radar's frame, positive to the left.
    pub(crate) angle: Estimate,
    /// Of velocity vectors, m/s: median distance between measured and predicted.
    pub(crate) off: f64,
}

/// The radar's velocity by the vehicle's motion, in the radar's frame: `R^T (v + omega x t)`, its plane only.
pub(crate) fn predicted(motion: &EgoMotion, mount: &Transform, t_ns: i64) -> Vector2<f64> {
    let (velocity, turn) = motion.twist(t_ns);
    (mount.rotation.inverse() * (velocity + turn.cross(&mount.translation.vector))).xy()
}

/// Compares all scans; `None` where none is left in which the vehicle moves.
pub(crate) fn compare(fits: &[Timed], motion: &EgoMotion, mount: &Transform) -> Option<DopplerFigures> {
    let (mut ratios, mut angles, mut offs, mut inliers) = (vec![], vec![], vec![], vec![]);
    for Timed { t_ns, fit } in fits {
        let expected = predicted(motion, mount, *t_ns);
        let (found, speed) = (fit.velocity, expected.norm());
        if speed < MOVING {
            continue;
        }
        ratios.push(found.norm() / speed);
        // A direction of no velocity is none.
        if found.norm() > MOVING * 0.5 {
            angles.push(expected.perp(&found).atan2(expected.dot(&found)));
        }
        offs.push((found - expected).norm());
        inliers.push(fit.inliers);
    }
    Some(DopplerFigures {
        scans: ratios.len(),
        inliers: median(&inliers)?,
        ratio: estimate(&ratios)?,
        angle: angle_estimate(&angles).unwrap_or(Estimate { value: 0.0, error: f64::INFINITY }),
        off: median(&offs)?,
    })
}

/// Scans in which the vehicle is said to stand while the world comes nearer.
pub(crate) fn creeping(fits: &[Timed], motion: &EgoMotion, mount: &Transform) -> usize {
    let stands = |t_ns: i64| predicted(motion, mount, t_ns).norm() < STANDING;
    let moves = |timed: &&Timed| timed.fit.velocity.norm() > CREEPING && timed.fit.inliers > 0.5;
    fits.iter().filter(moves).filter(|timed| stands(timed.t_ns)).count()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::doppler::VelocityFit;
    use nalgebra::{Matrix2, UnitQuaternion};
    use ralf::space::OdometrySample;
    use ralf::space::{Transform, Vector};

    pub(in crate::doppler) fn seen(t_ns: i64, velocity: Vector2<f64>) -> Timed {
        let covariance = Matrix2::identity() * 1e-4;
        let fit = VelocityFit { velocity, inliers: 0.6, count: 60, covariance, vertical: (0.0, 0.0) };
        Timed { t_ns, fit }
    }

    pub(in crate::doppler) fn driving(samples: impl Iterator<Item = (i64, f64, f64)>) -> EgoMotion {
        let samples = samples.map(|(t_ns, velocity, yaw_rate)| OdometrySample { t_ns, velocity, yaw_rate });
        EgoMotion::new(samples.collect(), vec![]).unwrap()
    }

    #[test]
    fn a_yaw_of_five_degrees_is_an_angle_of_minus_five() {
        // The radar truly looks 5 degrees to the left of where its mounting says: the world's flow turns to the right.
        let motion = driving([(0, 10.0, 0.0)].into_iter());
        let truth = Transform::from_parts(
            nalgebra::Translation3::new(3.7, 0.0, 0.5),
            UnitQuaternion::from_axis_angle(&Vector::z_axis(), 5.0_f64.to_radians()),
        );
        let told = Transform::translation(3.7, 0.0, 0.5);
        let fits: Vec<Timed> = (0..9).map(|i| seen(i, predicted(&motion, &truth, i))).collect();
        let found = compare(&fits, &motion, &told).unwrap();
        assert!((found.angle.value.to_degrees() + 5.0).abs() < 1e-9, "{found:?}");
        assert!((found.ratio.value - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_turn_gives_the_front_radar_a_sideways_velocity() {
        let motion = driving([(0, 5.0, 0.4)].into_iter());
        let velocity = predicted(&motion, &Transform::translation(3.0, 1.0, 0.0), 0);
        assert!((velocity - Vector2::new(5.0 - 0.4, 1.2)).norm() < 1e-12);
    }

    #[test]
    fn a_standing_vehicle_whose_world_moves_is_counted() {
        let motion = driving([(0, 0.0, 0.0)].into_iter());
        let mount = Transform::identity();
        let moving = [seen(0, Vector2::new(2.0, 0.0))];
        assert!(compare(&moving, &motion, &mount).is_none());
        assert_eq!(creeping(&moving, &motion, &mount), 1);
        let mixed = driving([(0, 0.0, 0.0), (10, 5.0, 0.0)].into_iter());
        let fits = [seen(0, Vector2::new(2.0, 0.0)), seen(10, Vector2::new(5.0, 0.0))];
        assert_eq!(creeping(&fits, &mixed, &mount), 1);
    }
}
