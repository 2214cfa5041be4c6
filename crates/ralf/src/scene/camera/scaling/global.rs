//! One scale for a whole view: the alternatives that the paper rejects, kept for comparison.
//!
//! The residual of a sample under a scale `s` is relative to the LiDAR's depth, as in the monitor:
//! `(s * depth_relative - Z_lidar) / Z_lidar`.

use super::ScaleSample;

/// 10 %: the inliers of RANSAC, and Huber's delta.
const TOLERANCE: f64 = 0.1;

/// The scale of the least squares `sum (Z - s d)^2` over the samples within 10 % of the best proposal.
///
/// Every sample's ratio is a proposal; the one that most samples agree with wins, of equals the earlier sample's.
/// Nothing is drawn by chance. `None` without samples.
pub(super) fn ransac(samples: &[ScaleSample]) -> Option<f64> {
    // |s d - Z| <= 0.1 Z, as bounds of the ratio Z / d that grow with it, so that sorted ratios are enough.
    let too_small = |ratio: f64, scale: f64| ratio * (1.0 + TOLERANCE) < scale;
    let too_large = |ratio: f64, scale: f64| ratio * (1.0 - TOLERANCE) > scale;
    let mut ratios: Vec<f64> = samples.iter().map(ScaleSample::ratio).collect();
    ratios.sort_by(f64::total_cmp);
    let inliers = |scale: f64| {
        let first = ratios.partition_point(|ratio| too_small(*ratio, scale));
        ratios.partition_point(|ratio| !too_large(*ratio, scale)) - first
    };
    let best = samples
        .iter()
        .map(ScaleSample::ratio)
        .map(|scale| (inliers(scale), scale))
        .reduce(|best, proposal| if proposal.0 > best.0 { proposal } else { best })?;
    let agree =
        |sample: &&ScaleSample| !too_small(sample.ratio(), best.1) && !too_large(sample.ratio(), best.1);
    let sums = samples.iter().filter(agree).fold((0.0, 0.0), |(zd, dd), sample| {
        (zd + sample.depth * sample.relative, dd + sample.relative * sample.relative)
    });
    Some(sums.0 / sums.1)
}

/// Huber's M-estimate of the scale with delta = 10 %: where the least squares `sum w (s d - Z)^2`, iteratively
/// reweighted by `w = min(1, delta / |r|)` of the relative residual `r = (s d - Z) / Z`, come to rest. `None` without
/// samples.
///
/// They rest where `sum(Z d clamp(r, -delta, delta))` is 0. That sum grows with `s`, so halving finds the place;
/// reweighting itself would take thousands of rounds where few samples agree.
pub(super) fn huber(samples: &[ScaleSample]) -> Option<f64> {
    let ratios: Vec<f64> = samples.iter().map(ScaleSample::ratio).collect();
    let pull = |scale: f64| -> f64 {
        let of_sample = |sample: &ScaleSample| {
            let residual = scale / sample.ratio() - 1.0;
            sample.depth * sample.relative * residual.clamp(-TOLERANCE, TOLERANCE)
        };
        samples.iter().map(of_sample).sum()
    };
    let (least, greatest) =
        (ratios.iter().copied().reduce(f64::min)?, ratios.iter().copied().reduce(f64::max)?);
    let start = median(ratios)?;
    let (mut low, mut high) = if pull(start) > 0.0 { (least, start) } else { (start, greatest) };
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        // Nothing lies between any more.
        if !(low < middle && middle < high) {
            break;
        }
        if pull(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(low)
}

/// The middle value, or the mean of the two middle ones; `None` of nothing.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    let middle = values.len() / 2;
    if values.is_empty() {
        return None;
    }
    let even = values.len().is_multiple_of(2);
    let (below, upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    let upper = *upper;
    let lower = below.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Some(if even { 0.5 * (lower + upper) } else { upper })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn samples(values: &[(f64, f64)]) -> Vec<ScaleSample> {
        let sample = |&(depth, relative)| ScaleSample { pixel: [0.0; 2], depth, relative };
        values.iter().map(sample).collect()
    }

    #[test]
    fn ransac_by_hand() {
        // Three within 10 % of ratio 2 (2, 2.1, 1.9), one outlier, weighed by their depth in the least squares.
        let given = samples(&[(20.0, 10.0), (50.0, 10.0), (21.0, 10.0), (3.8, 2.0)]);
        let expected = (200.0 + 210.0 + 7.6) / (100.0 + 100.0 + 4.0);
        assert!((ransac(&given).unwrap() - expected).abs() < 1e-12);
        // Of two that agree with nobody the earlier wins.
        assert_eq!(ransac(&samples(&[(30.0, 10.0), (10.0, 10.0)])), Some(3.0));
        assert_eq!(ransac(&[]), None);
    }

    #[test]
    fn huber_by_hand() {
        // Three of ratio 1 with Z d = 100, 16, 49, and an outlier of ratio 2 with Z d = 32 that pulls with delta:
        // (100 + 16 + 49) (s - 1) = 0.1 * 32.
        let scale = huber(&samples(&[(10.0, 10.0), (4.0, 4.0), (7.0, 7.0), (8.0, 4.0)])).unwrap();
        assert!((scale - (1.0 + 3.2 / 165.0)).abs() < 1e-10, "{scale}");
        assert_eq!(huber(&samples(&[(30.0, 10.0)])), Some(3.0));
        assert_eq!(huber(&[]), None);
    }

    #[test]
    fn medians() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(vec![4.0, 1.0, 3.0, 2.0]), Some(2.5));
        assert_eq!(median(vec![7.0]), Some(7.0));
        assert_eq!(median(vec![]), None);
    }

    fn brute_force_ransac(samples: &[ScaleSample]) -> Option<f64> {
        let inliers = |scale: f64| -> Vec<&ScaleSample> {
            let fits = |s: &&ScaleSample| {
                let ratio = s.depth / s.relative;
                scale <= ratio * 1.1 && ratio * 0.9 <= scale
            };
            samples.iter().filter(fits).collect()
        };
        let mut best: Vec<&ScaleSample> = vec![];
        for sample in samples {
            let found = inliers(sample.depth / sample.relative);
            best = if found.len() > best.len() { found } else { best };
        }
        let sum = |of: fn(&ScaleSample) -> f64| best.iter().map(|s| of(s)).sum::<f64>();
        (!best.is_empty()).then(|| sum(|s| s.depth * s.relative) / sum(|s| s.relative * s.relative))
    }

    proptest! {
        #[test]
        fn ransac_is_what_brute_force_gives(values in prop::collection::vec((1..30, 1..30), 0..60)) {
            let values: Vec<_> = values.iter().map(|(z, d)| (f64::from(*z), f64::from(*d))).collect();
            prop_assert_eq!(ransac(&samples(&values)), brute_force_ransac(&samples(&values)));
        }

        #[test]
        fn huber_solves_its_equation(values in prop::collection::vec((1.0..30.0, 1.0..30.0), 1..60)) {
            let given = samples(&values);
            let scale = huber(&given).unwrap();
            // One round of reweighting stays where it is, as far as the sums are exact.
            let (sum, squares) = given.iter().fold((0.0, 0.0), |(sum, squares), sample| {
                let residual = (scale * sample.relative - sample.depth) / sample.depth;
                let weight = (TOLERANCE / residual.abs()).min(1.0) * sample.relative;
                (sum + weight * sample.depth, squares + weight * sample.relative)
            });
            prop_assert!((sum / squares / scale - 1.0).abs() < 1e-9, "{} {}", scale, sum / squares);
        }
    }
}
