//! A ring road.

use super::{Lie, Site, draft, steps};
use crate::random::Random;
use crate::sketch::scene::{Block, Cover, Draft, Ground};
use crate::sketch::things::{barrier, bush, car, furniture, lamp, lorry, noise_wall, post, sign, tree};
use crate::sketch::way::Way;
use ralf::space::Vector;
use std::f64::consts::PI;

/// Widths of what lies beside the own lane, m to the left of its centre.
const LANES: [f64; 3] = [0.0, 3.6, -3.6];
const ONCOMING: [f64; 2] = [11.4, 15.0];
const SIGNS: u16 = 81;
const BRIDGE: u16 = 50;

/// Two carriageways in a bend.
pub(super) fn ring(random: &mut Random) -> Site {
    let radius = random.between(350.0, 1500.0) * if random.chance(0.5) { 1.0 } else { -1.0 };
    let way = Way::circle(1.0 / radius, 420.0);
    let speed = random.between(17.0, 33.0);
    let ground = Ground {
        strength_db: [random.between(-28.0, -20.0), 4.5],
        density: random.between(0.2, 0.4),
        reflectance: random.between(0.08, 0.18),
    };
    let slope = [random.between(-0.02, 0.02), random.between(-0.01, 0.01)];
    let mut draft = draft(Lie { slope, swells: vec![[0.5, 560.0]], ground }, random);
    barriers(&mut draft, &way);
    crossings(&mut draft, &way);
    verge(&mut draft, &way);
    traffic(&mut draft, &way, speed, 1.0 / radius);
    Site { scene: draft.scene, way, speed }
}

fn barriers(draft: &mut Draft<'_>, way: &Way) {
    let gap = draft.between(30.0, 200.0);
    for along in steps(-130.0, 330.0, 4.0) {
        for left in [6.4, 7.6] {
            barrier(draft, way.at(along, left), 4.0);
        }
        if !(gap..gap + 35.0).contains(&along) {
            barrier(draft, way.at(along, -9.2), 4.0);
        }
    }
    if draft.chance(0.6) {
        let left = draft.one_of(&[25.5, -14.0]);
        for along in steps(-130.0, 330.0, 5.0) {
            noise_wall(draft, way.at(along, left), 5.0, 4.2);
        }
    }
    for along in steps(-120.0, 320.0, 36.0) {
        let [x, y, heading] = way.at(along, 7.0);
        lamp(draft, [x, y, heading + PI / 2.0], 11.0, 2.5);
    }
    for along in steps(-130.0, 330.0, 50.0) {
        let [x, y, heading] = way.at(along, -10.4);
        sign(draft, [x, y, heading], 0.9, 0.12);
        post(draft, way.at(along + 10.0, -9.9), 1.0, 0.07, -10.0);
    }
}

/// A gantry with signs, and a bridge on its abutments.
fn crossings(draft: &mut Draft<'_>, way: &Way) {
    let gantry = draft.between(50.0, 120.0);
    for left in [-10.8, 7.0] {
        furniture(draft, way.at(gantry, left), [0.3, 0.3], [0.0, 7.5]);
    }
    let signs = draft.thing(SIGNS, way.at(gantry, -2.0));
    draft.block(signs, Block::new([0.25, 9.0], [5.7, 8.0]), 20.0).reflectance = 0.8;
    for _ in 0..40 {
        let (y, z, plate) = (draft.between(-9.0, 9.0), draft.between(5.7, 8.0), draft.normal(6.0, 6.0));
        draft.spot(signs, [-0.26, y, z], Some(-Vector::x()), plate);
    }
    let bridge = draft.between(130.0, 220.0);
    let deck = draft.thing(BRIDGE, way.at(bridge, 8.0));
    let slab = Block::new([5.5, 32.0], [5.6, 7.2]);
    draft.block(deck, slab, 60.0);
    draft.cover(deck, slab, Cover { density: 0.5, strength_db: [0.0, 5.0], edges_db: None });
    for left in [-12.5, 7.0, 28.0] {
        furniture(draft, way.at(bridge, left), [4.5, 0.5], [0.0, 5.6]);
    }
}

fn verge(draft: &mut Draft<'_>, way: &Way) {
    let trees = draft.between(0.2, 0.9);
    for along in steps(-120.0, 320.0, 6.0) {
        if draft.chance(trees) {
            let left = -17.0 - draft.random.exponential(4.0);
            let at = way.at(along + draft.normal(0.0, 1.5), left);
            let [height, crown] = [draft.between(6.0, 14.0), draft.between(1.8, 3.5)];
            tree(draft, at, height, crown);
        }
        if draft.chance(0.6) {
            let at = way.at(along + draft.normal(0.0, 2.0), draft.normal(-12.6, 0.6));
            let [radius, height] = [draft.between(0.5, 1.2), draft.between(0.7, 1.8)];
            bush(draft, at, radius, height);
        }
    }
}

/// Cars and lorries of both directions; nobody starts beside or shortly before the own vehicle in its lane.
fn traffic(draft: &mut Draft<'_>, way: &Way, speed: f64, curvature: f64) {
    let count = draft.between(6.0, 18.0) as usize;
    for number in 0..count {
        let lane = LANES[number % LANES.len()];
        let along = draft.between(-70.0, 160.0);
        if lane == 0.0 && (-22.0..16.0).contains(&along) {
            continue;
        }
        let at = way.at(along, lane + draft.normal(0.0, 0.15));
        let ahead = if lane == 0.0 { along.signum() } else { 0.0 };
        let onward = speed + ahead + lane * 0.9 + draft.normal(0.0, 1.2);
        let turn = onward * curvature / (1.0 - lane * curvature);
        if lane < 0.0 && draft.chance(0.7) {
            lorry(draft, at, onward, turn);
        } else {
            car(draft, at, onward, turn);
        }
    }
    for _ in 0..count {
        let lane = draft.one_of(&ONCOMING);
        let [x, y, heading] = way.at(draft.between(0.0, 380.0), lane);
        let slow = lane > 12.0;
        let onward = if slow { draft.between(20.0, 24.0) } else { draft.between(25.0, 33.0) };
        let turn = -onward * curvature / (1.0 - lane * curvature);
        let at = [x, y, heading + PI];
        if slow && draft.chance(0.6) {
            lorry(draft, at, onward, turn);
        } else {
            car(draft, at, onward, turn);
        }
    }
}
