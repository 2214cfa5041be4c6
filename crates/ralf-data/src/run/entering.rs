//! How a run comes into its output folder: alone, beside others that label parts of it, or to find that all is done.

use super::inputs::{self, Identity};
use super::other_recording::Told;
use super::output_folder::OutputFolder;
use super::unfinished::Unfinished;
use super::{LabelRun, Observer, fingerprint};
use crate::error::DataError;
use crate::result::{OutFolder, WriterLock, refuse_links_out};
use crate::tree::{SEQUENCES, UNFINISHED};

/// In the output folder while a run writes to it.
const LOCK: &str = ".ralf-lock";

impl LabelRun<'_> {
    /// Refuses, as [`Self::execute`] does, a recording for which labels of another one would go: to be asked before
    /// something is computed for it that takes long. Files are read only where such labels are there.
    ///
    /// # Errors
    /// Such labels, and what can't be read of them.
    pub fn refuse_other_recording(&self, observer: &dyn Observer) -> Result<(), DataError> {
        let (run, place) = (self.record(), &self.recording.path);
        let told = Told::read(self.out, &run)?;
        let names = self.recording.sequences.iter().map(|reader| reader.sequence().name.as_str());
        if !told.may_lose_others(place, &names.collect()) {
            return Ok(());
        }
        let asked = inputs::identify(self.recording, &fingerprint::of_run(&run), &[], self.jobs, observer)?;
        told.refuse_other_recording(place, &asked)
    }

    /// The right to write to the output folder, alone.
    pub(super) fn lock(&self) -> Result<WriterLock, DataError> {
        self.refuse_links()?;
        WriterLock::take(self.out.join(LOCK), self.out)
    }

    /// The right to write there beside others that label parts of the same run.
    pub(super) fn lock_shared(&self) -> Result<WriterLock, DataError> {
        WriterLock::share(self.out.join(LOCK), self.out)
    }

    /// Refuses links out of the output folder, where results would be written.
    pub(super) fn refuse_links(&self) -> Result<(), DataError> {
        refuse_links_out(self.out, SEQUENCES, 2)?;
        refuse_links_out(self.out, UNFINISHED, 4)
    }

    /// The output folder, and the right to write there; where nothing is to be done nobody needs that.
    pub(super) fn enter(
        &self,
        observer: &dyn Observer,
    ) -> Result<(Option<WriterLock>, OutputFolder, Vec<Identity>), DataError> {
        let refused = match self.lock() {
            Ok(lock) => {
                let (folder, asked) = self.open_folder(|| Ok(()), observer)?;
                return Ok((Some(lock), folder, asked));
            }
            Err(refused) => refused,
        };
        if !refused.is_of_permission() {
            return Err(refused);
        }
        let run = self.record();
        let asked = inputs::identify(self.recording, &fingerprint::of_run(&run), &[], self.jobs, observer)?;
        let folder = OutputFolder::finished(self.out, run, self.recording, &asked)?.ok_or(refused)?;
        Ok((None, folder, asked))
    }

    /// The output folder, ready for the sequences that are asked for. `accepted` is called before anything in it
    /// changes, once it is known to hold no labels of another recording.
    pub(super) fn open_folder(
        &self,
        accepted: impl FnOnce() -> Result<(), DataError>,
        observer: &dyn Observer,
    ) -> Result<(OutputFolder, Vec<Identity>), DataError> {
        let run = self.record();
        let known = Unfinished::of(&OutFolder::new(self.out), &run)?.inputs()?;
        let asked =
            inputs::identify(self.recording, &fingerprint::of_run(&run), &known, self.jobs, observer)?;
        Ok((OutputFolder::open(self.out, run, self.recording, &asked, accepted)?, asked))
    }
}
