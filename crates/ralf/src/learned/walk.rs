//! A tree, asked about a block of rows at a time, without a branch per row.
//!
//! Every question is asked of every row, and which rows it leads on is known for all of them together: a bit for each
//! where it is only asked which rows come to a leaf, all bits of a byte where numbers of rows are summed up. Where a
//! row belongs in a table that is made for a part of a tree is such a sum of weights, each of which counts for some
//! rows.

use super::block::{BLOCK, Bits, Block, Mask};
use super::tree::{Node, Split, Tree};
use std::collections::HashMap;
use std::ops::{BitAnd, Not};

/// The questions of many trees, each of them once.
#[derive(Debug, Clone, Default)]
pub(super) struct Questions {
    asked: Vec<Split>,
    places: HashMap<(u16, u32, bool), usize>,
}

impl Questions {
    /// The place of a question, which is added if it is new.
    fn place_of(&mut self, split: &Split) -> usize {
        let next = self.asked.len();
        let key = (split.feature, split.threshold.to_bits(), split.absent_is_yes);
        let place = *self.places.entry(key).or_insert(next);
        if place == next {
            self.asked.push(*split);
        }
        place
    }

    /// The rows of a block that get a yes to each question.
    pub(super) fn answers<A: Answered>(&self, block: &Block) -> Vec<A> {
        self.asked.iter().map(|split| A::of(block.answers(split))).collect()
    }

    /// The rows of a block that get a yes to the question at a place.
    pub(super) fn answer(&self, place: usize, block: &Block) -> Mask {
        block.answers(&self.asked[place])
    }
}

/// Which rows of a block are led on.
pub(super) trait Answered: Copy + BitAnd<Output = Self> + Not<Output = Self> {
    /// All of them.
    const ALL: Self;

    /// Those of a mask.
    fn of(mask: Mask) -> Self;

    /// Those of them that are among others, and those that aren't.
    fn split(self, others: Self) -> [Self; 2] {
        [self & others, self & !others]
    }
}

impl Answered for Bits {
    const ALL: Self = Self::MAX;

    fn of(mask: Mask) -> Self {
        mask.to_bitmask()
    }
}

impl Answered for Mask {
    const ALL: Self = Self::MAX;

    fn of(mask: Mask) -> Self {
        mask
    }
}

/// A weight that counts for the rows of a mask.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Term {
    /// The mask's place among [`Walk::masks`].
    pub(super) mask: usize,
    pub(super) weight: u8,
}

/// The sum of the weights that count for each row.
pub(super) fn sums(terms: &[Term], masks: &[Mask]) -> [u8; BLOCK] {
    let mut sums = Mask::ZERO;
    for term in terms {
        sums += masks[term.mask] & Mask::splat(term.weight);
    }
    sums.to_array()
}

/// The questions of a tree in preorder, told apart by groups.
#[derive(Debug, Clone)]
pub(super) struct Walk {
    nodes: usize,
    steps: Vec<Step>,
}

#[derive(Debug, Clone)]
struct Step {
    /// Its place among the [`Questions`].
    question: usize,
    /// The node behind the last question of its group before it; the tree's first node where there is none.
    behind: usize,
    /// The nodes that yes and no lead to.
    yes: usize,
    no: usize,
}

impl Walk {
    /// The questions of a tree, which are added to those of others; a feature belongs to the group `group_of` it.
    pub(super) fn new(tree: &Tree, questions: &mut Questions, group_of: impl Fn(u16) -> usize) -> Self {
        let (nodes, parents) = (tree.nodes(), tree.parents());
        let mut steps = Vec::with_capacity(nodes.len() / 2);
        for (at, node) in nodes.iter().enumerate() {
            let Node::Split(split) = node else { continue };
            let is_other = |node: usize| match &nodes[parents[node]] {
                Node::Split(parent) => group_of(parent.feature) != group_of(split.feature),
                Node::Leaf(_) => true,
            };
            let mut behind = at;
            while behind > 0 && is_other(behind) {
                behind = parents[behind];
            }
            let question = questions.place_of(split);
            steps.push(Step { question, behind, yes: at + 1, no: usize::from(split.right) });
        }
        Self { nodes: nodes.len(), steps }
    }

    /// Of each node, the rows that the question before it and the earlier ones of its group all lead towards it; of the
    /// first node all rows. `answer` gives the rows that get a yes to the question at a place; `led` is overwritten.
    pub(super) fn lead<A: Answered>(&self, answer: impl Fn(usize) -> A, led: &mut Vec<A>) {
        // What an earlier tree left is overwritten: every node but the first is led to.
        led.resize(self.nodes, A::ALL);
        led[0] = A::ALL;
        for step in &self.steps {
            [led[step.yes], led[step.no]] = led[step.behind].split(answer(step.question));
        }
    }
}
