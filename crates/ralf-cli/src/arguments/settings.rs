//! Settings from a file and from the command line.

use crate::outcome::UsageError;
use crate::text::{in_a_line, shell_path, shell_word};
use anyhow::Context;
use clap::Args;
use ralf_data::Settings;
use ralf_data::read::ros::Topics;
use ralf_files::Kind;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// More threads than this are of no use anywhere, and a system has no room for ever more.
const MOST_THREADS: usize = 1024;

/// As many threads as asked for, or as there are processors.
pub(crate) fn threads(jobs: Option<NonZeroUsize>) -> usize {
    let wanted = jobs.or_else(|| std::thread::available_parallelism().ok());
    wanted.map_or(1, NonZeroUsize::get).min(MOST_THREADS)
}

/// How the labeler is set.
#[derive(Debug, Args)]
pub(crate) struct SettingsArgs {
    /// Settings file (TOML); every key is optional. May be given several times, and a later one wins
    #[arg(long, value_name = "FILE")]
    config: Vec<PathBuf>,
    /// One setting, such as lidar.beta=0.5; wins over the file, may be given several times
    #[arg(long = "set", value_name = "KEY=VALUE")]
    assignments: Vec<String>,
    /// Take the vehicle's motion from these poses: a TUM file, or a KITTI file in the order of the LiDAR's scans; of
    /// several sequences a folder with a file for each, such as 00.tum
    #[arg(long, value_name = "POSES")]
    trajectory: Option<PathBuf>,
    /// The sensor whose poses these are; `vehicle` if not given
    #[arg(long, value_name = "NAME", requires = "trajectory")]
    trajectory_frame: Option<String>,
}

impl SettingsArgs {
    /// The settings, resolved.
    pub(crate) fn resolve(&self) -> anyhow::Result<Settings> {
        self.resolve_above(None)
    }

    /// The same above the settings of a run.
    pub(crate) fn resolve_above(&self, run: Option<&Settings>) -> anyhow::Result<Settings> {
        let files: anyhow::Result<Vec<_>> = self.config.iter().map(|file| checked(file)).collect();
        let mut texts: Vec<String> = run.map(Settings::to_toml).transpose()?.into_iter().collect();
        texts.extend(files.context("--config")?);
        let trajectory = self.trajectory.as_deref();
        trajectory.map_or(Ok(()), is_there).context("--trajectory")?;
        let text = Settings::joined(&texts).context("--config")?;
        let assignments: Vec<&str> = self.assignments.iter().map(String::as_str).collect();
        let settings = Settings::from_toml(&text, &assignments);
        let mut settings =
            settings.map_err(|error| UsageError(format!("--set: {}", in_a_line(&error.to_string()))))?;
        settings.motion.trajectory = self.trajectory.clone().or(settings.motion.trajectory);
        settings.motion.trajectory_frame = self.trajectory_frame.clone().or(settings.motion.trajectory_frame);
        Ok(settings)
    }

    /// Whether this key was typed with `--set`.
    pub(super) fn has_set(&self, key: &str) -> bool {
        let typed = self.assignments.iter().filter_map(|assignment| assignment.split_once('='));
        typed.map(|(typed, _)| typed.trim()).any(|typed| typed == key)
    }

    /// Whether any was typed.
    pub(crate) fn are_given(&self) -> bool {
        !self.config.is_empty() || !self.assignments.is_empty() || self.trajectory.is_some()
    }

    /// As they were typed, each after a space.
    pub(crate) fn told(&self) -> String {
        let config = self.config.iter().map(|file| format!(" --config {}", shell_path(file)));
        let set = self.assignments.iter().map(|assignment| format!(" --set {}", shell_word(assignment)));
        let trajectory = self.trajectory.iter().map(|file| format!(" --trajectory {}", shell_path(file)));
        let frame =
            self.trajectory_frame.iter().map(|name| format!(" --trajectory-frame {}", shell_word(name)));
        config.chain(set).chain(trajectory).chain(frame).collect()
    }
}

/// Refuses a trajectory of other than one recording: it is the motion of one, and times may be those of others, too.
pub(crate) fn check_trajectory(settings: &Settings, recordings: usize) -> Result<(), UsageError> {
    let found = match recordings {
        _ if settings.motion.trajectory.is_none() => return Ok(()),
        0 => "simulated worlds alone".to_owned(),
        1 => return Ok(()),
        several => several.to_string(),
    };
    let expected = "--trajectory (motion.trajectory): expected one DATASET, whose motion it tells";
    Err(UsageError(format!("{expected}, found {found}")))
}

/// The table `topics` of a settings file, which has to be there.
pub(super) fn topics(file: &Path) -> anyhow::Result<Topics> {
    let topics = parsed(file, &text(file)?)?.topics;
    anyhow::ensure!(!topics.is_empty(), "{}: expected the table `topics`, found none", file.display());
    Ok(topics)
}

/// The text of a settings file, which by itself is one: what is wrong with it is said of it.
fn checked(file: &Path) -> anyhow::Result<String> {
    let text = text(file)?;
    parsed(file, &text).map(|_| text)
}

fn parsed(file: &Path, text: &str) -> anyhow::Result<Settings> {
    Settings::from_toml(text, &[]).with_context(|| file.display().to_string())
}

/// Refuses what can't be a file of poses, or a folder of such, before anything is read.
fn is_there(file: &Path) -> anyhow::Result<()> {
    if file.is_dir() {
        return Ok(());
    }
    let found = ralf_files::check(file, Kind::Table).map(drop);
    found.with_context(|| file.display().to_string())
}

fn text(file: &Path) -> anyhow::Result<String> {
    ralf_files::read_text(file, Kind::Settings).with_context(|| file.display().to_string())
}
