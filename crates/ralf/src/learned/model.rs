//! A learned model: what it reads, what it says, and where it comes from.

use super::calibration::Calibration;
use super::familiar::Seen;
use super::forest::Forest;
use super::net::Net;
use super::rows::Rows;
use crate::config::ConfigError;
use crate::evidence::features;
use thiserror::Error;

/// A model that tells how plausible a detection is, from its evidence.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// Where it comes from.
    pub origin: Origin,
    /// The share of plausible detections to expect where nobody says another, in (0, 1); `None`: as where it was
    /// trained ([`Self::share`]).
    pub expects: Option<f64>,
    /// What it reads, in the order of its rows.
    pub inputs: Vec<Input>,
    /// Log odds that a detection is plausible.
    pub plausible: Forest,
    /// What is asked about the detections around, too; what both say together is the mean
    /// ([`Net::heard`]).
    pub net: Option<Net>,
    /// What the log odds of both together mean.
    pub calibration: Calibration,
    /// Log odds of each cause, of artifacts.
    pub causes: Vec<CauseForest>,
    /// What somebody's own corrections say against it; `None` where it learned none.
    pub corrected: Option<Corrected>,
}

/// What a model learned from corrections of recordings that it was not trained in.
#[derive(Debug, Clone, PartialEq)]
pub struct Corrected {
    /// What is added to the log odds of trees and net.
    pub forest: Forest,
    /// The corrected sequences, and how well models labelled each that knew the corrections of others alone.
    pub worlds: Vec<World>,
}

/// Where a model comes from.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Origin {
    /// The program that trained it: version and sources.
    pub program: String,
    /// The command that trains it again.
    pub command: String,
    /// The seed of every random choice.
    pub seed: u64,
    /// What it was trained in, and how well models did that had never seen it.
    pub worlds: Vec<World>,
}

/// Recordings of one kind, and how well a model labels them that was trained on all the others.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct World {
    /// Its name.
    pub name: String,
    /// Detections, of which so many are plausible.
    pub detections: u64,
    /// Plausible ones.
    pub plausible: u64,
    /// What was measured, with its name: printed as they are, for people.
    pub scores: Vec<(String, String)>,
}

impl World {
    /// With so many detections it has its full say: fewer tell more of themselves than of where they come from.
    const FULL_SAY: u64 = 512;

    /// How much a world of so many detections counts beside others in a model's calibration and share: as much as any
    /// other, but where it has few.
    pub fn say_of(detections: u64) -> f64 {
        detections.min(Self::FULL_SAY) as f64
    }
}

/// One feature that a model reads.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// The name of a [`Feature`](crate::evidence::Feature).
    pub name: String,
    /// What it was like in training.
    pub seen: Seen,
}

/// The log odds of one cause.
#[derive(Debug, Clone, PartialEq)]
pub struct CauseForest {
    /// The cause, as [`Cause::name`](crate::label::Cause::name) has it.
    pub name: String,
    /// Its log odds.
    pub forest: Forest,
}

/// Why a model can't be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum UseError {
    /// Evidence that this program doesn't gather.
    #[error("the model reads `{0}`, which this program does not observe: it was trained by another version")]
    UnknownFeature(String),
    /// A forest that asks for more features than the model names.
    #[error("a tree of the model asks for feature {asked} of {known}")]
    NoSuchFeature {
        /// The place asked for, from 0.
        asked: usize,
        /// How many there are.
        known: usize,
    },
    /// A net that reads another number of features than the model names.
    #[error("the model's net reads {read} features of {known}")]
    OtherInputs {
        /// How many it reads.
        read: usize,
        /// How many there are.
        known: usize,
    },
    /// A model that reads nothing says the same of everything.
    #[error("the model names no evidence that it reads")]
    NoInputs,
    /// Trees that ask so many groups of evidence in turn that what each adds can't be told.
    #[error(
        "the model's trees ask too many groups of evidence for reasons to be told: set learned.reasons = false"
    )]
    TooManyCases,
    /// A share to expect, of a model that doesn't tell in which it was trained.
    #[error(
        "the model does not tell what share of detections was plausible where it was trained, from which learned.share \
         would turn its answers: leave it at 0"
    )]
    NoShare,
    /// A setting out of its range.
    #[error(transparent)]
    Config(#[from] ConfigError),
}

