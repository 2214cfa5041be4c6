//! Back through sums of weighed numbers. Everything is added up in the order of the rows, and of the outputs of a row,
//! whatever lies side by side on the way.

use ralf::learned::net::{Dense, Matrix};
use std::iter::StepBy;
use std::ops::Range;

/// Weights of an input whose sums lie in registers, and inputs whose derivatives do.
const SIDE_BY_SIDE: usize = 32;
/// Rows that are added to a weight while its sum lies there.
const ROWS: usize = 16;
/// Lanes of a sum of products that are added up side by side.
const LANES: usize = 8;

/// Derivatives by what a step was given, of which it made what `d` is the derivative by; adds those by its weights.
pub(super) fn through_dense(dense: &Dense, x: &Matrix, d: &Matrix, by: &mut Dense) -> Matrix {
    add_weights(x.values(), d.values(), by);
    let weights = by_output(dense, x.width());
    let mut before = Matrix::zeros(x.len(), x.width());
    for row in 0..x.len() {
        let (lanes, rest) = before.row_mut(row).as_chunks_mut::<SIDE_BY_SIDE>();
        let alone = lanes.len() * SIDE_BY_SIDE;
        for (at, before) in lanes.iter_mut().enumerate() {
            *before = products(&weights, x.width(), at * SIDE_BY_SIDE, d.row(row));
        }
        for (at, before) in rest.iter_mut().enumerate() {
            [*before] = products(&weights, x.width(), alone + at, d.row(row));
        }
    }
    before
}

/// Adds the derivatives by the weights of a step, of rows of what it was given and of derivatives by what it made.
pub(super) fn add_weights(x: &[f32], d: &[f32], by: &mut Dense) {
    let outputs = by.outputs();
    let inputs = by.by_input.len() / outputs;
    for (x, d) in x.chunks(ROWS * inputs).zip(d.chunks(ROWS * outputs)) {
        for d in d.chunks_exact(outputs) {
            by.bias.iter_mut().zip(d).for_each(|(sum, d)| *sum += d);
        }
        for (input, sums) in by.by_input.chunks_exact_mut(outputs).enumerate() {
            let values = x[input..].iter().step_by(inputs);
            let (lanes, rest) = sums.as_chunks_mut::<SIDE_BY_SIDE>();
            let alone = lanes.len() * SIDE_BY_SIDE;
            for (at, sums) in lanes.iter_mut().enumerate() {
                add_rows(values.clone(), d[at * SIDE_BY_SIDE..].chunks(outputs), sums);
            }
            for (at, sum) in rest.iter_mut().enumerate() {
                add_rows(values.clone(), d[alone + at..].chunks(outputs), std::array::from_mut(sum));
            }
        }
    }
}

/// Adds to some weights of an input its value in each row times the derivatives there, which come first in their row.
fn add_rows<'a, const OUTPUTS: usize>(
    values: impl Iterator<Item = &'a f32>,
    rows: impl Iterator<Item = &'a [f32]>,
    sums: &mut [f32; OUTPUTS],
) {
    let mut kept = *sums;
    for (value, d) in values.zip(rows) {
        // About half of all numbers are 0.
        if *value != 0.0 {
            kept.iter_mut().zip(&d[..OUTPUTS]).for_each(|(sum, d)| *sum += value * d);
        }
    }
    *sums = kept;
}

/// The weights of a step with those of an output side by side.
fn by_output(dense: &Dense, inputs: usize) -> Vec<f32> {
    let mut weights = vec![0.0; dense.by_input.len()];
    for (input, of_input) in dense.by_input.chunks_exact(dense.outputs()).enumerate() {
        for (output, weight) in of_input.iter().enumerate() {
            weights[output * inputs + input] = *weight;
        }
    }
    weights
}

/// For some inputs from the one at `first` on, the sum of [`product`] of their weights and `d`.
fn products<const INPUTS: usize>(weights: &[f32], inputs: usize, first: usize, d: &[f32]) -> [f32; INPUTS] {
    let whole = d.len() / LANES * LANES;
    let mut sums = [0.0; INPUTS];
    let sum_of = |outputs: StepBy<Range<usize>>| {
        let mut sum = [0.0; INPUTS];
        for output in outputs {
            let weights = &weights[output * inputs + first..][..INPUTS];
            sum.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight * d[output]);
        }
        sum
    };
    for lane in 0..LANES.min(whole) {
        let lane = sum_of((lane..whole).step_by(LANES));
        sums.iter_mut().zip(lane).for_each(|(sum, lane)| *sum += lane);
    }
    let rest = sum_of((whole..d.len()).step_by(1));
    sums.iter_mut().zip(rest).for_each(|(sum, rest)| *sum += rest);
    sums
}

/// The sum of products, always added up in the same order.
pub(super) fn product(a: &[f32], b: &[f32]) -> f32 {
    let (whole_a, rest_a) = a.as_chunks::<LANES>();
    let (whole_b, rest_b) = b.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for (a, b) in whole_a.iter().zip(whole_b) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    let rest: f32 = rest_a.iter().zip(rest_b).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f32>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn derivatives_are_added_up_in_the_order_of_rows_and_outputs() {
        let mut random = Pcg64Mcg::seed_from_u64(5);
        for (rows, inputs, outputs) in [(1, 1, 1), (40, 70, 33), (17, 32, 32), (16, 5, 12), (0, 3, 4)] {
            let mut filled = |rows, width| {
                let mut matrix = Matrix::zeros(rows, width);
                matrix.values_mut().fill_with(|| random.random_range(-1.0_f32..1.0).max(-0.3) + 0.3);
                matrix
            };
            let (x, d, weights) = (filled(rows, inputs), filled(rows, outputs), filled(inputs, outputs));
            let dense = Dense { by_input: weights.values().to_vec(), bias: vec![0.0; outputs] };
            let mut by = Dense::zeros(inputs, outputs);
            let before = through_dense(&dense, &x, &d, &mut by);
            let mut expected = Dense::zeros(inputs, outputs);
            for row in 0..rows {
                for output in 0..outputs {
                    let d = d.row(row)[output];
                    expected.bias[output] += d;
                    for (input, value) in x.row(row).iter().enumerate() {
                        expected.by_input[input * outputs + output] += value * d;
                    }
                }
                let one = |input| product(dense.of_input(input), d.row(row));
                assert_eq!(before.row(row), (0..inputs).map(one).collect::<Vec<f32>>());
            }
            assert_eq!(by, expected);
        }
    }
}
