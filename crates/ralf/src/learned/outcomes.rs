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

/// What can be told of outcomes, put together from the leaves upward.
trait Told: Sized {
    /// There is one: the questions, if there are any, lead to this leaf.
    fn leaf(leaf: usize) -> Self;

    /// Whether the first outcome is that the questions lead to none of the leaves.
    fn begins_with_nothing(&self) -> bool;

    /// Both together: neither depends on the other.
    fn with(self, other: &Self) -> Self;

    /// Either these or, for the rows of a mask, the others, for which nothing counts here.
    fn or(self, other: Self, mask: usize) -> Self;

    /// These for the rows of a mask, nothing for the others.
    fn or_nothing(self, mask: usize) -> Self;
}

/// How many there are.
struct Count {
    count: usize,
    begins_with_nothing: bool,
}

impl Told for Count {
    fn leaf(_: usize) -> Self {
        Self { count: 1, begins_with_nothing: false }
    }

    fn begins_with_nothing(&self) -> bool {
        self.begins_with_nothing
    }

    fn with(self, other: &Self) -> Self {
        let begins_with_nothing = self.begins_with_nothing && other.begins_with_nothing;
        Self { count: self.count * other.count, begins_with_nothing }
    }

    fn or(self, other: Self, _: usize) -> Self {
        Self { count: self.count + other.count, ..self }
    }

    fn or_nothing(self, _: usize) -> Self {
        let more = usize::from(!self.begins_with_nothing);
        Self { count: self.count + more, begins_with_nothing: true }
    }
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

    /// How many outcomes that are, at a fraction of the work.
    pub(super) fn count(&self, group: usize, leaves: &Range<usize>) -> Option<usize> {
        self.among(0..self.tree.nodes().len(), group, leaves).map(|Count { count, .. }| count)
    }

    /// What is told of the outcomes in a part of the tree; `None` where none of the leaves is in it.
    fn among<T: Told>(&self, part: Range<usize>, group: usize, leaves: &Range<usize>) -> Option<T> {
        let [begin, end] = [part.start, part.end].map(|node| self.leaves_before[node]);
        if end <= leaves.start || leaves.end <= begin {
            return None;
        }
        let Node::Split(split) = &self.tree.nodes()[part.start] else {
            return Some(T::leaf(begin - leaves.start));
        };
        let (yes, no) = (part.start + 1, usize::from(split.right));
        let behind_yes: Option<T> = self.among(yes..no, group, leaves);
        let behind_no: Option<T> = self.among(no..part.end, group, leaves);
        let is_own = self.group_of[usize::from(split.feature)] == group;
        Some(match (behind_yes, behind_no) {
            (Some(one), Some(other)) if !is_own => one.with(&other),
            // What leads to nothing stays the first.
            (Some(one), Some(other)) if other.begins_with_nothing() => other.or(one, yes),
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
}

impl Told for Outcomes {
    fn leaf(leaf: usize) -> Self {
        Self { leads: vec![1 << leaf], terms: Vec::new() }
    }

    fn begins_with_nothing(&self) -> bool {
        self.leads[0] == 0
    }

    fn with(mut self, other: &Self) -> Self {
        let count = self.count();
        let both = other.leads.iter().flat_map(|other| self.leads.iter().map(move |own| own | other));
        let leads = both.collect();
        self.terms.extend(other.terms.iter().map(|(mask, weight)| (*mask, weight * count)));
        Self { leads, terms: self.terms }
    }

    fn or(mut self, other: Self, mask: usize) -> Self {
        self.terms.push((mask, self.count()));
        self.terms.extend(other.terms);
        self.leads.extend(other.leads);
        self
    }

    fn or_nothing(mut self, mask: usize) -> Self {
        if !self.begins_with_nothing() {
            self.leads.insert(0, 0);
            self.terms.push((mask, 1));
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::super::tree::tests::grow;
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn as_many_are_counted_as_are_told() {
        let mut random = rand_pcg::Pcg64::seed_from_u64(6);
        let group_of: Vec<usize> = (0..16).map(|feature| feature % 3).collect();
        for depth in 1..8 {
            let mut nodes = Vec::new();
            grow(&mut random, depth, 16, &mut nodes);
            let tree = Tree::new(nodes).unwrap();
            let part = Part::new(&tree, &group_of);
            for begin in 0..tree.nodes().len().div_ceil(2) {
                let leaves = begin..(begin + 5).min(tree.nodes().len().div_ceil(2));
                for group in 0..4 {
                    let outcomes = part.outcomes(group, &leaves).unwrap();
                    assert_eq!(part.count(group, &leaves), Some(outcomes.count()));
                    let leading = outcomes.leads().iter().fold(0, |all, leads| all | leads);
                    assert_eq!(leading, (1 << leaves.len()) - 1, "every leaf is led to");
                    assert!(group < 3 || outcomes.count() == 1, "who asks nothing leads to all");
                }
            }
            assert_eq!(part.count(0, &(0..0)), None);
        }
    }
}
