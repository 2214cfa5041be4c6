//! A small net that looks around: of each detection it hears what those nearest to it in its scan are like. Trees, who
//! see one detection at a time, can't.
//!
//! ```text
//! x    evidence as scores, and what is absent           Scale, one per feature
//! h    <- second(relu(first(x)))                        a few numbers for each detection
//! h    <- h + heard(mean_j e_ij, max_j e_ij)            in each layer, over the detections j nearest to i
//! e_ij =  relu(own(n_i) + other(n_j) + way(g_ij))       n: h, normalised; g_ij: where j lies, seen from i
//! log odds = out(relu(hidden(n)))
//! ```
//!
//! Message passing over nearest points as in PointNet++ (Qi et al., NIPS 2017) and DGCNN (Wang et al., 2019). Alone, a
//! large one learns a simulator by heart; a small one beside trees ([`Net::heard`]) is better than either in worlds of
//! others.

mod around;
mod dense;
mod layer;
mod matrix;
mod norm;
mod pass;
mod scale;

pub use around::{Around, WAYS};
pub use dense::Dense;
pub use layer::{Ends, Layer, Said};
pub use matrix::Matrix;
pub use norm::Norm;
pub use pass::Pass;
pub use scale::{Scale, ScaleError};

use super::rows::Rows;

/// How large a net is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shape {
    /// Features that it reads.
    pub inputs: usize,
    /// Numbers that stand for a detection.
    pub width: usize,
    /// How often each detection hears of those around it.
    pub layers: usize,
    /// Of how many it hears.
    pub nearest: usize,
}

impl Shape {
    /// More than any net has that is of use.
    const MOST: Self = Self { inputs: 4096, width: 512, layers: 16, nearest: 64 };

    /// Whether a net can be so large: neither nothing nor without bound.
    pub fn is_fine(&self) -> bool {
        let Self { inputs, width, layers, nearest } = *self;
        let most = Self::MOST;
        (1..=most.inputs).contains(&inputs)
            && (1..=most.width).contains(&width)
            && layers <= most.layers
            && (1..=most.nearest).contains(&nearest)
    }
}

/// A net that tells log odds of all detections of a scan.
#[derive(Debug, Clone, PartialEq)]
pub struct Net {
    /// Of how many detections around each one hears.
    pub nearest: usize,
    /// How each feature that it reads becomes a score.
    pub scales: Vec<Scale>,
    /// From scores, and what is absent, to numbers.
    pub first: Dense,
    /// From these to those that stand for a detection.
    pub second: Dense,
    /// What is heard of the detections around.
    pub layers: Vec<Layer>,
    /// Of what stands for a detection in the end.
    pub last: Norm,
    /// From there to numbers.
    pub hidden: Dense,
    /// To log odds.
    pub out: Dense,
}

impl Net {
    /// A net of this shape whose every weight is 0.
    pub fn zeros(shape: Shape, scales: Vec<Scale>) -> Self {
        let Shape { inputs, width, layers, nearest } = shape;
        Self {
            nearest,
            scales,
            first: Dense::zeros(2 * inputs, width),
            second: Dense::zeros(width, width),
            layers: (0..layers).map(|_| Layer::zeros(width)).collect(),
            last: Norm::zeros(width),
            hidden: Dense::zeros(width, width),
            out: Dense::zeros(width, 1),
        }
    }

    /// How large it is.
    pub fn shape(&self) -> Shape {
        Shape {
            inputs: self.scales.len(),
            width: self.second.outputs(),
            layers: self.layers.len(),
            nearest: self.nearest,
        }
    }

    /// All weights, matrix by matrix, always in the same order.
    pub fn weights(&self) -> Vec<&[f32]> {
        let mut weights: Vec<&[f32]> = Vec::new();
        weights.extend(self.first.weights());
        weights.extend(self.second.weights());
        self.layers.iter().for_each(|layer| weights.extend(layer.weights()));
        weights.extend(self.last.weights());
        weights.extend(self.hidden.weights());
        weights.extend(self.out.weights());
        weights
    }

    /// [`Self::weights`], to be changed.
    pub fn weights_mut(&mut self) -> Vec<&mut [f32]> {
        let mut weights: Vec<&mut [f32]> = Vec::new();
        weights.extend(self.first.weights_mut());
        weights.extend(self.second.weights_mut());
        self.layers.iter_mut().for_each(|layer| weights.extend(layer.weights_mut()));
        weights.extend(self.last.weights_mut());
        weights.extend(self.hidden.weights_mut());
        weights.extend(self.out.weights_mut());
        weights
    }

    /// The log odds of the detections of a scan, of which this evidence was observed, and which lie so around each
    /// other.
    pub fn log_odds(&self, rows: &Rows, around: &Around) -> Vec<f64> {
        // Scores are most of a net's memory, and nobody asks for them again.
        let pass = Pass::behind_first(self, Matrix::default(), self.first_step(rows), around);
        pass.log_odds.iter().map(|log_odds| f64::from(*log_odds)).collect()
    }

