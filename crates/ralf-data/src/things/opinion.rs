//! What the labels of a sequence would be, after what people said of some of them.

use super::{Answer, SequenceEvidence, SequenceThings, Thing};
use ralf_train::learning::{Believed, second_opinion};

/// A thing whose label would be another one.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// The thing.
    pub thing: Thing,
    /// What it would be.
    pub plausible: bool,
    /// How probable that is, on average over its detections.
    pub probability: f64,
    /// Its detections of which nobody said anything and that are called otherwise, in rising order.
    pub rows: Vec<usize>,
}

/// A thing is proposed only where its other label is this probable: most of what is looked at shall be right.
const PROPOSED: f64 = 0.85;

impl SequenceThings {
    /// Which things would be called otherwise by who has learned from these answers, those with the most detections
    /// first; of what wasn't observed nothing is said or learned. Nothing where nobody has said anything of the rest.
    /// The result doesn't depend on `jobs`.
    pub fn second_opinion(
        &self,
        observed: &SequenceEvidence,
        answers: &[Option<Answer>],
        jobs: usize,
    ) -> Vec<Change> {
        if self.answered(observed, answers) == 0 {
            return Vec::new();
        }
        let believed: Vec<Believed> =
            observed.of.iter().map(|row| self.believed(*row, answers[*row])).collect();
        let thought = second_opinion(&observed.rows, &observed.monotone, &believed, jobs);
        let mut opinion = vec![None; answers.len()];
        for (row, probability) in observed.of.iter().zip(thought) {
            opinion[*row] = Some(probability);
        }
        let left = self.expected_errors(answers);
        let mut changes: Vec<Change> = Vec::new();
        for (number, members) in self.members().into_iter().enumerate() {
            let Some((plausible, probability)) = judged(&members, answers, &opinion) else { continue };
            let is_open = |row: usize| answers[row].is_none() && opinion[row].is_some();
            let is_other = |row: &usize| is_open(*row) && self.sightings()[*row].plausible != plausible;
            let rows: Vec<usize> = members.iter().copied().filter(is_other).collect();
            if probability >= PROPOSED && !rows.is_empty() {
                let expected_errors = members.iter().map(|row| left[*row]).sum();
                let thing = self.thing(number as u32, &members, expected_errors, answers);
                changes.push(Change { thing, plausible, probability, rows });
            }
        }
        changes.sort_by(|a, b| b.rows.len().cmp(&a.rows.len()).then(a.thing.number.cmp(&b.thing.number)));
        changes
    }

    /// How many detections people said something of, among those that were observed.
    pub fn answered(&self, observed: &SequenceEvidence, answers: &[Option<Answer>]) -> usize {
        observed.of.iter().filter(|row| answers[**row].is_some()).count()
    }

    fn believed(&self, row: usize, answer: Option<Answer>) -> Believed {
        let machine = self.sightings()[row].plausible;
        Believed {
            plausible: machine != (answer == Some(Answer::Wrong)),
            said: answer.is_some(),
            sure: (1.0 - 2.0 * self.own_doubt()[row]).max(0.0),
            thing: self.things()[row],
        }
    }
}

/// What those of a thing are on average of which nobody said anything, and how probable that is.
fn judged(members: &[usize], answers: &[Option<Answer>], opinion: &[Option<f64>]) -> Option<(bool, f64)> {
    let open = || members.iter().filter(|row| answers[**row].is_none()).filter_map(|row| opinion[*row]);
    let mean = open().sum::<f64>() / open().count() as f64;
    mean.is_finite().then_some(if mean >= 0.5 { (true, mean) } else { (false, 1.0 - mean) })
}
