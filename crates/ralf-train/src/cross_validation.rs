//! Leaving one sequence out in turn: how well tuned settings do on sequences they were not tuned on.

use super::{Found, MismatchTable, Search, TuneError, TunedSettings};
use ralf::metrics::Scores;

/// One sequence, judged by settings that were tuned on the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Fold {
    /// The sequence's name.
    pub left_out: String,
    /// What was found on the others.
    pub found: Found,
    /// What the base settings reach on it.
    pub base: Scores,
    /// What the tuned ones reach on it.
    pub tuned: Scores,
}

/// Whether each of the named sequences can be left out, before anything is searched for.
///
/// # Errors
/// Fewer than two of them; all of one class; or one without which there are no plausible detections, or no artifacts.
pub fn check_folds(search: &Search, sequences: &[(String, MismatchTable)]) -> Result<(), TuneError> {
    if sequences.len() < 2 {
        return Err(TuneError::TooFewSequences(sequences.len()));
    }
    let all: Vec<&MismatchTable> = sequences.iter().map(|(_, table)| table).collect();
    search.check(&all)?;
    for (name, _) in sequences {
        search.check(&others(sequences, name)).map_err(|error| match error {
            TuneError::OneClass(missing) => TuneError::OneClassWithout { left_out: name.clone(), missing },
            other => other,
        })?;
    }
    Ok(())
}

fn others<'a>(sequences: &'a [(String, MismatchTable)], left_out: &str) -> Vec<&'a MismatchTable> {
    sequences.iter().filter(|(other, _)| other != left_out).map(|(_, table)| table).collect()
}

/// A fold for each of the named sequences, in their order. `progress` is told the sequence that is left out, too.
///
/// # Errors
/// Those of [`check_folds`] and [`Search::run`].
pub fn leave_one_out(
    search: &Search,
    sequences: &[(String, MismatchTable)],
    progress: &mut dyn FnMut(&str, usize, &Found),
) -> Result<Vec<Fold>, TuneError> {
    check_folds(search, sequences)?;
    let base = TunedSettings::from_config(search.base);
    let fold = |(name, table): &(String, MismatchTable)| {
        let found = search.run(&others(sequences, name), &mut |trial, best| progress(name, trial, best))?;
        Ok(Fold {
            left_out: name.clone(),
            found,
            base: Scores::from_scans(&table.confusions(&base)?),
            tuned: Scores::from_scans(&table.confusions(&found.settings)?),
        })
    };
    sequences.iter().map(fold).collect()
}
