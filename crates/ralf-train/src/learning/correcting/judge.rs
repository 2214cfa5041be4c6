//! What corrections bring, where they were not heard.

use super::super::scores::{Scored, Scores};
use super::super::table::{Known, TrainingTable, scans_of};
use super::super::view::View;
use super::folds::Folds;
use super::says::Says;
use ralf::learned::{Forest, World};

/// What a model is worth in a sequence, before and after it was corrected by what was said of others.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// The sequence.
    pub world: String,
    /// Detections of which somebody spoke.
    pub detections: usize,
    /// Plausible ones.
    pub plausible: usize,
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
        let (detections, plausible) = (self.detections as u64, self.plausible as u64);
        World { name: self.world.clone(), detections, plausible, scores }
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
    let mut worlds: Vec<(Vec<Scored>, Vec<Scored>)> = vec![Default::default(); table.worlds.len()];
    for scan in scans_of(&table.known) {
        let known = &table.known[scan.clone()];
        if known[0].view != View::Whole {
            continue;
        }
        let (rows, mut log_odds) = (says.rows.pick(scan.clone()), says.log_odds[scan.clone()].to_vec());
        let (before, after) = &mut worlds[usize::from(known[0].world)];
        before.extend(said(&says.plausibilities[scan.clone()], known));
        if let Some(forest) = parts.get(folds.of_row[scan.start]) {
            log_odds.iter_mut().zip(forest.log_odds(&rows)).for_each(|(sum, added)| *sum += added);
            after.extend(said(&says.weighing.plausibilities(&rows, &log_odds), known));
        }
    }
    let named = table.worlds.iter().zip(worlds).filter(|(_, (before, _))| !before.is_empty());
    let judged = |(world, (before, after)): (&String, (Vec<Scored>, Vec<Scored>))| Judged {
        world: world.clone(),
        detections: before.len(),
        plausible: before.iter().filter(|row| row.plausible).count(),
        before: Scores::new(&before, threshold),
        after: Scores::new(&after, threshold),
    };
    named.map(judged).collect()
}

/// The plausibilities of those of a scan's detections of which somebody spoke.
fn said(plausibilities: &[f64], known: &[Known]) -> impl Iterator<Item = Scored> {
    let of_all = plausibilities.iter().zip(known);
    of_all
        .filter(|(_, known)| known.said)
        .map(|(score, known)| Scored { score: *score, plausible: known.plausible })
}
