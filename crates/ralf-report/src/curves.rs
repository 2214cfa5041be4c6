//! What the plausibility `w` is worth beyond the label: its reliability, and charts of it.

use ralf::metrics::RankedPoint;

/// Bins of the reliability curve and the histogram.
pub(crate) const BINS: usize = 20;

/// One bin of `w`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Bin {
    /// Detections in it.
    pub(crate) count: usize,
    /// Of these truly plausible, or labelled so.
    pub(crate) plausible: usize,
    /// The sum of their `w`.
    sum_w: f64,
}

impl Bin {
    /// Counts one more.
    pub(crate) fn add(&mut self, w: f32, plausible: bool) {
        self.count += 1;
        self.sum_w += f64::from(w);
        self.plausible += usize::from(plausible);
    }

    /// The mean `w` and the plausible share; `None` of an empty bin.
    pub(crate) fn point(&self) -> Option<(f64, f64)> {
        let count = self.count as f64;
        (self.count > 0).then(|| (self.sum_w / count, self.plausible as f64 / count))
    }
}

/// Of so many points about as many as a chart can show, the last one among them.
pub(crate) fn thinned(points: &[RankedPoint], wanted: usize) -> Vec<RankedPoint> {
    let every = points.len().div_ceil(wanted.max(1)).max(1);
    let last = points.len().checked_sub(1).filter(|last| last % every != 0);
    points.iter().step_by(every).chain(last.map(|last| &points[last])).copied().collect()
}

/// The bin of a plausibility, from 0 to 1.
pub(crate) fn bin_of(w: f32) -> usize {
    ((f64::from(w) * BINS as f64) as usize).min(BINS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_both_ends() {
        let points: Vec<_> =
            (0..1000).map(|i| RankedPoint { recall: f64::from(i), precision: 1.0 }).collect();
        let found = thinned(&points, 100);
        assert!(found.len() <= 101);
        assert_eq!((found[0].recall, found[found.len() - 1].recall), (0.0, 999.0));
        assert!(thinned(&[], 10).is_empty());
    }

    #[test]
    fn both_ends_of_w_have_their_bin() {
        let mut bins = [Bin::default(); BINS];
        for (w, plausible) in [(0.0, false), (1.0, true), (0.974, false), (0.976, false)] {
            bins[bin_of(w)].add(w, plausible);
        }
        assert_eq!((bins[0].count, bins[BINS - 1].count), (1, 3));
        let (mean_w, share) = bins[BINS - 1].point().unwrap();
        assert!((mean_w - 2.95 / 3.0).abs() < 1e-6 && share == 1.0 / 3.0, "{mean_w} {share}");
        assert_eq!(bins[5].point(), None);
    }
}
