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
    ///
    /// Shapley's value is the mean over all orders in which players become known. As good as an order is a moment for
    /// each player, drawn evenly from [0, 1]: of those before a player's own moment `t` counts whether they lead here,
    /// of the others what they let through, and each is before it with probability `t`.
    pub(super) fn shares(&self) -> Vec<[f64; PLAYERS]> {
        let mut all = vec![[0.0; PLAYERS]; 1 << self.players.len()];
        for (own, player) in self.players.iter().enumerate() {
            let others = self.mean_without(own);
            let below = (1 << own) - 1;
            for (leading, shares) in all.iter_mut().enumerate() {
                let lead = (leading >> own & 1) as f64;
                let rest = leading & below | leading >> 1 & !below;
                shares[player.group] = self.value * (lead - player.share) * others[rest];
            }
        }
        all
    }

    /// What all players but one let through, the mean over the moments at which that one becomes known; by which of
    /// them lead here.
    fn mean_without(&self, own: usize) -> Vec<f64> {
        let mut means = vec![0.0; 1 << (self.players.len() - 1)];
        let mut through = Vec::with_capacity(means.len());
        for (t, weight) in MOMENTS {
            through.clear();
            through.push(weight);
            for (_, rival) in self.players.iter().enumerate().filter(|(other, _)| *other != own) {
                let unknown = (1.0 - t) * rival.share;
                let before = through.len();
                through.extend_from_within(..);
                let (elsewhere, here) = through.split_at_mut(before);
                elsewhere.iter_mut().for_each(|through| *through *= unknown);
                here.iter_mut().for_each(|through| *through *= t + unknown);
            }
            means.iter_mut().zip(&through).for_each(|(mean, through)| *mean += through);
        }
        means
    }
}

/// The mean over [0, 1] of a polynomial of a degree below [`PLAYERS`] is the sum over these moments of its values times
/// their weights (Gauss and Legendre).
const MOMENTS: [(f64, f64); 6] = {
    const OFF_MIDDLE: [(f64, f64); 3] = [
        (0.238_619_186_083_196_9, 0.467_913_934_572_691),
        (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
        (0.932_469_514_203_152, 0.171_324_492_379_170_4),
    ];
    let [near, middle, far] = OFF_MIDDLE;
    [below(far), below(middle), below(near), above(near), above(middle), above(far)]
};
const _: () = assert!(PLAYERS <= 2 * MOMENTS.len(), "more groups need more moments");

const fn below((off, weight): (f64, f64)) -> (f64, f64) {
    (0.5 - 0.5 * off, 0.5 * weight)
}

const fn above((off, weight): (f64, f64)) -> (f64, f64) {
    (0.5 + 0.5 * off, 0.5 * weight)
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
