//! What to do where labels belong to another recording.

use crate::progress::say;
use crate::text::listed;
use clap::Args;
use ralf_data::result::LabelledRun;
use ralf_data::{Recording, lost_sequences};
use std::path::Path;

/// So many sequences are named that are gone.
const SHOWN: usize = 5;

/// What to do where labels belong to another recording.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct ChangedArgs {
    /// Go on though files or sequences of the recording are not those that were labelled; they are named
    #[arg(long)]
    pub(crate) changed_recording: bool,
}

impl ChangedArgs {
    /// Compares a recording with what was labelled. What differs is refused, or named where it is to be used all the
    /// same.
    pub(crate) fn check(&self, run: &LabelledRun, recording: &Recording) -> anyhow::Result<()> {
        let changes = run.changes(recording)?;
        let texts: Vec<String> = changes
            .iter()
            .map(|changed| {
                let (file, found) = (changed.file.display(), changed.change.told());
                format!("{file}: expected what was labelled, found {found}")
            })
            .collect();
        if self.changed_recording {
            texts.iter().for_each(|text| say(&format!("warning: {text}")));
            return Ok(());
        }
        let Some(first) = texts.first() else { return Ok(()) };
        let more = texts.len() - 1;
        let more = if more > 0 { format!(", and so are {more} more files") } else { String::new() };
        anyhow::bail!("{first}{more}: label again, or go on with --changed-recording")
    }

    /// Refuses a whole recording that lacks sequences which were labelled, where a run is told, or corrected: they
    /// would be left out. Where they are to be left out all the same they are named.
    pub(crate) fn check_sequences(
        &self,
        out: &Path,
        run: Option<&LabelledRun>,
        recording: &Recording,
    ) -> anyhow::Result<()> {
        let lost = lost_sequences(out, run, recording)?;
        if lost.is_empty() {
            return Ok(());
        }
        let names: Vec<&str> = lost.iter().map(String::as_str).collect();
        let (place, lost) = (recording.path.display(), listed(&names, SHOWN));
        let text =
            format!("{place}: expected all sequences that were labelled or corrected, found none of {lost}");
        if self.changed_recording {
            say(&format!("warning: {text}"));
            return Ok(());
        }
        anyhow::bail!("{text}: put them back, or go on without them with --changed-recording")
    }
}
