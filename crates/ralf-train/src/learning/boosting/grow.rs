//! A tree, grown leaf by leaf: the leaf whose question gains most is asked next.

use super::gradients::Gradients;
use super::histogram::{Histogram, Sum};
use super::split::{Asked, Bounds, Question, answer};
use super::{Examples, Parameters};
use ralf::learned::{Leaf, Node, Split, Tree};

/// Grows trees on the same examples.
pub(super) struct Growth<'a> {
    examples: &'a Examples<'a>,
    parameters: &'a Parameters,
}

/// A leaf of a tree that grows.
struct Bud {
    rows: Vec<u32>,
    sum: Sum,
    bounds: Bounds,
    histogram: Histogram,
    question: Option<Question>,
}

/// A node of a tree that grows.
enum Growing {
    Asked {
        question: Question,
        yes: usize,
        no: usize,
    },
    /// `None` while it is being asked.
    Bud(Option<Box<Bud>>),
}

impl<'a> Growth<'a> {
    pub(super) fn new(examples: &'a Examples<'a>, parameters: &'a Parameters) -> Self {
        Self { examples, parameters }
    }

    /// A tree on these rows that asks for these features. What its questions gain is added to `gains`.
    pub(super) fn tree(
        &mut self,
        gradients: &Gradients,
        rows: Vec<u32>,
        features: &[usize],
        gains: &mut [f64],
    ) -> Tree {
        let histogram = Histogram::of(self.examples.bins, gradients, &rows, features);
        let mut sum = Sum::default();
        for row in &rows {
            let (gradient, hessian) = gradients.of(*row);
            sum = sum.plus(Sum { gradient, hessian, rows: 1 });
        }
        let root = self.bud(rows, sum, Bounds::NONE, histogram, features);
        let mut nodes = vec![Growing::Bud(Some(Box::new(root)))];
        for _ in 1..self.parameters.leaves.min(Tree::MOST_LEAVES) {
            let Some(at) = most_promising(&nodes) else { break };
            let Growing::Bud(bud) = &mut nodes[at] else { break };
            let Some(bud) = bud.take() else { break };
            let Some(question) = bud.question else { break };
            gains[question.feature] += question.gain;
            let (yes, no) = self.part(*bud, &question, gradients, features);
            nodes[at] = Growing::Asked { question, yes: nodes.len(), no: nodes.len() + 1 };
            nodes.push(Growing::Bud(Some(Box::new(yes))));
            nodes.push(Growing::Bud(Some(Box::new(no))));
        }
        let mut ordered = Vec::with_capacity(nodes.len());
        self.put_in_order(&nodes, 0, &mut ordered);
        // What is grown here is whole and finite; a tree without an answer stands for what could not be.
        Tree::new(ordered).unwrap_or_else(|_| Tree::none())
    }

    fn bud(&self, rows: Vec<u32>, sum: Sum, bounds: Bounds, histogram: Histogram, features: &[usize]) -> Bud {
        let asked = Asked {
            parameters: self.parameters,
            histogram: &histogram,
            features,
            bins: &|feature| self.examples.bins.edges(feature).len() + 1,
            monotone: self.examples.monotone,
            sum,
            bounds,
        };
        let question = asked.best();
        Bud { rows, sum, bounds, histogram, question }
    }

    /// The two parts that a question makes of a leaf. The larger one's sums are what the smaller one lacks.
    fn part(&self, bud: Bud, question: &Question, gradients: &Gradients, features: &[usize]) -> (Bud, Bud) {
        let codes = self.examples.bins.codes(question.feature);
        let (yes, no): (Vec<u32>, Vec<u32>) =
            bud.rows.into_iter().partition(|row| question.is_yes(codes[*row as usize]));
        let yes_is_smaller = yes.len() <= no.len();
        let smaller = if yes_is_smaller { &yes } else { &no };
        let part = Histogram::of(self.examples.bins, gradients, smaller, features);
        let rest = bud.histogram.without(&part);
        let (of_yes, of_no) = if yes_is_smaller { (part, rest) } else { (rest, part) };
        let Question { yes: sum_yes, no: sum_no, bounds_yes, bounds_no, .. } = *question;
        let yes = self.bud(yes, sum_yes, bounds_yes, of_yes, features);
        (yes, self.bud(no, sum_no, bounds_no, of_no, features))
    }

    /// The nodes in preorder.
    fn put_in_order(&self, nodes: &[Growing], at: usize, ordered: &mut Vec<Node>) {
        match &nodes[at] {
            Growing::Asked { question, yes, no } => {
                let edges = self.examples.bins.edges(question.feature);
                ordered.push(Node::Split(Split {
                    feature: question.feature as u16,
                    threshold: edges[usize::from(question.bin)],
                    absent_is_yes: question.absent_is_yes,
                    right: 0,
                }));
                self.put_in_order(nodes, *yes, ordered);
                self.put_in_order(nodes, *no, ordered);
            }
            Growing::Bud(bud) => {
                let Parameters { l2, rate, .. } = *self.parameters;
                let (mut value, mut cover) = (0.0, 0.0);
                if let Some(bud) = bud {
                    value = rate * answer(&bud.sum, &bud.bounds, l2);
                    cover = bud.sum.hessian.max(0.0);
                }
                ordered.push(Node::Leaf(Leaf { value: value as f32, cover: cover as f32 }));
            }
        }
    }
}

/// The leaf whose question gains most; the first of several.
fn most_promising(nodes: &[Growing]) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for (at, node) in nodes.iter().enumerate() {
        let Growing::Bud(Some(bud)) = node else { continue };
        let Some(question) = bud.question else { continue };
        if best.is_none_or(|(_, gain)| question.gain > gain) {
            best = Some((at, question.gain));
        }
    }
    best.map(|(at, _)| at)
}
