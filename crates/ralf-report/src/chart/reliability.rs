//! The plausibility `w` against how often it is right, and how it is spread.

use super::*;
use crate::curves::{BINS, Bin};

fn edges() -> Vec<f64> {
    (0..=BINS).map(|edge| edge as f64 / BINS as f64).collect()
}

/// The truly plausible share over the mean `w` of each bin, with the counts below. On the diagonal `w` would be a
/// probability.
pub(crate) fn reliability(bins: &[Bin; BINS], threshold: f64) -> Result<String, ReportError> {
    svg((560, 420), |area| {
        let (above, below) = area.split_vertically(285);
        let x = Axis::share("plausibility w");
        let mut chart = axes(&above, x, Axis::share("truly plausible share"), false)?;
        let diagonal = [(0.0, 0.0), (1.0, 1.0)];
        chart.draw_series(DashedLineSeries::new(diagonal, 5, 5, AXIS.stroke_width(1)))?;
        let cut = [(threshold, 0.0), (threshold, 1.0)];
        chart.draw_series(DashedLineSeries::new(cut, 2, 4, ARTIFACT.stroke_width(2)))?;
        let points: Vec<(f64, f64)> = bins.iter().filter_map(Bin::point).collect();
        chart.draw_series(LineSeries::new(points.clone(), PLAUSIBLE.stroke_width(3)))?;
        chart.draw_series(points.into_iter().map(|point| Circle::new(point, 4, PLAUSIBLE.filled())))?;
        let counts: Vec<u64> = bins.iter().map(|bin| bin.count as u64).collect();
        counts_below(&below, x, &edges(), &counts)
    })
}

/// How many detections have which `w`, by label: plausible ones on top of artifacts.
pub(crate) fn histogram(bins: &[Bin; BINS]) -> Result<String, ReportError> {
    svg((1160, 300), |area| {
        let most = bins.iter().map(|bin| bin.count).max().unwrap_or(0).max(1) as f64;
        let y = Axis { name: "detections", from: 0.0, to: most * 1.05, text: count, labels: 5 };
        let x = Axis { labels: 11, ..Axis::share("plausibility w") };
        let mut chart = axes(area, x, y, true)?;
        let gap = 0.04 / BINS as f64;
        let bars = edges().into_iter().zip(bins).flat_map(|(edge, bin)| {
            let (from, to) = (edge + gap, edge + 1.0 / BINS as f64 - gap);
            let [artifacts, all] = [bin.count - bin.plausible, bin.count].map(|count| count as f64);
            [bar(from, to, 0.0, artifacts, ARTIFACT), bar(from, to, artifacts, all, PLAUSIBLE)]
        });
        chart.draw_series(bars)?;
        Ok(())
    })
}
