//! What grows. Leaves and twigs stir.

use crate::shape::Shape;
use crate::sketch::scene::{Block, Draft};
use ralf::space::{Point, Vector};
use std::f64::consts::TAU;

const VEGETATION: u16 = 70;
const TRUNK: u16 = 71;

/// A tree of a height with a crown of a radius, m.
pub(in crate::sketch) fn tree(draft: &mut Draft<'_>, [x, y, _]: [f64; 3], height: f64, crown: f64) {
    let trunk = draft.thing(TRUNK, [x, y, 0.0]);
    let radius = draft.between(0.08, 0.22);
    draft.column(trunk, [0.0, 0.0], radius, [0.0, 0.45 * height], 8.0).reflectance = 0.3;
    draft.scatter(trunk, 4, Block::new([0.02, 0.02], [0.2, 0.4 * height]), [-9.0, 3.0]);
    let leaves = draft.thing(VEGETATION, [x, y, 0.0]);
    draft.scene.things[leaves].flutter = 0.15;
    let low = (height - 2.0 * crown).max(0.25 * height);
    let wide = crown * draft.between(0.8, 1.1);
    let half = Vector::new(crown, wide, (height - low) / 2.0);
    let middle = Point::new(0.0, 0.0, low.midpoint(height));
    let body = draft.body(leaves, Shape::Ellipsoid(half), middle, 1.5);
    body.porous = 1.4;
    for _ in 0..(14.0 * crown) as usize {
        let away = Vector::new(draft.normal(0.0, 1.0), draft.normal(0.0, 1.0), draft.normal(0.0, 1.0));
        let at = middle + away.normalize().component_mul(&half) * draft.between(0.5, 1.0);
        let twig = draft.normal(-16.0, 5.0);
        draft.spot(leaves, at.coords.into(), None, twig);
    }
}

/// A bush of a radius and a height, m.
pub(in crate::sketch) fn bush(draft: &mut Draft<'_>, [x, y, _]: [f64; 3], radius: f64, height: f64) {
    let thing = draft.thing(VEGETATION, [x, y, 0.0]);
    draft.scene.things[thing].flutter = 0.1;
    let half = Vector::new(radius, radius, height.midpoint(0.2));
    let body = draft.body(thing, Shape::Ellipsoid(half), Point::new(0.0, 0.0, height / 2.0 - 0.1), 3.0);
    body.porous = 4.0;
    for _ in 0..8 {
        let (sin, cos) = draft.between(0.0, TAU).sin_cos();
        let (z, twig) = (draft.between(0.2, 0.8 * height), draft.normal(-13.0, 4.0));
        draft.spot(thing, [0.8 * radius * cos, 0.8 * radius * sin, z], None, twig);
    }
}

/// A piece of a hedge of a length and a height, m.
pub(in crate::sketch) fn hedge(draft: &mut Draft<'_>, start: [f64; 3], length: f64, height: f64) {
    let thing = draft.thing(VEGETATION, start);
    draft.scene.things[thing].flutter = 0.08;
    let top = draft.normal(height, 0.06).max(0.4);
    let block = Block::new([length / 2.0, 0.35], [0.0, top]);
    let body = draft.block(thing, block, 5.0);
    (body.porous, body.reflectance) = (6.0, 0.45);
    let count = draft.random.poisson(1.2 * length * top);
    draft.scatter(thing, count, Block { heights: [0.05, top], ..block }, [-17.0, 5.0]);
}
