//! Back through what is said of pairs.

use super::dense::add_weights;
use ralf::learned::net::{Around, Dense, Ends, Layer, Matrix};

/// Derivatives by what both ends of pairs bring, from those by the mean and the largest of what is said; adds those by
/// the weights of the ways.
pub(super) fn through_pairs(
    layer: &Layer,
    ends: &Ends,
    around: &Around,
    d: &Matrix,
    by_way: &mut Dense,
) -> Ends {
    let (width, nearest) = (ends.own.width(), around.nearest());
    let ways = around.ways().width() * nearest;
    let zeros = |like: &Matrix| Matrix::zeros(like.len(), like.width());
    let mut by = Ends { own: zeros(&ends.own), other: zeros(&ends.other) };
    let (mut said, mut d_said) = (Matrix::zeros(nearest, width), Matrix::zeros(nearest, width));
    let mut most = vec![0.0; width];
    for (row, ways) in around.ways().values().chunks_exact(ways).enumerate() {
        hear(layer, ends, around, row, &mut said, &mut most);
        let (d_mean, d_most) = d.row(row).split_at(width);
        // The first of equal ones is the largest; what is handed on to it isn't to the others.
        let mut d_left = d_most.to_vec();
        for (pair, other) in around.of_one(row).iter().enumerate() {
            let d_said = d_said.row_mut(pair);
            for (at, said) in said.row(pair).iter().enumerate() {
                let is_most = *said == most[at];
                let from_most = if is_most { d_left[at] } else { 0.0 };
                d_left[at] = if is_most { 0.0 } else { d_left[at] };
                let d = d_mean[at] / nearest as f32 + from_most;
                d_said[at] = if *said > 0.0 { d } else { 0.0 };
            }
            let add = |by: &mut [f32]| by.iter_mut().zip(&*d_said).for_each(|(sum, d)| *sum += d);
            add(by.own.row_mut(row));
            add(by.other.row_mut(*other as usize));
        }
        add_weights(ways, d_said.values(), by_way);
    }
    by
}

/// What is said of the pairs of a detection, a row each, and the largest of it.
fn hear(layer: &Layer, ends: &Ends, around: &Around, row: usize, said: &mut Matrix, most: &mut [f32]) {
    most.fill(0.0);
    for (at, (pair, other)) in around.pairs_of(row).enumerate() {
        let said = said.row_mut(at);
        layer.said_of(ends, around, [row, pair], other, said);
        most.iter_mut().zip(&*said).for_each(|(most, said)| *most = most.max(*said));
    }
}
