//! Probabilities that mean what they say: isotonic regression (pool adjacent violators).

use ralf::learned::Calibration;

/// A log odds with what was true, and how much it counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Answered {
    pub(super) log_odds: f64,
    pub(super) plausible: bool,
    pub(super) weight: f64,
}

/// Rows that are pooled.
#[derive(Debug, Clone, Copy, Default)]
struct Pool {
    weight: f64,
    log_odds: f64,
    plausible: f64,
}

impl Pool {
    fn share(&self) -> f64 {
        self.plausible / self.weight
    }

    /// The same with one more.
    fn and(mut self, row: &Answered) -> Self {
        let plausible = if row.plausible { row.weight } else { 0.0 };
        self.join(&Self { weight: row.weight, log_odds: row.log_odds * row.weight, plausible });
        self
    }

    fn join(&mut self, other: &Self) {
        self.weight += other.weight;
        self.log_odds += other.log_odds;
        self.plausible += other.plausible;
    }
}

/// Rows of about as much weight each that are looked at together, so that a line has some hundred points at most.
const CELLS: f64 = 200.0;
/// A probability is never 0 or 1: as if as many rows had been otherwise.
const DOUBT: f64 = 1.0;

/// The rising line that comes nearest to what was true.
pub(super) fn calibration(answered: &[Answered]) -> Calibration {
    let mut sorted = answered.to_vec();
    sorted.sort_by(|a, b| a.log_odds.total_cmp(&b.log_odds));
    let mut points: Vec<(f64, f64)> = Vec::new();
    for pool in rising(&sorted) {
        let share = (pool.plausible + DOUBT * 0.5) / (pool.weight + DOUBT);
        let floor = points.last().map_or(0.0, |(_, share)| *share);
        let log_odds = pool.log_odds / pool.weight;
        if points.last().is_none_or(|(last, _)| *last < log_odds) {
            points.push((log_odds, share.max(floor)));
        }
    }
    // Of no rows nothing is known.
    Calibration::new(points).unwrap_or_else(|_| Calibration::even())
}

/// Rows in the order of their log odds, in pools whose shares rise.
fn rising(sorted: &[Answered]) -> Vec<Pool> {
    let all: f64 = sorted.iter().map(|row| row.weight).sum();
    let mut pools: Vec<Pool> = Vec::new();
    let mut cell: Option<Pool> = None;
    let full = all / CELLS;
    for alike in sorted.chunk_by(|a, b| a.log_odds == b.log_odds) {
        // Of what is told the same, one part can't be more plausible than another: many are a cell of their own.
        let together = alike.iter().fold(Pool::default(), |sum, row| sum.and(row));
        if alike.len() > 1 && together.weight >= full {
            cell.take().into_iter().chain([together]).for_each(|pool| add_rising(&mut pools, pool));
            continue;
        }
        for row in alike {
            let cell_now = cell.take().unwrap_or_default().and(row);
            if cell_now.weight >= full {
                add_rising(&mut pools, cell_now);
            } else {
                cell = Some(cell_now);
            }
        }
    }
    cell.into_iter().for_each(|pool| add_rising(&mut pools, pool));
    pools
}

/// Adds a pool, and joins the last ones until none falls below the one before.
fn add_rising(pools: &mut Vec<Pool>, pool: Pool) {
    pools.push(pool);
    while let [.., before, last] = pools.as_mut_slice()
        && before.share() >= last.share()
    {
        before.join(last);
        pools.pop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn rows(values: &[(f64, bool)]) -> Vec<Answered> {
        values
            .iter()
            .map(|(log_odds, plausible)| Answered { log_odds: *log_odds, plausible: *plausible, weight: 1.0 })
            .collect()
    }

    #[test]
    fn shares_of_what_was_true_become_the_probabilities() {
        let mut all = Vec::new();
        for (log_odds, share) in [(-2.0, 2), (0.0, 5), (3.0, 9)] {
            all.extend((0..1000).map(|i| (log_odds + f64::from(i) * 1e-6, i % 10 < share)));
        }
        let line = calibration(&rows(&all));
        for (log_odds, p) in [(-2.0, 0.2), (0.0, 0.5), (3.0, 0.9)] {
            let found = line.probability(log_odds + 5e-4);
            assert!((found - p).abs() < 0.02, "{found} for {p}");
        }
    }

    #[test]
    fn what_is_told_the_same_has_the_share_of_all_of_it_however_it_is_sorted() {
        for artifacts_first in [true, false] {
            let leaf = |log_odds: f64, plausible: usize| {
                let is_plausible =
                    move |i| if artifacts_first { i >= 500 - plausible } else { i < plausible };
                (0..500).map(move |i| (log_odds, is_plausible(i)))
            };
            let line = calibration(&rows(&leaf(-1.0, 100).chain(leaf(0.5, 250)).collect::<Vec<_>>()));
            let found = [-1.0, 0.5].map(|log_odds| line.probability(log_odds));
            assert!((found[0] - 0.2).abs() < 0.01 && (found[1] - 0.5).abs() < 0.01, "{found:?}");
        }
    }

    #[test]
    fn nothing_and_one_kind_alone_have_a_line() {
        assert_eq!(calibration(&[]).probability(3.0), 0.5);
        let sure = calibration(&rows(&[(1.0, true), (2.0, true)]));
        assert!((0.5..1.0).contains(&sure.probability(2.0)));
    }

    proptest! {
        #[test]
        fn the_line_never_falls(values in prop::collection::vec((-9.0..9.0_f64, any::<bool>()), 0..400)) {
            let line = calibration(&rows(&values));
            let probes: Vec<f64> = (-100..100).map(|i| line.probability(f64::from(i) / 10.0)).collect();
            prop_assert!(probes.windows(2).all(|pair| pair[0] <= pair[1]));
            prop_assert!(probes.iter().all(|p| (0.0..=1.0).contains(p)));
        }
    }
}
