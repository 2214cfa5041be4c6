//! The search: a tree-structured Parzen estimator over `alpha`, the three `beta`, `K` and `n_b`.

mod thinned;

use super::threshold::{Cut, Weighed};
use super::{MismatchTable, Objective, TuneError, TunedSettings};
use ralf::config::Config;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::fmt::Display;
use thinned::Thinned;
use tpe::TpeOptimizer;

/// Trials at random before the estimator has something to go by.
const RANDOM_TRIALS: usize = 20;
/// Decadic logarithms of the smallest and the largest `beta`.
const LOG_BETA: (f64, f64) = (-2.0, 1.0);

/// What is sought, and for how long.
#[derive(Debug, Clone)]
pub struct Search<'a> {
    /// The first trial, and the value of what has nothing to say.
    pub base: &'a Config,
    /// What is maximised over the pooled detections.
    pub objective: Objective,
    /// How many settings are tried beside the base's.
    pub trials: usize,
    /// Seed of all choices: the same seed finds the same settings.
    pub seed: u64,
    /// Dotted names of settings that stay as they are.
    pub held: Vec<String>,
}

/// The best settings so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// The settings.
    pub settings: TunedSettings,
    /// What they reach on the training tables.
    pub score: f64,
}

impl Search<'_> {
    /// Whether anything can be found on some tables together.
    ///
    /// # Errors
    /// Base settings out of their range; tables without plausible detections, or without artifacts.
    pub fn check(&self, tables: &[&MismatchTable]) -> Result<(), TuneError> {
        self.base.check()?;
        BranchesSeen::new(tables, &TunedSettings::from_config(self.base)).map(drop)
    }

    /// The best settings for some tables together; never worse there than the base's. `progress` is told of each trial,
    /// counted from 1, and of the best so far.
    pub fn run(
        &self,
        tables: &[&MismatchTable],
        progress: &mut dyn FnMut(usize, &Found),
    ) -> Result<Found, TuneError> {
        self.base.check()?;
        let base = TunedSettings::from_config(self.base);
        let observed = BranchesSeen::new(tables, &base)?;
        let mut dials = Dials::new(tables, &base, &observed, &|key| self.is_free(key))?;
        let mut rng = Pcg64Mcg::seed_from_u64(self.seed);
        let mut best = self.with_best_threshold(tables, base)?;
        for trial in 1..=self.trials {
            dials.turn(&mut rng, trial <= RANDOM_TRIALS)?;
            let found = self.with_best_threshold(tables, dials.settings(&base))?;
            dials.tell(-found.score)?;
            if found.score > best.score {
                best = found;
            }
            progress(trial, &best);
        }
        Ok(best)
    }

    fn is_free(&self, key: &str) -> bool {
        !self.held.iter().any(|held| held == key)
    }

    /// The settings with the `w0` that suits them best, unless it is held.
    fn with_best_threshold(
        &self,
        tables: &[&MismatchTable],
        mut settings: TunedSettings,
    ) -> Result<Found, TuneError> {
        let mut weighed = Weighed::with_capacity(tables.iter().map(|table| table.len()).sum());
        for table in tables {
            for (observed, plausible) in table.view(&settings)?.rows() {
                weighed.add(observed.plausibility(&settings.weights), plausible);
            }
        }
        if !self.is_free("fusion.threshold") {
            let counts = weighed.counts_at(settings.weights.fusion.threshold);
            return Ok(Found { settings, score: self.objective.score(&counts) });
        }
        let Cut { threshold, score, .. } = weighed.best_cut(self.objective);
        settings.weights.fusion.threshold = threshold;
        Ok(Found { settings, score })
    }
}

/// Which branches say anything at all.
struct BranchesSeen {
    lidar: bool,
    camera: bool,
    tracking: bool,
}

impl BranchesSeen {
    /// Looks through the tables, which must hold both classes.
    fn new(tables: &[&MismatchTable], base: &TunedSettings) -> Result<Self, TuneError> {
        let mut observed = Self { lidar: false, camera: false, tracking: false };
        let (mut plausible, mut artifact) = (false, false);
        for table in tables {
            for (found, truth) in table.view(base)?.rows() {
                observed.lidar |= found.d_lm.is_some();
                observed.camera |= found.d_cm.is_some();
                observed.tracking |= found.d_tr.is_some();
                plausible |= truth;
                artifact |= !truth;
            }
        }
        match (plausible, artifact) {
            (true, true) => Ok(observed),
            (false, _) => Err(TuneError::OneClass("plausible detections")),
            (_, false) => Err(TuneError::OneClass("artifacts")),
        }
    }
}

/// What is searched: `None` where the value would not matter.
struct Dials {
    alpha: Option<Dial>,
    beta_lm: Option<Dial>,
    beta_cm: Option<Dial>,
    beta_tr: Option<Dial>,
    /// A place in the list.
    neighbours: Option<(Dial, Vec<usize>)>,
    scans: Option<(Dial, Vec<usize>)>,
}

