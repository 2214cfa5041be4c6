//! What the drives of a vehicle have in common.

use super::quantity::values;
use crate::change::SensorChange;

/// Changes of several drives that differ by less than this are one, in what one expects to be off.
const ALIKE: f64 = 0.4;

/// What was found in most drives; nothing where most found nothing, or something else each.
pub(super) fn common(changes: &[SensorChange]) -> SensorChange {
    let is_like = |a: &SensorChange, b: &SensorChange| {
        (values(a) - values(b)).amax() <= ALIKE && is_alike_besides(a, b)
    };
    let count = |change: &SensorChange| changes.iter().filter(|other| is_like(change, other)).count();
    let most = changes.iter().copied().find(|change| 2 * count(change) > changes.len());
    most.unwrap_or_default()
}

/// Whether two changes are the same but for what is refined.
pub(super) fn is_alike_besides(a: &SensorChange, b: &SensorChange) -> bool {
    let rest =
        |change: &SensorChange| (change.mirrored, change.turn_deg[0], change.turn_deg[1], change.shift_m[2]);
    rest(a) == rest(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_most_drives_ask_for_is_common_and_what_one_asks_for_is_not() {
        let nothing = SensorChange::default();
        let [near, nearer] = [SensorChange::yaw(-4.0), SensorChange::yaw(-4.6)];
        assert_eq!(common(&[nearer]), nearer, "of a single drive all");
        assert_eq!(common(&[near, nothing, nothing]), nothing);
        assert_eq!(common(&[near, nothing]), nothing, "as many deny it");
        assert_eq!(common(&[near, nearer, nothing]), near);
        let other = SensorChange::yaw(170.0);
        assert_eq!(common(&[near, other, nothing]), nothing, "each something else");
        assert_eq!(common(&[near, SensorChange { mirrored: true, ..near }, nothing]), nothing);
    }
}
