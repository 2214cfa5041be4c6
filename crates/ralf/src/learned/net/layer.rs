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
    /// What of that is said of pairs.
    pub pairs: Pairs,
    /// The mean over a detection's pairs, and behind it the largest.
    pub mean_and_most: Matrix,
}

/// What is said of pairs, before it is put together.
#[derive(Debug, Clone, PartialEq)]
pub struct Pairs {
    /// Of each detection as one that hears.
    pub own: Matrix,
    /// Of each as one that is heard of.
    pub other: Matrix,
    /// Of each way between two, in the order of [`Around::ways`].
    pub way: Matrix,
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
        let (own, other) = (self.own.of(&normed), self.other.of(&normed));
        let pairs = Pairs { own, other, way: self.way.of(around.ways()) };
        let mean_and_most = pairs.mean_and_most(around);
        Said { normed, pairs, mean_and_most }
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

impl Pairs {
    /// What is said of a pair, by its number and that of the detection of which `row` hears: at least 0.
    pub fn said(&self, row: usize, pair: usize, other: u32, said: &mut [f32]) {
        let (own, other) = (self.own.row(row), self.other.row(other as usize));
        let parts = own.iter().zip(other).zip(self.way.row(pair));
        for (said, ((own, other), way)) in said.iter_mut().zip(parts) {
            *said = (own + other + way).max(0.0);
        }
    }

    fn mean_and_most(&self, around: &Around) -> Matrix {
        let width = self.own.width();
        let mut told = Matrix::zeros(self.own.len(), 2 * width);
        let mut said = vec![0.0; width];
        for row in 0..told.len() {
            let (mean, most) = told.row_mut(row).split_at_mut(width);
            for (pair, other) in (row * around.nearest()..).zip(around.of_one(row)) {
                self.said(row, pair, *other, &mut said);
                mean.iter_mut().zip(&said).for_each(|(sum, said)| *sum += said);
                most.iter_mut().zip(&said).for_each(|(most, said)| *most = most.max(*said));
            }
            mean.iter_mut().for_each(|sum| *sum /= around.nearest() as f32);
        }
        told
    }
}