    /// What the net adds to the log odds of trees, of detections of a scan that lie at these places: together they say
    /// the mean of both.
    pub fn heard(&self, trees: &[f64], rows: &Rows, places: &[[f32; 3]]) -> Vec<f64> {
        let said = self.log_odds(rows, &Around::of(places, self.nearest));
        trees.iter().zip(said).map(|(trees, said)| (said - trees) / 2.0).collect()
    }

    /// What the net reads of rows: the score of each feature, 0 where it is absent, and behind them 1 for what is
    /// absent.
    pub fn scores(&self, rows: &Rows) -> Matrix {
        let mut scores = Matrix::zeros(rows.len(), 2 * self.scales.len());
        for row in 0..rows.len() {
            self.score(rows.row(row), scores.row_mut(row));
        }
        scores
    }

    /// What the first step makes of rows, at least 0.
    fn first_step(&self, rows: &Rows) -> Matrix {
        let mut first = Matrix::zeros(rows.len(), self.first.outputs());
        let mut scores = vec![0.0; 2 * self.scales.len()];
        for row in 0..rows.len() {
            self.score(rows.row(row), &mut scores);
            self.first.of_row(&scores, first.row_mut(row));
        }
        first.relu()
    }

    /// The scores of one row.
    fn score(&self, row: &[f32], scores: &mut [f32]) {
        let (told, absent) = scores.split_at_mut(self.scales.len());
        for (((told, absent), scale), value) in told.iter_mut().zip(absent).zip(&self.scales).zip(row) {
            [*told, *absent] = if value.is_nan() { [0.0, 1.0] } else { [scale.score(*value), 0.0] };
        }
    }
}

#[cfg(test)]
pub(in crate::learned) mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    /// A net of small random weights that reads so many features.
    pub(in crate::learned) fn net(inputs: usize) -> Net {
        let mut random = rand_pcg::Pcg64::seed_from_u64(3);
        let scale = || Scale::new(vec![(-1.0, -1.5), (0.0, 0.25), (2.0, 1.0)]).unwrap();
        let shape = Shape { inputs, width: 4, layers: 2, nearest: 3 };
        let mut net = Net::zeros(shape, (0..inputs).map(|_| scale()).collect());
        for weights in net.weights_mut() {
            weights.fill_with(|| random.random_range(-1.0..1.0));
        }
        net
    }

    /// So many rows, of which some evidence is absent, at places of their own.
    pub(in crate::learned) fn scan(rows: usize, inputs: usize) -> (Rows, Vec<[f32; 3]>) {
        let mut random = rand_pcg::Pcg64::seed_from_u64(rows as u64);
        let mut table = Rows::absent(rows, inputs);
        for row in 0..rows {
            for value in table.row_mut(row) {
                *value = if random.random_bool(0.2) { f32::NAN } else { random.random_range(-2.0..3.0) };
            }
        }
        (table, (0..rows).map(|_| std::array::from_fn(|_| random.random_range(-30.0..30.0))).collect())
    }

    #[test]
    fn the_order_of_a_scans_detections_says_nothing() {
        let (net, (rows, places)) = (net(5), scan(20, 5));
        let said = net.log_odds(&rows, &Around::of(&places, net.nearest));
        let turned: Vec<usize> = (0..20).rev().collect();
        let elsewhere: Vec<[f32; 3]> = turned.iter().map(|row| places[*row]).collect();
        let again = net.log_odds(&rows.pick(turned.into_iter()), &Around::of(&elsewhere, net.nearest));
        for (said, again) in said.iter().zip(again.iter().rev()) {
            assert!((said - again).abs() < 1e-5, "{said} {again}");
        }
    }

    #[test]
    fn a_detection_hears_of_those_around_it_and_of_no_others() {
        let (net, (rows, mut places)) = (net(5), scan(20, 5));
        // A crowd, and one detection far away, which hears of three of the crowd; nobody of the crowd hears of it.
        places[0] = [500.0, 0.0, 0.0];
        let said = net.log_odds(&rows, &Around::of(&places, net.nearest));
        let mut changed = rows.clone();
        changed.row_mut(0).fill(2.0);
        let again = net.log_odds(&changed, &Around::of(&places, net.nearest));
        assert_ne!(said[0], again[0]);
        assert_eq!(said[1..], again[1..]);
    }

    #[test]
    fn one_detection_alone_is_told_of_and_none_is_fine() {
        let net = net(3);
        for rows in [0, 1, 2] {
            let (rows, places) = scan(rows, 3);
            let said = net.log_odds(&rows, &Around::of(&places, net.nearest));
            assert!(said.len() == rows.len() && said.iter().all(|log_odds| log_odds.is_finite()));
        }
    }

    #[test]
    fn together_they_say_the_mean() {
        let (net, (rows, places)) = (net(5), scan(4, 5));
        let said = net.log_odds(&rows, &Around::of(&places, net.nearest));
        for (heard, said) in net.heard(&[2.0; 4], &rows, &places).into_iter().zip(said) {
            assert_eq!(2.0 + heard, 2.0 + (said - 2.0) / 2.0);
        }
    }
}
