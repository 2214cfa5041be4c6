//! All that a net works out on the way to log odds: what learning goes back through.

use super::Net;
use super::around::Around;
use super::layer::Said;
use super::matrix::Matrix;

/// What a net works out of a scan, or of several, step by step.
#[derive(Debug, Clone, PartialEq)]
pub struct Pass {
    /// What it reads: [`Net::scores`]; nothing where nobody goes back through it.
    pub scores: Matrix,
    /// What the first step makes of that, at least 0.
    pub first: Matrix,
    /// What stands for each detection before each layer, and after the last.
    pub h: Vec<Matrix>,
    /// What is said in each layer.
    pub said: Vec<Said>,
    /// What stands for it in the end, normalised.
    pub last: Matrix,
    /// The step before the log odds, at least 0.
    pub hidden: Matrix,
    /// Of each detection.
    pub log_odds: Vec<f32>,
}

impl Pass {
    /// Goes through a net.
    pub fn new(net: &Net, scores: Matrix, around: &Around) -> Self {
        let first = net.first.of(&scores).relu();
        Self::behind_first(net, scores, first, around)
    }

    /// The same where the first step is known.
    pub(super) fn behind_first(net: &Net, scores: Matrix, first: Matrix, around: &Around) -> Self {
        let mut h = vec![net.second.of(&first)];
        let mut said = Vec::with_capacity(net.layers.len());
        for (at, layer) in net.layers.iter().enumerate() {
            let here = layer.said(&h[at], around);
            let mut next = layer.heard.of(&here.mean_and_most);
            next.add(&h[at]);
            h.push(next);
            said.push(here);
        }
        let last = net.last.of(&h[net.layers.len()]);
        let hidden = net.hidden.of(&last).relu();
        let log_odds = net.out.of(&hidden).values().to_vec();
        Self { scores, first, h, said, last, hidden, log_odds }
    }
}
