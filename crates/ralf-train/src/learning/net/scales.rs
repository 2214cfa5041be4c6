//! How features become scores: by their ranks among what is learned from.

use super::scans::Scans;
use ralf::learned::net::Scale;

/// Values of a feature that are looked at, at most about.
const VALUES: usize = 40_000;
/// Stretches of a scale, each of which as many values lie in.
const STRETCHES: usize = 32;
/// A feature that was observed less often has no score.
const FEWEST: usize = 100;
/// No rank is nearer to none, or to all.
const LEAST_RANK: f64 = 0.004;
/// Log odds of ranks are so many times as wide as normal scores, about.
const LOGISTIC_PER_NORMAL: f64 = 1.702;

/// The scale of each feature, of the scans of some worlds.
pub(super) fn of(scans: &Scans, worlds: &[u16]) -> Vec<Scale> {
    let rows: Vec<usize> =
        worlds.iter().flat_map(|world| scans.of_world(*world).iter().cloned().flatten()).collect();
    let every = rows.len().div_ceil(VALUES).max(1);
    let mut scales = Vec::with_capacity(scans.table.features.len());
    for feature in 0..scans.table.features.len() {
        let values = rows.iter().step_by(every).map(|row| scans.table.rows.row(*row)[feature]);
        let mut values: Vec<f32> = values.filter(|value| value.is_finite()).collect();
        values.sort_unstable_by(f32::total_cmp);
        // Values rise and so do their ranks; where they don't, there is nothing to tell.
        scales.push(Scale::new(points(&values)).unwrap_or_default());
    }
    scales
}

/// Points of sorted values: values that many share have the middle of their ranks.
fn points(sorted: &[f32]) -> Vec<(f32, f32)> {
    let mut points: Vec<(f32, f32)> = Vec::new();
    if sorted.len() < FEWEST {
        return points;
    }
    for stretch in 0..=STRETCHES {
        let value = sorted[(sorted.len() - 1) * stretch / STRETCHES];
        if points.last().is_some_and(|(last, _)| *last >= value) {
            continue;
        }
        let below = sorted.partition_point(|other| *other < value);
        let up_to = sorted.partition_point(|other| *other <= value);
        points.push((value, score((below + up_to) as f64 / 2.0 / sorted.len() as f64)));
    }
    points
}

/// The score of a rank in [0, 1]: its log odds, about as wide as normal scores.
fn score(rank: f64) -> f32 {
    let rank = rank.clamp(LEAST_RANK, 1.0 - LEAST_RANK);
    ((rank / (1.0 - rank)).ln() / LOGISTIC_PER_NORMAL) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scores_are_those_of_ranks_and_equal_values_have_one() {
        let even: Vec<f32> = (0..1000).map(|i| i as f32).collect();
        let scale = Scale::new(points(&even)).unwrap();
        for (value, expected) in
            [(500.0, 0.0), (731.1, 1.0 / 1.702), (268.9, -1.0 / 1.702), (880.8, 2.0 / 1.702)]
        {
            assert!((scale.score(value) - expected).abs() < 0.03, "{} for {expected}", scale.score(value));
        }
        let mostly_zero: Vec<f32> = (0..1000).map(|i| (i - 800).max(0) as f32).collect();
        let scale = Scale::new(points(&mostly_zero)).unwrap();
        assert!((scale.score(0.0) - score(0.4)).abs() < 0.01, "{}", scale.score(0.0));
        assert_eq!(points(&even[..50]), []);
    }
}
