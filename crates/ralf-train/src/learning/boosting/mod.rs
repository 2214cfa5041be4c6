//! Gradient-boosted trees (Friedman 2001) grown leaf by leaf over histograms (LightGBM: Ke et al., NIPS 2017).
//!
//! Sums run over the rows in their order, on one thread: the same table, parameters and seed give the same forest,
//! whatever else runs beside. Several forests are grown side by side by whoever needs several.

mod bins;
mod gradients;
mod grow;
mod histogram;
mod split;

pub use bins::Bins;

use gradients::Gradients;
use grow::Growth;
use ralf::learned::{Forest, Rows, probability};
use rand::seq::index::sample;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// How trees are grown.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    /// Trees.
    pub rounds: usize,
    /// Most leaves of a tree; more than [`Tree::MOST_LEAVES`](ralf::learned::Tree::MOST_LEAVES) are not grown.
    pub leaves: usize,
    /// What each tree's answer is multiplied by.
    pub rate: f64,
    /// The share of the features that a tree may ask for.
    pub feature_fraction: f64,
    /// The share of the rows that a tree is grown on.
    pub bagging: f64,
    /// Added to the second derivatives of every leaf.
    pub l2: f64,
    /// Fewest rows of a leaf.
    pub rows_per_leaf: u32,
    /// Of every random choice.
    pub seed: u64,
}

impl Default for Parameters {
    fn default() -> Self {
        Self {
            rounds: 64,
            leaves: 63,
            rate: 0.2,
            feature_fraction: 0.5,
            bagging: 0.7,
            l2: 5.0,
            rows_per_leaf: 150,
            seed: 0,
        }
    }
}

/// What a forest is grown from.
#[derive(Debug, Clone, Copy)]
pub struct Examples<'a> {
    /// Features.
    pub rows: &'a Rows,
    /// The same, in bins.
    pub bins: &'a Bins,
    /// What each row is: true or not.
    pub target: &'a [bool],
    /// How much each row counts; above 0.
    pub weights: &'a [f32],
    /// By feature: 1 where more of it never makes the answer fall, -1 where it never makes it rise, else 0.
    pub monotone: &'a [i8],
    /// The log odds of each row to which trees are added; `None`: those of a row of which nothing is known.
    pub begin: Option<&'a [f64]>,
}

/// A forest, and what each feature's questions gained.
#[derive(Debug, Clone, PartialEq)]
pub struct Grown {
    /// Log odds that a row is true.
    pub forest: Forest,
    /// By feature, the sum of the drop in loss.
    pub gains: Vec<f64>,
}

/// Grows a forest on some rows, whose places rise.
pub fn boost(examples: &Examples, train: &[u32], parameters: &Parameters) -> Grown {
    let base = if examples.begin.is_some() { 0.0 } else { base(examples, train) };
    let mut forest = Forest { base, trees: Vec::with_capacity(parameters.rounds) };
    let mut gains = vec![0.0; examples.rows.width()];
    let mut random = Pcg64Mcg::seed_from_u64(parameters.seed);
    let begin = |row: &u32| examples.begin.map_or(base, |begin| begin[*row as usize]);
    let mut scores: Vec<f64> = train.iter().map(begin).collect();
    let mut gradients = Gradients::new(examples.rows.len());
    let mut growth = Growth::new(examples, parameters);
    for _ in 0..parameters.rounds {
        let mut bag = Vec::with_capacity(train.len());
        for (row, score) in train.iter().zip(&scores) {
            if random.random::<f64>() < parameters.bagging {
                let at = *row as usize;
                gradients.set(at, *score, examples.target[at], examples.weights[at]);
                bag.push(*row);
            }
        }
        let width = examples.rows.width();
        let wanted = ((width as f64 * parameters.feature_fraction).ceil() as usize).clamp(1, width.max(1));
        let mut features = sample(&mut random, width, wanted.min(width)).into_vec();
        features.sort_unstable();
        let tree = growth.tree(&gradients, bag, &features, &mut gains);
        for (row, score) in train.iter().zip(&mut scores) {
            *score += f64::from(tree.answer(examples.rows.row(*row as usize)));
        }
        forest.trees.push(tree);
    }
    Grown { forest, gains }
}

/// The log odds of a row of which nothing is known. Where all rows are alike, as if one more were unlike.
fn base(examples: &Examples, train: &[u32]) -> f64 {
    let (mut all, mut true_ones) = (0.0, 0.0);
    for row in train {
        let weight = f64::from(examples.weights[*row as usize]);
        all += weight;
        if examples.target[*row as usize] {
            true_ones += weight;
        }
    }
    let share = (true_ones + 0.5) / (all + 1.0);
    (share / (1.0 - share)).ln()
}

/// Derivatives of the logistic loss at log odds: the first and the second.
fn derivatives(log_odds: f64, target: bool) -> (f64, f64) {
    let p = probability(log_odds);
    (p - if target { 1.0 } else { 0.0 }, (p * (1.0 - p)).max(1e-16))
}

#[cfg(test)]
mod tests;
