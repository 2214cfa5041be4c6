//! Why a model says what it says, in words.

use super::familiar::Seen;
use crate::evidence::{Feature, GROUPS};
use std::fmt::Write;

/// What the share of the detections around is called, which stands behind those of [`GROUPS`].
pub const NEIGHBOURS: &str = "Neighbours";
/// Groups that a reason names.
const MOST: usize = 3;
/// Characters that a reason seldom exceeds.
const ROOM: usize = 120;
/// Log odds below which a group's share isn't worth a word.
const LEAST: f64 = 0.05;

/// The features that a model reads, by how much they tell of their groups.
#[derive(Debug, Clone)]
pub(super) struct Telling {
    /// Of each of [`GROUPS`] the places of its features, what is worth most to the model first.
    by_group: [Vec<usize>; GROUPS.len()],
    inputs: Vec<&'static Feature>,
}

impl Telling {
    /// `group_of` gives the place of each feature's group, `seen` what it is worth.
    pub(super) fn new(inputs: &[&'static Feature], group_of: &[usize], seen: &[Seen]) -> Self {
        let mut by_group = std::array::from_fn(|_| Vec::new());
        for (place, group) in group_of.iter().enumerate() {
            by_group[*group].push(place);
        }
        for places in &mut by_group {
            places.sort_by(|a, b| seen[*b].gain.total_cmp(&seen[*a].gain));
        }
        Self { by_group, inputs: inputs.to_vec() }
    }

    /// The groups that add most to a detection's log odds, largest first, each with its most telling feature:
    /// `LiDAR rays -2.31 (rays_beyond 0.93)`.
    pub(super) fn reason(&self, shares: &[f64], row: &[f32]) -> String {
        let mut order: Vec<usize> = (0..shares.len()).filter(|group| shares[*group].abs() >= LEAST).collect();
        order.sort_by(|a, b| shares[*b].abs().total_cmp(&shares[*a].abs()));
        let mut words = String::with_capacity(ROOM);
        for group in order.into_iter().take(MOST) {
            words.push_str(if words.is_empty() { "" } else { "; " });
            // Writing to a text never fails.
            let name = GROUPS.get(group).copied().unwrap_or(NEIGHBOURS);
            _ = write!(words, "{name} {:+.2}", shares[group]);
            if let Some(place) = self.most_telling(group, row) {
                let value = row[place];
                _ = write!(words, " ({} {value:.*})", self.inputs[place].name, digits(value));
            }
        }
        words
    }

    /// The groups that the model reads and of which a row holds nothing, as places in [`GROUPS`].
    pub(super) fn lacking(&self, row: &[f32]) -> Vec<usize> {
        let is_lacking =
            |group: &usize| !self.by_group[*group].is_empty() && self.most_telling(*group, row).is_none();
        (0..GROUPS.len()).filter(is_lacking).collect()
    }

    /// The feature of a group that was observed and is worth most to the model.
    fn most_telling(&self, group: usize, row: &[f32]) -> Option<usize> {
        self.by_group.get(group)?.iter().copied().find(|place| !row[*place].is_nan())
    }
}

/// Digits behind the point, so that a value has three or so.
fn digits(value: f32) -> usize {
    match value.abs() {
        size if size >= 100.0 => 0,
        size if size >= 10.0 => 1,
        _ => 2,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_shares_come_first_with_what_tells_most_of_them() {
        static RAYS: [Feature; 3] = [
            Feature { name: "rays_in", unit: "1", group: GROUPS[0], meaning: "" },
            Feature { name: "rays_beyond", unit: "1", group: GROUPS[0], meaning: "" },
            Feature { name: "speed", unit: "m/s", group: GROUPS[6], meaning: "" },
        ];
        let seen = [1.0, 2.0, 3.0].map(|gain| Seen { low: 0.0, high: 0.0, absent: 0.0, gain });
        let mut shares = [0.0; GROUPS.len()];
        (shares[0], shares[6], shares[1]) = (-0.5, 2.0, 0.01);
        let inputs: Vec<&'static Feature> = RAYS.iter().collect();
        let telling = Telling::new(&inputs, &[0, 0, 6], &seen);
        let words = telling.reason(&shares, &[0.25, 0.93, 123.4]);
        assert_eq!(words, "Doppler +2.00 (speed 123); LiDAR rays -0.50 (rays_beyond 0.93)");
        let words = telling.reason(&shares, &[0.25, f32::NAN, f32::NAN]);
        assert_eq!(words, "Doppler +2.00; LiDAR rays -0.50 (rays_in 0.25)");
        let words = telling.reason(&[&shares[..], &[-9.0]].concat(), &[0.25, 0.93, 123.4]);
        assert!(words.starts_with("Neighbours -9.00; Doppler +2.00"), "{words}");
    }
}
