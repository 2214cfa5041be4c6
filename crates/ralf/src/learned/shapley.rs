//! What each group of evidence adds to a forest's answer: Shapley values over groups, exact.
//!
//! A group is a player; without it, a tree's answer is the mean over both ways of each of its questions, weighed by
//! the training rows that went there (path-dependent TreeSHAP: Lundberg et al., *From local explanations to global
//! understanding with explainable AI for trees*, Nature Machine Intelligence 2020). With groups for features, a leaf
//! has as many players as groups are asked on the way to it, mostly three or four: what each adds in every case is
//! worked out once.

use super::forest::Forest;
use super::rows::Rows;
use super::tree::{Node, Tree};

/// Rows that are worked on together: one bit each.
const BLOCK: usize = 64;
/// Players up to which a leaf keeps what they add in every case.
const MOST_KEPT: usize = 6;

/// A forest, prepared for telling what each group adds to its answers.
#[derive(Debug, Clone)]
pub struct Explainer {
    groups: usize,
    expected: f64,
    trees: Vec<(Tree, Vec<Path>)>,
}

/// The way to a leaf.
#[derive(Debug, Clone)]
struct Path {
    /// The leaf's answer.
    value: f64,
    players: Vec<Player>,
    /// What each player adds for each set of players whose questions lead here, by the set's bits; of few players.
    table: Vec<f32>,
}

/// A group that is asked on the way to a leaf.
#[derive(Debug, Clone)]
struct Player {
    group: usize,
    /// Nodes of its questions, and whether a yes leads on.
    questions: Vec<(usize, bool)>,
    /// The share of the training rows that its questions let through.
    share: f64,
}

impl Explainer {
    /// Prepares a forest whose feature `i` belongs to the group `group_of[i] < groups`.
    pub fn new(forest: &Forest, group_of: &[usize], groups: usize) -> Self {
        let mut expected = forest.base;
        let mut trees = Vec::with_capacity(forest.trees.len());
        for tree in &forest.trees {
            let paths = paths(tree, group_of);
            for path in &paths {
                expected += path.value * path.players.iter().map(|player| player.share).product::<f64>();
            }
            trees.push((tree.clone(), paths));
        }
        Self { groups, expected, trees }
    }

    /// The forest's mean answer over its training rows, log odds: where the groups' shares begin.
    pub fn expected(&self) -> f64 {
        self.expected
    }

    /// What each group adds to the answer for each row, log odds, row by row. A row's values and
    /// [`expected`](Self::expected) sum up to the forest's answer.
    pub fn explain(&self, rows: &Rows) -> Vec<Vec<f64>> {
        let mut added = vec![vec![0.0; self.groups]; rows.len()];
        let mut yes = Vec::new();
        for (block, added) in added.chunks_mut(BLOCK).enumerate() {
            for (tree, paths) in &self.trees {
                answers(tree, rows, block * BLOCK, added.len(), &mut yes);
                for path in paths {
                    path.add(&yes, added);
                }
            }
        }
        added
    }
}

/// The bits of each node's yes over the rows of a block.
fn answers(tree: &Tree, rows: &Rows, begin: usize, count: usize, yes: &mut Vec<u64>) {
    yes.clear();
    for node in tree.nodes() {
        let mut bits = 0;
        if let Node::Split(split) = node {
            for at in 0..count {
                bits |= u64::from(split.is_yes(rows.row(begin + at))) << at;
            }
        }
        yes.push(bits);
    }
}

/// The ways to all leaves of a tree.
fn paths(tree: &Tree, group_of: &[usize]) -> Vec<Path> {
    let covers = tree.covers();
    let mut found = Vec::new();
    let mut open: Vec<(usize, Vec<Player>)> = vec![(0, Vec::new())];
    while let Some((at, players)) = open.pop() {
        match &tree.nodes()[at] {
            Node::Leaf(leaf) => found.push(Path::new(f64::from(leaf.value), players)),
            Node::Split(split) => {
                let group = group_of[usize::from(split.feature)];
                for (next, is_yes) in [(at + 1, true), (usize::from(split.right), false)] {
                    let share = if covers[at] > 0.0 { covers[next] / covers[at] } else { 0.5 };
                    open.push((next, asked(&players, group, (at, is_yes), share)));
                }
            }
        }
    }
    found
}

/// The players of a way that has one question more.
fn asked(players: &[Player], group: usize, question: (usize, bool), share: f64) -> Vec<Player> {
    let mut players = players.to_vec();
    match players.iter_mut().find(|player| player.group == group) {
        Some(known) => {
            known.questions.push(question);
            known.share *= share;
        }
        None => players.push(Player { group, questions: vec![question], share }),
    }
    players
}

