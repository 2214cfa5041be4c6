//! Kinds: detections all over a sequence that one answer can be about, however far apart they lie.
//!
//! A kind has one label by the machine and one [`Sign`] in its evidence. So a question about it is short: "these are
//! weaker than most of their scan, and are called plausible: are they?" It is asked of those that the [shipped
//! model](ralf::learned::Model), which has read all evidence, contradicts the most; who is asked may draw the line
//! between these and the others elsewhere. Nothing is changed by asking.

use super::heard::{Heard, Lesson, usual};
use super::sign::{Sign, Signs};
use super::{Answer, SequenceEvidence, SequenceThings};
use ralf::learned::probability;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{self, Display};
use std::str::FromStr;

/// What is the other with a lower probability is of no kind.
const ASKED: f64 = 0.05;
/// A question that is expected to mend fewer labels isn't worth an answer.
const WORTH: f64 = 1.0;

/// Which kind a detection is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct KindName {
    /// What the machine calls it.
    pub plausible: bool,
    /// What its evidence shows.
    pub sign: Sign,
}

impl KindName {
    /// Of a detection that the model calls plausible with these log odds; `None` of one that isn't asked about.
    fn of(plausible: bool, log_odds: f64, sign: Sign) -> Option<Self> {
        let name = Self { plausible, sign };
        (probability(name.way() * (log_odds + usual(sign))) >= ASKED).then_some(name)
    }

    /// 1 where the other label would be plausible, else -1.
    fn way(self) -> f64 {
        if self.plausible { -1.0 } else { 1.0 }
    }
}

impl Display for KindName {
    fn fmt(&self, to: &mut fmt::Formatter) -> fmt::Result {
        write!(to, "{}-{}", if self.plausible { "plausible" } else { "artifact" }, self.sign.name())
    }
}

impl FromStr for KindName {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        let all = [true, false].into_iter();
        let mut all = all.flat_map(|plausible| Sign::ALL.map(|sign| Self { plausible, sign }));
        all.find(|name| name.to_string() == text).ok_or(())
    }
}

/// Detections of which nobody said anything and that one question is about.
#[derive(Debug, Clone, PartialEq)]
pub struct Kind {
    /// Which.
    pub name: KindName,
    /// They, in rising order.
    pub rows: Vec<usize>,
    /// Of each of them, how many are contradicted more: the order in which they are wrong more and more rarely.
    pub ranks: Vec<usize>,
    /// How many of the first in that order are more probably wrong than right, after what was said of others: at least
    /// one.
    pub asked: usize,
    /// How many of all are expected to be wrong, after what was said of others.
    pub expected_errors: f64,
    /// How many wrong labels fewer are expected once it is answered with the line where it should be.
    pub worth: f64,
}

/// The detections of one kind, by their places in what was observed.
#[derive(Default)]
struct Members {
    open: Vec<usize>,
    said: Vec<usize>,
}

impl SequenceThings {
    /// The kinds that want an answer, those first that are worth most. `passed`: kinds that somebody was asked about:
    /// what nobody said anything of is right for most, and heard as an answer is for kinds that are like them; they
    /// aren't asked about again.
    pub fn kinds(
        &self,
        observed: &SequenceEvidence,
        answers: &[Option<Answer>],
        passed: &BTreeSet<KindName>,
    ) -> Vec<Kind> {
        let members = self.members_of_kinds(observed, answers);
        let machine = |at: usize| self.sightings()[observed.of[at]].plausible;
        let mut lessons: Vec<Lesson> = Vec::new();
        for (name, Members { open, said }) in &members {
            let lesson = |rows: &[usize], is: &dyn Fn(usize) -> bool| Lesson {
                sign: name.sign,
                answers: rows.iter().map(|at| (observed.log_odds(*at), is(*at))).collect(),
            };
            let is_wrong = |at: usize| answers[observed.of[at]] == Some(Answer::Wrong);
            lessons.push(lesson(said, &|at| machine(at) != is_wrong(at)));
            if passed.contains(name) {
                lessons.push(lesson(open, &machine));
            }
        }
        let heard = Heard::of(&lessons);
        let asked =
            members.iter().filter(|(name, members)| !passed.contains(name) && !members.open.is_empty());
        let kinds = asked.map(|(name, members)| kind(*name, &members.open, observed, &heard));
        let mut kinds: Vec<Kind> = kinds.filter(|kind| kind.worth >= WORTH).collect();
        kinds.sort_by(|a, b| b.worth.total_cmp(&a.worth).then(a.name.cmp(&b.name)));
        kinds
    }

    fn members_of_kinds(
        &self,
        observed: &SequenceEvidence,
        answers: &[Option<Answer>],
    ) -> BTreeMap<KindName, Members> {
        let signs = Signs::of(observed);
        let mut members: BTreeMap<KindName, Members> = BTreeMap::new();
        for (at, row) in observed.of.iter().enumerate() {
            let plausible = self.sightings()[*row].plausible;
            let sign = signs.sign(&observed.rows, at, plausible);
            let Some(name) = KindName::of(plausible, observed.log_odds(at), sign) else { continue };
            let members = members.entry(name).or_default();
            if answers[*row].is_some() { members.said.push(at) } else { members.open.push(at) }
        }
        members
    }
}

/// A question about detections by their places in what was observed.
fn kind(name: KindName, open: &[usize], observed: &SequenceEvidence, heard: &Heard) -> Kind {
    let way = name.way();
    let contrary: Vec<f64> = open.iter().map(|at| way * observed.log_odds(*at)).collect();
    let (expected_errors, worth) = heard.worth(name.sign, way, &contrary);
    let offset = heard.offset(name.sign, way);
    let asked = contrary.iter().filter(|l| *l + offset >= 0.0).count();
    let rows = open.iter().map(|at| observed.of[*at]).collect();
    Kind { name, rows, ranks: ranks(&contrary), asked: asked.max(1), expected_errors, worth }
}

/// The place of each value in falling order; of equal ones the first comes first.
fn ranks(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*b].total_cmp(&values[*a]).then(a.cmp(b)));
    let mut ranks = vec![0; values.len()];
    order.into_iter().enumerate().for_each(|(rank, at)| ranks[at] = rank);
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_kind_has_a_name_of_its_own_that_leads_back_to_it() {
        let mut names = BTreeSet::new();
        for plausible in [true, false] {
            for sign in Sign::ALL {
                let name = KindName { plausible, sign };
                assert_eq!(name.to_string().parse(), Ok(name));
                names.insert(name.to_string());
            }
        }
        assert_eq!(names.len(), 14);
        assert_eq!("plausible".parse::<KindName>(), Err(()));
    }

    #[test]
    fn what_the_model_hardly_contradicts_is_of_no_kind() {
        // It is more probably an artifact than the model says: 5 % is a log odds of -2.94.
        let is_asked = |plausible, log_odds| KindName::of(plausible, log_odds, Sign::Weak).is_some();
        assert!(!is_asked(true, 5.0) && is_asked(true, 4.9));
        assert!(!is_asked(false, -1.0) && is_asked(false, -0.9));
    }

    #[test]
    fn what_is_contradicted_most_comes_first() {
        assert_eq!(ranks(&[0.5, 2.0, -1.0, 2.0]), [2, 0, 3, 1]);
        assert!(ranks(&[]).is_empty());
    }
}
