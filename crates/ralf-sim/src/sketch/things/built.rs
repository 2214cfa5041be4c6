//! What is built, and what stands along roads.

use crate::sketch::scene::{Block, Cover, Draft};
use ralf::space::Vector;

const BUILDING: u16 = 50;
const FENCE: u16 = 51;
const STRUCTURE: u16 = 52;
const POLE: u16 = 80;
const SIGN: u16 = 81;
const OTHER: u16 = 99;
/// A kerb belongs to the ground.
const KERB: u16 = 1;

/// What a building is like.
#[derive(Debug, Clone, Copy)]
pub(in crate::sketch) struct Facade {
    /// Spots on a square metre.
    pub(in crate::sketch) density: f64,
    /// dBsm.
    pub(in crate::sketch) strength_db: f64,
    /// Share of a LiDAR's rays that windows swallow.
    pub(in crate::sketch) glass: f64,
    /// What it takes from a wave that it mirrors, dB.
    pub(in crate::sketch) mirror_db: f64,
}

/// Anything upright with four sides, as high as `heights`, m.
fn upright(draft: &mut Draft<'_>, class: u16, start: [f64; 3], block: Block, facade: Facade, edges_db: f64) {
    let thing = draft.thing(class, start);
    let reflectance = draft.between(0.2, 0.55);
    let body = draft.block(thing, block, 60.0);
    (body.reflectance, body.gaps, body.mirror_db) = (reflectance, facade.glass, Some(facade.mirror_db));
    let Facade { density, strength_db, .. } = facade;
    draft.cover(thing, block, Cover { density, strength_db: [strength_db, 6.0], edges_db: Some(edges_db) });
}

/// A house of half a length and width, m.
pub(in crate::sketch) fn building(
    draft: &mut Draft<'_>,
    start: [f64; 3],
    half: [f64; 2],
    height: f64,
    facade: Facade,
) {
    upright(draft, BUILDING, start, Block::new(half, [-0.6, height]), facade, 3.0);
}

/// Containers, one above the other.
pub(in crate::sketch) fn stack(draft: &mut Draft<'_>, start: [f64; 3], count: usize) {
    let facade = Facade { density: 0.28, strength_db: -9.0, glass: 0.02, mirror_db: 2.0 };
    let block = Block::new([6.05, 1.22], [0.0, 2.6 * count as f64]);
    upright(draft, STRUCTURE, start, block, facade, 6.0);
}

/// A piece of steel or concrete: a crane's leg, an abutment, a plinth, a block.
pub(in crate::sketch) fn furniture(
    draft: &mut Draft<'_>,
    start: [f64; 3],
    half: [f64; 2],
    heights: [f64; 2],
) {
    let facade = Facade { density: 1.0, strength_db: -3.0, glass: 0.0, mirror_db: 4.0 };
    upright(draft, STRUCTURE, start, Block::new(half, heights), facade, 5.0);
}

/// A piece of a noise wall of a length and a height, m.
pub(in crate::sketch) fn noise_wall(draft: &mut Draft<'_>, start: [f64; 3], length: f64, height: f64) {
    let facade = Facade { density: 0.4, strength_db: -12.0, glass: 0.0, mirror_db: 5.0 };
    upright(draft, STRUCTURE, start, Block::new([length / 2.0, 0.12], [0.0, height]), facade, -3.0);
}

/// A market stall: a counter below a roof on four rods.
pub(in crate::sketch) fn stall(draft: &mut Draft<'_>, start: [f64; 3]) {
    let thing = draft.thing(OTHER, start);
    let counter = Block::new([1.1, 0.5], [0.05, 0.95]);
    draft.block(thing, counter, 20.0);
    draft.block(thing, Block::new([1.3, 0.9], [2.1, 2.25]), 3.0);
    for (x, y) in [(-1.2, -0.8), (-1.2, 0.8), (1.2, -0.8), (1.2, 0.8)] {
        draft.column(thing, [x, y], 0.03, [0.0, 2.1], 0.0);
    }
    draft.cover(thing, counter, Cover { density: 2.5, strength_db: [-10.0, 4.0], edges_db: Some(-6.0) });
}

/// A pole of a height and a radius, m; its spots have so many dBsm.
pub(in crate::sketch) fn pole(
    draft: &mut Draft<'_>,
    start: [f64; 3],
    height: f64,
    radius: f64,
    strength_db: f64,
) -> usize {
    rod(draft, POLE, start, height, radius, strength_db)
}

/// A bollard, a downpipe, a tub: as a pole, but something else.
pub(in crate::sketch) fn post(
    draft: &mut Draft<'_>,
    start: [f64; 3],
    height: f64,
    radius: f64,
    strength_db: f64,
) {
    rod(draft, OTHER, start, height, radius, strength_db);
}

