//! The distribution of a quantity in two recordings.

use super::*;

/// Bins of a quantity that is no share.
const BINS: usize = 44;
/// Bins of a share, centred at its twentieths, so that none lies on a border.
const SHARE_BINS: usize = 21;

/// The bins of a chart.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bins {
    from: f64,
    to: f64,
    count: usize,
}

impl Bins {
    /// From 0 to 1.
    fn of_shares() -> Self {
        let half = 0.5 / (SHARE_BINS - 1) as f64;
        Self { from: -half, to: 1.0 + half, count: SHARE_BINS }
    }

    /// From the first to the last hundredth of both lists, which are in ascending order and not both empty.
    fn over(real: &[f32], simulated: &[f32]) -> Self {
        let at = |values: &[f32], share: f64| {
            let last = values.len().checked_sub(1)?;
            values.get((share * last as f64).round() as usize).copied().map(f64::from)
        };
        let both = [real, simulated];
        let from = both.iter().filter_map(|values| at(values, 0.01)).fold(f64::INFINITY, f64::min);
        let to = both.iter().filter_map(|values| at(values, 0.99)).fold(f64::NEG_INFINITY, f64::max);
        let room = if to > from { 0.02 * (to - from) } else { 0.5 };
        Self { from: from - room, to: to + room, count: BINS }
    }

    fn edge(&self, bin: usize) -> f64 {
        self.from + (self.to - self.from) * bin as f64 / self.count as f64
    }

    /// The share of all values that each bin holds; what lies outside is in none.
    fn shares(&self, values: &[f32]) -> Vec<f64> {
        let mut shares = vec![0.0; self.count];
        for value in values {
            let place = (f64::from(*value) - self.from) / (self.to - self.from) * self.count as f64;
            if place >= 0.0 && place < self.count as f64 {
                shares[place as usize] += 1.0 / values.len() as f64;
            }
        }
        shares
    }
}

/// Shares of values, the real recording's as areas and the simulated one's as a line. Both lists are in ascending
/// order, and one may be empty.
pub(crate) fn distribution(
    real: &[f32],
    simulated: &[f32],
    name: &str,
    is_share: bool,
) -> Result<String, ReportError> {
    let bins = if is_share { Bins::of_shares() } else { Bins::over(real, simulated) };
    let (of_real, of_simulated) = (bins.shares(real), bins.shares(simulated));
    let most = of_real.iter().chain(&of_simulated).copied().fold(0.01, f64::max);
    svg((560, 260), |area| {
        let x = Axis { name, from: bins.from, to: bins.to, text: short, labels: 8 };
        let y = Axis { name: "share", from: 0.0, to: most * 1.08, text: short, labels: 4 };
        let mut chart = axes(area, x, y, true)?;
        let filled = of_real.iter().enumerate().map(|(bin, share)| {
            let corners = [(bins.edge(bin), 0.0), (bins.edge(bin + 1), *share)];
            Rectangle::new(corners, PLAUSIBLE.mix(0.45).filled())
        });
        chart.draw_series(filled)?;
        if !simulated.is_empty() {
            let steps = of_simulated.iter().enumerate();
            let line =
                steps.flat_map(|(bin, share)| [(bins.edge(bin), *share), (bins.edge(bin + 1), *share)]);
            chart.draw_series(LineSeries::new(line, ARTIFACT.stroke_width(2)))?;
        }
        Ok(())
    })
}

/// As few digits as tell the value.
fn short(value: f64) -> String {
    match value.abs() {
        1e3.. => count(value),
        10.0.. => whole(value),
        0.995.. | 0.0 => one_decimal(value),
        _ => format!("{value:.2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_within_the_bins_counts_once() {
        let values: Vec<f32> = (0..200).map(|i| i as f32 / 10.0).collect();
        let bins = Bins::over(&values, &[]);
        assert!(bins.from < 0.2 && bins.to > 19.7 && bins.count == BINS);
        let total: f64 = bins.shares(&values).iter().sum();
        assert!(total > 0.97 && total < 1.0 + 1e-9, "{total}");
        // Shares have their own bins: a twentieth each.
        let shares = Bins::of_shares().shares(&[0.0, 0.5, 0.5, 1.0]);
        assert_eq!((shares[0], shares[10], shares[20]), (0.25, 0.5, 0.25));
        // All values equal.
        assert_eq!(Bins::over(&[7.0; 3], &[7.0]).shares(&[7.0]).iter().sum::<f64>(), 1.0);
    }
}
