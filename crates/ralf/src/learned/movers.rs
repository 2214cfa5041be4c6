//! How many of what moves is real: each scan tells.
//!
//! To a model moving by itself says nothing, for traffic and noise differ from place to place. So it expects as many
//! real ones among a scan's movers as among all detections, where of noise, mirror images and double bounces, whose
//! range rates are anything, there may be many times more than of cars. The answers themselves tell how many: the mean
//! of their probabilities, which changes their odds, and so on until both agree (Saerens et al., *Adjusting the outputs
//! of a classifier to new a priori probabilities*, Neural Computation 2002).

use super::calibration::with_odds;
use super::rows::Rows;

/// The feature that tells how surely a detection moves, and from where on it does, in its units.
const MOVES: (&str, f32) = ("doppler_residual", 3.0);
/// What is expected of a scan's movers counts as much as so many of them.
const EXPECTED_AS: f64 = 100.0;
/// Shares that differ by no more agree.
const AGREEING: f64 = 1e-4;
/// Rounds after which they are near enough, whatever they do.
const ROUNDS: usize = 50;

/// Where to look in a row of evidence, and what is expected.
#[derive(Debug, Clone, Copy)]
pub(super) struct Movers {
    moves: Option<usize>,
    /// The share of plausible ones that probabilities come from.
    share: f64,
}

impl Movers {
    /// For rows of features of these names, and for probabilities that expect so large a share of plausible ones.
    /// Where that is not in (0, 1) nothing is expected, and nothing changes.
    pub(super) fn among<'a>(mut names: impl Iterator<Item = &'a str>, share: f64) -> Self {
        let is_known = share > 0.0 && share < 1.0;
        Self { moves: names.position(|name| name == MOVES.0).filter(|_| is_known), share }
    }

    /// The probabilities of a scan's rows, with the odds of those that move multiplied by one factor: as many are
    /// plausible as they themselves say.
    pub(super) fn weigh(&self, rows: &Rows, probabilities: &mut [f64]) {
        let Some(moves) = self.moves else { return };
        let is_mover = |row: usize| rows.row(row)[moves].abs() > MOVES.1;
        let movers: Vec<usize> = (0..rows.len()).filter(|row| is_mover(*row)).collect();
        let known: Vec<f64> = movers.iter().map(|row| probabilities[*row]).collect();
        let factor = factor(&known, self.share);
        for row in movers {
            probabilities[row] = with_odds(probabilities[row], factor);
        }
    }
}

/// What the odds of probabilities that expect a share are multiplied by.
fn factor(probabilities: &[f64], expected: f64) -> f64 {
    let (mut share, mut factor) = (expected, 1.0);
    for _ in 0..ROUNDS {
        let sum: f64 = probabilities.iter().map(|probability| with_odds(*probability, factor)).sum();
        let next = (sum + EXPECTED_AS * expected) / (probabilities.len() as f64 + EXPECTED_AS);
        factor = odds(next) / odds(expected);
        if (next - share).abs() <= AGREEING {
            break;
        }
        share = next;
    }
    factor
}

fn odds(share: f64) -> f64 {
    share / (1.0 - share)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A scan whose residuals are these.
    fn scan(residuals: &[f32]) -> Rows {
        let mut rows = Rows::absent(residuals.len(), 2);
        for (row, residual) in residuals.iter().enumerate() {
            rows.row_mut(row)[1] = *residual;
        }
        rows
    }

    fn movers(share: f64) -> Movers {
        Movers::among(["amplitude", MOVES.0].into_iter(), share)
    }

    #[test]
    fn sure_answers_tell_how_many_are_real() {
        // Of 900 movers 90 are real for sure: with 30 of the 100 that are expected, 120 of 1,000.
        let known: Vec<f64> = (0..900).map(|at| if at < 90 { 1.0 } else { 0.0 }).collect();
        let expected = (0.12 / 0.88) / (0.3 / 0.7);
        assert!((factor(&known, 0.3) - expected).abs() < 1e-9);
    }

    #[test]
    fn both_agree_in_the_end() {
        let known: Vec<f64> = (0..400).map(|at| 0.5 * f64::from(at) / 400.0).collect();
        let factor = factor(&known, 0.3);
        let sum: f64 = known.iter().map(|p| with_odds(*p, factor)).sum();
        let share = (sum + 30.0) / 500.0;
        assert!(factor < 1.0 && (odds(share) / odds(0.3) - factor).abs() < 1e-3, "{factor} {share}");
    }

    #[test]
    fn what_stands_still_keeps_its_probability_and_movers_their_order() {
        let residuals = [0.1, -2.9, 3.1, -9.0, 50.0, f32::NAN];
        let mut weighed = [0.6, 0.7, 0.1, 0.2, 0.9, 0.4];
        movers(0.3).weigh(&scan(&residuals), &mut weighed);
        assert_eq!([weighed[0], weighed[1], weighed[5]], [0.6, 0.7, 0.4]);
        assert!(weighed[2] < weighed[3] && weighed[3] < weighed[4]);
        assert!((odds(weighed[2]) / odds(0.1) - odds(weighed[4]) / odds(0.9)).abs() < 1e-9, "one factor");
    }

    #[test]
    fn where_nothing_moves_or_is_expected_nothing_changes() {
        let known = [0.2, 0.8];
        for (share, residuals) in [(0.3, [0.5, -1.0]), (0.0, [9.0, 9.0]), (1.0, [9.0, 9.0])] {
            let mut weighed = known;
            movers(share).weigh(&scan(&residuals), &mut weighed);
            assert_eq!(weighed, known);
        }
        let mut weighed = known;
        Movers::among(["amplitude"].into_iter(), 0.3).weigh(&scan(&[9.0, 9.0]), &mut weighed);
        assert_eq!(weighed, known, "nobody tells what moves");
    }

    #[test]
    fn even_the_surest_answers_leave_numbers() {
        let mut weighed = [0.0, 1.0];
        movers(0.3).weigh(&scan(&[9.0, 9.0]), &mut weighed);
        assert_eq!(weighed, [0.0, 1.0]);
    }
}
