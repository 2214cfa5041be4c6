//! What a detection hears of those around it.

use super::around::{Around, WAYS};
use super::dense::Dense;
use super::matrix::Matrix;
use super::norm::Norm;

/// What is said of each pair, and what a detection makes of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Of what stands for a detection.
    pub norm: Norm,
    /// What the detection that hears brings.
    pub own: Dense,
    /// What the one brings of which it hears.
    pub other: Dense,
    /// What the way between them brings.
    pub way: Dense,
    /// From the mean and the largest of what is said of all pairs to what is added.
    pub heard: Dense,
}

/// All that was said in a layer, for who wants to know what it came from.
#[derive(Debug, Clone, PartialEq)]
pub struct Said {
    /// What stands for each detection, normalised.
    pub normed: Matrix,
    /// What of that both ends of pairs bring.
    pub ends: Ends,
    /// The mean over a detection's pairs, and behind it the largest.
    pub mean_and_most: Matrix,
}

/// What both ends of pairs bring to what is said of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Ends {
    /// Each detection as one that hears.
    pub own: Matrix,
    /// Each as one that is heard of.
    pub other: Matrix,
}

impl Layer {
    pub(super) fn zeros(width: usize) -> Self {
        Self {
            norm: Norm::zeros(width),
            own: Dense::zeros(width, width),
            other: Dense::zeros(width, width),
            way: Dense::zeros(WAYS, width),
            heard: Dense::zeros(2 * width, width),
        }
    }

    /// What is said, of what stands for each detection.
    pub(super) fn said(&self, h: &Matrix, around: &Around) -> Said {
        let normed = self.norm.of(h);
        let ends = Ends { own: self.own.of(&normed), other: self.other.of(&normed) };
        let mean_and_most = self.mean_and_most(&ends, around);
        Said { normed, ends, mean_and_most }
    }

    /// What is said of a pair, by its number and that of the detection of which `row` hears: at least 0. It is worked
    /// out anew wherever it is asked for: kept, what is said of all pairs would be most of a net's memory.
    pub fn said_of(
        &self,
        ends: &Ends,
        around: &Around,
        [row, pair]: [usize; 2],
        other: u32,
        said: &mut [f32],
    ) {
        self.way.of_row(around.ways().row(pair), said);
        for ((said, own), other) in said.iter_mut().zip(ends.own.row(row)).zip(ends.other.row(other as usize))
        {
            *said = (own + other + *said).max(0.0);
        }
    }

    fn mean_and_most(&self, ends: &Ends, around: &Around) -> Matrix {
        let width = ends.own.width();
        let mut told = Matrix::zeros(ends.own.len(), 2 * width);
        let mut said = vec![0.0; width];
        for row in 0..told.len() {
            let (mean, most) = told.row_mut(row).split_at_mut(width);
            for (pair, other) in around.pairs_of(row) {
                self.said_of(ends, around, [row, pair], other, &mut said);
                mean.iter_mut().zip(&said).for_each(|(sum, said)| *sum += said);
                most.iter_mut().zip(&said).for_each(|(most, said)| *most = most.max(*said));
            }
            mean.iter_mut().for_each(|sum| *sum /= around.nearest() as f32);
        }
        told
    }

    pub(super) fn weights(&self) -> [&[f32]; 10] {
        let [gain, shift] = self.norm.weights();
        let ([a, b], [c, d]) = (self.own.weights(), self.other.weights());
        let ([e, f], [g, h]) = (self.way.weights(), self.heard.weights());
        [gain, shift, a, b, c, d, e, f, g, h]
    }

    pub(super) fn weights_mut(&mut self) -> [&mut [f32]; 10] {
        let [gain, shift] = self.norm.weights_mut();
        let ([a, b], [c, d]) = (self.own.weights_mut(), self.other.weights_mut());
        let ([e, f], [g, h]) = (self.way.weights_mut(), self.heard.weights_mut());
        [gain, shift, a, b, c, d, e, f, g, h]
    }
}
