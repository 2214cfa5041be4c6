//! Errors along an axis.

use super::*;
use crate::breakdown::Profile;

/// For each bin the share of plausible detections that are missed and of artifacts that are kept, with the counts
/// below.
pub(crate) fn profile(profile: &Profile, name: &str) -> Result<String, ReportError> {
    let Profile { first, step, bins } = profile;
    let edges: Vec<f64> = (0..=bins.len()).map(|edge| first + edge as f64 * step).collect();
    let x = Axis { name, from: *first, to: edges[bins.len()], text: whole, labels: 9 };
    svg((560, 420), |area| {
        let (above, below) = area.split_vertically(285);
        let mut chart = axes(&above, x, Axis::share("share labelled wrong"), false)?;
        let share = |wrong: u64, all: u64| if all == 0 { 0.0 } else { wrong as f64 / all as f64 };
        let bars = edges.iter().zip(bins).flat_map(|(edge, bin)| {
            let [from, middle, to] = [0.1, 0.5, 0.9].map(|part| edge + part * step);
            let (missed, kept) = (share(bin.r#fn, bin.tp + bin.r#fn), share(bin.fp, bin.fp + bin.tn));
            [bar(from, middle, 0.0, missed, PLAUSIBLE), bar(middle, to, 0.0, kept, ARTIFACT)]
        });
        chart.draw_series(bars)?;
        let counts: Vec<u64> = bins.iter().map(|bin| bin.total()).collect();
        counts_below(&below, x, &edges, &counts)
    })
}