fn rod(
    draft: &mut Draft<'_>,
    class: u16,
    start: [f64; 3],
    height: f64,
    radius: f64,
    strength_db: f64,
) -> usize {
    let thing = draft.thing(class, start);
    draft.column(thing, [0.0, 0.0], radius, [0.0, height], 3.0).reflectance = 0.35;
    let count = ((height.min(6.0) / 1.2) as usize).max(2);
    let lower = Block::new([0.0, 0.0], [0.1, height.min(7.0)]);
    draft.scatter(thing, count, lower, [strength_db - 4.0, 4.0]);
    draft.spot(thing, [0.0, 0.0, 0.15], None, strength_db + 2.0);
    thing
}

/// A lamp whose arm reaches along its x axis.
pub(in crate::sketch) fn lamp(draft: &mut Draft<'_>, start: [f64; 3], height: f64, arm: f64) {
    let thing = pole(draft, start, height, 0.12, 0.0);
    let reach = Block { middle: [arm / 2.0, 0.0], half: [arm / 2.0, 0.06], heights: [height - 0.15, height] };
    draft.block(thing, reach, 3.0).reflectance = 0.3;
    draft.spot(thing, [arm, 0.0, height - 0.1], None, -4.0);
}

/// A plate of half a width, m, that looks against its own x axis.
pub(in crate::sketch) fn sign(draft: &mut Draft<'_>, start: [f64; 3], height: f64, half: f64) {
    let thing = rod(draft, SIGN, start, height + half, 0.04, -8.0);
    let heights = [height - half, height + half];
    let plate = Block { middle: [-0.05, 0.0], half: [0.02, half], heights };
    draft.block(thing, plate, 8.0).reflectance = 0.9;
    for _ in 0..2 {
        let (y, z) = (draft.between(-half, half), draft.between(heights[0], heights[1]));
        let strength = draft.normal(2.0, 5.0);
        draft.spot(thing, [-0.07, y, z], Some(-Vector::x()), strength);
    }
}

/// A piece of a fence of a length and a height, m: of wire, or of boards.
pub(in crate::sketch) fn fence(draft: &mut Draft<'_>, start: [f64; 3], length: f64, height: f64, wire: bool) {
    let thing = draft.thing(FENCE, start);
    let half = length / 2.0;
    let sheet = Block::new([half, 0.03], [0.05, height]);
    draft.block(thing, sheet, 25.0).porous = if wire { 5.0 } else { 25.0 };
    for step in 0..=(length / 2.5) as usize {
        let x = -half + 2.5 * step as f64;
        draft.column(thing, [x, 0.0], 0.035, [0.0, height + 0.05], 1.0);
        draft.scatter(
            thing,
            2,
            Block { middle: [x, 0.0], half: [0.0; 2], heights: [0.1, height] },
            [-8.0, 3.0],
        );
    }
    let count = draft.random.poisson(1.5 * length);
    draft.scatter(thing, count, Block { half: [half, 0.0], ..sheet }, [-16.0, 5.0]);
}

/// A piece of a kerb of a length and a height, m.
pub(in crate::sketch) fn kerb(draft: &mut Draft<'_>, start: [f64; 3], length: f64, height: f64) {
    let thing = draft.thing(KERB, start);
    let half = length / 2.0;
    draft.block(thing, Block::new([half, 0.08], [-0.1, height]), 2.0).reflectance = 0.3;
    let count = draft.random.poisson(0.8 * length);
    let edge = Block::new([half, 0.0], [0.7 * height, 0.7 * height]);
    draft.scatter(thing, count, edge, [-18.0, 4.0]);
}

/// A piece of a crash barrier of a length, m.
pub(in crate::sketch) fn barrier(draft: &mut Draft<'_>, start: [f64; 3], length: f64) {
    let thing = draft.thing(FENCE, start);
    let half = length / 2.0;
    let rail = draft.block(thing, Block::new([half, 0.05], [0.46, 0.78]), 7.0);
    (rail.reflectance, rail.gaps, rail.mirror_db) = (0.5, 0.03, Some(4.0));
    for step in 0..(length / 2.0).ceil() as usize {
        let x = -half + 0.5 + 2.0 * step as f64;
        draft.block(thing, Block { middle: [x, 0.0], half: [0.05, 0.06], heights: [0.0, 0.62] }, 1.0);
        let (z, strength) = (draft.between(0.1, 0.7), draft.normal(-4.0, 3.0));
        draft.spot(thing, [x, 0.0, z], None, strength);
    }
    let count = draft.random.poisson(0.5 * length);
    draft.scatter(thing, count, Block::new([half, 0.0], [0.62, 0.62]), [-12.0, 4.0]);
}
