//! What somebody labels a second time.

use super::assignment::Assignment;
use crate::error::DataError;
use crate::truth::{Corrections, ScanId};
use std::collections::BTreeSet;
use std::path::Path;

/// The scans that somebody labels a second time: those that were dealt to this person, or all of others' sequences
/// where none were dealt in any. Never one of the person's own.
#[derive(Debug, Clone)]
pub struct Twice<'a> {
    own: &'a [String],
    dealt: BTreeSet<&'a ScanId>,
}

impl Twice<'_> {
    /// Whether the scan is one of them.
    pub fn holds(&self, scan: &ScanId) -> bool {
        !self.own.contains(&scan.sequence) && (self.dealt.is_empty() || self.dealt.contains(scan))
    }

    /// Somebody's second labels of these scans alone, and of how many others they said something: those are of no
    /// random sample.
    pub fn among(&self, second: Corrections) -> (Corrections, usize) {
        let others = second.scans().filter(|scan| !self.holds(scan)).count();
        (second.of_scans(|scan| self.holds(scan)), others)
    }
}

impl Assignment {
    /// What somebody labels a second time; `None` of somebody whom the assignment doesn't name.
    pub fn twice_of(&self, name: &str) -> Option<Twice<'_>> {
        let share = self.0.get(name)?;
        Some(Twice { own: &share.sequences, dealt: share.twice.iter().collect() })
    }

    /// Refuses who is not named by the assignment of an output folder: nobody would know what was dealt to them.
    ///
    /// # Errors
    /// With the known names.
    pub fn check_known(&self, out: &Path, name: &str) -> Result<(), DataError> {
        if self.0.contains_key(name) {
            return Ok(());
        }
        let known: Vec<&str> = self.0.keys().map(String::as_str).collect();
        let expected = format!("one of {}", known.join(", "));
        Err(DataError::content(&Self::file(out), "second labels", expected, format!("`{name}`")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::team::Share;

    fn scan(sequence: &str, scan: u32) -> ScanId {
        ScanId { sequence: sequence.into(), radar: "front".into(), scan }
    }

    #[test]
    fn nobody_labels_its_own_sequences_a_second_time() {
        let share = |sequences: &[&str], twice: &[ScanId]| Share {
            sequences: sequences.iter().map(|name| (*name).to_owned()).collect(),
            twice: twice.to_vec(),
        };
        let dealt = Assignment(
            [("ada", share(&["a"], &[])), ("bob", share(&["b"], &[scan("a", 1), scan("b", 1)]))]
                .map(|(name, share)| (name.to_owned(), share))
                .into(),
        );
        let holds = |name: &str| {
            let twice = dealt.twice_of(name).unwrap();
            [("a", 0), ("a", 1), ("b", 0), ("b", 1)].map(|(sequence, at)| twice.holds(&scan(sequence, at)))
        };
        assert_eq!(holds("bob"), [false, true, false, false]);
        assert_eq!(holds("ada"), [false, false, true, true], "none were dealt: all that is others'");
        assert!(dealt.twice_of("Bob").is_none());
        let told = dealt.check_known(Path::new("out"), "Bob").unwrap_err().to_string();
        assert!(told.contains("team.toml: second labels: expected one of ada, bob, found `Bob`"), "{told}");
    }
}
