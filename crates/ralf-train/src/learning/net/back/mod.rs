//! The gradient of a loss by all weights of a net: the chain rule, from the log odds back to the evidence.

mod dense;
mod pairs;

use dense::{add_weights, product, through_dense};
use pairs::through_pairs;
use ralf::learned::net::{Around, Layer, Matrix, Net, Norm, Pass, Said};

/// The gradient by each weight, as a net of the same shape, of a loss whose derivative by each log odds is `wrong`.
pub(super) fn gradient(net: &Net, pass: &Pass, around: &Around, wrong: &[f32]) -> Net {
    let mut by = Net::zeros(net.shape(), Vec::new());
    let mut d = Matrix::zeros(wrong.len(), 1);
    d.values_mut().copy_from_slice(wrong);
    let d = through_relu(through_dense(&net.out, &pass.hidden, &d, &mut by.out), &pass.hidden);
    let d = through_dense(&net.hidden, &pass.last, &d, &mut by.hidden);
    let layers = net.layers.len();
    let mut d = through_norm(&net.last, &pass.h[layers], &d, &mut by.last);
    for at in (0..layers).rev() {
        let before =
            through_layer(&net.layers[at], &pass.h[at], &pass.said[at], around, &d, &mut by.layers[at]);
        d.add(&before);
    }
    let d = through_relu(through_dense(&net.second, &pass.first, &d, &mut by.second), &pass.first);
    add_weights(pass.scores.values(), d.values(), &mut by.first);
    by
}

/// What is added to the derivative before a layer, beside what leads past it.
fn through_layer(
    layer: &Layer,
    h: &Matrix,
    said: &Said,
    around: &Around,
    d: &Matrix,
    by: &mut Layer,
) -> Matrix {
    let d = through_dense(&layer.heard, &said.mean_and_most, d, &mut by.heard);
    let ends = through_pairs(layer, &said.ends, around, &d, &mut by.way);
    let mut d = through_dense(&layer.own, &said.normed, &ends.own, &mut by.own);
    d.add(&through_dense(&layer.other, &said.normed, &ends.other, &mut by.other));
    through_norm(&layer.norm, h, &d, &mut by.norm)
}

/// Derivatives where numbers above 0 pass.
fn through_relu(mut d: Matrix, made: &Matrix) -> Matrix {
    for (d, made) in d.values_mut().iter_mut().zip(made.values()) {
        *d = if *made > 0.0 { *d } else { 0.0 };
    }
    d
}

/// Derivatives by what was normalised; adds those by gain and shift.
fn through_norm(norm: &Norm, x: &Matrix, d: &Matrix, by: &mut Norm) -> Matrix {
    let width = x.width() as f32;
    let mut before = Matrix::zeros(x.len(), x.width());
    let (mut normal, mut by_normal) = (Vec::new(), Vec::new());
    for row in 0..x.len() {
        let (mean, per_deviation) = Norm::moments(x.row(row));
        let d = d.row(row);
        normal.clear();
        normal.extend(x.row(row).iter().map(|value| (value - mean) * per_deviation));
        by_normal.clear();
        by_normal.extend(d.iter().zip(&norm.gain).map(|(d, gain)| d * gain));
        let mean_by = by_normal.iter().sum::<f32>() / width;
        let along = product(&by_normal, &normal) / width;
        for (at, before) in before.row_mut(row).iter_mut().enumerate() {
            *before = per_deviation * (by_normal[at] - mean_by - normal[at] * along);
            by.gain[at] += d[at] * normal[at];
            by.shift[at] += d[at];
        }
    }
    before
}

#[cfg(test)]
mod tests {
    use super::super::begin::begin;
    use super::*;
    use ralf::learned::net::{Scale, Shape};
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    /// The sum of log odds, each with a factor of its own.
    fn loss(net: &Net, scores: &Matrix, around: &Around, factors: &[f32]) -> f64 {
        let said = Pass::new(net, scores.clone(), around).log_odds;
        said.iter().zip(factors).map(|(said, factor)| f64::from(*said) * f64::from(*factor)).sum()
    }

    #[test]
    fn the_gradient_is_what_small_changes_come_to() {
        let mut random = Pcg64Mcg::seed_from_u64(2);
        let shape = Shape { inputs: 6, width: 12, layers: 2, nearest: 3 };
        let mut net = Net::zeros(shape, vec![Scale::new(vec![]).unwrap(); 6]);
        begin(&mut net, &mut random);
        // Gains and shifts that aren't those of the beginning.
        for weights in net.weights_mut() {
            weights.iter_mut().for_each(|weight| *weight += random.random_range(-0.1..0.1));
        }
        let mut scores = Matrix::zeros(30, 12);
        scores.values_mut().fill_with(|| random.random_range(-1.5..1.5));
        let places: Vec<[f32; 3]> =
            (0..30).map(|_| std::array::from_fn(|_| random.random_range(-9.0..9.0))).collect();
        let around = Around::of(&places, 3);
        let factors: Vec<f32> = (0..30).map(|_| random.random_range(-1.0..1.0)).collect();
        let pass = Pass::new(&net, scores.clone(), &around);
        let by = gradient(&net, &pass, &around, &factors);
        for block in 0..net.weights().len() {
            // Along a direction of one matrix' weights. Where a number becomes 0 on the way, a step is off a little.
            let length = net.weights()[block].len();
            let direction: Vec<f32> = (0..length).map(|_| random.random_range(-1.0..1.0)).collect();
            let moved = |step: f32| {
                let mut net = net.clone();
                let weights = net.weights_mut().swap_remove(block);
                weights.iter_mut().zip(&direction).for_each(|(weight, way)| *weight += step * way);
                loss(&net, &scores, &around, &factors)
            };
            let step = 2e-3 / (length as f32).sqrt();
            let expected = (moved(step) - moved(-step)) / (2.0 * f64::from(step));
            let found = f64::from(product(by.weights()[block], &direction));
            let size = by.weights()[block].iter().map(|d| f64::from(*d).powi(2)).sum::<f64>().sqrt();
            assert!(
                (found - expected).abs() < 0.08 * size.max(0.1),
                "block {block}: {found} for {expected} of {size}"
            );
        }
    }
}
