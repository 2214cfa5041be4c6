//! From a table to a model: cross-fitted, judged and calibrated world by world.

use super::asked;
use super::balance::weights;
use super::blanking::blanked;
use super::boosting::{Bins, Examples, Grown, boost};
use super::calibrate::calibration;
use super::causes::cause_forests;
use super::fitting::Fitting;
use super::judge::{LeftOut, answered, judge};
use super::monotone::direction;
use super::net::{Scans, fit_net};
use super::range::Range;
use super::table::{Known, TrainingTable};
use ralf::learned::net::Net;
use ralf::learned::{Input, Model, Origin, Rows, Seen, UseError};
use ralf_jobs::side_by_side;
use std::collections::BTreeSet;
use std::convert::Infallible;
use thiserror::Error;

/// A model with what it is worth.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// Fitted to all worlds.
    pub model: Model,
    /// How well models do that never saw a world, by world.
    pub left_out: Vec<LeftOut>,
}

/// Why no model can be fitted.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LearnError {
    /// Nothing is learned from one class.
    #[error("expected plausible detections and artifacts to learn from, found {plausible} and {artifacts}")]
    OneClass {
        /// How many are plausible.
        plausible: usize,
        /// How many are not.
        artifacts: usize,
    },
    /// A model that learned one class says the same of everything, which would be taken for what models say of a world.
    #[error(
        "expected plausible detections and artifacts in two worlds or more, so that each can be left out; found no \
         {missing} without {left_out}"
    )]
    OneClassWithout {
        /// The world that holds the only ones.
        left_out: String,
        /// Which they are.
        missing: &'static str,
    },
    /// Nothing is corrected of a model whose answers are one.
    #[error(
        "expected a model that tells detections apart, found one whose probabilities go from {low:.2} to {high:.2}"
    )]
    SaysTheSame {
        /// The lowest probability that it ever tells.
        low: f64,
        /// The highest.
        high: f64,
    },
    /// Leaving one out must leave another.
    #[error(
        "expected recordings of two worlds or more, so that one can be left out and judged by; found {0}"
    )]
    TooFewWorlds(usize),
    /// A model of nothing says the same of everything.
    #[error("expected evidence that was observed of some detection, found none in the groups to learn from")]
    NothingObserved,
    /// Nothing is learned where nobody spoke.
    #[error("expected detections of which somebody said whether they are plausible, found none")]
    NothingSaid,
    /// What such a model knows would be learned twice, and judged by what it heard.
    #[error("expected a model as it was before it was corrected, found one that knows corrections already")]
    AlreadyCorrected,
    /// A model that reads what is not observed.
    #[error(transparent)]
    Use(#[from] UseError),
}

impl LearnError {
    /// Refuses what is all plausible or all artifacts.
    pub(super) fn of_one_class(target: impl Iterator<Item = bool>) -> Result<(), Self> {
        let [mut plausible, mut artifacts] = [0; 2];
        target.for_each(|is_plausible| *if is_plausible { &mut plausible } else { &mut artifacts } += 1);
        if plausible > 0 && artifacts > 0 { Ok(()) } else { Err(Self::OneClass { plausible, artifacts }) }
    }
}

/// The share of scans that lack a group of evidence, for a net: as many as for trees, in the mean.
const BLANKED: f64 = 0.1;

/// What is fitted without a world, or to all of them.
struct Fold {
    grown: Grown,
    net: Option<Net>,
}

/// What forests are grown of, and nets fitted to.
struct Ground<'a> {
    table: &'a TrainingTable,
    /// As they are fitted to: with groups blanked.
    rows: Rows,
    bins: Bins,
    target: Vec<bool>,
    weights: Vec<f32>,
    monotone: Vec<i8>,
}

