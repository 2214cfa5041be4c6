//! Whether a view's calibrated depth can be trusted (docs/method.md, section 5).

use super::grid::PixelGrid;
use super::scaling::{ScaleSample, Scaling, median};
use crate::config::CameraConfig;
use crate::sensors::CameraImage;
use serde::{Deserialize, Serialize};

/// What was found about a view's depth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ViewReport {
    /// Whether the view is used.
    pub state: ViewState,
    /// Median of `|Z - Z_lidar| / Z_lidar` over the samples of odd index, calibrated by those of even index. `None`
    /// with fewer than two samples.
    pub residual: Option<f64>,
    /// LiDAR points in the view that nothing occludes, on pixels that have a depth.
    pub samples: usize,
    /// Mean luminance of the raw image, 0 to 255.
    pub luminance: f64,
}

/// Whether a view is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ViewState {
    /// Its depth is metric.
    Calibrated,
    /// It is left out, and what lies in it is flagged.
    Failed(Failure),
}

/// Why a view is left out. Where several reasons hold, it is the first of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Failure {
    /// Image or depth can't be read, or aren't those of the camera.
    Unusable,
    /// No LiDAR scan was near enough in time.
    NoScan,
    /// The raw image is darker than `camera.min_luminance`.
    Dark,
    /// Fewer samples than `camera.min_samples`, or than the two without which nothing can be checked.
    FewSamples,
    /// The residual is above `camera.max_residual`.
    Residual,
}

impl ViewReport {
    /// The report on a view with these samples; `None` where there was no LiDAR scan.
    pub(super) fn new(samples: Option<&[ScaleSample]>, luminance: f64, config: &CameraConfig) -> Self {
        let found = samples.unwrap_or_default();
        let residual = residual(found, config);
        let bright = luminance >= config.min_luminance;
        let enough = found.len() >= config.min_samples && residual.is_some();
        let close = residual.is_some_and(|residual| residual <= config.max_residual);
        let checks = [
            (samples.is_some(), Failure::NoScan),
            (bright, Failure::Dark),
            (enough, Failure::FewSamples),
            (close, Failure::Residual),
        ];
        let failure = checks.into_iter().find(|(passed, _)| !passed).map(|(_, failure)| failure);
        let state = failure.map_or(ViewState::Calibrated, ViewState::Failed);
        Self { state, residual, samples: found.len(), luminance }
    }
}

/// The median relative error of the samples of odd index when those of even index calibrate them.
fn residual(samples: &[ScaleSample], config: &CameraConfig) -> Option<f64> {
    let every_other = |first: usize| samples.iter().skip(first).step_by(2).copied().collect::<Vec<_>>();
    let [even, odd] = [every_other(0), every_other(1)];
    let scaling = Scaling::fit(config.scaling, &even, config.scale_neighbours)?;
    // A median does not mind the order, and neighbours in a row are quicker to calibrate.
    let pixels: Vec<[f64; 2]> = odd.iter().map(|sample| sample.pixel).collect();
    let order: Vec<usize> = PixelGrid::balanced(&pixels).order().collect();
    let scales = scaling.at(order.iter().map(|index| pixels[*index]));
    let error = |(index, scale): (&usize, f64)| {
        let ScaleSample { depth, relative, .. } = odd[*index];
        (scale * relative - depth).abs() / depth
    };
    median(order.iter().zip(scales).map(error).collect())
}

/// Mean luminance (BT.601: 0.299 R + 0.587 G + 0.114 B) of an image, 0 to 255; 0 of an empty one.
pub fn luminance(image: &CameraImage) -> f64 {
    // Whole numbers add up exactly and fast; the weights come last.
    let [red, green, blue] = sums(&image.rgb).map(|sum| sum as f64 / image.rgb.len().max(1) as f64);
    0.299 * red + 0.587 * green + 0.114 * blue
}

