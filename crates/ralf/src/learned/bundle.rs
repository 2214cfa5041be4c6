//! Leaves that lie side by side, with what the groups that are asked on the way to any of them add in every case.

use super::block::{BLOCK, Mask};
use super::outcomes::{Outcomes, Part};
use super::walk::{Term, sums};
use super::way::{PLAYERS, Way};
use std::ops::Range;
use wide::i32x4;

/// Cases of a bundle at most, unless it is a leaf alone, on whose way each group has two outcomes: more of them would
/// make fewer bundles, but tables that leave the cache.
const MOST_CASES: usize = 1024;
/// Cases that one digit can count.
const MOST_OF_DIGIT: usize = 256;
/// Leaves of a bundle at most, a bit each.
const MOST_LEAVES: usize = u64::BITS as usize;

/// A number of each group: vectors, so that all of them are added at once.
pub(super) type Sums = [i32x4; PLAYERS.div_ceil(LANES)];
const LANES: usize = 4;

/// Leaves that lie side by side.
#[derive(Debug, Clone)]
pub(super) struct Bundle {
    /// What a row's case is made of: two digits, each a sum of weights.
    digits: [Vec<Term>; 2],
    /// Cases that the first digit counts.
    low: u16,
    /// What each group adds in each case, in some unit.
    table: Vec<Sums>,
}

/// What the questions of all groups can come to on the ways to some leaves.
struct Cases {
    players: Vec<Asked>,
    /// How many each digit counts.
    counts: [usize; 2],
}

/// A group that is asked on the way to some leaves.
struct Asked {
    group: usize,
    outcomes: Outcomes,
    digit: usize,
    /// By so much the digit rises from one outcome to the next.
    stride: usize,
}

/// The bundles of a tree, as large as they may be. `ways` are those to its leaves; log odds times `scale` are the unit
/// of the tables. Takes their cases from the `room` that there is; `None` where that isn't enough.
pub(super) fn bundles(part: &Part, ways: &[Way], scale: f64, room: &mut usize) -> Option<Vec<Bundle>> {
    let mut found = Vec::new();
    let mut leaves = 0..0;
    while leaves.end < ways.len() {
        leaves = leaves.end..leaves.end + 1;
        let mut counts = counts_with_last(part, ways, &leaves, &[1; PLAYERS]);
        while leaves.end < ways.len() && leaves.len() < MOST_LEAVES {
            let longer = leaves.start..leaves.end + 1;
            counts = counts_with_last(part, ways, &longer, &counts);
            let most = counts.iter().max().is_some_and(|most| *most > MOST_OF_DIGIT);
            if most || counts.iter().product::<usize>() > MOST_CASES {
                break;
            }
            leaves = longer;
        }
        let cases = Cases::of(part, &leaves);
        *room = room.checked_sub(cases.count())?;
        found.push(Bundle::new(&cases, &ways[leaves.clone()], scale));
    }
    Some(found)
}

/// How many outcomes each group has on the ways to some leaves; `counts` are those without the last leaf, whose way
/// changes them only for the groups that it asks.
fn counts_with_last(
    part: &Part,
    ways: &[Way],
    leaves: &Range<usize>,
    counts: &[usize; PLAYERS],
) -> [usize; PLAYERS] {
    let mut counts = *counts;
    for player in &ways[leaves.end - 1].players {
        counts[player.group] = part.count(player.group, leaves).unwrap_or(1);
    }
    counts
}

impl Cases {
    fn of(part: &Part, leaves: &Range<usize>) -> Self {
        let (mut players, mut counts) = (Vec::new(), [1, 1]);
        let asked = (0..PLAYERS).filter_map(|group| Some((group, part.outcomes(group, leaves)?)));
        for (group, outcomes) in asked.filter(|(_, outcomes)| outcomes.count() > 1) {
            // What the first digit has no room for, the second has: see the limits above.
            let digit = usize::from(counts[0] * outcomes.count() > MOST_OF_DIGIT);
            let stride = counts[digit];
            counts[digit] *= outcomes.count();
            players.push(Asked { group, outcomes, digit, stride });
        }
        Self { players, counts }
    }

