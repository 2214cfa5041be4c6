//! Own corrections, learned beside simulated worlds.

use super::text::line;
use ralf::config::Config;
use ralf::learned::Model;
use ralf_train::learning::{Scores, TrainingTable, worth_in};
use std::ops::Range;
use std::path::Path;

/// How many simulated detections one counts as that somebody has looked at (docs/learned.md).
const WEIGHT: f32 = 20.0;

/// How much each detection of a recording counts.
pub(super) fn weight(from: Option<&Path>) -> f32 {
    if from.is_some() { WEIGHT } else { 1.0 }
}

/// What the shipped model is worth in each own sequence.
pub(super) fn before(
    table: &TrainingTable,
    own: Range<u16>,
    config: &Config,
) -> anyhow::Result<Vec<(String, Scores)>> {
    let shipped = Model::shipped()?;
    let worth = |world: u16| {
        let scores = worth_in(&shipped, table, world, config)?;
        Some((table.worlds[usize::from(world)].clone(), scores))
    };
    Ok(own.filter_map(worth).collect())
}

/// For people, below the table in which each sequence is judged by a model that has not seen its corrections.
pub(super) fn told(before: &[(String, Scores)]) -> String {
    if before.is_empty() {
        return String::new();
    }
    let mut page = String::from("\nThe shipped model, before (F1, AP, accuracy, ECE):\n");
    for (sequence, scores) in before {
        line(&mut page, 12, sequence, &scores.to_string());
    }
    page
}
