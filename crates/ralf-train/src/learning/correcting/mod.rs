//! Correcting a [`Model`]: it learns what somebody said of detections that it labels wrongly.
//!
//! Trees are grown that begin where the model ends, so that they say what it lacks and nothing else:
//! `log odds = model + trees`. A model fitted anew to its worlds and to the corrections needs half an hour in place of
//! seconds, and is worse: few corrections drown in many worlds (docs/learned-judged.md).
//!
//! Of a scan of which somebody said something, what they left alone counts, too, as they saw it labelled
//! ([`LEFT_ALONE`]). Who corrects errors alone would teach otherwise that everything is one.

mod folds;
mod judge;
mod says;

pub use judge::{Judged, Turns};

use super::boosting::{Bins, Examples, Grown, Parameters, boost};
use super::fit::LearnError;
use super::monotone::direction;
use super::range::Range;
use super::table::{Known, TrainingTable};
use folds::Folds;
use judge::judge;
use ralf::config::LearnedConfig;
use ralf::learned::{Corrected, Forest, Model, Origin, Rows, Seen};
use ralf_jobs::side_by_side;
use says::Says;
use std::convert::Infallible;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How much what somebody left alone counts, beside what they spoke of in the same scan.
pub const LEFT_ALONE: f32 = 0.3;
/// The least that a model's probabilities differ by, so that it can be corrected.
const TELLING_APART: f64 = 0.2;

/// How a model is corrected.
#[derive(Debug, Clone, PartialEq)]
pub struct Correcting {
    /// Of the trees.
    pub parameters: Parameters,
    /// `w0`: what is labelled plausible.
    pub threshold: f64,
    /// How the model's answers are weighed.
    pub learned: LearnedConfig,
    /// Forests grown side by side; the result doesn't depend on it.
    pub jobs: usize,
}

impl Correcting {
    /// The trees where nobody says others: few rows tell little, so they are small and not many.
    pub fn trees() -> Parameters {
        Parameters { rounds: 40, leaves: 12, rows_per_leaf: 20, ..Parameters::default() }
    }
}

/// A corrected model with what that brings.
#[derive(Debug, Clone, PartialEq)]
pub struct CorrectedModel {
    /// The model, with what it learned.
    pub model: Model,
    /// What was corrected, by sequence.
    pub judged: Vec<Judged>,
}

/// Corrects a model by what is said in a table, whose worlds are the corrected sequences and whose scans are whole:
/// with the detections of which nobody spoke. `origin` names where the new model comes from; the worlds that it was
/// trained in stay those of the one it begins with. `progress` is told how many forests of how many are grown.
///
/// # Errors
/// A table of which nobody said anything or in which all is alike, what was left alone, too; one that lacks what the
/// model reads; a model that says nearly the same of everything; or one that was corrected already: what it knows of
/// these recordings would be learned twice.
pub fn correct(
    begin: &Model,
    table: &TrainingTable,
    correcting: &Correcting,
    origin: Origin,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<CorrectedModel, LearnError> {
    if begin.corrected.is_some() {
        return Err(LearnError::AlreadyCorrected);
    }
    if !table.known.iter().any(|known| known.said) {
        return Err(LearnError::NothingSaid);
    }
    refuse_the_same_of_all(begin)?;
    let says = Says::new(begin, table, &correcting.learned)?;
    let ground = Ground::new(begin, table, &says, correcting.threshold);
    LearnError::of_one_class(ground.target.iter().copied())?;
    let folds = Folds::new(table);
    // One without each part, and the last with all.
    let left_out: Vec<Option<usize>> = (0..folds.count).map(Some).chain([None]).collect();
    let done = AtomicUsize::new(0);
    let Ok(mut grown) = side_by_side(&left_out, correcting.jobs, |part| {
        let grown = ground.grow(&folds, *part, &correcting.parameters);
        progress(done.fetch_add(1, Ordering::Relaxed) + 1, left_out.len());
        Ok::<_, Infallible>(grown)
    });
    let Some(Grown { forest, gains }) = grown.pop() else { return Err(LearnError::NothingSaid) };
    let parts: Vec<Forest> = grown.into_iter().map(|grown| grown.forest).collect();
    let judged = judge(table, &says, &folds, &parts, correcting.threshold);
    let said = says.rows.pick((0..table.len()).filter(|row| table.known[*row].said));
    let mut model = begin.clone();
    for (place, (input, gain)) in model.inputs.iter_mut().zip(gains).enumerate() {
        input.seen = seen_too(input.seen, &said, place, gain as f32);
    }
    model.corrected = Some(Corrected { forest, worlds: judged.iter().map(Judged::told).collect() });
    model.origin = Origin { worlds: begin.origin.worlds.clone(), ..origin };
    Ok(CorrectedModel { model, judged })
}

/// A correction goes through the model's calibration: where that hardly rises, nothing comes of it.
fn refuse_the_same_of_all(model: &Model) -> Result<(), LearnError> {
    let mut told = model.calibration.points().iter().map(|(_, probability)| *probability);
    let low = told.next().unwrap_or(0.5);
    let high = told.next_back().unwrap_or(low);
    if high - low < TELLING_APART { Err(LearnError::SaysTheSame { low, high }) } else { Ok(()) }
}

/// What trees are grown of.
struct Ground<'a> {
    rows: &'a Rows,
    bins: Bins,
    target: Vec<bool>,
    weights: Vec<f32>,
    monotone: Vec<i8>,
    begin: &'a [f64],
}

impl<'a> Ground<'a> {
    fn new(model: &Model, table: &TrainingTable, says: &'a Says, threshold: f64) -> Self {
        // What they saw may be by another model or method than the one that learns.
        let left_alone = |known: &Known, w: &f64| known.shown.unwrap_or(*w >= threshold);
        let both = || table.known.iter().zip(&says.plausibilities);
        Self {
            rows: &says.rows,
            bins: Bins::new(&says.rows),
            target: both()
                .map(|(known, w)| if known.said { known.plausible } else { left_alone(known, w) })
                .collect(),
            weights: both().map(|(known, _)| if known.said { 1.0 } else { LEFT_ALONE }).collect(),
            monotone: model.inputs.iter().map(|input| direction(&input.name)).collect(),
            begin: &says.at_last,
        }
    }

    fn grow(&self, folds: &Folds, left_out: Option<usize>, parameters: &Parameters) -> Grown {
        let Self { rows, bins, target, weights, monotone, begin } = self;
        let examples = Examples { rows, bins, target, weights, monotone, begin: Some(begin) };
        let is_kept = |row: &u32| left_out.is_none_or(|part| folds.of_row[*row as usize] != part);
        let train: Vec<u32> = (0..rows.len() as u32).filter(is_kept).collect();
        boost(&examples, &train, parameters)
    }
}

/// What a feature was like in training and is like in what was corrected: there the model has business, too.
fn seen_too(seen: Seen, rows: &Rows, place: usize, gain: f32) -> Seen {
    let (low, high) = Range::of(rows, place).bounds.unwrap_or((seen.low, seen.high));
    Seen { low: seen.low.min(low), high: seen.high.max(high), absent: seen.absent, gain: seen.gain + gain }
}

#[cfg(test)]
mod tests;