impl Path {
    fn new(value: f64, players: Vec<Player>) -> Self {
        let mut path = Self { value, players, table: Vec::new() };
        if path.players.len() <= MOST_KEPT {
            for leading in 0..1_usize << path.players.len() {
                path.table.extend(path.shares(leading).iter().map(|share| *share as f32));
            }
        }
        path
    }

    /// What each player adds where the players of these bits are those whose questions lead here.
    fn shares(&self, leading: usize) -> Vec<f64> {
        let leads = |player: usize| if leading >> player & 1 == 1 { 1.0 } else { 0.0 };
        let count = self.players.len();
        let mut shares = Vec::with_capacity(count);
        for (own, player) in self.players.iter().enumerate() {
            // By the number of the others that are asked: the sum of what the rest lets through.
            let mut coefficients = vec![1.0];
            for (other, rival) in self.players.iter().enumerate().filter(|(other, _)| *other != own) {
                let mut next = vec![0.0; coefficients.len() + 1];
                for (asked, coefficient) in coefficients.iter().enumerate() {
                    next[asked] += coefficient * rival.share;
                    next[asked + 1] += coefficient * leads(other);
                }
                coefficients = next;
            }
            let mut weight = 1.0 / count as f64;
            let mut sum = 0.0;
            for (asked, coefficient) in coefficients.iter().enumerate() {
                sum += weight * coefficient;
                // k! (m - 1 - k)! / m!
                weight *= (asked + 1) as f64 / (count - 1 - asked).max(1) as f64;
            }
            shares.push(self.value * (leads(own) - player.share) * sum);
        }
        shares
    }

    /// Adds what the players of this way add for each row of a block.
    fn add(&self, yes: &[u64], added: &mut [Vec<f64>]) {
        let mut leading = Vec::with_capacity(self.players.len());
        for player in &self.players {
            let all = player
                .questions
                .iter()
                .fold(u64::MAX, |bits, (node, is_yes)| bits & if *is_yes { yes[*node] } else { !yes[*node] });
            leading.push(all);
        }
        let count = self.players.len();
        for (row, added) in added.iter_mut().enumerate() {
            let mut pattern = 0;
            for (player, bits) in leading.iter().enumerate() {
                pattern |= ((bits >> row & 1) as usize) << player;
            }
            if count <= MOST_KEPT {
                let shares = &self.table[pattern * count..][..count];
                for (player, share) in self.players.iter().zip(shares) {
                    added[player.group] += f64::from(*share);
                }
            } else {
                for (player, share) in self.players.iter().zip(self.shares(pattern)) {
                    added[player.group] += share;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learned::tree::tests::{leaf, split};
    use rand::RngExt;
    use rand::SeedableRng;

    /// A random tree of some depth over features.
    fn grow(random: &mut rand_pcg::Pcg64, depth: usize, features: u16, nodes: &mut Vec<Node>) {
        if depth == 0 || random.random_bool(0.15) {
            nodes.push(leaf(random.random_range(-1.0..1.0), random.random_range(1.0..9.0)));
            return;
        }
        let threshold = random.random_range(-0.5..0.5);
        nodes.push(split(random.random_range(0..features), threshold, random.random()));
        grow(random, depth - 1, features, nodes);
        grow(random, depth - 1, features, nodes);
    }

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

    #[test]
    fn groups_get_what_shapleys_definition_gives_them() {
        let mut random = rand_pcg::Pcg64::seed_from_u64(3);
        for (groups, depth) in [(1, 3), (3, 5), (5, 6), (8, 9)] {
            let group_of: Vec<usize> = (0..16).map(|feature| feature % groups).collect();
            let mut nodes = Vec::new();
            grow(&mut random, depth, 16, &mut nodes);
            let forest = Forest { base: 0.25, trees: vec![Tree::new(nodes).unwrap()] };
            let explainer = Explainer::new(&forest, &group_of, groups);
            let mut rows = Rows::absent(70, 16);
            for row in 0..rows.len() {
                for value in rows.row_mut(row) {
                    *value = if random.random_bool(0.2) { f32::NAN } else { random.random_range(-1.0..1.0) };
                }
            }
            let explained = explainer.explain(&rows);
            for (row, answer) in forest.log_odds(&rows).into_iter().enumerate() {
                let expected = by_definition(&forest.trees[0], rows.row(row), &group_of, groups);
                for (found, expected) in explained[row].iter().zip(expected) {
                    assert!((found - expected).abs() < 1e-5, "{groups} groups: {found} and {expected}");
                }
                let sum = explainer.expected() + explained[row].iter().sum::<f64>();
                assert!((sum - answer).abs() < 1e-5, "{sum} and {answer}");
            }
        }
    }
}
