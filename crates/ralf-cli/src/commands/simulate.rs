//! `ralf simulate`: a recording whose truth is known; and how far it is from a real one.

pub(super) mod compare;

use crate::arguments::{check_page, open_and_tell, threads};
use crate::outcome::{Outcome, UsageError};
use crate::sequences::{IsThere, write_missing};
use anyhow::Context;
use clap::Args;
use clap::builder::PossibleValuesParser;
use compare::{Named, Told, compare};
use ralf_data::{SequenceReader, has_sequence, has_whole_sequence};
use ralf_files::Kind;
use ralf_sim::presets::{self, Preset};
use ralf_sim::world::FAMILIES;
use ralf_sim::{Scenario, SimulatedSequence, Worlds};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// Scans of a scenario of one's own, where no number is given.
const USUAL_SCANS: usize = 100;

/// Most scans of each radar that can be asked for: hours of driving, and what is known of all scans before the first is
/// made still lies in memory with ease.
pub(super) const MOST_SCANS: i64 = 100_000;

/// The preset whose sequences a seed draws.
const WORLDS: &str = "worlds";

/// Arguments of `ralf simulate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Writes LiDAR, four radars, four fisheye cameras with depth, wheel odometry, and the truth of every detection, in \
RALF's own layout. A sequence that is there already is never overwritten: the same command, typed again, writes \
those that are missing. Another sequence of that name, such as that of a scenario before it was edited, is refused. \
The same preset, numbers and seed give the same bytes.

With `--preset worlds` a seed draws sensors, places and physics from a family of worlds (docs/worlds.md): radars and \
LiDARs of other kinds, cameras or none, and four to six sequences of 40 scans. Families, by number: city, survey, \
motorway, carpark, imaging, yard, country, anything. A+B+C has the sensors of A at the places of C, where waves behave \
as in B. Worlds of another make, sketched: quay, ring, lane, gardens (no cameras).

Examples:
  ralf simulate -o recordings/sim --scans 300         the paper's eleven sequences, each shorter
  ralf simulate -o recordings/sim                     all 2,704 scans of each radar: minutes, and some 6 GB
  ralf simulate -o recordings/tiny --preset tiny      in a second
  ralf simulate -o recordings/motorway --preset worlds --family motorway --seed 3
  ralf simulate -o recordings/mixed --preset worlds --family survey+yard+motorway --seed 3
  ralf simulate -o recordings/city5 --preset worlds --family 0 --seed 5 --scans 200 --sequence 01
  ralf simulate -o recordings/mine --scenario yard.toml --scans 200 --seed 3

With --compare nothing is simulated that isn't looked at: some hundred scans, spread over the sequences, are set \
beside as many of a real recording, and the distance between the distributions of what both measure is printed. \
`docs/realism.md` tells what is compared, and how.

  ralf simulate --compare nuscenes --preset paper -o realism.html
  ralf simulate --compare nuscenes --preset worlds --family 2 -o realism.html
  ralf simulate --compare nuscenes --with recordings/mine -o realism.html --json > realism.json")]
pub(crate) struct SimulateArgs {
    /// Folder of the dataset that is written; with --compare the page (HTML), which may be left out
    #[arg(short, long, value_name = "PATH", required_unless_present = "compare")]
    output: Option<PathBuf>,
    /// Write no recording: tell how far it is from this real one
    #[arg(long, value_name = "RECORDING")]
    compare: Option<PathBuf>,
    /// Compare this recording in place of one that is simulated now
    #[arg(long, value_name = "RECORDING", requires = "compare",
        conflicts_with_all = ["preset", "family", "scenario", "sequences", "scans", "seed"])]
    with: Option<PathBuf>,
    /// The comparison's figures as JSON
    #[arg(long, requires = "compare")]
    json: bool,
    /// Which sequences
    #[arg(long, default_value = "paper", conflicts_with = "scenario",
        value_parser = PossibleValuesParser::new(presets::ALL.iter().map(|preset| preset.name).chain([WORLDS])))]
    preset: String,
    /// Of `--preset worlds`: their family, by name or number, or three: SENSORS+WAVES+PLACES; city if not given
    #[arg(long, value_name = "FAMILY", value_parser = family)]
    family: Option<Worlds>,
    /// A scenario of your own (TOML; docs/scenario.md), as sequence 00
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// Only this sequence; may be given several times
    #[arg(long = "sequence", value_name = "NAME", conflicts_with = "scenario")]
    sequences: Vec<String>,
    /// Scans of each radar, over all sequences of the preset, at least one of each; all of them if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MOST_SCANS))]
    scans: Option<u32>,
    /// Of every random choice
    #[arg(long, default_value_t = 0, value_name = "S")]
    seed: u64,
    /// No cameras: all other measurements are the same, and made ten times as fast
    #[arg(long, conflicts_with = "compare")]
    no_images: bool,
    /// With the segmentation of every image, as a faultless network gives it: CAMERA/segmentation/000000.png
    #[arg(long, conflicts_with_all = ["no_images", "compare"])]
    segmentation: bool,
    /// Measurements side by side; as many as there are processors if not given. The files are the same for any number
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
}

/// Makes a recording, or compares one.
pub(crate) fn run(arguments: &SimulateArgs) -> anyhow::Result<Outcome> {
    arguments.check_family()?;
    match (&arguments.compare, &arguments.output) {
        (Some(real), _) => arguments.compare_with(real),
        (None, Some(output)) => arguments.write(output),
        (None, None) => Err(UsageError("--output: expected a folder, found none".into()).into()),
    }
}

