//! Many trees, whose answers are added up.

use super::block::{BLOCK, Bits, Blocks};
use super::rows::Rows;
use super::tree::{Node, Tree};
use super::walk::{Questions, Walk};

/// Trees whose answers, added to a base, are log odds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Forest {
    /// The log odds before any question.
    pub base: f64,
    /// The trees, in the order in which they were grown.
    pub trees: Vec<Tree>,
}

impl Forest {
    /// The log odds of each row. Who asks again and again prepares an [`Inference`].
    pub fn log_odds(&self, rows: &Rows) -> Vec<f64> {
        Inference::new(self).log_odds(&Blocks::of(rows))
    }

    /// The largest place of a feature that is asked for, and 1 more.
    pub fn width(&self) -> usize {
        self.trees.iter().map(Tree::width).max().unwrap_or(0)
    }
}

/// A forest, prepared for being asked.
#[derive(Debug, Clone)]
pub struct Inference {
    base: f64,
    questions: Questions,
    trees: Vec<Leaves>,
}

/// A tree's leaves, and how a row gets to its own.
#[derive(Debug, Clone)]
struct Leaves {
    walk: Walk,
    /// What each answers, from left to right.
    answers: Vec<f64>,
    /// For each digit of a leaf's number, in the binary system, the nodes of the leaves that have it.
    digits: Vec<Vec<usize>>,
}

impl Inference {
    /// Prepares a forest.
    pub fn new(forest: &Forest) -> Self {
        let mut questions = Questions::default();
        let trees = forest.trees.iter().map(|tree| Leaves::new(tree, &mut questions)).collect();
        Self { base: forest.base, questions, trees }
    }

    /// The log odds of each row.
    pub fn log_odds(&self, rows: &Blocks) -> Vec<f64> {
        let mut log_odds = Vec::with_capacity(rows.blocks.len() * BLOCK);
        let mut led = Vec::new();
        for block in &rows.blocks {
            let answers: Vec<Bits> = self.questions.answers(block);
            let mut sums = [self.base; BLOCK];
            for tree in &self.trees {
                tree.walk.lead(|question| answers[question], &mut led);
                tree.add(&led, &mut sums);
            }
            log_odds.extend(sums);
        }
        log_odds.truncate(rows.rows);
        log_odds
    }
}

impl Leaves {
    fn new(tree: &Tree, questions: &mut Questions) -> Self {
        let (mut answers, mut digits) = (Vec::new(), Vec::new());
        for (at, node) in tree.nodes().iter().enumerate() {
            let Node::Leaf(leaf) = node else { continue };
            let number = answers.len();
            digits.resize((usize::BITS - number.leading_zeros()) as usize, Vec::new());
            let has = |digit: &usize| number >> digit & 1 == 1;
            (0..digits.len()).filter(has).for_each(|digit| digits[digit].push(at));
            answers.push(f64::from(leaf.value));
        }
        Self { walk: Walk::new(tree, questions, |_| 0), answers, digits }
    }

    /// Adds each row's answer to its sum. `led` are the rows that come to each node.
    fn add(&self, led: &[Bits], sums: &mut [f64; BLOCK]) {
        // Eight rows to a word, without asking how many come to a leaf, which is hard to foretell.
        let mut numbers = [0; BLOCK / 8];
        for (digit, nodes) in self.digits.iter().enumerate() {
            let rows = nodes.iter().fold(0, |rows, node| rows | led[*node]);
            for (eight, rows) in numbers.iter_mut().zip(rows.to_le_bytes()) {
                *eight |= BYTES_OF_BITS[usize::from(rows)] << digit;
            }
        }
        for (sums, numbers) in sums.as_chunks_mut::<8>().0.iter_mut().zip(numbers) {
            for (sum, number) in sums.iter_mut().zip(numbers.to_le_bytes()) {
                *sum += self.answers[usize::from(number)];
            }
        }
    }
}

/// For each byte its bits, the lowest first, as bytes of a word.
static BYTES_OF_BITS: [u64; 256] = bytes_of_bits();

const fn bytes_of_bits() -> [u64; 256] {
    let mut words = [0; 256];
    let mut at = 0;
    while at < 256 * 8 {
        let (byte, bit) = (at / 8, at % 8);
        words[byte] |= (byte as u64 >> bit & 1) << (8 * bit);
        at += 1;
    }
    words
}

/// The probability that log odds stand for.
pub fn probability(log_odds: f64) -> f64 {
    1.0 / (1.0 + (-log_odds).exp())
}

#[cfg(test)]
mod tests {
    use super::super::tree::tests::grow;
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn a_block_gets_what_each_row_gets_alone() {
        let mut random = rand_pcg::Pcg64::seed_from_u64(5);
        for (depth, rows) in [(1, 1), (3, 64), (5, 65), (7, 130)] {
            let trees = (0..9).map(|_| {
                let mut nodes = Vec::new();
                grow(&mut random, depth, 6, &mut nodes);
                Tree::new(nodes).unwrap()
            });
            let forest = Forest { base: 0.25, trees: trees.collect() };
            let mut rows = Rows::absent(rows, 6);
            for row in 0..rows.len() {
                for value in rows.row_mut(row) {
                    *value = if random.random_bool(0.2) { f32::NAN } else { random.random_range(-1.0..1.0) };
                }
            }
            let alone = |row: usize| {
                let answers = forest.trees.iter().map(|tree| f64::from(tree.answer(rows.row(row))));
                answers.fold(0.25, |sum, answer| sum + answer)
            };
            let expected: Vec<f64> = (0..rows.len()).map(alone).collect();
            assert_eq!(forest.log_odds(&rows), expected, "to the bit");
        }
    }
}
