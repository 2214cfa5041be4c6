//! Sums of derivatives by bin.

use super::bins::{ALL, Bins};
use super::gradients::Gradients;

/// What is summed up of rows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Sum {
    /// First derivatives.
    pub(super) gradient: f64,
    /// Second derivatives.
    pub(super) hessian: f64,
    /// How many.
    pub(super) rows: u32,
}

impl Sum {
    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            gradient: self.gradient + other.gradient,
            hessian: self.hessian + other.hessian,
            rows: self.rows + other.rows,
        }
    }

    pub(super) fn minus(self, other: Self) -> Self {
        Self {
            gradient: self.gradient - other.gradient,
            hessian: self.hessian - other.hessian,
            rows: self.rows - other.rows,
        }
    }
}

/// The sums of some rows, by feature and bin.
#[derive(Debug, Clone)]
pub(super) struct Histogram {
    sums: Vec<Sum>,
}

impl Histogram {
    /// Sums up rows, by the bins of some features.
    pub(super) fn of(bins: &Bins, gradients: &Gradients, rows: &[u32], features: &[usize]) -> Self {
        let mut sums = vec![Sum::default(); features.len() * ALL];
        let derivatives: Vec<(f64, f64)> = rows.iter().map(|row| gradients.of(*row)).collect();
        for (feature, sums) in features.iter().zip(sums.chunks_mut(ALL)) {
            let codes = bins.codes(*feature);
            for (row, (gradient, hessian)) in rows.iter().zip(&derivatives) {
                let sum = &mut sums[usize::from(codes[*row as usize])];
                sum.gradient += gradient;
                sum.hessian += hessian;
                sum.rows += 1;
            }
        }
        Self { sums }
    }

    /// The sums of the rows that a part of these lacks.
    pub(super) fn without(mut self, part: &Self) -> Self {
        for (sum, part) in self.sums.iter_mut().zip(&part.sums) {
            *sum = sum.minus(*part);
        }
        self
    }

    /// By bin, of the feature at this place among those that were summed up.
    pub(super) fn of_feature(&self, place: usize) -> &[Sum] {
        &self.sums[place * ALL..][..ALL]
    }
}
