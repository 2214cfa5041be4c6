//! Why a model says what it says, in words.

use super::familiar::Seen;
use crate::evidence::{Feature, GROUPS};

/// Groups that a reason names.
const MOST: usize = 3;
/// Log odds below which a group's share isn't worth a word.
const LEAST: f64 = 0.05;

/// The groups that add most to a detection's log odds, largest first, each with its most telling feature:
/// `LiDAR rays -2.31 (rays_beyond 0.93)`.
pub(super) fn reason(shares: &[f64], inputs: &[&Feature], seen: &[Seen], row: &[f32]) -> String {
    let mut order: Vec<usize> = (0..shares.len()).filter(|group| shares[*group].abs() >= LEAST).collect();
    order.sort_by(|a, b| shares[*b].abs().total_cmp(&shares[*a].abs()));
    let mut parts = Vec::with_capacity(MOST);
    for group in order.into_iter().take(MOST) {
        let mut part = format!("{} {:+.2}", GROUPS[group], shares[group]);
        if let Some(place) = most_telling(GROUPS[group], inputs, seen, row) {
            part += &format!(" ({} {})", inputs[place].name, short(row[place]));
        }
        parts.push(part);
    }
    parts.join("; ")
}

/// The feature of a group that was observed and is worth most to the model.
fn most_telling(group: &str, inputs: &[&Feature], seen: &[Seen], row: &[f32]) -> Option<usize> {
    let mut best: Option<usize> = None;
    for (place, feature) in inputs.iter().enumerate() {
        let worth_more = best.is_none_or(|best| seen[place].gain > seen[best].gain);
        if feature.group == group && !row[place].is_nan() && worth_more {
            best = Some(place);
        }
    }
    best
}

/// A value with three digits or so.
fn short(value: f32) -> String {
    match value.abs() {
        size if size >= 100.0 => format!("{value:.0}"),
        size if size >= 10.0 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_shares_come_first_with_what_tells_most_of_them() {
        const RAYS: [Feature; 3] = [
            Feature { name: "rays_in", unit: "1", group: GROUPS[0], meaning: "" },
            Feature { name: "rays_beyond", unit: "1", group: GROUPS[0], meaning: "" },
            Feature { name: "speed", unit: "m/s", group: GROUPS[6], meaning: "" },
        ];
        let seen = [1.0, 2.0, 3.0].map(|gain| Seen { low: 0.0, high: 0.0, absent: 0.0, gain });
        let mut shares = [0.0; GROUPS.len()];
        (shares[0], shares[6], shares[1]) = (-0.5, 2.0, 0.01);
        let inputs: Vec<&Feature> = RAYS.iter().collect();
        let words = reason(&shares, &inputs, &seen, &[0.25, 0.93, 123.4]);
        assert_eq!(words, "Doppler +2.00 (speed 123); LiDAR rays -0.50 (rays_beyond 0.93)");
        let words = reason(&shares, &inputs, &seen, &[0.25, f32::NAN, f32::NAN]);
        assert_eq!(words, "Doppler +2.00; LiDAR rays -0.50 (rays_in 0.25)");
    }
}
