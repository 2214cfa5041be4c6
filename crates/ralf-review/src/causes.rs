//! Causes of artifacts, numbered alike in all sequences.

use ralf::label::Cause;
use ralf_corrections::ScanState;
use ralf_data::result::{Table, Values};
use ralf_data::{Causes, DataError, GroundTruth, Recording, ScanId};
use std::sync::Arc;

/// The result's column of what a model calls the causes of artifacts.
const BY_MACHINE: &str = "cause";

/// The causes that people may say, by number; 0 is none.
pub(crate) fn sayable() -> [&'static str; Cause::ALL.len()] {
    Cause::ALL.map(|cause| if cause == Cause::Plausible { "" } else { cause.name() })
}

/// The detections of which people said a cause, with its number. One that this program doesn't know is none.
pub(crate) fn numbered(state: &ScanState) -> impl Iterator<Item = (u32, u8)> {
    state.causes.iter().filter_map(|(point, name)| {
        let known = Cause::named(name).filter(|cause| *cause != Cause::Plausible)?;
        Some((*point, known as u8))
    })
}

/// What the machine calls the causes of a scan's artifacts: names by number, of which 0 is none, and the number of each
/// detection; `None` where no model was asked.
pub(crate) fn by_machine(rows: &Table) -> Option<(Vec<Arc<str>>, Vec<u8>)> {
    let told = rows.columns().find_map(|(column, values)| match values {
        Values::Text(told) if column.name == BY_MACHINE => Some(told),
        _ => None,
    })?;
    let mut names = vec![Arc::from("")];
    let number = |name: &Arc<str>| {
        let known = names.iter().position(|known| known == name).unwrap_or(names.len());
        if known == names.len() {
            names.push(name.clone());
        }
        u8::try_from(known).unwrap_or(0)
    };
    let numbers = told.iter().map(number).collect();
    Some((names, numbers))
}

/// The names of all causes of all sequences, and what each sequence's codes mean.
pub(crate) struct CauseNames {
    names: Vec<String>,
    /// By sequence: its causes, and the number of each of its codes in `names`.
    sequences: Vec<Option<(Causes, Vec<u8>)>>,
}

impl CauseNames {
    /// Reads the names; a recording that knows no causes has none.
    pub(crate) fn of(recording: &Recording) -> Result<Self, DataError> {
        // Number 0 is no cause, and the page shows nothing for it.
        let mut names = vec![String::new()];
        let mut sequences = Vec::new();
        let truth = GroundTruth::find(&recording.path)?;
        for reader in &recording.sequences {
            let name = &reader.sequence().name;
            let of_files = || Causes::find(&recording.path, name);
            let Some(causes) = truth.as_ref().map_or_else(of_files, |truth| truth.causes(name))? else {
                sequences.push(None);
                continue;
            };
            let mut numbers = vec![0];
            for name in &causes.names()[1..] {
                let known = names.iter().position(|known| known == name).unwrap_or(names.len());
                if known == names.len() {
                    names.push(name.clone());
                }
                numbers.push(u8::try_from(known).map_err(|_| {
                    let place = "names of causes of all sequences";
                    DataError::content(&recording.path, place, "at most 256", "more")
                })?);
            }
            sequences.push(Some((causes, numbers)));
        }
        Ok(Self { names, sequences })
    }

    /// The name of each number; `None` where no sequence knows causes.
    pub(crate) fn names(&self) -> Option<&[String]> {
        self.sequences.iter().any(Option::is_some).then_some(self.names.as_slice())
    }

    /// The numbers of a scan's causes, where they are known.
    pub(crate) fn of_scan(
        &self,
        sequence: usize,
        scan: &ScanId,
        detections: usize,
    ) -> Result<Option<Vec<u8>>, DataError> {
        let Some(Some((causes, numbers))) = self.sequences.get(sequence) else { return Ok(None) };
        let codes = causes.of_scan(scan, detections)?;
        Ok(codes.map(|codes| codes.into_iter().map(|code| numbers[usize::from(code)]).collect()))
    }
}
