//! Which way each row wants its answer to go.

use super::derivatives;

/// First and second derivatives of the loss, by row.
#[derive(Debug, Clone)]
pub(super) struct Gradients {
    values: Vec<(f32, f32)>,
}

impl Gradients {
    pub(super) fn new(rows: usize) -> Self {
        Self { values: vec![(0.0, 0.0); rows] }
    }

    /// A row's, at its log odds.
    pub(super) fn set(&mut self, row: usize, log_odds: f64, target: bool, weight: f32) {
        let (gradient, hessian) = derivatives(log_odds, target);
        self.values[row] = (gradient as f32 * weight, hessian as f32 * weight);
    }

    pub(super) fn of(&self, row: u32) -> (f64, f64) {
        let (gradient, hessian) = self.values[row as usize];
        (f64::from(gradient), f64::from(hessian))
    }
}
