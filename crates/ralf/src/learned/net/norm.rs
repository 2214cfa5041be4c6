//! Layer normalisation (Ba et al., 2016).

use super::matrix::Matrix;

/// Numbers of a row, less their mean, in units of their standard deviation, with a gain and a shift for each.
#[derive(Debug, Clone, PartialEq)]
pub struct Norm {
    /// What each is multiplied by.
    pub gain: Vec<f32>,
    /// What is added to each.
    pub shift: Vec<f32>,
}

/// Added to every variance, so that rows of equal numbers have one.
const LEAST_VARIANCE: f32 = 1e-5;

impl Norm {
    pub(super) fn zeros(width: usize) -> Self {
        Self { gain: vec![0.0; width], shift: vec![0.0; width] }
    }

    /// Each row, normalised.
    pub fn of(&self, x: &Matrix) -> Matrix {
        let mut made = Matrix::zeros(x.len(), x.width());
        for row in 0..x.len() {
            let (mean, per_deviation) = Self::moments(x.row(row));
            for (place, (made, value)) in made.row_mut(row).iter_mut().zip(x.row(row)).enumerate() {
                *made = (value - mean) * per_deviation * self.gain[place] + self.shift[place];
            }
        }
        made
    }

    /// The mean of numbers, and 1 over their standard deviation.
    pub fn moments(numbers: &[f32]) -> (f32, f32) {
        let count = numbers.len() as f32;
        let mean = numbers.iter().sum::<f32>() / count;
        let variance = numbers.iter().map(|number| (number - mean) * (number - mean)).sum::<f32>() / count;
        (mean, 1.0 / (variance + LEAST_VARIANCE).sqrt())
    }

    pub(super) fn weights(&self) -> [&[f32]; 2] {
        [&self.gain, &self.shift]
    }

    pub(super) fn weights_mut(&mut self) -> [&mut [f32]; 2] {
        [&mut self.gain, &mut self.shift]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_has_no_mean_and_a_unit_deviation() {
        let norm = Norm { gain: vec![1.0, 1.0, 2.0], shift: vec![0.0, 0.0, 5.0] };
        let mut x = Matrix::zeros(1, 3);
        x.row_mut(0).copy_from_slice(&[1.0, 2.0, 3.0]);
        let sigma = (2.0_f32 / 3.0 + LEAST_VARIANCE).sqrt();
        assert_eq!(norm.of(&x).values(), [-1.0 / sigma, 0.0, 2.0 / sigma + 5.0]);
    }
}