/// Fits a model to a table. `origin` names where it comes from; its worlds are filled in here. `progress` is told how
/// many forests of how many are grown, each with its net.
///
/// # Errors
/// A table of one class, of fewer than two worlds, or of which nothing was observed.
pub fn fit(
    table: &TrainingTable,
    fitting: &Fitting,
    origin: Origin,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Fitted, LearnError> {
    refuse_what_cannot_be_learned(table)?;
    let ground = Ground::new(table, fitting);
    let worlds = table.worlds.len();
    // One without each world, and the last with all.
    let left_out: Vec<Option<u16>> = (0..worlds).map(|world| Some(world as u16)).chain([None]).collect();
    let done = std::sync::atomic::AtomicUsize::new(0);
    let Ok(mut folds) = side_by_side(&left_out, fitting.jobs, |left_out| {
        let fold = Fold { grown: ground.grow(*left_out, fitting), net: ground.fit_net(*left_out, fitting) };
        progress(done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1, worlds + 1);
        Ok::<_, Infallible>(fold)
    });
    let Some(Fold { grown: whole, net }) = folds.pop() else { return Err(LearnError::TooFewWorlds(0)) };
    let log_odds = out_of_fold(table, &folds);
    let left_out = judge(table, &log_odds, fitting);
    let everywhere = calibration(&answered(table, &log_odds, |_| true));
    let causes =
        if fitting.causes { cause_forests(table, &ground.rows, &ground.bins, fitting) } else { Vec::new() };
    let model = Model {
        origin: Origin { worlds: left_out.iter().map(LeftOut::told).collect(), ..origin },
        expects: fitting.expects,
        inputs: inputs(table, &whole.gains),
        plausible: whole.forest,
        net,
        calibration: everywhere,
        causes,
        corrected: None,
    };
    Ok(Fitted { model, left_out })
}

fn refuse_what_cannot_be_learned(table: &TrainingTable) -> Result<(), LearnError> {
    LearnError::of_one_class(table.known.iter().map(|known| known.plausible))?;
    // Of some nothing may be known: without rows, they are none.
    let worlds = table.known.iter().map(|known| known.world).collect::<BTreeSet<_>>().len();
    if worlds < 2 {
        return Err(LearnError::TooFewWorlds(worlds));
    }
    refuse_one_class_without(table)?;
    let is_observed = |row: usize| table.rows.row(row).iter().any(|value| !value.is_nan());
    if (0..table.len()).any(is_observed) { Ok(()) } else { Err(LearnError::NothingObserved) }
}

/// Refuses worlds of which one holds all plausible detections, or all artifacts.
fn refuse_one_class_without(table: &TrainingTable) -> Result<(), LearnError> {
    for (is_plausible, missing) in [(true, "plausible detections"), (false, "artifacts")] {
        let of_class = table.known.iter().filter(|known| known.plausible == is_plausible);
        let holding: BTreeSet<u16> = of_class.map(|known| known.world).collect();
        if let (Some(world), 1) = (holding.first(), holding.len()) {
            let left_out = table.worlds[usize::from(*world)].clone();
            return Err(LearnError::OneClassWithout { left_out, missing });
        }
    }
    Ok(())
}

impl<'a> Ground<'a> {
    fn new(table: &'a TrainingTable, fitting: &Fitting) -> Self {
        let rows =
            if fitting.blanking { blanked(table, fitting.parameters.seed) } else { table.rows.clone() };
        let bins = Bins::new(&rows);
        Self {
            table,
            bins,
            rows,
            target: table.known.iter().map(|known| known.plausible).collect(),
            weights: weights(table),
            monotone: table.features.iter().map(|feature| direction(feature.name)).collect(),
        }
    }

    fn grow(&self, left_out: Option<u16>, fitting: &Fitting) -> Grown {
        let known = self.table.known.iter().enumerate();
        let train: Vec<u32> =
            known.filter(|(_, known)| Some(known.world) != left_out).map(|(row, _)| row as u32).collect();
        let examples = Examples {
            rows: &self.rows,
            bins: &self.bins,
            target: &self.target,
            weights: &self.weights,
            monotone: &self.monotone,
            begin: None,
        };
        boost(&examples, &train, &fitting.parameters)
    }

    /// The net beside the forest, where one is asked for. Groups of evidence lack in other scans of every step.
    fn fit_net(&self, left_out: Option<u16>, fitting: &Fitting) -> Option<Net> {
        let parameters = fitting.net.as_ref()?;
        let all = 0..self.table.worlds.len() as u16;
        let worlds: Vec<u16> = all.filter(|world| Some(*world) != left_out).collect();
        let blanked = if fitting.blanking { BLANKED } else { 0.0 };
        // What a scan holds tells a net which movers are real: weighed as for trees it is worse (learned-tried.md).
        Some(fit_net(&Scans::new(self.table), &worlds, parameters, blanked, fitting.parameters.seed))
    }
}

/// The log odds of every row by what was fitted without its world; of what was observed, nothing blanked.
fn out_of_fold(table: &TrainingTable, folds: &[Fold]) -> Vec<f64> {
    let mut log_odds = vec![0.0; table.len()];
    for (world, Fold { grown, net }) in folds.iter().enumerate() {
        let is_here = |row: &usize| usize::from(table.known[*row].world) == world;
        let places: Vec<usize> = (0..table.len()).filter(is_here).collect();
        let known: Vec<Known> = places.iter().map(|row| table.known[*row]).collect();
        let rows = table.rows.pick(places.iter().copied());
        for (row, answer) in
            places.into_iter().zip(asked::log_odds(&grown.forest, net.as_ref(), &rows, &known))
        {
            log_odds[row] = answer;
        }
    }
    log_odds
}

/// What each feature was like, as far as it was observed at all.
fn inputs(table: &TrainingTable, gains: &[f64]) -> Vec<Input> {
    let mut inputs = Vec::new();
    for (place, feature) in table.features.iter().enumerate() {
        let Range { observed, bounds } = Range::of(&table.rows, place);
        let (low, high) = bounds.unwrap_or_default();
        let absent = 1.0 - observed as f32 / table.len().max(1) as f32;
        let seen = Seen { low, high, absent, gain: gains[place] as f32 };
        inputs.push(Input { name: feature.name.to_owned(), seen });
    }
    inputs
}

#[cfg(test)]
mod tests {
    use super::super::boosting::Parameters;
    use super::super::testing::{small, table};
    use super::*;
    use ralf::config::Config;

    fn fitting(jobs: usize) -> Fitting {
        let parameters = Parameters { rounds: 30, rows_per_leaf: 20, ..Parameters::default() };
        Fitting {
            parameters,
            net: Some(small()),
            expects: None,
            blanking: true,
            causes: true,
            threshold: 0.5,
            learned: Config::default().learned,
            jobs,
        }
    }

    fn fitted(table: &TrainingTable, jobs: usize) -> Result<Fitted, LearnError> {
        fit(table, &fitting(jobs), Origin::default(), &|_, _| {})
    }

    #[test]
    fn a_model_is_the_same_to_the_byte_whatever_the_number_of_jobs() {
        let table = table(120, 10);
        let texts = [1, 2, 5].map(|jobs| fitted(&table, jobs).unwrap().model.to_text());
        assert!(texts[0] == texts[1] && texts[1] == texts[2]);
        assert_eq!(Model::from_text(&texts[0]).unwrap().to_text(), texts[0]);
    }

    #[test]
    fn nothing_is_learned_from_what_was_never_observed() {
        let whole = table(30, 4);
        let mut unseen = whole.clone();
        unseen.rows = Rows::absent(whole.len(), whole.features.len());
        let groups: Vec<String> = ralf::evidence::GROUPS.map(str::to_owned).to_vec();
        for none in [unseen, whole.without_groups(&groups)] {
            assert_eq!(fitted(&none, 1), Err(LearnError::NothingObserved));
        }
    }

    #[test]
    fn what_can_be_learned_is_learned_in_worlds_that_were_left_out() {
        let found = fitted(&table(300, 10), 2).unwrap();
        assert_eq!(found.left_out.len(), 3);
        for world in &found.left_out {
            assert!(world.learned.average_precision.unwrap() > 0.85, "{world:?}");
            assert!(world.learned.calibration_error.unwrap() < 0.1, "{world:?}");
            assert!(world.paper.average_precision.unwrap() < 0.7, "the table's `paper` says nothing");
        }
        assert_eq!(found.model.origin.worlds.len(), 3);
        assert_eq!(found.model.check(), Ok(()));
    }

    #[test]
    fn one_class_and_one_world_are_refused() {
        let mut one_class = table(10, 10);
        one_class.known.iter_mut().for_each(|known| known.plausible = false);
        assert_eq!(fitted(&one_class, 1), Err(LearnError::OneClass { plausible: 0, artifacts: 100 }));
        let mut all_in_town = table(30, 10);
        all_in_town.known.iter_mut().filter(|known| known.world > 0).for_each(|known| known.plausible = true);
        let found = fitted(&all_in_town, 1).unwrap_err();
        assert!(found.to_string().ends_with("found no artifacts without town"), "{found}");
        let mut one_world = table(10, 10);
        one_world.known.iter_mut().for_each(|known| known.world = 0);
        assert_eq!(fitted(&one_world, 1), Err(LearnError::TooFewWorlds(1)), "others without rows are none");
        one_world.worlds.truncate(1);
        assert_eq!(fitted(&one_world, 1), Err(LearnError::TooFewWorlds(1)));
    }
}
