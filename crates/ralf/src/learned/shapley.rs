//! What each group of evidence adds to a forest's answer: Shapley values over groups, exact.
//!
//! A group is a player; without it, a tree's answer is the mean over both ways of each of its questions, weighed by
//! the training rows that went there (path-dependent TreeSHAP: Lundberg et al., *From local explanations to global
//! understanding with explainable AI for trees*, Nature Machine Intelligence 2020). With groups for features, few
//! players are asked on the way to a leaf, and leaves that hang together share most of them: what each adds in every
//! case of such a bundle is worked out once, so that a row costs a look into a table per bundle.

use super::block::{BLOCK, Block};
use super::forest::Forest;
use super::rows::Rows;
use super::tree::{Node, Tree};

/// Bits of a bundle's cases: twice as many cases each.
const MOST_BITS: usize = 8;

/// A forest, prepared for telling what each group adds to its answers.
#[derive(Debug, Clone)]
pub struct Explainer {
    groups: usize,
    expected: f64,
    trees: Vec<(Tree, Vec<Bundle>)>,
}

/// Leaves that hang together, with what the groups that are asked on the way to any of them add in every case.
#[derive(Debug, Clone)]
struct Bundle {
    /// What a case is made of, a bit each: whether all of these questions lead on. First the groups that were asked
    /// before, then the questions among the leaves.
    bits: Vec<Vec<Question>>,
    /// The groups that are asked.
    groups: Vec<usize>,
    /// What each of these adds in each case, group by group; none where there are too many cases.
    table: Vec<f32>,
    /// Of the leaves, where there is no table.
    ways: Vec<Way>,
}

/// A question's node, and whether a yes leads on.
type Question = (usize, bool);

/// The way to a leaf.
#[derive(Debug, Clone)]
struct Way {
    /// The leaf's answer.
    value: f64,
    players: Vec<Player>,
}

/// A group that is asked on the way to a leaf.
#[derive(Debug, Clone)]
struct Player {
    group: usize,
    questions: Vec<Question>,
    /// The share of the training rows that its questions let through.
    share: f64,
}

impl Explainer {
    /// Prepares a forest whose feature `i` belongs to the group `group_of[i] < groups`.
    pub fn new(forest: &Forest, group_of: &[usize], groups: usize) -> Self {
        let mut expected = forest.base;
        let mut trees = Vec::with_capacity(forest.trees.len());
        for tree in &forest.trees {
            let mut bundles = Plan { tree, group_of, covers: tree.covers() }.bundles();
            for way in bundles.iter().flat_map(|bundle| &bundle.ways) {
                expected += way.value * way.players.iter().map(|player| player.share).product::<f64>();
            }
            bundles
                .iter_mut()
                .filter(|bundle| !bundle.table.is_empty())
                .for_each(|bundle| bundle.ways = Vec::new());
            trees.push((tree.clone(), bundles));
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
        let mut all = Vec::with_capacity(rows.len());
        let mut yes = Vec::new();
        for begin in (0..rows.len()).step_by(BLOCK) {
            let (block, count) = (Block::of(rows, begin), BLOCK.min(rows.len() - begin));
            let mut added = vec![[0.0; BLOCK]; self.groups];
            for (tree, bundles) in &self.trees {
                yes.clear();
                yes.extend(tree.nodes().iter().map(|node| match node {
                    Node::Split(split) => block.answers(split),
                    Node::Leaf(_) => [false; BLOCK],
                }));
                bundles.iter().for_each(|bundle| bundle.add(&yes, count, &mut added));
            }
            all.extend(
                (0..count).map(|row| added.iter().map(|of_group| of_group[row]).collect::<Vec<f64>>()),
            );
        }
        all
    }
}

/// A tree that is put into bundles.
struct Plan<'a> {
    tree: &'a Tree,
    group_of: &'a [usize],
    covers: Vec<f64>,
}

