//! What the questions of one group can come to: by which of them rows are led on, on the ways to some leaves of a tree.

use super::tree::{Node, Tree};
use super::walk::Term;
use std::ops::Range;

/// A tree, to be asked for some of its leaves, which are counted from left to right.
pub(super) struct Part<'a> {
    tree: &'a Tree,
    group_of: &'a [usize],
    /// How many leaves lie before each node, and all of them.
    leaves_before: Vec<usize>,
}

/// What the questions of one group can come to on the ways to some leaves, counted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Outcomes {
    /// The leaves to which the questions lead in each, a bit each.
    leads: Vec<u64>,
    /// The number of a row's outcome is the sum of these weights, each of which counts for the rows of a mask.
    terms: Vec<(usize, usize)>,
}

impl<'a> Part<'a> {
    /// The feature `i` belongs to the group `group_of[i]`.
    pub(super) fn new(tree: &'a Tree, group_of: &'a [usize]) -> Self {
        let mut leaves_before = vec![0];
        for node in tree.nodes() {
            let leaves = leaves_before[leaves_before.len() - 1] + usize::from(matches!(node, Node::Leaf(_)));
            leaves_before.push(leaves);
        }
        Self { tree, group_of, leaves_before }
    }

    /// What the questions of a group can come to on the ways to some leaves, at most 64; `None` of none.
    pub(super) fn outcomes(&self, group: usize, leaves: &Range<usize>) -> Option<Outcomes> {
        self.among(0..self.tree.nodes().len(), group, leaves)
    }

    /// The same in a part of the tree; `None` where none of the leaves is in it.
    fn among(&self, part: Range<usize>, group: usize, leaves: &Range<usize>) -> Option<Outcomes> {
        let [begin, end] = [part.start, part.end].map(|node| self.leaves_before[node]);
        if end <= leaves.start || leaves.end <= begin {
            return None;
        }
        let Node::Split(split) = &self.tree.nodes()[part.start] else {
            return Some(Outcomes { leads: vec![1 << (begin - leaves.start)], terms: Vec::new() });
        };
        let (yes, no) = (part.start + 1, usize::from(split.right));
        let behind_yes = self.among(yes..no, group, leaves);
        let behind_no = self.among(no..part.end, group, leaves);
        let is_own = self.group_of[usize::from(split.feature)] == group;
        Some(match (behind_yes, behind_no) {
            (Some(one), Some(other)) if !is_own => one.with(&other),
            // What leads to nothing stays the first.
            (Some(one), Some(other)) if other.leads[0] == 0 => other.or(one, yes),
            (Some(one), Some(other)) => one.or(other, no),
            (Some(one), None) if is_own => one.or_nothing(yes),
            (None, Some(other)) if is_own => other.or_nothing(no),
            (one, other) => one.or(other)?,
        })
    }
}

impl Outcomes {
    pub(super) fn count(&self) -> usize {
        self.leads.len()
    }

    /// The leaves to which the questions lead in each outcome, a bit each.
    pub(super) fn leads(&self) -> &[u64] {
        &self.leads
    }

    /// What the number of a row's outcome, times a stride, is the sum of; it is below 256.
    pub(super) fn terms(&self, stride: usize) -> impl Iterator<Item = Term> {
        self.terms.iter().map(move |(mask, weight)| Term { mask: *mask, weight: (weight * stride) as u8 })
    }

    /// Both together: neither depends on the other.
    fn with(mut self, other: &Self) -> Self {
        let count = self.count();
        let both = other.leads.iter().flat_map(|other| self.leads.iter().map(move |own| own | other));
        let leads = both.collect();
        self.terms.extend(other.terms.iter().map(|(mask, weight)| (*mask, weight * count)));
        Self { leads, terms: self.terms }
    }

    /// Either these or, for the rows of a mask, the others, for which nothing counts here.
    fn or(mut self, other: Self, mask: usize) -> Self {
        self.terms.push((mask, self.count()));
        self.terms.extend(other.terms);
        self.leads.extend(other.leads);
        self
    }

    /// These for the rows of a mask, nothing for the others.
    fn or_nothing(mut self, mask: usize) -> Self {
        if self.leads[0] != 0 {
            self.leads.insert(0, 0);
            self.terms.push((mask, 1));
        }
        self
    }
}
