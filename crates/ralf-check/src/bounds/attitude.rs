//! How poses hold the vehicle: it stays on its wheels, and drives the way it looks.

use super::mounting::{reordered, w_first};
use crate::remedy::{OTHER_ORDER, Remedy};
use crate::statistics::{median, quantile};
use crate::verdict::{Question, Verdict};
use nalgebra::{UnitQuaternion, Vector3};
use ralf::space::PoseSample;

/// No road tilts a vehicle this far from how it is held in the mean, degrees.
const TILT_DEG: f64 = 30.0;
/// Nor does one drive this far aside, up or down of where it looks, degrees.
const ASIDE_DEG: f64 = 30.0;
/// What is clearly better: an angle of so many degrees, and another one that is so many times as small. Where one
/// rolls in place of turning by less than a fifth, so many degrees of driving aside are enough.
const CLEAR: (f64, f64) = (6.0, 2.0);
const ROLLING: (f64, f64) = (0.2, 1.5);
/// Ways that tell where it drives: so many, of so many metres each, at no less than so many m/s. Standing vehicles
/// jitter to all sides.
const WAYS: usize = 5;
const WAY: f64 = 2.0;
const SLOWEST: f64 = 1.0;

/// What speaks against how poses hold the vehicle.
pub(super) fn judge(poses: &[PoseSample]) -> Option<Verdict> {
    let told = Attitude::of(poses, |rotation| *rotation);
    let otherwise = Attitude::of(poses, |rotation| reordered(rotation, w_first));
    let is_reordered = otherwise.is_of_a_vehicle() && otherwise.is_clearly_better_than(&told);
    if told.is_of_a_vehicle() && !is_reordered {
        return None;
    }
    let what =
        if is_reordered { OTHER_ORDER } else { "are they the vehicle's, with x ahead, y left and z up?" };
    Some(Verdict::doubt("motion", Question::Bounds, told.in_words(), Some(Remedy::LookInto(what))))
}

/// How a vehicle is held, degrees.
struct Attitude {
    /// How far it is tilted from how it is held in the mean, at the most but for a tenth of the poses.
    tilt: f64,
    /// Between where it looks and where it drives, in the median over ways; ahead or back.
    aside: f64,
    /// The share of its turning that is about its vertical axis, by squares, 0 to 1.
    upright: f64,
}

impl Attitude {
    fn of(poses: &[PoseSample], read: impl Fn(&UnitQuaternion<f64>) -> UnitQuaternion<f64>) -> Self {
        let rotations: Vec<UnitQuaternion<f64>> =
            poses.iter().map(|pose| read(&pose.odom_from_vehicle.rotation)).collect();
        let ups: Vec<Vector3<f64>> = rotations.iter().map(|rotation| rotation * Vector3::z()).collect();
        let mean = ups.iter().sum::<Vector3<f64>>();
        let tilts: Vec<f64> = ups.iter().map(|up| mean.angle(up).to_degrees()).collect();
        let (mut asides, mut turning, mut from) = (Vec::new(), Vector3::zeros(), 0);
        for to in 1..poses.len() {
            let [a, b] = [from, to].map(|at| poses[at].odom_from_vehicle.translation.vector);
            let way = rotations[from].inverse() * (b - a);
            if way.norm() < WAY {
                continue;
            }
            let seconds = (poses[to].t_ns - poses[from].t_ns) as f64 * 1e-9;
            if way.norm() > SLOWEST * seconds {
                asides.push((way.x.abs() / way.norm()).clamp(0.0, 1.0).acos().to_degrees());
                let turned = (rotations[from].inverse() * rotations[to]).scaled_axis();
                turning += turned.component_mul(&turned);
            }
            from = to;
        }
        let aside = median(&asides).filter(|_| asides.len() >= WAYS);
        let upright = if turning.sum() > 0.0 { turning.z / turning.sum() } else { 1.0 };
        Self { tilt: quantile(&tilts, 0.9).unwrap_or(0.0), aside: aside.unwrap_or(0.0), upright }
    }

    fn is_of_a_vehicle(&self) -> bool {
        self.tilt < TILT_DEG && self.aside < ASIDE_DEG
    }

    /// Gentle turns tilt a vehicle a little, too, whose quaternions are taken for others.
    fn is_clearly_better_than(&self, other: &Self) -> bool {
        let (limit, times) = CLEAR;
        let off = |attitude: &Self| attitude.tilt.max(attitude.aside);
        let is_rolling = other.upright < ROLLING.0 && self.upright > 1.0 - ROLLING.0;
        let is_aside = other.aside > ROLLING.1 && self.aside * times < other.aside;
        off(other) > limit && off(self) * times < off(other) || is_rolling && is_aside
    }

    fn in_words(&self) -> String {
        let Self { tilt, aside, .. } = self;
        if tilt > aside {
            return format!("poses tilt the vehicle by {tilt:.0} degrees from how they hold it in the mean");
        }
        format!("by its poses the vehicle drives {aside:.0} degrees aside of where it looks")
    }
}

#[cfg(test)]
mod tests {
    use super::super::mounting::w_third;
    use super::*;
    use nalgebra::{Isometry3, Quaternion, Translation3};

    /// A vehicle that drives along an arc of a circle of 40 m, a small one of 200 m, and begins in this direction.
    fn poses(
        begin: f64,
        arc: f64,
        told: impl Fn(UnitQuaternion<f64>) -> UnitQuaternion<f64>,
    ) -> Vec<PoseSample> {
        let radius = if arc < 0.3 { 200.0 } else { 40.0 };
        let pose = |at: i64| {
            let yaw = begin + arc * at as f64 / 50.0;
            let place = Vector3::new(radius * yaw.sin(), -radius * yaw.cos(), 0.0);
            let rotation = told(UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw));
            let odom_from_vehicle = Isometry3::from_parts(Translation3::from(place), rotation);
            PoseSample { t_ns: at * 100_000_000, odom_from_vehicle }
        };
        (0..50).map(pose).collect()
    }

    fn says(poses: &[PoseSample]) -> Option<Remedy> {
        judge(poses).and_then(|verdict| verdict.remedy)
    }

    #[test]
    fn vehicles_stay_on_their_wheels_and_drive_ahead() {
        assert_eq!(says(&poses(0.3, 3.0, |q| q)), None);
        let back = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::PI);
        assert_eq!(says(&poses(0.3, 3.0, |q| q * back)), None, "backwards");
        assert_eq!(says(&poses(0.3, 0.0, |q| q)), None, "standing");
        assert_eq!(says(&[]), None);
    }

    #[test]
    fn quaternions_in_another_order_are_told() {
        // It undoes the other order.
        let as_read = |q: UnitQuaternion<f64>| reordered(&q, w_third);
        for (begin, arc) in [(0.0, 2.0), (1.2, 0.5), (0.1, 6.0), (0.0, 0.4), (0.0, 0.2)] {
            let told = poses(begin, arc, as_read);
            assert_eq!(says(&told), Some(Remedy::LookInto(OTHER_ORDER)), "{begin} {arc}");
        }
    }

    #[test]
    fn frames_of_other_axes_are_told() {
        // As of a camera that looks ahead.
        let optical = UnitQuaternion::from_quaternion(Quaternion::new(0.5, -0.5, 0.5, -0.5));
        let remedy = says(&poses(0.0, 1.0, |q| q * optical));
        assert!(matches!(remedy, Some(Remedy::LookInto(what)) if what.contains("x ahead")), "{remedy:?}");
    }
}