impl Plan<'_> {
    /// Bundles as large as the bits allow.
    fn bundles(&self) -> Vec<Bundle> {
        let mut found = Vec::new();
        let mut open: Vec<(usize, Vec<Player>)> = vec![(0, Vec::new())];
        while let Some((at, before)) = open.pop() {
            let inside = self.questions_from(at);
            if inside.is_empty() || before.len() + inside.len() <= MOST_BITS {
                found.push(Bundle::new(self, at, &before, &inside));
            } else {
                open.extend(self.further(at, &before));
            }
        }
        found
    }

    /// The questions of the part of the tree that begins at a node.
    fn questions_from(&self, at: usize) -> Vec<usize> {
        let (mut questions, mut open, mut node) = (Vec::new(), 1, at);
        while open > 0 {
            if matches!(self.tree.nodes()[node], Node::Split(_)) {
                questions.push(node);
                open += 1;
            } else {
                open -= 1;
            }
            node += 1;
        }
        questions
    }

    /// Where a question leads, with the players on the way there; nowhere from a leaf.
    fn further(&self, at: usize, before: &[Player]) -> Vec<(usize, Vec<Player>)> {
        let Node::Split(split) = &self.tree.nodes()[at] else { return Vec::new() };
        let group = self.group_of[usize::from(split.feature)];
        let lead = |(next, is_yes): (usize, bool)| {
            let share = if self.covers[at] > 0.0 { self.covers[next] / self.covers[at] } else { 0.5 };
            (next, asked(before, group, (at, is_yes), share))
        };
        [(at + 1, true), (usize::from(split.right), false)].map(lead).into()
    }

    /// The ways to the leaves of the part that begins at a node.
    fn ways(&self, at: usize, before: &[Player]) -> Vec<Way> {
        let mut found = Vec::new();
        let mut open = vec![(at, before.to_vec())];
        while let Some((at, players)) = open.pop() {
            match &self.tree.nodes()[at] {
                Node::Leaf(leaf) => found.push(Way { value: f64::from(leaf.value), players }),
                Node::Split(_) => open.extend(self.further(at, &players)),
            }
        }
        found
    }
}