    fn count(&self) -> usize {
        self.counts[0] * self.counts[1]
    }

    /// In each case, which of the players of a leaf's way lead there: a bit for each, in their order.
    fn leading(&self, leaf: usize, way: &Way) -> Vec<u16> {
        let mut all = vec![0];
        let of_digit = |digit: usize| self.players.iter().filter(move |player| player.digit == digit);
        for player in of_digit(0).chain(of_digit(1)) {
            let before = all.len();
            for _ in 1..player.outcomes.count() {
                all.extend_from_within(..before);
            }
            let Some(place) = way.players.iter().position(|asked| asked.group == player.group) else {
                continue;
            };
            for (cases, leads) in all.chunks_exact_mut(before).zip(player.outcomes.leads()) {
                let leads = (leads >> leaf & 1) as u16;
                cases.iter_mut().for_each(|case| *case |= leads << place);
            }
        }
        all
    }
}

impl Bundle {
    fn new(cases: &Cases, ways: &[Way], scale: f64) -> Self {
        let mut digits = [Vec::new(), Vec::new()];
        for player in &cases.players {
            digits[player.digit].extend(player.outcomes.terms(player.stride));
        }
        Self { digits, low: cases.counts[0] as u16, table: table(cases, ways, scale) }
    }

    /// The case of each row of a block. `masks` are those of the tree.
    fn cases(&self, masks: &[Mask]) -> [u16; BLOCK] {
        let [low, high] = self.digits.each_ref().map(|terms| sums(terms, masks));
        std::array::from_fn(|row| u16::from(low[row]) + self.low * u16::from(high[row]))
    }
}

/// Adds what each group adds to a tree's answer for each row of a block. `masks` are those of the tree, of which these
/// are all bundles.
pub(super) fn add(bundles: &[Bundle], masks: &[Mask], added: &mut [Sums; BLOCK]) {
    let looked_up: Vec<(&[Sums], [u16; BLOCK])> =
        bundles.iter().map(|bundle| (bundle.table.as_slice(), bundle.cases(masks))).collect();
    // Row by row, so that sums are taken and put back once.
    for (row, added) in added.iter_mut().enumerate() {
        let mut sums = *added;
        for (table, cases) in &looked_up {
            for (sums, shares) in sums.iter_mut().zip(&table[usize::from(cases[row])]) {
                *sums += *shares;
            }
        }
        *added = sums;
    }
}

/// The number of each group by itself.
pub(super) fn of_groups(sums: &Sums) -> [i32; PLAYERS] {
    std::array::from_fn(|group| sums[group / LANES].to_array()[group % LANES])
}

/// The other way round.
fn sums_of(groups: &[i32; PLAYERS]) -> Sums {
    let number = |group: usize| groups.get(group).copied().unwrap_or(0);
    std::array::from_fn(|at| i32x4::new(std::array::from_fn(|lane| number(at * LANES + lane))))
}

/// What each group adds in each case.
fn table(cases: &Cases, ways: &[Way], scale: f64) -> Vec<Sums> {
    let mut table = vec![[0.0; PLAYERS]; cases.count()];
    for (leaf, way) in ways.iter().enumerate() {
        let shares = way.shares();
        for (sums, leading) in table.iter_mut().zip(cases.leading(leaf, way)) {
            for (sum, share) in sums.iter_mut().zip(&shares[usize::from(leading)]) {
                *sum += share;
            }
        }
    }
    let in_units = |sums: [f64; PLAYERS]| sums_of(&sums.map(|sum| rounded(sum * scale)));
    table.into_iter().map(in_units).collect()
}

/// The nearest whole number, which is far below what an `i32` holds. `f64::round` is a call where processors of twenty
/// years ago are built for.
fn rounded(value: f64) -> i32 {
    (value + 0.5_f64.copysign(value)) as i32
}
