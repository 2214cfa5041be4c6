//! A model, asked about radar scans.

use super::block::Blocks;
use super::familiar::{Seen, novelty};
use super::forest::{Inference, probability};
use super::model::{Model, UseError};
use super::reason::Telling;
use super::rows::Rows;
use super::shapley::Explainer;
use super::visibility::Visibility;
use super::weighing::{Weighing, refuse_unknown_share};
use crate::config::Config;
use crate::evidence::{Column, Feature, GROUPS, features};
use crate::label::flag;
use crate::paper::{DetectionLabel, Labeler};
use crate::scene::{Detection, Frame};

/// Labels radar scans with a model and one set of settings.
#[derive(Debug, Clone)]
pub struct LearnedLabeler<'a> {
    config: &'a Config,
    paper: Labeler<'a>,
    model: &'a Model,
    /// What the model reads, in its order.
    inputs: Vec<&'static Feature>,
    seen: Vec<Seen>,
    telling: Telling,
    weighing: Weighing,
    plausible: Inference,
    /// What corrections add, where the model learned any.
    corrected: Option<Inference>,
    /// One for each of the model's causes.
    causes: Vec<Inference>,
    /// `None` where reasons are not wanted.
    explainer: Option<Explainer>,
}

/// What a model says of a scan's detections, in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct LearnedScan {
    /// As the paper's method has them, with the model's plausibility and label in place of its own.
    pub labels: Vec<DetectionLabel>,
    /// What the model says besides.
    pub answers: Vec<Answer>,
}

/// What a model says of a detection besides its plausibility.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Answer {
    /// The share of the evidence, by its worth to the model, that is unlike what the model was trained on, in [0, 1];
    /// `None` of a detection without a place.
    pub novelty: Option<f64>,
    /// What each of [`GROUPS`] adds to the log odds, and behind them, of a model with a net, what this adds that hears
    /// of the detections around; empty where reasons are not wanted or the model was not asked.
    pub shares: Vec<f64>,
    /// The largest of these in words.
    pub reason: String,
    /// Why it is an artifact, where it is called one and a cause stands out.
    pub cause: Option<ToldCause>,
    /// How the LiDARs see its place; `None` of a detection without a place.
    pub visibility: Option<Visibility>,
    /// The groups of evidence, as places in [`GROUPS`], that the model reads and of which nothing was observed.
    pub lacking: Vec<usize>,
}

/// A cause with how sure the model is.
#[derive(Debug, Clone, PartialEq)]
pub struct ToldCause {
    /// As [`Cause::name`](crate::label::Cause::name) has it, or [`UNCLEAR`].
    pub name: String,
    /// Its share among all causes, in [0, 1].
    pub probability: f64,
}

/// The name where no cause stands out.
pub const UNCLEAR: &str = "unclear";
/// The share among all causes from which one stands out.
const CLEAR: f64 = 0.5;

impl<'a> LearnedLabeler<'a> {
    /// A labeler with this model and these settings.
    ///
    /// # Errors
    /// A model that this program can't use, or whose reasons it can't tell; a setting out of its range.
    pub fn new(config: &'a Config, model: &'a Model) -> Result<Self, UseError> {
        let paper = Labeler::new(config)?;
        refuse_unknown_share(model, &config.learned)?;
        let known: Vec<&'static Feature> = features().collect();
        let inputs: Vec<&'static Feature> = model.places()?.into_iter().map(|place| known[place]).collect();
        let group_of: Vec<usize> = inputs.iter().map(|feature| group_of(feature)).collect();
        let explain = config.learned.reasons;
        let explainer = explain.then(|| Explainer::new(&model.trees(), &group_of)).transpose()?;
        let seen: Vec<Seen> = model.inputs.iter().map(|input| input.seen).collect();
        let telling = Telling::new(&inputs, &group_of, &seen);
        let weighing = Weighing::new(model, inputs.iter().map(|input| input.name), &config.learned);
        Ok(Self {
            config,
            paper,
            model,
            inputs,
            seen,
            telling,
            weighing,
            plausible: Inference::new(&model.plausible),
            corrected: model.corrected.as_ref().map(|corrected| Inference::new(&corrected.forest)),
            causes: model.causes.iter().map(|cause| Inference::new(&cause.forest)).collect(),
            explainer,
        })
    }

