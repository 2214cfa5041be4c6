//! Many trees, whose answers are added up.

use super::block::{BLOCK, Block};
use super::rows::Rows;
use super::tree::{Node, Tree};

/// Leaves up to which a tree is asked about a whole block at a time: a bit each.
const LEAVES: usize = 32;

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
        for (at, sums) in sums.chunks_mut(BLOCK).enumerate() {
            let block = Block::of(rows, at * BLOCK);
            for tree in &self.trees {
                if tree.nodes().len() < 2 * LEAVES {
                    add_answers(tree, &block, sums);
                } else {
                    for (row, sum) in sums.iter_mut().enumerate() {
                        *sum += f64::from(tree.answer(rows.row(at * BLOCK + row)));
                    }
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

/// Adds a tree's answers to a block's sums. Every question is asked of every row: a no takes away the leaves behind the
/// yes, and the first leaf that is left is the row's (QuickScorer: Lucchese et al., SIGIR 2015).
fn add_answers(tree: &Tree, block: &Block, sums: &mut [f64]) {
    let mut left = [u32::MAX; BLOCK];
    let mut values = [0.0; LEAVES];
    let mut leaf = 0;
    for (at, node) in tree.nodes().iter().enumerate() {
        match node {
            Node::Leaf(end) => {
                values[leaf] = end.value;
                leaf += 1;
            }
            Node::Split(split) => {
                // A tree of n nodes has (n + 1) / 2 leaves, and those of a yes come next.
                let behind_yes = (usize::from(split.right) - at) / 2;
                let without = !(((1_u64 << behind_yes) - 1) << leaf) as u32;
                for (left, yes) in left.iter_mut().zip(block.answers(split)) {
                    *left &= without | u32::from(yes).wrapping_neg();
                }
            }
        }
    }
    for (sum, left) in sums.iter_mut().zip(left) {
        *sum += f64::from(values[left.trailing_zeros() as usize]);
    }
}

/// The probability that log odds stand for.
pub fn probability(log_odds: f64) -> f64 {
    1.0 / (1.0 + (-log_odds).exp())
}

#[cfg(test)]
mod tests {
    use super::super::tree::tests::grow;
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn a_block_gets_what_each_row_gets_alone() {
        let mut random = rand_pcg::Pcg64::seed_from_u64(5);
        for (depth, rows) in [(1, 1), (3, 64), (5, 65), (7, 130)] {
            let trees = (0..9).map(|_| {
                let mut nodes = Vec::new();
                grow(&mut random, depth, 6, &mut nodes);
                Tree::new(nodes).unwrap()
            });
            let forest = Forest { base: 0.25, trees: trees.collect() };
            let mut rows = Rows::absent(rows, 6);
            for row in 0..rows.len() {
                for value in rows.row_mut(row) {
                    *value = if random.random_bool(0.2) { f32::NAN } else { random.random_range(-1.0..1.0) };
                }
            }
            let alone = |row: usize| {
                let answers = forest.trees.iter().map(|tree| f64::from(tree.answer(rows.row(row))));
                answers.fold(0.25, |sum, answer| sum + answer)
            };
            let expected: Vec<f64> = (0..rows.len()).map(alone).collect();
            assert_eq!(forest.log_odds(&rows), expected, "to the bit");
        }
    }
}
