//! Motion beyond the poses that are known of it.

use super::{PoseSample, Transform};

impl PoseSample {
    /// The pose to which the motion from another pose to this one leads when it goes on for so long, ns. Of a later and
    /// an earlier one it leads to before that, and the time is negative. Two poses of one time tell no motion.
    pub fn going_on(&self, from: &Self, for_ns: i64) -> Self {
        let step_ns = self.t_ns.saturating_sub(from.t_ns);
        let share = if step_ns == 0 { 0.0 } else { for_ns as f64 / step_ns as f64 };
        let step = from.odom_from_vehicle.inv_mul(&self.odom_from_vehicle);
        let further =
            Transform::from_parts((step.translation.vector * share).into(), step.rotation.powf(share));
        let odom_from_vehicle = self.odom_from_vehicle * further;
        Self { t_ns: self.t_ns.saturating_add(for_ns), odom_from_vehicle }
    }
}

/// Poses in the order of time, and one on either side where the motion of the two outermost has gone on: for so long,
/// ns, and for so many of their steps at most, for two that nearly coincide tell no speed. A single pose is left alone.
pub fn going_on(poses: Vec<PoseSample>, most_ns: i64, steps: i64) -> Vec<PoseSample> {
    let ([first, second, ..], [.., before, last]) = (&poses[..], &poses[..]) else { return poses };
    let beyond = |from: &PoseSample, end: &PoseSample| {
        let step_ns = end.t_ns.saturating_sub(from.t_ns);
        end.going_on(from, step_ns.saturating_mul(steps).clamp(-most_ns, most_ns))
    };
    let [head, tail] = [beyond(second, first), beyond(before, last)];
    [head].into_iter().chain(poses).chain([tail]).collect()
}
