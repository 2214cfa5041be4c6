//! Steps down a gradient, each weight at a pace of its own (Kingma and Ba, ICLR 2015).

use ralf::learned::net::Net;

/// How much of the mean gradient, and of its mean square, a step keeps.
const KEPT: [f64; 2] = [0.9, 0.98];
/// Added to a root of a mean square, so that it is never 0.
const LEAST: f64 = 1e-8;

/// What is kept from step to step.
pub(super) struct Adam {
    /// Of each weight: the mean of its gradients, and of their squares.
    means: Vec<Vec<[f32; 2]>>,
    steps: i32,
}

impl Adam {
    pub(super) fn new(net: &Net) -> Self {
        Self { means: net.weights().iter().map(|weights| vec![[0.0; 2]; weights.len()]).collect(), steps: 0 }
    }

    /// Changes a net's weights; none goes much farther than `rate`.
    pub(super) fn step(&mut self, net: &mut Net, gradient: &Net, rate: f64) {
        self.steps += 1;
        // What is kept of nothing at first.
        let [first, second] = KEPT.map(|kept| 1.0 - kept.powi(self.steps));
        let gradients = gradient.weights();
        for ((weights, gradient), means) in net.weights_mut().into_iter().zip(gradients).zip(&mut self.means)
        {
            for ((weight, gradient), [mean, square]) in weights.iter_mut().zip(gradient).zip(means) {
                *mean += (1.0 - KEPT[0] as f32) * (gradient - *mean);
                *square += (1.0 - KEPT[1] as f32) * (gradient * gradient - *square);
                let (mean, square) = (f64::from(*mean) / first, f64::from(*square) / second);
                *weight -= (rate * mean / (square.sqrt() + LEAST)) as f32;
            }
        }
    }
}
