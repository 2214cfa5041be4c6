//! What `run.json` tells of the check at the head of a run.

use super::own_files::told_within;
use ralf_check::{SequenceCheck, State, Verdict};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// What a check says of one sequence; what is in order is left out.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CheckRecord {
    /// Its name.
    pub sequence: String,
    /// What speaks against the recording.
    pub doubts: Vec<CheckLine>,
    /// What is worth knowing.
    pub facts: Vec<CheckLine>,
    /// What could not be judged, and what is missing.
    pub cannot_judge: Vec<CheckLine>,
}

/// One answer of a check.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CheckLine {
    /// A sensor's name, or `motion`.
    pub subject: String,
    /// On what grounds.
    pub evidence: String,
    /// What would put it right, in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub remedy: Option<String>,
}

impl CheckRecord {
    /// A check in short, of a sequence of the recording at `root`.
    pub fn of(check: &SequenceCheck, root: &Path) -> Self {
        let lines = |state: State| {
            let own = check.verdicts.iter().filter(|verdict| verdict.state == state);
            own.map(|verdict| CheckLine::of(verdict, root)).collect()
        };
        Self {
            sequence: check.name.clone(),
            doubts: lines(State::Doubt),
            facts: lines(State::Fact),
            cannot_judge: lines(State::CannotJudge),
        }
    }
}

impl CheckLine {
    fn of(verdict: &Verdict, root: &Path) -> Self {
        Self {
            subject: verdict.subject.clone(),
            evidence: told_within(&verdict.evidence, root),
            remedy: verdict.remedy.as_ref().map(ralf_check::Remedy::words),
        }
    }
}
