//! What is tuned, and among which values.

use super::mismatches::Weights;
use ralf::config::Config;
use std::collections::BTreeSet;

/// Values of `K` and of `n_b` worth a try.
const COUNTS: [usize; 5] = [1, 2, 3, 5, 8];

/// Which branches have a say. A table of mismatches may hold those of more than these.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Branches {
    /// `w_lm`.
    pub lidar: bool,
    /// `w_cm`.
    pub camera: bool,
    /// `w_tr`.
    pub tracking: bool,
}

/// The tuned settings, and the branches that they are meant for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TunedSettings {
    /// `alpha`, the three `beta` and `w0`.
    pub weights: Weights,
    /// `K`.
    pub neighbours: usize,
    /// `n_b`.
    pub scans: usize,
    /// Not tuned.
    pub branches: Branches,
}

impl TunedSettings {
    /// Dotted names of those that are tuned.
    pub const KEYS: [&'static str; 7] = [
        "fusion.alpha",
        "fusion.threshold",
        "lidar.beta",
        "lidar.neighbours",
        "camera.beta",
        "tracking.beta",
        "tracking.scans",
    ];

    /// Those of all settings.
    pub fn from_config(config: &Config) -> Self {
        Self {
            weights: Weights::from(config),
            neighbours: config.lidar.neighbours,
            scans: config.tracking.scans,
            branches: Branches {
                lidar: config.lidar.enabled,
                camera: config.camera.enabled,
                tracking: config.tracking.enabled,
            },
        }
    }

    /// All settings with these among them.
    pub fn applied_to(&self, config: &Config) -> Config {
        let mut config = config.clone();
        config.lidar.beta = self.weights.beta_lm;
        config.camera.beta = self.weights.beta_cm;
        config.tracking.beta = self.weights.beta_tr;
        config.fusion = self.weights.fusion;
        config.lidar.neighbours = self.neighbours;
        config.tracking.scans = self.scans;
        config.lidar.enabled = self.branches.lidar;
        config.camera.enabled = self.branches.camera;
        config.tracking.enabled = self.branches.tracking;
        config
    }

    /// Dotted names and values of those that are tuned.
    pub fn entries(&self) -> [(&'static str, f64); Self::KEYS.len()] {
        let Weights { beta_lm, beta_cm, beta_tr, fusion } = self.weights;
        let (neighbours, scans) = (self.neighbours as f64, self.scans as f64);
        let values = [fusion.alpha, fusion.threshold, beta_lm, neighbours, beta_cm, beta_tr, scans];
        std::array::from_fn(|place| (Self::KEYS[place], values[place]))
    }
}

/// For which `K` and `n_b` mismatches are gathered: each list ascends and holds one value at least.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Space {
    /// Values of `K`.
    pub neighbours: Vec<usize>,
    /// Values of `n_b`.
    pub scans: Vec<usize>,
}

impl Space {
    /// The settings' own values and some usual ones. A branch that is off has nothing to choose.
    pub fn around(config: &Config) -> Self {
        let values = |own: usize, enabled: bool| {
            let usual = COUNTS.into_iter().filter(|_| enabled);
            usual.chain([own]).collect::<BTreeSet<_>>().into_iter().collect()
        };
        Self {
            neighbours: values(config.lidar.neighbours, config.lidar.enabled),
            scans: values(config.tracking.scans, config.tracking.enabled),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_settings_own_values_are_among_the_usual_ones() {
        let config = Config::from_toml("", &["lidar.neighbours=4", "tracking.enabled=false"]).unwrap();
        let space = Space::around(&config);
        assert_eq!((space.neighbours, space.scans), (vec![1, 2, 3, 4, 5, 8], vec![5]));
    }

    #[test]
    fn what_is_applied_is_found_again_and_nothing_else_changes() {
        let base = Config::from_toml("seed = 3", &["ground.model=flat"]).unwrap();
        let other = Config::from_toml(
            "seed = 3",
            &[
                "ground.model=flat",
                "fusion.alpha=0.1",
                "fusion.threshold=0.2",
                "lidar.beta=0.3",
                "lidar.neighbours=4",
                "camera.beta=0.5",
                "tracking.beta=0.6",
                "tracking.scans=7",
                "camera.enabled=false",
            ],
        )
        .unwrap();
        assert_eq!(TunedSettings::from_config(&other).applied_to(&base), other);
    }
}