impl Model {
    /// Whether this program can use it: it observes every feature that the model reads, and no tree asks for another.
    ///
    /// # Errors
    /// The first feature that is not known, or not named; a model that reads none.
    pub fn check(&self) -> Result<(), UseError> {
        self.places().map(drop)
    }

    /// The log odds that each of a scan's detections is plausible, by all that the model has: `rows` are what it reads
    /// of them, and `places` where they lie in the vehicle frame, m.
    pub fn log_odds(&self, rows: &Rows, places: &[[f32; 3]]) -> Vec<f64> {
        let mut log_odds = self.plausible.log_odds(rows);
        self.add_to_trees(&mut log_odds, rows, places);
        log_odds
    }

    /// Adds to what the trees say of a scan's detections what net and corrections do; [`Self::log_odds`] of trees that
    /// were asked before.
    pub fn add_to_trees(&self, log_odds: &mut [f64], rows: &Rows, places: &[[f32; 3]]) {
        let heard = self.net.as_ref().map(|net| net.heard(log_odds, rows, places));
        let corrected = self.corrected.as_ref().map(|corrected| corrected.forest.log_odds(rows));
        for added in heard.iter().chain(&corrected) {
            log_odds.iter_mut().zip(added).for_each(|(sum, added)| *sum += added);
        }
    }

    /// All trees whose answers are added to the log odds, as one forest.
    pub(super) fn trees(&self) -> Forest {
        let mut all = self.plausible.clone();
        if let Some(Corrected { forest, .. }) = &self.corrected {
            all.base += forest.base;
            all.trees.extend(forest.trees.iter().cloned());
        }
        all
    }

    /// The share of detections that is plausible where it was trained, in [0, 1]: the mean of its worlds, which count
    /// as in its calibration ([`World::say_of`]); 0 where it names none.
    pub fn share(&self) -> f64 {
        let filled = self.origin.worlds.iter().filter(|world| world.detections > 0);
        let (all, plausible) = filled.fold((0.0, 0.0), |(all, plausible), world| {
            let say = World::say_of(world.detections);
            (all + say, plausible + say * (world.plausible as f64 / world.detections as f64))
        });
        if all > 0.0 { plausible / all } else { 0.0 }
    }

    /// Where each feature that the model reads stands among [`features`].
    ///
    /// # Errors
    /// Those of [`Self::check`].
    pub fn places(&self) -> Result<Vec<usize>, UseError> {
        let places = self.places_among(features().map(|feature| feature.name))?;
        let known = self.inputs.len();
        if known == 0 {
            return Err(UseError::NoInputs);
        }
        let of_corrections = self.corrected.iter().map(|corrected| &corrected.forest);
        let of_causes = self.causes.iter().map(|cause| &cause.forest);
        for forest in of_causes.chain(of_corrections).chain([&self.plausible]) {
            let width = forest.width();
            if width > known {
                return Err(UseError::NoSuchFeature { asked: width - 1, known });
            }
        }
        match self.net.as_ref().map(|net| net.shape().inputs) {
            Some(read) if read != known => Err(UseError::OtherInputs { read, known }),
            _ => Ok(places),
        }
    }

    /// Where each feature that the model reads stands among some, by their names.
    ///
    /// # Errors
    /// The first feature that isn't among them.
    pub fn places_among<'a>(&self, names: impl Iterator<Item = &'a str>) -> Result<Vec<usize>, UseError> {
        let names: Vec<&str> = names.collect();
        let place = |input: &Input| {
            let found = names.iter().position(|name| *name == input.name);
            found.ok_or_else(|| UseError::UnknownFeature(input.name.clone()))
        };
        self.inputs.iter().map(place).collect()
    }
}
