//! From a model's log odds to the plausibility of a scan's detections: calibrated, for as many plausible ones as are
//! expected, less where nobody but the radar speaks, and for as many real movers as the scan tells of.

use super::calibration::{Calibration, with_odds};
use super::model::{Model, UseError};
use super::movers::Movers;
use super::rows::Rows;
use super::unconfirmed::Unconfirmed;
use crate::config::LearnedConfig;

/// What a model's log odds are worth with some settings.
#[derive(Debug, Clone)]
pub struct Weighing {
    calibration: Calibration,
    /// What the odds of every detection are multiplied by.
    expected: f64,
    unconfirmed: Unconfirmed,
    /// What those of an unconfirmed one are multiplied by besides.
    factor: f64,
    /// `None` where the settings don't ask for it.
    movers: Option<Movers>,
}

impl Weighing {
    /// Of a model with settings, for rows of features of these names.
    pub fn new<'a>(
        model: &Model,
        names: impl Iterator<Item = &'a str> + Clone,
        config: &LearnedConfig,
    ) -> Self {
        let (known, wanted) = (model.share(), wanted(model, config));
        let share = if turns(known, wanted) { wanted } else { known };
        let as_calibrated = Self::as_calibrated(model.calibration.clone(), share, names, config);
        Self { expected: expected(known, wanted), ..as_calibrated }
    }

    /// By a calibration whose probabilities expect so large a share of plausible ones; no other is expected.
    pub fn as_calibrated<'a>(
        calibration: Calibration,
        share: f64,
        names: impl Iterator<Item = &'a str> + Clone,
        config: &LearnedConfig,
    ) -> Self {
        Self {
            calibration,
            expected: 1.0,
            unconfirmed: Unconfirmed::among(names.clone()),
            factor: config.unconfirmed,
            movers: config.movers.then(|| Movers::among(names, share)),
        }
    }

    /// Whether nobody but the radar tells of the detection of a row.
    pub fn is_unconfirmed(&self, row: &[f32]) -> bool {
        self.unconfirmed.is(row)
    }

    /// The plausibility of each of a scan's detections, whose log odds the model says.
    pub fn plausibilities(&self, rows: &Rows, log_odds: &[f64]) -> Vec<f64> {
        let mut weighed = Vec::with_capacity(rows.len());
        for (row, log_odds) in log_odds.iter().enumerate() {
            let calibrated = with_odds(self.calibration.probability(*log_odds), self.expected);
            weighed.push(self.unconfirmed.weighed(rows.row(row), calibrated, self.factor));
        }
        if let Some(movers) = &self.movers {
            movers.weigh(rows, &mut weighed);
        }
        weighed
    }
}

/// Refuses a share in the settings that nothing can be turned into: the model doesn't tell its own.
pub(super) fn refuse_unknown_share(model: &Model, config: &LearnedConfig) -> Result<(), UseError> {
    if config.share > 0.0 && !turns(model.share(), config.share) {
        return Err(UseError::NoShare);
    }
    Ok(())
}

/// The share of plausible detections that the settings expect, or else the model; 0 where neither does.
fn wanted(model: &Model, config: &LearnedConfig) -> f64 {
    if config.share > 0.0 { config.share } else { model.expects.unwrap_or(0.0) }
}

/// What turns odds where so large a share is plausible into those where another is: Bayes' rule, with whatever makes
/// plausible ones look as they do unchanged (label shift). 1 where either is not known, which 0 says, and where a model
/// has seen plausible ones alone, to whom no odds are known.
fn expected(known: f64, wanted: f64) -> f64 {
    if turns(known, wanted) { (wanted / (1.0 - wanted)) / (known / (1.0 - known)) } else { 1.0 }
}

/// Whether both shares are known, so that one can be turned into the other.
fn turns(known: f64, wanted: f64) -> bool {
    known > 0.0 && known < 1.0 && wanted > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_say_more_of_the_share_than_the_model() {
        let (mut model, mut config) = (Model::shipped().unwrap(), LearnedConfig::default());
        assert_eq!((model.expects, wanted(&model, &config)), (Some(0.3), 0.3));
        config.share = 0.2;
        assert_eq!(wanted(&model, &config), 0.2);
        (model.expects, config.share) = (None, 0.0);
        assert_eq!(wanted(&model, &config), 0.0);
    }

    #[test]
    fn a_share_can_be_asked_of_models_that_tell_their_own() {
        let (mut model, mut config) = (Model::shipped().unwrap(), LearnedConfig::default());
        config.share = 0.2;
        assert_eq!(refuse_unknown_share(&model, &config), Ok(()));
        model.origin.worlds.clear();
        assert_eq!(refuse_unknown_share(&model, &config), Err(UseError::NoShare));
        config.share = 0.0;
        assert_eq!(refuse_unknown_share(&model, &config), Ok(()));
    }

    #[test]
    fn of_what_says_nothing_as_many_are_plausible_as_expected() {
        for (known, wanted) in [(0.41, 0.2), (0.41, 0.41), (0.1, 0.6)] {
            assert!((with_odds(known, expected(known, wanted)) - wanted).abs() < 1e-12, "{known} {wanted}");
        }
        assert_eq!([expected(0.41, 0.0), expected(0.0, 0.2), expected(1.0, 0.2)], [1.0; 3]);
    }
}
