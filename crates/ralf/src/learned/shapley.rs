//! What each group of evidence adds to a forest's answer: Shapley values over groups, exact.
//!
//! A group is a player; without it, a tree's answer is the mean over both ways of each of its questions, weighed by
//! the training rows that went there (path-dependent TreeSHAP: Lundberg et al., *From local explanations to global
//! understanding with explainable AI for trees*, Nature Machine Intelligence 2020). With groups for features, few
//! players are asked on the way to a leaf, and leaves that lie side by side share most of them: what each adds in every
//! case of such a bundle is worked out once, so that a row costs a look into a table per bundle.

use super::block::{BLOCK, Blocks};
use super::bundle::{Bundle, Sums, add, bundles, of_groups};
use super::forest::Forest;
use super::model::UseError;
use super::outcomes::Part;
use super::tree::{Node, Tree};
use super::walk::{Questions, Walk};
use super::way::{PLAYERS, Way};

/// Blocks that a tree is asked about before the next one: the tables of one tree stay in a cache, those of all don't,
/// and neither would the features of more blocks.
const TOGETHER: usize = 32;
/// Cases of all tables at most, 400 MB. The shipped model has a seventh of that; a file from elsewhere might ask for
/// all memory.
const ROOM: usize = 8 << 20;

/// A forest, prepared for telling what each group adds to its answers.
#[derive(Debug, Clone)]
pub struct Explainer {
    expected: f64,
    /// Log odds are told in whole units of this size: sums of such are exact, in whatever order.
    unit: f64,
    questions: Questions,
    trees: Vec<(Walk, Vec<Bundle>)>,
}

impl Explainer {
    /// Prepares a forest whose feature `i` belongs to the group `group_of[i]`, a place in
    /// [`GROUPS`](crate::evidence::GROUPS).
    ///
    /// # Errors
    /// A forest whose leaves lie behind so many groups that its tables would fill the memory.
    pub fn new(forest: &Forest, group_of: &[usize]) -> Result<Self, UseError> {
        Self::within(ROOM, forest, group_of)
    }

    /// The same with room for so many cases.
    fn within(mut room: usize, forest: &Forest, group_of: &[usize]) -> Result<Self, UseError> {
        // No part of what a tree adds is more than twice its largest answer, so that no sum leaves half of the range.
        let most: f64 = forest.trees.iter().map(|tree| 2.0 * largest_answer(tree)).sum();
        let unit = most.max(1.0) / f64::from(i32::MAX / 2);
        let (mut expected, mut questions) = (forest.base, Questions::default());
        let mut trees = Vec::with_capacity(forest.trees.len());
        for tree in &forest.trees {
            let ways = Way::all(tree, group_of);
            expected += ways.iter().map(Way::expected).sum::<f64>();
            let walk = Walk::new(tree, &mut questions, |feature| group_of[usize::from(feature)]);
            let bundles = bundles(&Part::new(tree, group_of), &ways, unit.recip(), &mut room);
            trees.push((walk, bundles.ok_or(UseError::TooManyCases)?));
        }
        Ok(Self { expected, unit, questions, trees })
    }

    /// The forest's mean answer over its training rows, log odds: where the groups' shares begin.
    pub fn expected(&self) -> f64 {
        self.expected
    }

    /// What each group adds to the answer for each row, log odds, row by row. A row's values and
    /// [`expected`](Self::expected) sum up to the forest's answer.
    pub fn explain(&self, rows: &Blocks) -> Vec<[f64; PLAYERS]> {
        let mut all = vec![Sums::default(); rows.blocks.len() * BLOCK];
        let mut masks = Vec::new();
        for (blocks, added) in rows.blocks.chunks(TOGETHER).zip(all.chunks_mut(TOGETHER * BLOCK)) {
            for (walk, bundles) in &self.trees {
                for (block, added) in blocks.iter().zip(added.as_chunks_mut().0) {
                    walk.lead(|question| self.questions.answer(question, block), &mut masks);
                    add(bundles, &masks, added);
                }
            }
        }
        all.truncate(rows.rows);
        all.into_iter().map(|units| of_groups(&units).map(|units| f64::from(units) * self.unit)).collect()
    }
}

