//! What drives and walks.

use crate::shape::Shape;
use crate::sketch::scene::{Block, Cover, Draft};
use ralf::space::{Point, Vector};

const CAR: u16 = 10;
const BICYCLIST: u16 = 31;
const TRUCK: u16 = 18;
const OTHER_VEHICLE: u16 = 20;
const PERSON: u16 = 30;

/// A car, or a van; one that stands has no speed.
pub(in crate::sketch) fn car(draft: &mut Draft<'_>, start: [f64; 3], speed: f64, turn_rate: f64) {
    let van = draft.chance(0.18);
    let thing = draft.mover(CAR, start, speed, turn_rate);
    let l = if van { draft.between(2.45, 2.8) } else { draft.between(1.9, 2.4) };
    let w = draft.between(0.86, 0.97);
    let height = if van { draft.between(1.9, 2.3) } else { draft.between(1.4, 1.65) };
    let paint = draft.one_of(&[0.08, 0.25, 0.5, 0.6]);
    let waist = if van { height } else { 0.82 };
    let hull = draft.block(thing, Block::new([l, w], [0.22, waist]), 14.0);
    (hull.reflectance, hull.gaps, hull.mirror_db) = (paint, 0.06, Some(4.0));
    if !van {
        let cabin = Block { middle: [-0.2, 0.0], half: [0.58 * l, 0.86 * w], heights: [waist, height] };
        let glass = draft.block(thing, cabin, 12.0);
        (glass.reflectance, glass.gaps) = (0.15, 0.35);
    }
    let sides = Cover { density: 1.5, strength_db: [-9.0, 5.0], edges_db: Some(-1.0) };
    draft.cover(thing, Block::new([l, w], [0.3, 0.8]), sides);
    for end in [1.0, -1.0] {
        for side in [1.0, -1.0] {
            let wheel = draft.normal(-2.0, 3.0);
            draft.spot(thing, [end * 0.62 * l, side * w, 0.32], Some(Vector::y() * side), wheel);
        }
        let mean = if end < 0.0 { 1.0 } else { -1.0 };
        for _ in 0..4 {
            let (y, z, lamp) = (draft.between(-w, w), draft.between(0.35, 0.75), draft.normal(mean, 5.0));
            draft.spot(thing, [end * l, y, z], Some(Vector::x() * end), lamp);
        }
        draft.spot(thing, [0.25 * l, end * (w + 0.08), 1.0], None, -10.0);
    }
}

/// A lorry with a box, or with an empty bed.
pub(in crate::sketch) fn lorry(draft: &mut Draft<'_>, start: [f64; 3], speed: f64, turn_rate: f64) {
    let thing = draft.mover(TRUCK, start, speed, turn_rate);
    let (l, w) = (draft.between(5.0, 8.0), 1.25);
    let top = draft.one_of(&[1.5, 3.6, 4.0]);
    let load = Block { middle: [-0.8, 0.0], half: [l - 0.9, w], heights: [1.0, top] };
    let side = draft.block(thing, load, 25.0);
    (side.reflectance, side.gaps, side.mirror_db) = (0.55, 0.02, Some(2.0));
    let cab = Block { middle: [l - 0.85, 0.0], half: [0.85, w], heights: [0.4, 3.2] };
    draft.block(thing, cab, 25.0).gaps = 0.1;
    for x in [-l + 1.2, -l + 2.5, l - 1.8] {
        let axle = Block { middle: [x, 0.0], half: [0.5, 1.15], heights: [0.0, 1.0] };
        let wheels = draft.block(thing, axle, 10.0);
        (wheels.reflectance, wheels.gaps) = (0.07, 0.2);
    }
    let sides = Cover { density: 1.1, strength_db: [-6.0, 6.0], edges_db: Some(4.0) };
    draft.cover(thing, Block::new([l, w], [0.5, top.max(2.0)]), sides);
    for step in 0..6 {
        let x = -l + 0.5 + f64::from(step) * (2.0 * l - 1.5) / 5.0;
        for side in [1.0, -1.0] {
            let rim = draft.normal(3.0, 3.0);
            draft.spot(thing, [x, side * w, 0.6], Some(Vector::y() * side), rim);
        }
    }
    for _ in 0..5 {
        let (y, z, bar) = (draft.between(-w, w), draft.between(0.4, 1.3), draft.normal(7.0, 4.0));
        draft.spot(thing, [-l, y, z], Some(-Vector::x()), bar);
    }
}

/// A straddle carrier: four legs, a beam above, a container between.
pub(in crate::sketch) fn carrier(draft: &mut Draft<'_>, start: [f64; 3], speed: f64) {
    let thing = draft.mover(OTHER_VEHICLE, start, speed, 0.0);
    let steel = Cover { density: 1.3, strength_db: [-2.0, 5.0], edges_db: Some(3.0) };
    for x in [-4.0, 4.0] {
        for y in [-1.9, 1.9] {
            let leg = Block { middle: [x, y], half: [0.45, 0.3], heights: [0.1, 9.0] };
            draft.block(thing, leg, 30.0);
            draft.cover(thing, leg, steel);
        }
    }
    draft.block(thing, Block::new([4.8, 2.1], [9.0, 10.5]), 60.0);
    let load = Block::new([3.0, 1.22], [1.5, 4.1]);
    draft.block(thing, load, 60.0);
    draft.cover(thing, load, Cover { density: 0.6, strength_db: [-5.0, 6.0], edges_db: Some(5.0) });
}

pub(in crate::sketch) fn pedestrian(draft: &mut Draft<'_>, start: [f64; 3], speed: f64) {
    let thing = draft.mover(PERSON, start, speed, 0.0);
    draft.scene.things[thing].flutter = if speed > 0.0 { 0.5 } else { 0.1 };
    let height = draft.between(1.5, 1.9);
    draft.column(thing, [0.0, 0.0], 0.22, [0.75, height], 6.0).reflectance = 0.3;
    for side in [1.0, -1.0] {
        draft.column(thing, [0.12 * side, 0.1 * side], 0.09, [0.0, 0.8], 2.0).reflectance = 0.2;
    }
    draft.scatter(thing, 4, Block::new([0.2, 0.2], [0.3, height - 0.1]), [-10.0, 3.0]);
}

pub(in crate::sketch) fn cyclist(draft: &mut Draft<'_>, start: [f64; 3], speed: f64) {
    let thing = draft.mover(BICYCLIST, start, speed, 0.0);
    draft.scene.things[thing].flutter = 0.4;
    draft.column(thing, [0.0, 0.0], 0.24, [0.8, 1.75], 5.0).reflectance = 0.3;
    let frame = Shape::Box(Vector::new(0.85, 0.04, 0.42));
    draft.body(thing, frame, Point::new(0.0, 0.0, 0.47), 1.0).gaps = 0.6;
    for at in [[0.55, 0.0, 0.35], [-0.5, 0.0, 0.35], [0.0, 0.0, 0.9], [0.0, 0.0, 1.3], [0.4, 0.0, 1.0]] {
        let part = draft.normal(-8.0, 3.0);
        draft.spot(thing, at, None, part);
    }
}
