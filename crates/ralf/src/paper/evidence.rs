//! From what is known of a detection to its label: everything that depends on `alpha`, the three `beta` and `w0` alone
//! (docs/method.md, sections 3, 6, 8 and 10). Labelling and tuning both go this way.

use super::fusion::{optical, prioritize};
use crate::config::{Config, FusionConfig};
use crate::scene::plausibility;

/// What is known of a detection before any of the [`Weights`] comes in. `None` is *not observed*.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
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

/// The settings that turn evidence into a label.
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

/// What the weights make of the evidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Verdict {
    /// `exp(-beta_lm d_lm)`.
    pub w_lm: Option<f64>,
    /// `exp(-beta_cm d_cm)`.
    pub w_cm: Option<f64>,
    /// `exp(-beta_tr d_tr)`.
    pub w_tr: Option<f64>,
    /// Of LiDAR and cameras together.
    pub w_opt: Option<f64>,
    /// The plausibility; `None` where no branch could say anything.
    pub w: Option<f64>,
    /// Whether the detection is plausible.
    pub plausible: bool,
}

impl Weights {
    /// Those of all settings.
    pub fn of(config: &Config) -> Self {
        Self {
            beta_lm: config.lidar.beta,
            beta_cm: config.camera.beta,
            beta_tr: config.tracking.beta,
            fusion: config.fusion,
        }
    }
}

impl Evidence {
    /// Plausibility and label: `w = exp(-beta d)` of each branch, then the paper's equations 5, 6 and 9.
    pub fn weigh(&self, weights: &Weights) -> Verdict {
        let optical_branch = |beta, d: Option<f64>| {
            if self.on_floor { Some(0.0) } else { d.map(|d| plausibility(beta, d)) }
        };
        let w_lm = optical_branch(weights.beta_lm, self.d_lm);
        let w_cm = optical_branch(weights.beta_cm, self.d_cm);
        let w_tr = self.d_tr.map(|d| plausibility(weights.beta_tr, d));
        let w_opt = optical(self.in_blind_spot, w_lm, w_cm);
        let w = prioritize(&weights.fusion, w_opt, w_tr, self.gamma_s);
        let plausible = !self.on_floor && w.is_some_and(|w| w >= weights.fusion.threshold);
        Verdict { w_lm, w_cm, w_tr, w_opt, w, plausible }
    }

    /// What a threshold is compared with: the verdict's `w`, and `None` of a floor detection. It asks but the one
    /// optical branch that has the say, for a search does this for every detection in every trial.
    pub fn plausibility(&self, weights: &Weights) -> Option<f64> {
        if self.on_floor {
            return None;
        }
        let w_lm = || self.d_lm.map(|d| plausibility(weights.beta_lm, d));
        let w_cm = || self.d_cm.map(|d| plausibility(weights.beta_cm, d));
        let w_opt = if self.in_blind_spot { w_cm().or_else(w_lm) } else { w_lm().or_else(w_cm) };
        let w_tr = self.d_tr.map(|d| plausibility(weights.beta_tr, d));
        prioritize(&weights.fusion, w_opt, w_tr, self.gamma_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn mismatch() -> impl Strategy<Value = Option<f64>> {
        prop::option::of(0.0..50.0)
    }

    proptest! {
        #[test]
        fn the_plausibility_is_the_verdicts(
            [d_lm, d_cm, d_tr] in prop::array::uniform3(mismatch()),
            on_floor in any::<bool>(), in_blind_spot in any::<bool>(), gamma_s in 1.0..2.0,
            [beta_lm, beta_cm, beta_tr] in prop::array::uniform3(0.01..3.0), alpha in 0.0..=1.0,
        ) {
            let evidence = Evidence { d_lm, d_cm, d_tr, on_floor, in_blind_spot, gamma_s };
            let fusion = FusionConfig { alpha, threshold: 0.5 };
            let weights = Weights { beta_lm, beta_cm, beta_tr, fusion };
            let verdict = evidence.weigh(&weights);
            prop_assert_eq!(evidence.plausibility(&weights), verdict.w.filter(|_| !on_floor));
        }
    }
}
