//! The way to a leaf of a tree, and what the groups that are asked on it add to its answer.

use super::tree::{Node, Tree};
use crate::evidence::GROUPS;

/// Groups of evidence: no way asks more.
pub(super) const PLAYERS: usize = GROUPS.len();

/// The way to a leaf.
#[derive(Debug)]
pub(super) struct Way {
    /// The leaf's answer.
    pub(super) value: f64,
    /// The groups that are asked, in their order.
    pub(super) players: Vec<Player>,
}

/// A group that is asked on the way to a leaf.
#[derive(Debug, Clone, Copy)]
pub(super) struct Player {
    pub(super) group: usize,
    /// The share of the training rows that its questions let through.
    pub(super) share: f64,
}

impl Way {
    /// The ways to the leaves of a tree, from left to right; the feature `i` belongs to the group `group_of[i]`.
    pub(super) fn all(tree: &Tree, group_of: &[usize]) -> Vec<Self> {
        let (nodes, covers) = (tree.nodes(), tree.covers());
        let mut found = Vec::new();
        let mut open: Vec<(usize, Vec<Player>)> = vec![(0, Vec::new())];
        while let Some((at, players)) = open.pop() {
            match &nodes[at] {
                Node::Leaf(leaf) => found.push(Self { value: f64::from(leaf.value), players }),
                Node::Split(split) => {
                    let group = group_of[usize::from(split.feature)];
                    let lead = |next: usize| {
                        let share = if covers[at] > 0.0 { covers[next] / covers[at] } else { 0.5 };
                        (next, asked(&players, Player { group, share }))
                    };
                    open.extend([usize::from(split.right), at + 1].map(lead));
                }
            }
        }
        found
    }

    /// The leaf's part of the tree's mean answer over its training rows.
    pub(super) fn expected(&self) -> f64 {
        self.value * self.players.iter().map(|player| player.share).product::<f64>()
    }

    /// What each group adds, by which of the players' questions lead here: a bit for each player, in their order.
    pub(super) fn shares(&self) -> Vec<[f64; PLAYERS]> {
        let weights = weights(self.players.len());
        (0..1 << self.players.len()).map(|leading| self.shares_where(leading, &weights)).collect()
    }

    fn shares_where(&self, leading: usize, weights: &[f64; PLAYERS]) -> [f64; PLAYERS] {
        let leads = |player: usize| leading >> player & 1 == 1;
        let mut shares = [0.0; PLAYERS];
        for (own, player) in self.players.iter().enumerate() {
            // By the number of the leading rivals that are asked: the sum of what the rest lets through.
            let (mut coefficients, mut asked, mut through) = ([0.0; PLAYERS + 1], 0, 1.0);
            coefficients[0] = 1.0;
            for (other, rival) in self.players.iter().enumerate().filter(|(other, _)| *other != own) {
                if !leads(other) {
                    through *= rival.share;
                    continue;
                }
                asked += 1;
                for more in (0..asked).rev() {
                    coefficients[more + 1] += coefficients[more];
                    coefficients[more] *= rival.share;
                }
            }
            let terms = coefficients.iter().zip(weights).take(asked + 1);
            let sum: f64 = terms.map(|(coefficient, weight)| coefficient * weight).sum();
            let lead = if leads(own) { 1.0 } else { 0.0 };
            shares[player.group] = self.value * (lead - player.share) * through * sum;
        }
        shares
    }
}

/// Of so many players, how much each number of others that are asked before one of them counts: `k! (m - 1 - k)! / m!`.
fn weights(players: usize) -> [f64; PLAYERS] {
    let mut weights = [0.0; PLAYERS];
    let mut weight = 1.0 / players as f64;
    for (asked, known) in weights.iter_mut().enumerate().take(players) {
        *known = weight;
        weight *= (asked + 1) as f64 / (players - 1 - asked).max(1) as f64;
    }
    weights
}

/// The players of a way that has one question more.
fn asked(players: &[Player], next: Player) -> Vec<Player> {
    let mut players = players.to_vec();
    match players.binary_search_by_key(&next.group, |player| player.group) {
        Ok(known) => players[known].share *= next.share,
        Err(place) => players.insert(place, next),
    }
    players
}
