//! Allotment gardens.

use super::{Lie, Site, bends, draft, steps};
use crate::random::Random;
use crate::sketch::scene::{Draft, Ground};
use crate::sketch::things::{
    Facade, building, bush, car, cyclist, fence, hedge, pedestrian, pole, post, sign, tree,
};
use crate::sketch::way::Way;
use std::f64::consts::PI;

const SHED: Facade = Facade { density: 0.8, strength_db: -12.0, glass: 0.12, mirror_db: 10.0 };

/// A gravel lane on a slope between plots.
pub(super) fn gardens(random: &mut Random) -> Site {
    let way = Way::new(&bends(random, 8, [10.0, 25.0], 18.0), 220.0);
    let speed = random.between(3.0, 11.0);
    let ground = Ground {
        strength_db: [random.between(-22.0, -15.0), 5.5],
        density: random.between(0.7, 1.3),
        reflectance: random.between(0.18, 0.35),
    };
    let slope = [random.between(-0.06, 0.06), random.between(-0.05, 0.05)];
    let swells = vec![[0.35, 195.0], [0.02, 15.0]];
    let mut draft = draft(Lie { slope, swells, ground }, random);
    for side in [1.0, -1.0] {
        let beside = draft.between(3.2, 5.0);
        let mut along = -75.0;
        while along < 150.0 {
            along += plot(&mut draft, &way, side, beside, along);
        }
    }
    for along in steps(-70.0, 150.0, 31.0) {
        pole(&mut draft, way.at(along, 2.7), 7.5, 0.13, -6.0);
        if draft.chance(0.5) {
            sign(&mut draft, way.at(along + 9.0, -2.6), 1.8, 0.25);
        }
    }
    traffic(&mut draft, &way);
    Site { scene: draft.scene, way, speed }
}

/// One plot behind its hedge or fence, with a gate; how far it reaches, m.
fn plot(draft: &mut Draft<'_>, way: &Way, side: f64, beside: f64, from: f64) -> f64 {
    let length = draft.between(11.0, 18.0);
    let left = side * (beside + draft.between(0.0, 0.6));
    enclosure(draft, way, left, [from, from + length]);
    shed(draft, way, side, left, [from, length]);
    let trees = draft.between(1.0, 3.99) as usize;
    for _ in 0..trees {
        let at = way.at(from + draft.between(1.0, length), left + side * draft.between(2.2, 14.0));
        let [height, crown] = [draft.between(3.0, 6.0), draft.between(1.0, 2.0)];
        tree(draft, at, height, crown);
    }
    let bushes = draft.between(2.0, 5.99) as usize;
    for _ in 0..bushes {
        let at = way.at(from + draft.between(1.0, length), left + side * draft.between(1.2, 14.0));
        let [radius, height] = [draft.between(0.3, 0.9), draft.between(0.5, 1.4)];
        bush(draft, at, radius, height);
    }
    if draft.chance(0.6) {
        let at = way.at(from + draft.between(2.0, length - 2.0), left + side * 2.2);
        post(draft, at, 1.0, 0.4, -7.0);
    }
    let [x, y, heading] = way.at(from + length, left + side * 8.0);
    fence(draft, [x, y, heading + PI / 2.0], 14.0, 1.0, true);
    length + if draft.chance(0.3) { draft.between(1.2, 5.0) } else { 0.0 }
}

/// A hedge or a fence along the lane, and a gate.
fn enclosure(draft: &mut Draft<'_>, way: &Way, left: f64, [from, to]: [f64; 2]) {
    let (kind, height) = (draft.between(0.0, 1.0), draft.between(1.0, 2.2));
    for along in steps(from, to - 2.2, 3.0) {
        let at = way.at(along + 1.5, left);
        if kind < 0.55 {
            hedge(draft, at, 3.0, height);
        } else {
            fence(draft, at, 3.0, 1.2, kind < 0.85);
        }
    }
    for along in [to - 2.1, to - 0.2] {
        post(draft, way.at(along, left), 1.3, 0.06, -8.0);
    }
    fence(draft, way.at(to - 1.2, left), 1.7, 1.1, true);
}

/// Somewhere in a plot of a length.
fn shed(draft: &mut Draft<'_>, way: &Way, side: f64, left: f64, [from, length]: [f64; 2]) {
    let along = from + draft.between(4.0, length - 4.0);
    let [x, y, heading] = way.at(along, left + side * draft.between(4.0, 10.0));
    let (turned, height) = (draft.normal(0.0, 0.2), draft.between(2.2, 3.0));
    let half = [draft.between(1.5, 2.4), draft.between(1.2, 2.0)];
    building(draft, [x, y, heading + turned], half, height, SHED);
}

fn traffic(draft: &mut Draft<'_>, way: &Way) {
    for _ in 0..5 {
        let [x, y, heading] = way.at(draft.between(-50.0, 110.0), draft.one_of(&[2.4, -2.4]));
        let turned = draft.one_of(&[0.0, PI]);
        car(draft, [x, y, heading + turned], 0.0, 0.0);
    }
    let people = draft.between(4.0, 20.0) as usize;
    for _ in 0..people {
        let left = draft.one_of(&[-1.9, 1.9, 6.0, -7.0, 9.0]);
        let [x, y, heading] = way.at(draft.between(-30.0, 100.0), left);
        let turned = draft.one_of(&[0.0, PI]);
        let speed = draft.one_of(&[0.0, 0.0, 1.0]);
        pedestrian(draft, [x, y, heading + turned], speed);
    }
    for _ in 0..2 {
        let [x, y, heading] = way.at(draft.between(15.0, 80.0), 0.9);
        let speed = draft.between(3.0, 5.5);
        cyclist(draft, [x, y, heading + PI], speed);
    }
    let [x, y, heading] = way.at(draft.between(50.0, 110.0), 1.3);
    let speed = draft.between(3.0, 7.0);
    car(draft, [x, y, heading + PI], speed, 0.0);
}