/// The largest answer of a tree, whatever its sign.
fn largest_answer(tree: &Tree) -> f64 {
    let answers = tree.nodes().iter().map(|node| match node {
        Node::Leaf(leaf) => f64::from(leaf.value).abs(),
        Node::Split(_) => 0.0,
    });
    answers.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::super::rows::Rows;
    use super::*;
    use crate::learned::tree::tests::{grow, leaf, split};
    use rand::RngExt;
    use rand::SeedableRng;

    /// The mean answer where only the features of these groups are known.
    fn conditional(tree: &Tree, covers: &[f64], at: usize, row: &[f32], known: &dyn Fn(u16) -> bool) -> f64 {
        match &tree.nodes()[at] {
            Node::Leaf(leaf) => f64::from(leaf.value),
            Node::Split(split) => {
                let right = usize::from(split.right);
                if known(split.feature) {
                    let next = if split.is_yes(row) { at + 1 } else { right };
                    return conditional(tree, covers, next, row, known);
                }
                let mean =
                    |next: usize| covers[next] / covers[at] * conditional(tree, covers, next, row, known);
                mean(at + 1) + mean(right)
            }
        }
    }

    /// Shapley's values by their definition: the mean over all orders in which groups become known.
    fn by_definition(tree: &Tree, row: &[f32], group_of: &[usize], groups: usize) -> Vec<f64> {
        let covers = tree.covers();
        let value = |set: usize| {
            conditional(tree, &covers, 0, row, &|feature| set >> group_of[usize::from(feature)] & 1 == 1)
        };
        let factorial = |n: usize| (1..=n).product::<usize>() as f64;
        let mut shares = vec![0.0; groups];
        for set in 0..1_usize << groups {
            let size = set.count_ones() as usize;
            for (group, share) in shares.iter_mut().enumerate().filter(|(group, _)| set >> group & 1 == 0) {
                let weight = factorial(size) * factorial(groups - size - 1) / factorial(groups);
                *share += weight * (value(set | 1 << group) - value(set));
            }
        }
        shares
    }

    /// Compares what is told of a tree with the definition, for some random rows of 16 features.
    fn compare(random: &mut rand_pcg::Pcg64, nodes: Vec<Node>, groups: usize, rows: usize) {
        let group_of: Vec<usize> = (0..16).map(|feature| feature % groups).collect();
        let forest = Forest { base: 0.25, trees: vec![Tree::new(nodes).unwrap()] };
        let explainer = Explainer::new(&forest, &group_of).unwrap();
        let mut rows = Rows::absent(rows, 16);
        for row in 0..rows.len() {
            for value in rows.row_mut(row) {
                *value = if random.random_bool(0.2) { f32::NAN } else { random.random_range(-1.0..1.0) };
            }
        }
        let explained = explainer.explain(&Blocks::of(&rows));
        for (row, answer) in forest.log_odds(&rows).into_iter().enumerate() {
            let expected = by_definition(&forest.trees[0], rows.row(row), &group_of, groups);
            for (found, expected) in explained[row].iter().zip(expected) {
                assert!((found - expected).abs() < 1e-6, "{groups} groups: {found} and {expected}");
            }
            let sum = explainer.expected() + explained[row].iter().sum::<f64>();
            assert!((sum - answer).abs() < 1e-6, "{sum} and {answer}");
        }
    }

    #[test]
    fn groups_get_what_shapleys_definition_gives_them() {
        let mut random = rand_pcg::Pcg64::seed_from_u64(3);
        for (groups, depth) in [(1, 3), (3, 5), (5, 6), (8, 9), (11, 9)] {
            let mut nodes = Vec::new();
            grow(&mut random, depth, 16, &mut nodes);
            compare(&mut random, nodes, groups, 70);
        }
    }

    #[test]
    fn a_leaf_behind_more_groups_than_leaves_together_may_have_gets_its_share_too() {
        let mut random = rand_pcg::Pcg64::seed_from_u64(4);
        let no = |feature: u16| {
            [split(feature, 0.9, true), leaf(f32::from(feature) - 5.5, 1.0 + f32::from(feature))]
        };
        let mut nodes: Vec<Node> = (0..11).flat_map(no).collect();
        nodes.push(leaf(3.0, 4.0));
        compare(&mut random, nodes, 11, 3);
    }

    #[test]
    fn tables_that_would_fill_the_memory_are_refused() {
        let tree = Tree::new(vec![split(0, 0.5, true), leaf(1.0, 1.0), leaf(-1.0, 1.0)]).unwrap();
        let forest = Forest { base: 0.0, trees: vec![tree; 3] };
        // Yes or no, three times.
        assert!(Explainer::within(6, &forest, &[0]).is_ok());
        assert_eq!(Explainer::within(5, &forest, &[0]).err(), Some(UseError::TooManyCases));
    }
}
