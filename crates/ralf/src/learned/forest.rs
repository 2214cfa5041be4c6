//! Many trees, whose answers are added up.

use super::rows::Rows;
use super::tree::Tree;

/// Rows that are asked one after the other about the same tree, while it is at hand.
const BLOCK: usize = 64;

/// Trees whose answers, added to a base, are log odds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Forest {
    /// The log odds before any question.
    pub base: f64,
    /// The trees, in the order in which they were grown.
    pub trees: Vec<Tree>,
}

impl Forest {
    /// The log odds of each row.
    pub fn log_odds(&self, rows: &Rows) -> Vec<f64> {
        let mut sums = vec![self.base; rows.len()];
        for (block, sums) in sums.chunks_mut(BLOCK).enumerate() {
            for tree in &self.trees {
                for (at, sum) in sums.iter_mut().enumerate() {
                    *sum += f64::from(tree.answer(rows.row(block * BLOCK + at)));
                }
            }
        }
        sums
    }

    /// The largest place of a feature that is asked for, and 1 more.
    pub fn width(&self) -> usize {
        self.trees.iter().map(Tree::width).max().unwrap_or(0)
    }
}

/// The probability that log odds stand for.
pub fn probability(log_odds: f64) -> f64 {
    1.0 / (1.0 + (-log_odds).exp())
}