    /// What the model says of a frame, of which this evidence was gathered.
    ///
    /// `w` is the probability that a detection is plausible, where as many are as `learned.share` says, and of what
    /// moves as many as the scan itself tells (`learned.movers`). Where the evidence is too
    /// unlike what the model was trained on (`learned.max_novelty`), the paper's method answers: flag [`flag::PAPER`].
    /// What nobody but the radar tells of counts less (`learned.unconfirmed`): flag [`flag::UNCONFIRMED`].
    pub fn label(&self, frame: &Frame, evidence: &[Column]) -> LearnedScan {
        let mut labels = self.paper.label(frame);
        let mut answers = vec![Answer::default(); labels.len()];
        let rows = self.rows(frame.scan.len(), evidence);
        let novelties: Vec<f64> = (0..rows.len()).map(|row| novelty(&self.seen, rows.row(row))).collect();
        let is_asked = |row: usize| {
            frame.scan.detections[row].is_some() && novelties[row] <= self.config.learned.max_novelty
        };
        let asked: Vec<usize> = (0..labels.len()).filter(|row| is_asked(*row)).collect();
        let seen_as = Visibility::of_scan(evidence, labels.len());
        for (row, detection) in frame.scan.detections.iter().enumerate() {
            answers[row].novelty = detection.as_ref().map(|_| novelties[row]);
            answers[row].visibility = detection.as_ref().map(|_| seen_as[row]);
            answers[row].lacking = self.telling.lacking(rows.row(row));
            labels[row].flags |= flag::when(detection.is_some() && !is_asked(row), flag::PAPER);
        }
        let rows = rows.pick(asked.iter().copied());
        let blocks = Blocks::of(&rows);
        let mut log_odds = self.plausible.log_odds(&blocks);
        let heard = self.model.net.as_ref().map(|net| net.heard(&log_odds, &rows, &places(frame, &asked)));
        let corrected = self.corrected.as_ref().map(|corrected| corrected.log_odds(&blocks));
        for added in heard.iter().chain(&corrected) {
            log_odds.iter_mut().zip(added).for_each(|(sum, added)| *sum += added);
        }
        for (at, w) in self.weighing.plausibilities(&rows, &log_odds).into_iter().enumerate() {
            let label = &mut labels[asked[at]];
            label.w = w;
            label.plausible = label.w >= self.config.fusion.threshold;
            label.flags |= flag::when(self.weighing.is_unconfirmed(rows.row(at)), flag::UNCONFIRMED);
            label.flags &= !flag::UNOBSERVED;
        }
        self.explain(&rows, &blocks, heard.as_deref(), &asked, &mut answers);
        self.tell_causes(&rows, &asked, &labels, &mut answers);
        LearnedScan { labels, answers }
    }

    /// The model's rows.
    fn rows(&self, detections: usize, evidence: &[Column]) -> Rows {
        let mut rows = Rows::absent(detections, self.inputs.len());
        for (place, feature) in self.inputs.iter().enumerate() {
            if let Some(column) = evidence.iter().find(|column| column.feature.name == feature.name) {
                rows.set_column(place, &column.values);
            }
        }
        rows
    }

    fn explain(
        &self,
        rows: &Rows,
        blocks: &Blocks,
        heard: Option<&[f64]>,
        asked: &[usize],
        answers: &mut [Answer],
    ) {
        let Some(explainer) = &self.explainer else { return };
        for (at, shares) in explainer.explain(blocks).into_iter().enumerate() {
            let answer = &mut answers[asked[at]];
            answer.shares = Vec::with_capacity(shares.len() + 1);
            answer.shares.extend(shares);
            answer.shares.extend(heard.map(|heard| heard[at]));
            answer.reason = self.telling.reason(&answer.shares, rows.row(at));
        }
    }

    /// The likeliest cause of each artifact.
    fn tell_causes(&self, rows: &Rows, asked: &[usize], labels: &[DetectionLabel], answers: &mut [Answer]) {
        let artifacts: Vec<usize> = (0..asked.len()).filter(|at| !labels[asked[*at]].plausible).collect();
        if self.causes.is_empty() {
            return;
        }
        let rows = Blocks::of(&rows.pick(artifacts.iter().copied()));
        let odds: Vec<Vec<f64>> = self.causes.iter().map(|forest| forest.log_odds(&rows)).collect();
        for (row, at) in artifacts.into_iter().enumerate() {
            let likely: Vec<f64> = odds.iter().map(|odds| probability(odds[row])).collect();
            answers[asked[at]].cause = Some(self.likeliest(&likely));
        }
    }

    fn likeliest(&self, likely: &[f64]) -> ToldCause {
        let all: f64 = likely.iter().sum();
        let (mut best, mut most) = (0, f64::NEG_INFINITY);
        for (place, likely) in likely.iter().enumerate() {
            if *likely > most {
                (best, most) = (place, *likely);
            }
        }
        let probability = most / all.max(f64::MIN_POSITIVE);
        let name = if probability >= CLEAR { self.model.causes[best].name.as_str() } else { UNCLEAR };
        ToldCause { name: name.to_owned(), probability }
    }
}

/// Where the detections of some rows lie, which have a place.
fn places(frame: &Frame, rows: &[usize]) -> Vec<[f32; 3]> {
    let detections = rows.iter().filter_map(|row| frame.scan.detections[*row].as_ref());
    detections.map(Detection::place).collect()
}

/// The place of a feature's group in [`GROUPS`]; the last of one that is in none.
fn group_of(feature: &Feature) -> usize {
    GROUPS.iter().position(|group| *group == feature.group).unwrap_or(GROUPS.len() - 1)
}
