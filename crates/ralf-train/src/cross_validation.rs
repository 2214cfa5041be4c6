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

/// A fold for each of the named sequences, in their order. `progress` is told the sequence that is left out, too.
pub fn leave_one_out(
    search: &Search,
    sequences: &[(String, MismatchTable)],
    progress: &mut dyn FnMut(&str, usize, &Found),
) -> Result<Vec<Fold>, TuneError> {
    if sequences.len() < 2 {
        return Err(TuneError::TooFewSequences(sequences.len()));
    }
    let base = TunedSettings::from_config(search.base);
    let fold = |(name, table): &(String, MismatchTable)| {
        let others = sequences.iter().filter(|(other, _)| other != name);
        let others: Vec<&MismatchTable> = others.map(|(_, table)| table).collect();
        let found = search.run(&others, &mut |trial, best| progress(name, trial, best))?;
        Ok(Fold {
            left_out: name.clone(),
            found,
            base: Scores::from_scans(&table.confusions(&base)?),
            tuned: Scores::from_scans(&table.confusions(&found.settings)?),
        })
    };
    sequences.iter().map(fold).collect()
}
