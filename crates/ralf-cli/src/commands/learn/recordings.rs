//! Recordings to learn from.

use super::correct::CorrectArgs;
use crate::arguments::{STORED_DEPTH, check_trajectory, tell_left_out};
use crate::outcome::{Outcome, UsageError};
use crate::progress::say;
use crate::run_summary::{say_not_used, say_without};
use crate::text::{shell_path, shell_word};
use clap::Args;
use clap::builder::PossibleValuesParser;
use ralf_data::result::LabelledRun;
use ralf_data::views::{DepthStore, with_stored};
use ralf_data::{GroundTruth, Recording, Settings, TrainingGatherer, TrainingTruth};
use ralf_sim::Worlds;
use ralf_train::learning::TrainingTable;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Which recordings.
#[derive(Debug, Args)]
pub(super) struct RecordingArgs {
    /// Recordings with corrected labels; each is a world. With --from or --correct, recordings of which people said
    /// something
    #[arg(value_name = "DATASET", required_unless_present = "preset")]
    pub(super) datasets: Vec<PathBuf>,
    /// Take the recordings for this format
    #[arg(long, value_name = "FORMAT", requires = "datasets",
        value_parser = PossibleValuesParser::new(ralf_data::formats()))]
    format: Option<String>,
    #[arg(long, value_name = "FOLDER", requires = "datasets", help = STORED_DEPTH)]
    depth: Option<PathBuf>,
}

impl RecordingArgs {
    /// What can be told before anything is read.
    pub(super) fn check(&self, settings: &Settings) -> Result<(), UsageError> {
        check_trajectory(settings, self.datasets.len())?;
        let places: BTreeSet<PathBuf> = self.datasets.iter().map(|dataset| whole(dataset)).collect();
        if places.len() < self.datasets.len() {
            return Err(UsageError("DATASET: expected each once, found one that is named twice".into()));
        }
        Ok(())
    }

    /// Adds what the recordings hold, as they were labelled in a run if it is of one.
    pub(super) fn gather(
        &self,
        gatherer: &TrainingGatherer,
        of: &Gathering,
        table: &mut TrainingTable,
    ) -> anyhow::Result<Outcome> {
        let mut outcome = Outcome::Done;
        for dataset in &self.datasets {
            let recording = self.open(dataset, of)?;
            tell_left_out(&recording);
            let (truth, all_applied) = of.correct.truth(&recording)?;
            let world = |sequence: &str| self.world(dataset, sequence, of);
            let not_used = gatherer.add(table, &world, &recording, TrainingTruth::Said(&truth))?;
            outcome = not_used.iter().map(say_not_used).fold(outcome.and(all_applied), Outcome::and);
            // Of what people corrected, most sequences may say nothing.
            if of.correct.from.is_none() {
                name_without_truth(&recording, &truth);
            }
        }
        Ok(outcome)
    }

    /// A recording with the depth that is asked for, or that its labels were made with.
    fn open(&self, dataset: &Path, of: &Gathering) -> anyhow::Result<Recording> {
        let recording = ralf_data::open_with(dataset, self.format.as_deref(), &of.settings.topics)?;
        let mut recording = match of.run {
            Some(run) => of.settings.correct_labelled(recording, |name| run.holds(name))?,
            None => of.settings.correct(recording)?,
        };
        if let Some(run) = of.run.filter(|_| self.depth.is_none()) {
            for store in run.lost_depth_stores(&recording.path) {
                let place = store.display();
                say(&format!(
                    "warning: {place}: expected the depth that was labelled with, found none (--depth)"
                ));
            }
            for store in run.depth_stores(&recording.path) {
                recording = DepthStore::open(&store)?.attach(recording);
            }
        }
        Ok(with_stored(recording, self.depth.as_deref(), None)?)
    }

    /// The world that a sequence belongs to: of a single recording it is one itself. Of several each recording is one,
    /// named after its folder, by its whole path where another one or a simulated family has that name. Where a model
    /// is corrected, every sequence is judged.
    fn world(&self, dataset: &Path, sequence: &str, of: &Gathering) -> String {
        if self.datasets.len() == 1 && !of.beside_simulated {
            return sequence.to_owned();
        }
        if of.correct.is_asked() {
            return format!("{}/{sequence}", dataset.display());
        }
        let name = last_name(dataset);
        let of_that_name = self.datasets.iter().filter(|other| last_name(other) == name).count();
        let is_family =
            of.beside_simulated && Worlds::all().any(|(family, _)| name == Some(family.to_owned()));
        let is_its_own = of_that_name == 1 && !is_family;
        name.filter(|_| is_its_own).unwrap_or_else(|| whole(dataset).display().to_string())
    }

    /// As they were typed.
    pub(super) fn told(&self) -> String {
        let datasets = self.datasets.iter().map(|dataset| format!(" {}", shell_path(dataset)));
        let format = self.format.iter().map(|format| format!(" --format {}", shell_word(format)));
        let depth = self.depth.iter().map(|depth| format!(" --depth {}", shell_path(depth)));
        datasets.chain(format).chain(depth).collect()
    }
}

/// What recordings are read with.
pub(super) struct Gathering<'a> {
    pub(super) settings: &'a Settings,
    pub(super) correct: &'a CorrectArgs,
    /// The run that people corrected.
    pub(super) run: Option<&'a LabelledRun>,
    /// Whether simulated worlds are learned from, too.
    pub(super) beside_simulated: bool,
}

fn whole(dataset: &Path) -> PathBuf {
    let found = dataset.canonicalize().or_else(|_| std::path::absolute(dataset));
    found.unwrap_or_else(|_| dataset.to_owned())
}

fn last_name(dataset: &Path) -> Option<String> {
    whole(dataset).file_name().map(|name| name.to_string_lossy().into_owned())
}

/// Names the sequences of which nothing is learned.
fn name_without_truth(recording: &Recording, truth: &GroundTruth) {
    let names = recording.sequences.iter().map(|reader| &reader.sequence().name);
    let said = |name: &String| truth.scans().iter().any(|scan| scan.sequence == *name);
    say_without("truth", names.filter(|name| !said(name)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recordings_of_one_name_are_worlds_of_their_own() {
        let settings = Settings::default();
        let correct = CorrectArgs::default();
        let worlds = |datasets: [&str; 2], beside_simulated| {
            let of = Gathering { settings: &settings, correct: &correct, run: None, beside_simulated };
            let datasets = datasets.map(PathBuf::from).to_vec();
            let arguments = RecordingArgs { datasets, format: None, depth: None };
            arguments.datasets.iter().map(|dataset| arguments.world(dataset, "00", &of)).collect::<Vec<_>>()
        };
        assert_eq!(worlds(["a/town", "b/quay"], false), ["town", "quay"]);
        let both = worlds(["a/town", "b/town"], false);
        assert!(both[0].ends_with("a/town") && both[1].ends_with("b/town"), "{both:?}");
        let named = worlds(["a/town", "quay"], true);
        assert!(named[0] == "town" && named[1] != "quay", "{named:?}");
    }
}
