//! Sequences written into a dataset, one after the other: the same command, typed again, writes what is missing.

use crate::progress::{Progress, say};
use ralf::sensors::Sequence;
use ralf_data::{DataError, SequenceReader, sequence_folder, write_sequence_with};
use std::path::Path;

/// Whether the dataset has a sequence already; another of its name is an error.
pub(crate) type IsThere<'a> = &'a dyn Fn(&dyn SequenceReader) -> Result<bool, DataError>;

/// Writes those of the sequences that the dataset doesn't have, and names each; `doing` is what is shown beside the
/// progress. Those that are there already are named, too: what they hold was measured, or drawn, by an earlier run.
///
/// # Errors
/// Another sequence has the name of one of them, before anything is written; or what ended the first that can't be
/// written.
pub(crate) fn write_missing(
    sequences: &[&dyn SequenceReader],
    dataset: &Path,
    is_there: IsThere,
    jobs: usize,
    doing: &str,
) -> Result<(), DataError> {
    let place = |reader: &dyn SequenceReader| sequence_folder(dataset, &reader.sequence().name);
    let (mut missing, mut kept) = (Vec::new(), Vec::new());
    for reader in sequences.iter().copied() {
        match is_there(reader)? {
            true => kept.push(place(reader).display().to_string()),
            false => missing.push(reader),
        }
    }
    if !kept.is_empty() {
        say(&format!("kept as it is, for it is there already: {}", kept.join(", ")));
    }
    for reader in missing {
        let progress = shown(reader.sequence(), doing);
        write_sequence_with(reader, dataset, jobs, &|done| progress.reached(done as u64))?;
        drop(progress);
        say(&format!("wrote {}", place(reader).display()));
    }
    Ok(())
}

/// How far writing a sequence has got, in measurements.
pub(crate) fn shown(sequence: &Sequence, doing: &str) -> Progress {
    Progress::of_steps(sequence.times.measurements() as u64, format!("{doing} {}", sequence.name))
}
