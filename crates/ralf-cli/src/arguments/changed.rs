//! What to do where labels belong to another recording.

use crate::progress::say;
use clap::Args;
use ralf_data::Recording;
use ralf_data::result::LabelledRun;

/// What to do where labels belong to another recording.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct ChangedArgs {
    /// Go on though files of the recording are not those that were labelled; they are named
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
}
