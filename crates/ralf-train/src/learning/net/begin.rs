//! Weights before anything is learned.

use ralf::learned::net::{Dense, Net, Norm};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Of a step whose numbers below 0 are lost: what is left spreads as widely as what came in (He et al., 2015).
const BEFORE_RELU: f32 = std::f32::consts::SQRT_2;
/// Of what is added to what is there.
const ADDED: f32 = 0.5;
/// Of the answer: at first it is little.
const ANSWER: f32 = 0.1;

/// Draws a net's weights.
pub(super) fn begin(net: &mut Net, random: &mut Pcg64Mcg) {
    draw(&mut net.first, BEFORE_RELU, random);
    draw(&mut net.second, 1.0, random);
    for layer in &mut net.layers {
        even(&mut layer.norm);
        for dense in [&mut layer.own, &mut layer.other, &mut layer.way] {
            draw(dense, 1.0, random);
        }
        draw(&mut layer.heard, ADDED, random);
    }
    even(&mut net.last);
    draw(&mut net.hidden, BEFORE_RELU, random);
    draw(&mut net.out, ANSWER, random);
}

/// Weights of a standard deviation of `spread` over the root of the number of inputs, evenly distributed.
fn draw(dense: &mut Dense, spread: f32, random: &mut Pcg64Mcg) {
    let inputs = dense.by_input.len() / dense.outputs().max(1);
    let most = spread * (3.0 / inputs.max(1) as f32).sqrt();
    dense.by_input.fill_with(|| random.random_range(-most..most));
}

fn even(norm: &mut Norm) {
    norm.gain.fill(1.0);
}
