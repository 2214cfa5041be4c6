//! What is known of a detection before `alpha`, the three `beta` and `w0` come in, and the plausibility that these make
//! of it (docs/method.md, sections 3, 6, 8 and 10).

use ralf::config::{Config, FusionConfig};
use ralf::paper::prioritize;
use ralf::scene::plausibility;

/// What is known of a detection before any of the [`Weights`] comes in. `None` is *not observed*.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DetectionMismatches {
    /// Mean mismatch with the LiDAR's points.
    pub d_lm: Option<f64>,
    /// Mean mismatch with the cameras' points.
    pub d_cm: Option<f64>,
    /// Weighted mismatch with the neighbouring scans.
    pub d_tr: Option<f64>,
    /// A floor detection: never plausible.
    pub on_floor: bool,
    /// In the LiDAR's blind spot, where the cameras answer first.
    pub in_blind_spot: bool,
    /// `gamma_s` of the radar at the detection's azimuth, at least 1.
    pub gamma_s: f64,
}

/// The settings that turn what is observed into a label.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// `beta_lm`.
    pub beta_lm: f64,
    /// `beta_cm`.
    pub beta_cm: f64,
    /// `beta_tr`.
    pub beta_tr: f64,
    /// `alpha` and `w0`.
    pub fusion: FusionConfig,
}

impl From<&Config> for Weights {
    fn from(config: &Config) -> Self {
        Self {
            beta_lm: config.lidar.beta,
            beta_cm: config.camera.beta,
            beta_tr: config.tracking.beta,
            fusion: config.fusion,
        }
    }
}

impl DetectionMismatches {
    /// A detection without a position: whatever the weights, it is not plausible.
    pub const NOTHING: Self =
        Self { d_lm: None, d_cm: None, d_tr: None, on_floor: false, in_blind_spot: false, gamma_s: 1.0 };

    /// What the threshold is compared with: the labeler's `w`, and `None` for a floor detection and where no branch
    /// said anything. It computes `w` for one optical branch alone, the one that counts, because a search does this for
    /// every detection in every trial.
    pub fn plausibility(&self, weights: &Weights) -> Option<f64> {
        if self.on_floor {
            return None;
        }
        let lidar = (weights.beta_lm, self.d_lm);
        let camera = (weights.beta_cm, self.d_cm);
        let (first, second) = if self.in_blind_spot { (camera, lidar) } else { (lidar, camera) };
        let (beta, d) = if first.1.is_some() { first } else { second };
        let w_opt = d.map(|d| plausibility(beta, d));
        let w_tr = self.d_tr.map(|d| plausibility(weights.beta_tr, d));
        prioritize(weights.fusion.alpha, w_opt, w_tr, self.gamma_s)
    }

    /// Whether the detection is plausible with these weights.
    pub fn is_plausible(&self, weights: &Weights) -> bool {
        self.plausibility(weights).is_some_and(|w| w >= weights.fusion.threshold)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use ralf::paper::optical;

    fn mismatch() -> impl Strategy<Value = Option<f64>> {
        prop::option::of(0.0..50.0)
    }

    proptest! {
        #[test]
        fn the_plausibility_is_that_of_the_branch_that_counts(
            [d_lm, d_cm, d_tr] in prop::array::uniform3(mismatch()),
            on_floor in any::<bool>(), in_blind_spot in any::<bool>(), gamma_s in 1.0..2.0,
            [beta_lm, beta_cm, beta_tr] in prop::array::uniform3(0.01..3.0), alpha in 0.0..=1.0,
        ) {
            let mismatches = DetectionMismatches { d_lm, d_cm, d_tr, on_floor, in_blind_spot, gamma_s };
            let weights = Weights { beta_lm, beta_cm, beta_tr, fusion: FusionConfig { alpha, threshold: 0.5 } };
            let weighed = |beta, d: Option<f64>| d.map(|d| plausibility(beta, d));
            let w_opt = optical(in_blind_spot, weighed(beta_lm, d_lm), weighed(beta_cm, d_cm));
            let w = prioritize(alpha, w_opt, weighed(beta_tr, d_tr), gamma_s).filter(|_| !on_floor);
            prop_assert_eq!(mismatches.plausibility(&weights), w);
            prop_assert_eq!(mismatches.is_plausible(&weights), w.is_some_and(|w| w >= 0.5));
        }
    }
}
