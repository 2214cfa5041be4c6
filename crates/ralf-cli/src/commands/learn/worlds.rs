//! Worlds to learn in that are simulated on the way.

use crate::commands::simulate::MOST_SCANS;
use crate::outcome::Outcome;
use crate::progress::Stages;
use crate::run_summary::say_not_used;
use clap::Args;
use clap::builder::PossibleValuesParser;
use ralf_data::{Recording, SequenceReader, TrainingGatherer, TrainingTruth};
use ralf_sim::Worlds;
use ralf_train::learning::TrainingTable;
use std::path::Path;

/// More would take weeks.
const MOST_SEEDS: u64 = 1000;

/// Which worlds.
#[derive(Debug, Args)]
pub(super) struct WorldArgs {
    /// Simulate worlds to learn in, too
    #[arg(long, value_parser = PossibleValuesParser::new(["worlds"]))]
    preset: Option<String>,
    /// With --preset: worlds of each family
    #[arg(long, value_name = "N", default_value_t = 8, requires = "preset",
        value_parser = clap::value_parser!(u64).range(1..=MOST_SEEDS))]
    seeds: u64,
    /// With --preset: scans of each radar in each world, over all of its four to six sequences: some 3 s each, so that
    /// evidence sees as much around a scan as in a real recording
    #[arg(long, value_name = "N", default_value_t = 200, requires = "preset",
        value_parser = clap::value_parser!(u32).range(1..=MOST_SCANS))]
    scans: u32,
    /// With --preset: learn from one in so many of these
    #[arg(long, value_name = "N", default_value_t = 8, requires = "preset",
        value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// With --preset: leave these families out, to judge the model in them
    #[arg(long, value_name = "FAMILY,...", value_delimiter = ',', requires = "preset",
        value_parser = PossibleValuesParser::new(Worlds::all().map(|(name, _)| name)))]
    without: Vec<String>,
}

impl WorldArgs {
    /// Whether any are.
    pub(super) fn are_asked(&self) -> bool {
        self.preset.is_some()
    }

    /// As they were typed, where they are asked.
    pub(super) fn told(&self) -> String {
        if !self.are_asked() {
            return String::new();
        }
        let without = if self.without.is_empty() {
            String::new()
        } else {
            format!(" --without {}", self.without.join(","))
        };
        let Self { seeds, scans, every, .. } = self;
        format!(" --preset worlds --seeds {seeds} --scans {scans} --every {every}{without}")
    }

    /// One in so many scans is learned from.
    pub(super) fn every(&self) -> usize {
        self.every as usize
    }

    /// Adds every family's worlds; a family is what is left out at a time.
    pub(super) fn gather(
        &self,
        gatherer: &TrainingGatherer,
        stages: &Stages,
        table: &mut TrainingTable,
    ) -> anyhow::Result<Outcome> {
        let mut outcome = Outcome::Done;
        let is_asked = |name: &&str| !self.without.iter().any(|left| left == name);
        let families: Vec<_> = Worlds::all().filter(|(name, _)| is_asked(name)).collect();
        let all = families.len() as u64 * self.seeds;
        for (kind, (name, worlds)) in (0..).zip(families) {
            for seed in 0..self.seeds {
                let world = kind * self.seeds + seed + 1;
                stages.name_recording(&format!("world {world} of {all}"));
                let recording = self.recording(worlds, seed)?;
                let not_used = gatherer.add(table, &|_| name.to_owned(), &recording, TrainingTruth::Known)?;
                outcome = not_used.iter().map(say_not_used).fold(outcome, Outcome::and);
            }
        }
        Ok(outcome)
    }

    fn recording(&self, worlds: Worlds, seed: u64) -> anyhow::Result<Recording> {
        let world = worlds.recording(seed);
        let mut sequences: Vec<Box<dyn SequenceReader>> = Vec::new();
        for (index, scans) in world.spread(Some(self.scans as usize)).into_iter().enumerate() {
            sequences.push(Box::new(world.sequence(index, scans)?));
        }
        let path = format!("{worlds} {seed}");
        Ok(Recording::new(Path::new(&path), "simulated", sequences))
    }
}
