//! Sums of weighed numbers: `y = x W + b`.

use super::matrix::Matrix;

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
            let sums = made.row_mut(row);
            sums.copy_from_slice(&self.bias);
            for (input, value) in x.row(row).iter().enumerate() {
                // Of what was observed nothing is absent, and about half of all numbers were below 0.
                if *value != 0.0 {
                    add_scaled(sums, *value, self.of_input(input));
                }
            }
        }
        made
    }

    pub(super) fn weights(&self) -> [&[f32]; 2] {
        [&self.by_input, &self.bias]
    }

    pub(super) fn weights_mut(&mut self) -> [&mut [f32]; 2] {
        [&mut self.by_input, &mut self.bias]
    }
}

/// Adds so many times some numbers to sums.
fn add_scaled(sums: &mut [f32], factor: f32, numbers: &[f32]) {
    for (sum, number) in sums.iter_mut().zip(numbers) {
        *sum += factor * number;
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
}
