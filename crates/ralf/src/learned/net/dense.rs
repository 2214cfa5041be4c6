//! Sums of weighed numbers: `y = x W + b`.

use super::matrix::Matrix;

/// Outputs that are added up side by side, in registers.
const LANES: usize = 32;

/// `y = x W + b` of each row.
#[derive(Debug, Clone, PartialEq)]
pub struct Dense {
    /// `W`, the weights of an input side by side.
    pub by_input: Vec<f32>,
    /// `b`, one per output.
    pub bias: Vec<f32>,
}

impl Dense {
    /// From so many numbers to so many, all weights 0.
    pub fn zeros(inputs: usize, outputs: usize) -> Self {
        Self { by_input: vec![0.0; inputs * outputs], bias: vec![0.0; outputs] }
    }

    /// Numbers that it makes.
    pub fn outputs(&self) -> usize {
        self.bias.len()
    }

    /// The weights of an input.
    pub fn of_input(&self, input: usize) -> &[f32] {
        &self.by_input[input * self.outputs()..][..self.outputs()]
    }

    /// What it makes of each row.
    pub fn of(&self, x: &Matrix) -> Matrix {
        let mut made = Matrix::zeros(x.len(), self.outputs());
        for row in 0..x.len() {
            self.of_row(x.row(row), made.row_mut(row));
        }
        made
    }

    /// What it makes of one row.
    pub fn of_row(&self, x: &[f32], made: &mut [f32]) {
        let (lanes, rest) = made.as_chunks_mut::<LANES>();
        let alone = lanes.len() * LANES;
        for (at, sums) in lanes.iter_mut().enumerate() {
            *sums = self.sums(x, at * LANES);
        }
        for (at, sum) in rest.iter_mut().enumerate() {
            [*sum] = self.sums(x, alone + at);
        }
    }

    /// Some of the outputs, side by side, from the one at `first` on.
    fn sums<const OUTPUTS: usize>(&self, x: &[f32], first: usize) -> [f32; OUTPUTS] {
        let mut sums = std::array::from_fn(|at| self.bias[first + at]);
        for (value, weights) in x.iter().zip(self.by_input.chunks_exact(self.outputs())) {
            // Of what was observed nothing is absent, and about half of all numbers were below 0.
            if *value != 0.0 {
                let weights = &weights[first..][..OUTPUTS];
                for (sum, weight) in sums.iter_mut().zip(weights) {
                    *sum += value * weight;
                }
            }
        }
        sums
    }

    pub(super) fn weights(&self) -> [&[f32]; 2] {
        [&self.by_input, &self.bias]
    }

    pub(super) fn weights_mut(&mut self) -> [&mut [f32]; 2] {
        [&mut self.by_input, &mut self.bias]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_weighed_and_added_up() {
        let dense = Dense { by_input: vec![1.0, 2.0, 10.0, 20.0, 100.0, 200.0], bias: vec![0.5, -0.5] };
        let mut x = Matrix::zeros(2, 3);
        x.row_mut(0).copy_from_slice(&[1.0, 0.0, 2.0]);
        x.row_mut(1).copy_from_slice(&[0.0, -1.0, 0.0]);
        assert_eq!(dense.of(&x).values(), [201.5, 401.5, -9.5, -20.5]);
    }

    #[test]
    fn any_number_of_outputs_is_made() {
        let mut x = Matrix::zeros(1, 2);
        x.row_mut(0).copy_from_slice(&[2.0, 3.0]);
        for outputs in [1, 15, 16, 17, 33] {
            let by_input = (0..2 * outputs).map(|weight| weight as f32).collect();
            let dense = Dense { by_input, bias: vec![0.5; outputs] };
            let expected: Vec<f32> =
                (0..outputs).map(|at| (2 * at + 3 * (outputs + at)) as f32 + 0.5).collect();
            assert_eq!(dense.of(&x).values(), expected);
        }
    }
}
