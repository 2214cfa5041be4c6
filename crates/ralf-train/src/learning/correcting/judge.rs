//! What corrections bring, where they were not heard.

use super::super::scores::{Scored, Scores};
use super::super::table::{Known, TrainingTable, scans_of};
use super::super::view::View;
use super::folds::Folds;
use super::says::Says;
use ralf::learned::{Forest, World};
use std::iter::Sum;

/// What a model is worth in a sequence, before and after it was corrected by what was said of others.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// The sequence.
    pub world: String,
    /// What becomes of its labels.
    pub turns: Turns,
    /// What the model is worth as it was, at the threshold of the settings.
    pub before: Scores,
    /// What models are worth that were corrected by the other sequences; by other parts of this one, where it is the
    /// only one. All `None` where nothing else was said.
    pub after: Scores,
}

impl Judged {
    /// For the model's file.
    pub(super) fn told(&self) -> World {
        let scores = Scores::told([("", &self.after), ("before_", &self.before)]);
        let (detections, plausible) = (self.turns.said as u64, self.turns.plausible as u64);
        World { name: self.world.clone(), detections, plausible, scores }
    }
}

/// What becomes of labels where a model is corrected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Turns {
    /// Detections of which somebody spoke.
    pub said: usize,
    /// Those that are plausible.
    pub plausible: usize,
    /// Those that the model labels otherwise than was said.
    pub wrong_before: usize,
    /// Those that corrected ones do; `None` where nothing else was said.
    pub wrong_after: Option<usize>,
    /// Detections of the same scans of which nobody spoke.
    pub left_alone: usize,
    /// Those that corrected models label otherwise than they were shown; `None` where nothing else was said.
    pub turned: Option<usize>,
}

impl Sum for Turns {
    fn sum<I: Iterator<Item = Self>>(turns: I) -> Self {
        let none = Self {
            said: 0,
            plausible: 0,
            wrong_before: 0,
            wrong_after: Some(0),
            left_alone: 0,
            turned: Some(0),
        };
        let both = |a: Option<usize>, b: Option<usize>| Some(a? + b?);
        turns.fold(none, |sum, one| Self {
            said: sum.said + one.said,
            plausible: sum.plausible + one.plausible,
            wrong_before: sum.wrong_before + one.wrong_before,
            wrong_after: both(sum.wrong_after, one.wrong_after),
            left_alone: sum.left_alone + one.left_alone,
            turned: both(sum.turned, one.turned),
        })
    }
}

/// What a sequence tells.
#[derive(Clone, Default)]
struct Heard {
    before: Vec<Scored>,
    after: Vec<Scored>,
    left_alone: usize,
    turned: usize,
}

impl Heard {
    fn judged(&self, world: &str, threshold: f64) -> Judged {
        let wrong =
            |rows: &[Scored]| rows.iter().filter(|row| (row.score >= threshold) != row.plausible).count();
        let is_judged = !self.after.is_empty();
        Judged {
            world: world.to_owned(),
            turns: Turns {
                said: self.before.len(),
                plausible: self.before.iter().filter(|row| row.plausible).count(),
                wrong_before: wrong(&self.before),
                wrong_after: is_judged.then(|| wrong(&self.after)),
                left_alone: self.left_alone,
                turned: is_judged.then_some(self.turned),
            },
            before: Scores::new(&self.before, threshold),
            after: Scores::new(&self.after, threshold),
        }
    }
}

/// Every sequence of which somebody spoke, by forests that heard nothing of the part it is in.
pub(super) fn judge(
    table: &TrainingTable,
    says: &Says,
    folds: &Folds,
    parts: &[Forest],
    threshold: f64,
) -> Vec<Judged> {
    let mut worlds: Vec<Heard> = vec![Heard::default(); table.worlds.len()];
    for scan in scans_of(&table.known) {
        let known = &table.known[scan.clone()];
        if known[0].view != View::Whole {
            continue;
        }
        let (rows, mut log_odds) = (says.rows.pick(scan.clone()), says.log_odds[scan.clone()].to_vec());
        let (heard, before) = (&mut worlds[usize::from(known[0].world)], &says.plausibilities[scan.clone()]);
        heard.before.extend(said(before, known));
        heard.left_alone += known.iter().filter(|known| !known.said).count();
        if let Some(forest) = parts.get(folds.of_row[scan.start]) {
            log_odds.iter_mut().zip(forest.log_odds(&rows)).for_each(|(sum, added)| *sum += added);
            let after = says.weighing.plausibilities(&rows, &log_odds);
            heard.after.extend(said(&after, known));
            let turns = |((known, before), after): &((&Known, &f64), &f64)| {
                !known.said && known.shown.unwrap_or(**before >= threshold) != (**after >= threshold)
            };
            heard.turned += known.iter().zip(before).zip(&after).filter(turns).count();
        }
    }
    let named = table.worlds.iter().zip(&worlds).filter(|(_, heard)| !heard.before.is_empty());
    named.map(|(world, heard)| heard.judged(world, threshold)).collect()
}

/// The plausibilities of those of a scan's detections of which somebody spoke.
fn said(plausibilities: &[f64], known: &[Known]) -> impl Iterator<Item = Scored> {
    let of_all = plausibilities.iter().zip(known);
    of_all
        .filter(|(_, known)| known.said)
        .map(|(score, known)| Scored { score: *score, plausible: known.plausible })
}