impl SimulateArgs {
    /// A family says nothing of other sequences, and whoever gives one wants its worlds.
    fn check_family(&self) -> Result<(), UsageError> {
        let found = match &self.scenario {
            _ if self.family.is_none() => return Ok(()),
            Some(_) => "--scenario".to_owned(),
            None if self.preset == WORLDS => return Ok(()),
            None => format!("--preset {}", self.preset),
        };
        Err(UsageError(format!(
            "--family: expected --preset {WORLDS}, whose families these are, found {found}"
        )))
    }

    /// The family of the worlds.
    fn family(&self) -> Worlds {
        self.family.unwrap_or_else(|| Worlds::Family((&FAMILIES[0]).into()))
    }

    fn sequences(&self) -> anyhow::Result<Vec<SimulatedSequence>> {
        match &self.scenario {
            Some(file) => Ok(vec![own(file, self)?]),
            None if self.preset == WORLDS => world(self),
            None => preset(self),
        }
    }

    fn write(&self, output: &Path) -> anyhow::Result<Outcome> {
        let mut sequences = self.sequences()?;
        if self.no_images {
            sequences = sequences.into_iter().map(SimulatedSequence::without_cameras).collect();
        }
        if self.segmentation {
            sequences = sequences.into_iter().map(SimulatedSequence::with_segmentation).collect();
        }
        let sequences: Vec<_> = sequences.iter().map(|sequence| sequence as &dyn SequenceReader).collect();
        let jobs = threads(self.jobs);
        let whole = |reader: &dyn SequenceReader| has_whole_sequence(reader, output, jobs);
        let by_some = |reader: &dyn SequenceReader| has_sequence(reader, output);
        // Any line of a scenario may have been edited since, and may show in a few measurements alone.
        let is_there: IsThere = if self.scenario.is_some() { &whole } else { &by_some };
        write_missing(&sequences, output, is_there, jobs, "simulating")?;
        Ok(Outcome::Done)
    }

    fn compare_with(&self, real: &Path) -> anyhow::Result<Outcome> {
        if let Some(page) = &self.output {
            let read_only: Vec<&Path> = [real].into_iter().chain(self.with.as_deref()).collect();
            check_page("--output", page, &read_only)?;
        }
        let told = Told { page: self.output.as_deref(), json: self.json };
        let recording = open_and_tell(real)?;
        let real = Named::opened(&recording);
        if let Some(other) = &self.with {
            let other = open_and_tell(other)?;
            compare(&real, &Named::opened(&other), threads(self.jobs), &told)?;
            return Ok(Outcome::Done);
        }
        let made = self.sequences()?;
        let name = match &self.scenario {
            Some(file) => file.display().to_string(),
            None if self.preset == WORLDS => format!("{}, seed {}", self.family(), self.seed),
            None => format!("{}, seed {}", self.preset, self.seed),
        };
        let sequences = made.iter().map(|sequence| sequence as &dyn SequenceReader).collect();
        compare(&real, &Named { name, sequences }, threads(self.jobs), &told)?;
        Ok(Outcome::Done)
    }
}

/// The user's scenario.
fn own(file: &Path, arguments: &SimulateArgs) -> anyhow::Result<SimulatedSequence> {
    let name = || file.display().to_string();
    let text = ralf_files::read_text(file, Kind::Settings).with_context(name).context("--scenario")?;
    let scenario = Scenario::from_toml(&text).with_context(name)?;
    let scans = arguments.scans.map_or(USUAL_SCANS, |scans| scans as usize);
    SimulatedSequence::new("00", &scenario, arguments.seed, scans).with_context(name)
}

/// What `--family` names.
fn family(text: &str) -> Result<Worlds, String> {
    let count = FAMILIES.len();
    Worlds::find(text).ok_or_else(|| {
        let known: Vec<&str> = Worlds::all().map(|(name, _)| name).collect();
        let known = known.join(", ");
        format!("expected one of {known}, a number below {count}, or three of the first {count} as A+B+C")
    })
}

/// The sequences of a world that are asked for.
fn world(arguments: &SimulateArgs) -> anyhow::Result<Vec<SimulatedSequence>> {
    let recording = arguments.family().recording(arguments.seed);
    let names = recording.names();
    let spread = recording.spread(arguments.scans.map(|scans| scans as usize));
    let mut found = Vec::new();
    for index in wanted(arguments, &names)? {
        found.push(recording.sequence(index, spread[index])?);
    }
    Ok(found)
}

/// The sequences of the preset that are asked for. Each has a seed of its own.
fn preset(arguments: &SimulateArgs) -> anyhow::Result<Vec<SimulatedSequence>> {
    let preset: &Preset = presets::find(&arguments.preset).context("no such preset")?;
    let names: Vec<String> = preset.sequences.iter().map(|sequence| sequence.name.to_owned()).collect();
    let spread = preset.spread(arguments.scans.map_or(preset.scans(), |scans| scans as usize));
    let mut found = Vec::new();
    for index in wanted(arguments, &names)? {
        found.push(preset.sequences[index].simulate(arguments.seed, spread[index])?);
    }
    Ok(found)
}

/// Which of some sequences `--sequence` asks for, in their order: all if it isn't given.
fn wanted(arguments: &SimulateArgs, names: &[String]) -> anyhow::Result<Vec<usize>> {
    let asked = &arguments.sequences;
    if let Some(unknown) = asked.iter().find(|name| !names.contains(name)) {
        let known = names.join(", ");
        return Err(UsageError(format!("--sequence: expected one of {known}, found {unknown}")).into());
    }
    let wanted = |index: &usize| asked.is_empty() || asked.contains(&names[*index]);
    Ok((0..names.len()).filter(wanted).collect())
}
