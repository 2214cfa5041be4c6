//! Labels in the formats of other tools.
//!
//! [`Export::write`] goes through the labelled sequences of a recording and hands them to the writer of a format, one
//! file of this folder each. What the writers get is the same: a `LabelledScan` with the results of `ralf label` and
//! the *effective* labels (a person's correction, else what a person accepted, else the machine's).
//!
//! Labels come alone, unless the sensors' data are asked for too. A detection that [`Split`] leaves out is in no file
//! of the export; where the labels belong to clouds that are not part of it (their order is the only key), it stays as
//! unlabeled.
//!
//! An export appears whole or not at all: it is written beside its place, then renamed. The same recording and results
//! give the same bytes.

mod bytes;
mod columns;
mod common_columns;
mod formats;
mod labelled;
mod npy_array;
mod npz;
mod nuscenes;
mod options;
mod parquet;
mod pcd;
mod place;
mod record;
mod ros;
mod semantic_kitti;

pub use formats::{ExportFormat, ExportOptions};
pub use options::{Sensors, Split};
pub use ros::{RosFormat, RosWritten, write_ros};

use crate::disk::real_path::through_link;
use crate::error::DataError;
use crate::read::{Recording, SequenceReader, refuse_to_write_into};
use crate::result::{LabelledRun, OutFolder, SequenceNames, SequenceRecord};
use crate::truth::Corrections;
use labelled::{LabelledSequence, Tally};
use place::Place;
use std::path::Path;

/// An export: what, from where, and how.
pub struct Export<'a> {
    /// The recording.
    pub recording: &'a Recording,
    /// What `ralf label` wrote for it.
    pub out: &'a Path,
    /// Format and extent.
    pub options: ExportOptions,
}

/// What an export holds.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Exported {
    /// Scans that were written.
    pub scans: usize,
    /// Detections that were written.
    pub detections: usize,
    /// Sequences of the recording that the results don't hold; they are left out.
    pub without_labels: Vec<String>,
    /// Scans that `ralf label` could not label, as `sequence/radar/scan`: unlabeled, unless a person has labelled them.
    pub not_labelled: Vec<String>,
    /// A sentence for each scan of which people said something that is not applied, for it held something else then or
    /// can't be read.
    pub orphaned: Vec<String>,
    /// Sequences whose times are later in the export than in the recording, and by how much, ns: those with times
    /// before 1970, where the format has none.
    pub delayed: Vec<(String, i64)>,
}

/// What an export is made of, as its writer has to know it from the beginning.
struct Contents<'a> {
    /// Where the labels are from.
    run: &'a LabelledRun,
    /// The sequences, each with what the run tells of it.
    sequences: &'a [(&'a dyn SequenceReader, &'a SequenceRecord)],
    /// Whose data go with the labels.
    sensors: Sensors,
}

/// The writer of a format.
trait Writer {
    /// Writes one sequence below the export's folder.
    fn sequence(&mut self, folder: &OutFolder, sequence: &mut LabelledSequence) -> Result<(), DataError>;

    /// Writes what tells of all sequences.
    fn finish(&mut self, _folder: &OutFolder) -> Result<(), DataError> {
        Ok(())
    }
}

impl Export<'_> {
    /// How many scans [`Self::write`] goes through, at most.
    pub fn scans(&self) -> usize {
        let sequences = self.recording.sequences.iter();
        sequences.flat_map(|reader| &reader.sequence().times.radars).map(Vec::len).sum()
    }

    /// Writes the export to `path`, or where a link of this name leads. `progress` is told after each scan how many are
    /// done.
    ///
    /// # Errors
    /// A part of the recording; anything at `path` but an empty folder, or an earlier export in this format where
    /// replacing it is asked for; results that are not those of the recording, or of none of its sequences; what the
    /// system refuses. Nothing half-written stays.
    pub fn write(&self, path: &Path, progress: &dyn Fn(usize)) -> Result<Exported, DataError> {
        refuse_to_write_into(&self.recording.path, path)?;
        let path = &through_link(path);
        let run = LabelledRun::open(self.out)?;
        let corrections = Corrections::of_recording(self.out, self.recording)?;
        let orphaned = corrections.told_orphaned();
        let mut exported = Exported { orphaned, ..Exported::default() };
        let mut sequences = Vec::new();
        for reader in &self.recording.sequences {
            let name = &reader.sequence().name;
            match run.record().sequence(name) {
                Some(found) => sequences.push((reader.as_ref(), found)),
                None => exported.without_labels.push(name.clone()),
            }
        }
        if sequences.is_empty() {
            let found = exported.without_labels.join(", ");
            let found = format!("none of them (the recording holds {found})");
            return Err(DataError::content(
                self.out,
                "run.json, sequences",
                "labels of the recording",
                found,
            ));
        }
        let names = SequenceNames::all(sequences.iter().map(|(reader, _)| *reader))?;
        let place = Place::prepare(path, &self.options, names.iter().map(|names| &names.sequence))?;
        let contents = Contents { run: &run, sequences: &sequences, sensors: self.options.sensors };
        let mut writer = self.options.format.writer(&contents)?;
        let mut tally = Tally { exported, progress };
        for (found, names) in sequences.into_iter().zip(names) {
            let mut sequence = LabelledSequence::open(self, &run, &corrections, found.0, names, &mut tally)?;
            writer.sequence(place.folder(), &mut sequence)?;
        }
        writer.finish(place.folder())?;
        place.finish()?;
        Ok(tally.exported)
    }
}
