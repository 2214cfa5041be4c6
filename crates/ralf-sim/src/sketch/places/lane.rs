//! A lane through an old town.

use super::{Lie, Site, bends, draft, steps};
use crate::random::Random;
use crate::sketch::scene::{Draft, Ground};
use crate::sketch::things::{
    Facade, building, car, cyclist, kerb, pedestrian, pole, post, sign, stall, tree,
};
use crate::sketch::way::Way;
use std::f64::consts::PI;

const TOWN: Facade = Facade { density: 0.42, strength_db: -8.0, glass: 0.22, mirror_db: 8.0 };

/// Facades close to both sides; a market somewhere on the left.
pub(super) fn lane(random: &mut Random) -> Site {
    let way = Way::new(&bends(random, 8, [8.0, 20.0], 14.0), 200.0);
    let speed = random.between(2.5, 8.0);
    let ground = Ground {
        strength_db: [random.between(-22.0, -15.0), 5.5],
        density: random.between(0.6, 1.1),
        reflectance: random.between(0.15, 0.3),
    };
    let slope = [random.between(-0.03, 0.03), 0.0];
    let swells = vec![[0.015, 28.0], [0.12, 145.0]];
    let mut draft = draft(Lie { slope, swells, ground }, random);
    let market = [draft.between(0.0, 40.0), draft.between(55.0, 75.0)];
    let walk = [draft.between(3.9, 6.5), draft.between(4.9, 8.0)];
    for (side, beside) in [(1.0, walk[0]), (-1.0, walk[1])] {
        facades(&mut draft, &way, side, beside, market);
    }
    kerbs(&mut draft, &way, walk);
    stalls(&mut draft, &way, market);
    traffic(&mut draft, &way, walk, market);
    Site { scene: draft.scene, way, speed }
}

fn facades(draft: &mut Draft<'_>, way: &Way, side: f64, beside: f64, market: [f64; 2]) {
    let mut along = -70.0;
    while along < 130.0 {
        let length = draft.between(5.5, 12.0);
        let middle = along + length / 2.0;
        let gap = side > 0.0 && (market[0]..market[1]).contains(&middle);
        if !gap && draft.chance(0.92) {
            let setback = beside + draft.between(0.0, 0.7);
            let [x, y, heading] = way.at(middle, side * (setback + 4.0));
            let (turned, height) = (draft.normal(0.0, 0.02), draft.between(7.0, 14.0));
            building(draft, [x, y, heading + turned], [length / 2.0, 4.0], height, TOWN);
            for at in steps(along + 0.6, along + length, 2.9) {
                if draft.chance(0.5) {
                    let height = draft.one_of(&[0.5, 6.0]);
                    let radius = draft.one_of(&[0.06, 0.22]);
                    post(draft, way.at(at, side * (setback - 0.3)), height, radius, -8.0);
                }
            }
        }
        along += length + if draft.chance(0.8) { 0.0 } else { draft.between(1.0, 2.6) };
    }
}

fn kerbs(draft: &mut Draft<'_>, way: &Way, walk: [f64; 2]) {
    for along in steps(-70.0, 130.0, 4.0) {
        kerb(draft, way.at(along, 2.7), 4.0, 0.1);
        kerb(draft, way.at(along, -2.5), 4.0, 0.1);
    }
    let bollards = draft.between(0.1, 0.8);
    for along in steps(-65.0, 130.0, 2.2) {
        if draft.chance(bollards) {
            post(draft, way.at(along, 3.0), 0.85, 0.06, -7.0);
        }
    }
    for along in steps(-60.0, 130.0, 19.0) {
        pole(draft, way.at(along, 3.2), 4.5, 0.07, -3.0);
        if draft.chance(0.4) {
            let [x, y, heading] = way.at(along + 7.0, draft.one_of(&[3.1, -2.8]));
            let back = draft.one_of(&[0.0, PI]);
            sign(draft, [x, y, heading + back], 2.1, 0.3);
        }
    }
    if walk[1] < 5.6 {
        return;
    }
    let parked = draft.between(0.3, 0.9);
    let mut along = -66.0;
    while along < 125.0 {
        if draft.chance(parked) {
            let [x, y, heading] = way.at(along, -3.6);
            let turned = draft.one_of(&[0.0, PI]) + draft.normal(0.0, 0.03);
            car(draft, [x, y, heading + turned], 0.0, 0.0);
        }
        along += draft.between(5.6, 8.0);
    }
}

/// A square with stalls, trees and a house at its far side.
fn stalls(draft: &mut Draft<'_>, way: &Way, [from, to]: [f64; 2]) {
    for along in steps(from + 2.0, to - 2.0, 3.6) {
        for left in [8.5, 13.5] {
            if draft.chance(0.7) {
                stall(draft, way.at(along, left));
            }
        }
    }
    let middle = from.midpoint(to);
    building(draft, way.at(middle, 32.0), [12.0, 6.0], 18.0, TOWN);
    for (along, left) in [(from + 3.0, 6.4), (to - 3.0, 6.6), (middle, 24.0)] {
        let crown = draft.between(1.6, 2.6);
        tree(draft, way.at(along, left), 7.0, crown);
    }
}

fn traffic(draft: &mut Draft<'_>, way: &Way, walk: [f64; 2], market: [f64; 2]) {
    let people = draft.between(8.0, 60.0) as usize;
    for _ in 0..people {
        let left = draft.one_of(&[3.5, 3.4, -3.2, -walk[1] + 0.7, 8.0, 11.0]) + draft.normal(0.0, 0.3);
        let along =
            if left > 6.0 { draft.between(market[0], market[1]) } else { draft.between(-50.0, 110.0) };
        let [x, y, heading] = way.at(along, left);
        let turned = draft.one_of(&[0.0, PI]) + draft.normal(0.0, 0.2);
        let speed = draft.one_of(&[0.0, 0.7, 1.3, 1.5]);
        pedestrian(draft, [x, y, heading + turned], speed);
    }
    let cyclists = draft.between(0.0, 8.0) as usize;
    for _ in 0..cyclists {
        let oncoming = draft.chance(0.6);
        let left = if oncoming { 1.7 } else { -1.6 };
        let [x, y, heading] = way.at(draft.between(8.0, 90.0), left);
        let speed = draft.between(2.5, 6.5);
        cyclist(draft, [x, y, heading + if oncoming { PI } else { 0.0 }], speed);
    }
    for along in [draft.between(25.0, 60.0), draft.between(60.0, 110.0)] {
        let [x, y, heading] = way.at(along, 1.6);
        let speed = draft.between(3.0, 7.0);
        car(draft, [x, y, heading + PI], speed, 0.0);
    }
}