impl Dials {
    fn new(
        tables: &[&MismatchTable],
        base: &TunedSettings,
        observed: &BranchesSeen,
        is_free: &dyn Fn(&str) -> bool,
    ) -> Result<Self, TuneError> {
        let BranchesSeen { lidar, camera, tracking } = *observed;
        let number =
            |key, applies: bool, range| (applies && is_free(key)).then(|| Dial::number(range)).transpose();
        let choice = |key, applies: bool, values: Vec<usize>| {
            let applies = applies && is_free(key) && values.len() > 1;
            applies.then(|| Ok::<_, TuneError>((Dial::choice(values.len())?, values))).transpose()
        };
        let space = tables.first().map(|table| table.space());
        let neighbours = space.map_or(vec![base.neighbours], |space| space.neighbours.clone());
        let scans = space.map_or(vec![base.scans], |space| space.scans.clone());
        Ok(Self {
            alpha: number("fusion.alpha", (lidar || camera) && tracking, (0.0, 1.0))?,
            beta_lm: number("lidar.beta", lidar, LOG_BETA)?,
            beta_cm: number("camera.beta", camera, LOG_BETA)?,
            beta_tr: number("tracking.beta", tracking, LOG_BETA)?,
            neighbours: choice("lidar.neighbours", lidar, neighbours)?,
            scans: choice("tracking.scans", tracking, scans)?,
        })
    }

    fn all(&mut self) -> impl Iterator<Item = &mut Dial> {
        let numbers = [&mut self.alpha, &mut self.beta_lm, &mut self.beta_cm, &mut self.beta_tr];
        let choices = [&mut self.neighbours, &mut self.scans];
        let choices = choices.into_iter().flatten().map(|(dial, _)| dial);
        numbers.into_iter().flatten().chain(choices)
    }

    /// The next trial.
    fn turn(&mut self, rng: &mut Pcg64Mcg, at_random: bool) -> Result<(), TuneError> {
        self.all().try_for_each(|dial| dial.turn(rng, at_random))
    }

    /// How the trial went; less is better.
    fn tell(&mut self, loss: f64) -> Result<(), TuneError> {
        self.all().try_for_each(|dial| dial.optimiser.tell(dial.value, loss).map_err(refused))
    }

    /// The settings of the trial, rounded to what people read.
    fn settings(&self, base: &TunedSettings) -> TunedSettings {
        let beta = |dial: &Option<Dial>, base: f64| {
            dial.as_ref().map_or(base, |dial| three_digits(10.0_f64.powf(dial.value)))
        };
        let count = |dial: &Option<(Dial, Vec<usize>)>, base: usize| {
            dial.as_ref().and_then(|(dial, values)| values.get(dial.value as usize)).copied().unwrap_or(base)
        };
        let mut settings = *base;
        let weights = &mut settings.weights;
        if let Some(alpha) = &self.alpha {
            weights.fusion.alpha = (alpha.value * 1000.0).round() / 1000.0;
        }
        weights.beta_lm = beta(&self.beta_lm, weights.beta_lm);
        weights.beta_cm = beta(&self.beta_cm, weights.beta_cm);
        weights.beta_tr = beta(&self.beta_tr, weights.beta_tr);
        settings.neighbours = count(&self.neighbours, base.neighbours);
        settings.scans = count(&self.scans, base.scans);
        settings
    }
}

/// One searched value.
struct Dial {
    optimiser: TpeOptimizer<Thinned>,
    range: (f64, f64),
    value: f64,
}

impl Dial {
    fn number((low, high): (f64, f64)) -> Result<Self, TuneError> {
        let range = tpe::range(low, high).map_err(refused)?;
        Ok(Self {
            optimiser: TpeOptimizer::new(Thinned(tpe::parzen_estimator()), range),
            range: (low, high),
            value: low,
        })
    }

    fn choice(count: usize) -> Result<Self, TuneError> {
        let range = tpe::categorical_range(count).map_err(refused)?;
        let optimiser = TpeOptimizer::new(Thinned(tpe::histogram_estimator()), range);
        Ok(Self { optimiser, range: (0.0, count as f64), value: 0.0 })
    }

    fn turn(&mut self, rng: &mut Pcg64Mcg, at_random: bool) -> Result<(), TuneError> {
        self.value = if at_random {
            rng.random_range(self.range.0..self.range.1)
        } else {
            self.optimiser.ask(rng).map_err(refused)?
        };
        Ok(())
    }
}

fn refused(error: impl Display) -> TuneError {
    TuneError::Optimiser(error.to_string())
}

/// Three digits that count.
fn three_digits(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests;

#[cfg(test)]
pub(super) use tests::planted;
