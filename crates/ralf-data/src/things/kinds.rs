//! Kinds: detections all over a sequence that one answer can be about, however far apart they lie.
//!
//! A kind has one label by the machine, one [`Sign`] in its evidence, and contradicts the [shipped
//! model](ralf::learned::Model), which has read all evidence, about as much. So a question about it is short: "these
//! are weaker than most of their scan, and are called plausible: are they?" Nothing is changed by asking.

use super::heard::{Heard, Lesson};
use super::sign::{Sign, Signs};
use super::{Answer, Observed, SequenceThings};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{self, Display};
use std::str::FromStr;

/// What is the other with a lower probability isn't asked about: of what is called plausible, and of what is called an
/// artifact. Beside the paper's method, which needs other sensors to believe a detection, a model that doesn't is bold.
const ASKED: [f64; 2] = [0.15, 0.5];
/// From this probability on the model contradicts the label surely: of what is called plausible, and of an artifact.
const SURELY: [f64; 2] = [0.5, 0.85];
/// A question that is expected to mend fewer labels isn't worth an answer.
const WORTH: f64 = 1.0;

/// Which kind a detection is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct KindName {
    /// What the machine calls it.
    pub plausible: bool,
    /// What its evidence shows.
    pub sign: Sign,
    /// Whether the model contradicts the label surely.
    pub surely: bool,
}

impl KindName {
    /// Of a detection that the model calls the other with this probability; `None` of one that isn't asked about.
    fn of(plausible: bool, contrary: f64, sign: Sign) -> Option<Self> {
        let by_label = usize::from(!plausible);
        let surely = contrary >= SURELY[by_label];
        (contrary >= ASKED[by_label]).then_some(Self { plausible, sign, surely })
    }
}

impl Display for KindName {
    fn fmt(&self, to: &mut fmt::Formatter) -> fmt::Result {
        let label = if self.plausible { "plausible" } else { "artifact" };
        write!(to, "{label}-{}-{}", self.sign.name(), if self.surely { "surely" } else { "perhaps" })
    }
}

impl FromStr for KindName {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        let all = [true, false].into_iter().flat_map(|plausible| {
            let signs = Sign::ALL.into_iter();
            signs.flat_map(move |sign| [true, false].map(|surely| Self { plausible, sign, surely }))
        });
        all.into_iter().find(|name| name.to_string() == text).ok_or(())
    }
}

/// Detections of which nobody said anything and that one question is about.
#[derive(Debug, Clone, PartialEq)]
pub struct Kind {
    /// Which.
    pub name: KindName,
    /// They, in rising order.
    pub rows: Vec<usize>,
    /// How many of them are expected to be wrong, after what was said of others.
    pub expected_errors: f64,
    /// How many wrong labels fewer are expected once it is answered: more than nothing, for it can be passed over.
    pub worth: f64,
}

/// The detections of one kind, by their places in what was observed.
#[derive(Default)]
struct Members {
    open: Vec<usize>,
    said: Vec<usize>,
}

impl SequenceThings {
    /// The kinds that want an answer, those first that are worth most; one of which the model isn't sure comes after
    /// the one like it of which it is. `passed`: kinds whose label is right for most, as somebody said by passing over
    /// them; they aren't asked about again, and are heard as an answer is for kinds that are like them.
    pub fn kinds(
        &self,
        observed: &Observed,
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
        let is_asked = |name: &KindName| {
            !passed.contains(name) && members.get(name).is_some_and(|members| !members.open.is_empty())
        };
        // Where the model is surer comes first: the answer there tells whether the rest is worth one.
        let is_next = |name: &KindName| {
            is_asked(name) && (name.surely || !is_asked(&KindName { surely: true, ..*name }))
        };
        let kind = |(name, members): (&KindName, &Members)| {
            let way = if name.plausible { -1.0 } else { 1.0 };
            let contrary: Vec<f64> = members.open.iter().map(|at| way * observed.log_odds(*at)).collect();
            let (expected_errors, worth) = heard.worth(name.sign, way, &contrary);
            let rows = members.open.iter().map(|at| observed.of[*at]).collect();
            Kind { name: *name, rows, expected_errors, worth }
        };
        let asked = members.iter().filter(|(name, _)| is_next(name));
        let mut kinds: Vec<Kind> = asked.map(kind).filter(|kind| kind.worth >= WORTH).collect();
        kinds.sort_by(|a, b| b.worth.total_cmp(&a.worth).then(a.name.cmp(&b.name)));
        kinds
    }

    fn members_of_kinds(
        &self,
        observed: &Observed,
        answers: &[Option<Answer>],
    ) -> BTreeMap<KindName, Members> {
        let signs = Signs::of(observed);
        let mut members: BTreeMap<KindName, Members> = BTreeMap::new();
        for (at, row) in observed.of.iter().enumerate() {
            let plausible = self.sightings()[*row].plausible;
            let probability = observed.probability[at];
            let contrary = if plausible { 1.0 - probability } else { probability };
            let sign = signs.sign(&observed.rows, at, plausible);
            let Some(name) = KindName::of(plausible, contrary, sign) else { continue };
            let members = members.entry(name).or_default();
            if answers[*row].is_some() { members.said.push(at) } else { members.open.push(at) }
        }
        members
    }
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
                for surely in [true, false] {
                    let name = KindName { plausible, sign, surely };
                    assert_eq!(name.to_string().parse(), Ok(name));
                    names.insert(name.to_string());
                }
            }
        }
        assert_eq!(names.len(), 28);
        assert_eq!("plausible-weak".parse::<KindName>(), Err(()));
    }

    #[test]
    fn what_the_model_hardly_contradicts_is_not_asked_about() {
        let name = |plausible, contrary| KindName::of(plausible, contrary, Sign::Weak);
        assert_eq!(name(true, 0.1), None);
        assert_eq!(name(false, 0.4), None);
        assert_eq!(name(true, 0.4).map(|name| name.surely), Some(false));
        assert_eq!(name(true, 0.6).map(|name| name.surely), Some(true));
        assert_eq!(name(false, 0.6).map(|name| name.surely), Some(false));
        assert_eq!(name(false, 0.9).map(|name| name.surely), Some(true));
    }
}