/// The sums of red, green and blue.
fn sums(pixels: &[[u8; 3]]) -> [u64; 3] {
    let mut sums = [0; 3];
    // Each byte of sixteen pixels has a sum of its own, so that they add up side by side; none overflows in a part.
    for part in pixels.chunks(1 << 20) {
        let (blocks, rest) = part.as_chunks::<16>();
        let mut lanes = [0_u32; 48];
        for block in blocks {
            lanes.iter_mut().zip(block.as_flattened()).for_each(|(lane, value)| *lane += u32::from(*value));
        }
        let rest = rest.as_flattened().iter().copied().map(u32::from);
        for (place, value) in lanes.into_iter().chain(rest).enumerate() {
            sums[place % 3] += u64::from(value);
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::DepthScaling;
    use proptest::prelude::*;

    /// A row of samples with the given ratios of LiDAR depth to relative depth.
    fn row(ratios: &[f64]) -> Vec<ScaleSample> {
        let sample = |(i, ratio): (usize, &f64)| ScaleSample {
            pixel: [10.0 * i as f64, 5.0],
            depth: 4.0 * ratio,
            relative: 4.0,
        };
        ratios.iter().enumerate().map(sample).collect()
    }

    fn config(scaling: DepthScaling) -> CameraConfig {
        CameraConfig { scaling, scale_neighbours: 1, min_samples: 4, ..CameraConfig::default() }
    }

    fn report(samples: &[ScaleSample]) -> ViewReport {
        ViewReport::new(Some(samples), 100.0, &config(DepthScaling::Local))
    }

    #[test]
    fn even_samples_calibrate_odd_ones() {
        // Equally far from both sides, an odd sample takes the earlier even one: 2 for 2.5, 2 for 1.6, 4 for 4.
        let found = report(&row(&[2.0, 2.5, 2.0, 1.6, 4.0, 4.0]));
        assert_eq!((found.state, found.samples), (ViewState::Calibrated, 6));
        assert!((found.residual.unwrap() - 0.5 / 2.5).abs() < 1e-12);
        // Of two errors, 0.2 and 0.25, the median is the mean.
        let found = report(&row(&[2.0, 2.5, 2.0, 1.6]));
        assert!((found.residual.unwrap() - 0.225).abs() < 1e-12);
    }

    /// The residual as it is written down, without any search structure.
    fn naive_residual(samples: &[ScaleSample], k: usize) -> f64 {
        let even: Vec<&ScaleSample> = samples.iter().step_by(2).collect();
        let error = |odd: &ScaleSample| {
            let distance = |s: &ScaleSample| (s.pixel[0] - odd.pixel[0]).hypot(s.pixel[1] - odd.pixel[1]);
            let mut near = even.clone();
            near.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
            near.truncate(k);
            let weight = |s: &ScaleSample| 1.0 / (distance(s) + 1.0);
            let sum: f64 = near.iter().map(|s| weight(s) * s.depth / s.relative).sum();
            let weights: f64 = near.iter().map(|s| weight(s)).sum();
            (odd.relative * sum / weights - odd.depth).abs() / odd.depth
        };
        let mut errors: Vec<f64> = samples.iter().skip(1).step_by(2).map(error).collect();
        errors.sort_by(f64::total_cmp);
        0.5 * (errors[(errors.len() - 1) / 2] + errors[errors.len() / 2])
    }

    proptest! {
        #[test]
        fn the_residual_is_what_the_naive_way_gives(
            values in prop::collection::vec((0.0..320.0, 0.0..240.0, 1.0..40.0, 0.1..9.0), 2..80),
            k in 1_usize..6,
        ) {
            let sample = |&(u, v, depth, relative)| ScaleSample { pixel: [u, v], depth, relative };
            let samples: Vec<_> = values.iter().map(sample).collect();
            let config = CameraConfig { scale_neighbours: k, ..config(DepthScaling::Local) };
            let found = ViewReport::new(Some(&samples), 100.0, &config).residual.unwrap();
            let expected = naive_residual(&samples, k);
            prop_assert!((found - expected).abs() < 1e-9 * (1.0 + expected), "{} {}", found, expected);
        }
    }

    #[test]
    fn every_reason_to_fail() {
        let good = row(&[2.0; 6]);
        let failed = |samples: Option<&[ScaleSample]>, luminance: f64| {
            ViewReport::new(samples, luminance, &config(DepthScaling::Local)).state
        };
        assert_eq!(failed(Some(&good), 10.0), ViewState::Calibrated, "the limit itself is bright enough");
        assert_eq!(failed(Some(&good), 9.99), ViewState::Failed(Failure::Dark));
        assert_eq!(failed(None, 100.0), ViewState::Failed(Failure::NoScan));
        assert_eq!(failed(Some(&good[..3]), 100.0), ViewState::Failed(Failure::FewSamples));
        assert_eq!(failed(Some(&good[..4]), 100.0), ViewState::Calibrated);
        assert_eq!(failed(Some(&row(&[2.0, 4.0, 2.0, 4.0])), 100.0), ViewState::Failed(Failure::Residual));
        // Recorded nevertheless.
        assert_eq!(report(&row(&[2.0, 4.0, 2.0, 4.0])).residual, Some(0.5));
    }

    #[test]
    fn without_two_samples_nothing_can_be_checked() {
        let lenient = CameraConfig { min_samples: 0, ..config(DepthScaling::None) };
        for few in [&row(&[])[..], &row(&[1.0])[..]] {
            let found = ViewReport::new(Some(few), 100.0, &lenient);
            assert_eq!((found.state, found.residual), (ViewState::Failed(Failure::FewSamples), None));
        }
    }

    #[test]
    fn metric_depth_is_compared_as_it_is() {
        let found = ViewReport::new(Some(&row(&[9.0, 1.25, 9.0, 1.25])), 100.0, &config(DepthScaling::None));
        assert!((found.residual.unwrap() - 0.2).abs() < 1e-12);
    }

    #[test]
    fn luminance_by_hand() {
        let image = CameraImage { width: 2, height: 1, rgb: vec![[255, 0, 0], [0, 100, 50]] };
        assert!((luminance(&image) - (0.299 * 255.0 + 0.587 * 100.0 + 0.114 * 50.0) / 2.0).abs() < 1e-12);
        assert_eq!(luminance(&CameraImage { width: 0, height: 0, rgb: vec![] }), 0.0);
    }

    #[test]
    fn colours_add_up_whatever_the_number_of_pixels() {
        for count in [0, 1, 15, 16, 17, 100, (1 << 20) + 19] {
            let pixels: Vec<[u8; 3]> = (0..count).map(|i| [i as u8, 255, (i / 7) as u8]).collect();
            let expected = pixels.iter().fold([0; 3], |sums: [u64; 3], pixel| {
                std::array::from_fn(|channel| sums[channel] + u64::from(pixel[channel]))
            });
            assert_eq!(sums(&pixels), expected);
        }
    }
}