/// The players of a way that has one question more.
fn asked(players: &[Player], group: usize, question: Question, share: f64) -> Vec<Player> {
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

impl Bundle {
    fn new(plan: &Plan, at: usize, before: &[Player], inside: &[usize]) -> Self {
        let ways = plan.ways(at, before);
        let mut bits: Vec<Vec<Question>> = before.iter().map(|player| player.questions.clone()).collect();
        bits.extend(inside.iter().map(|node| vec![(*node, true)]));
        let mut groups: Vec<usize> =
            ways.iter().flat_map(|way| &way.players).map(|player| player.group).collect();
        groups.sort_unstable();
        groups.dedup();
        let mut bundle = Self { bits, groups, table: Vec::new(), ways };
        if bundle.bits.len() <= MOST_BITS {
            bundle.table = bundle.all_cases(before, inside);
        }
        bundle
    }

    /// What the groups add in every case.
    fn all_cases(&self, before: &[Player], inside: &[usize]) -> Vec<f32> {
        let width = self.groups.len();
        let mut table = vec![0.0; width << self.bits.len()];
        for way in &self.ways {
            let cases: Vec<(usize, usize)> =
                way.players.iter().map(|player| leading_cases(player, before, inside)).collect();
            let shares: Vec<Vec<f64>> =
                (0..1 << way.players.len()).map(|leading| way.shares(leading)).collect();
            let places: Vec<usize> = way.players.iter().map(|player| self.place_of(player.group)).collect();
            for (case, sums) in table.chunks_mut(width.max(1)).enumerate() {
                let leads = |place: usize| case & cases[place].0 == cases[place].1;
                let leading =
                    (0..cases.len()).fold(0, |bits, place| bits | usize::from(leads(place)) << place);
                for (place, share) in places.iter().zip(&shares[leading]) {
                    sums[*place] += *share;
                }
            }
        }
        let of_group = |place: usize| table.iter().skip(place).step_by(width);
        (0..width).flat_map(of_group).map(|sum| *sum as f32).collect()
    }

    fn place_of(&self, group: usize) -> usize {
        self.groups.partition_point(|known| *known < group)
    }

    /// Adds what the groups of these leaves add for each row of a block, of which so many count.
    fn add(&self, yes: &[[bool; BLOCK]], count: usize, added: &mut [[f64; BLOCK]]) {
        if self.table.is_empty() {
            return self.ways.iter().for_each(|way| way.add(yes, count, added));
        }
        let mut cases = [0_u8; BLOCK];
        for (bit, questions) in self.bits.iter().enumerate() {
            for (case, leads) in cases.iter_mut().zip(all_lead(yes, questions)) {
                *case |= u8::from(leads) << bit;
            }
        }
        for (group, shares) in self.groups.iter().zip(self.table.chunks_exact(1 << self.bits.len())) {
            for (sum, case) in added[*group].iter_mut().zip(cases).take(count) {
                *sum += f64::from(shares[usize::from(case)]);
            }
        }
    }
}

/// The bits of a bundle's cases that a player depends on, and what they are where its questions lead on.
fn leading_cases(player: &Player, before: &[Player], inside: &[usize]) -> (usize, usize) {
    let (mut mask, mut value) = (0, 0);
    if let Some(place) = before.iter().position(|known| known.group == player.group) {
        mask |= 1 << place;
        value |= 1 << place;
    }
    for (node, is_yes) in &player.questions {
        if let Some(place) = inside.iter().position(|known| known == node) {
            mask |= 1 << (before.len() + place);
            value |= usize::from(*is_yes) << (before.len() + place);
        }
    }
    (mask, value)
}

/// Whether all of these questions lead on, for each row.
fn all_lead(yes: &[[bool; BLOCK]], questions: &[Question]) -> [bool; BLOCK] {
    let mut lead = [true; BLOCK];
    for (node, is_yes) in questions {
        for (lead, yes) in lead.iter_mut().zip(&yes[*node]) {
            *lead &= yes == is_yes;
        }
    }
    lead
}

impl Way {
    /// What each player adds where the players of these bits are those whose questions lead here.
    fn shares(&self, leading: usize) -> Vec<f64> {
        let leads = |player: usize| if leading >> player & 1 == 1 { 1.0 } else { 0.0 };
        let count = self.players.len();
        let (mut shares, mut coefficients) = (Vec::with_capacity(count), vec![0.0; count]);
        for (own, player) in self.players.iter().enumerate() {
            // By the number of the others that are asked: the sum of what the rest lets through.
            coefficients.fill(0.0);
            coefficients[0] = 1.0;
            let rivals = self.players.iter().enumerate().filter(|(other, _)| *other != own);
            for (done, (other, rival)) in rivals.enumerate() {
                for asked in (0..=done).rev() {
                    coefficients[asked + 1] += coefficients[asked] * leads(other);
                    coefficients[asked] *= rival.share;
                }
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

    /// Adds what the players of this way add for each row of a block, of which so many count.
    fn add(&self, yes: &[[bool; BLOCK]], count: usize, added: &mut [[f64; BLOCK]]) {
        let leading: Vec<[bool; BLOCK]> =
            self.players.iter().map(|player| all_lead(yes, &player.questions)).collect();
        for row in 0..count {
            let bits = leading.iter().rev().fold(0, |bits, leads| bits << 1 | usize::from(leads[row]));
            for (player, share) in self.players.iter().zip(self.shares(bits)) {
                added[player.group][row] += share;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learned::tree::tests::grow;
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

    #[test]
    fn groups_get_what_shapleys_definition_gives_them() {
        let mut random = rand_pcg::Pcg64::seed_from_u64(3);
        for (groups, depth) in [(1, 3), (3, 5), (5, 6), (8, 9), (11, 9)] {
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
