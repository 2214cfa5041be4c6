//! Containers on a quay.

use super::{Lie, Site, bends, draft, steps};
use crate::random::Random;
use crate::sketch::scene::{Draft, Ground};
use crate::sketch::things::{
    car, carrier, fence, furniture, kerb, lorry, pedestrian, pole, post, sign, stack,
};
use crate::sketch::way::Way;
use std::f64::consts::PI;

/// An aisle between stacks that opens to the water's edge.
pub(super) fn quay(random: &mut Random) -> Site {
    let way = Way::new(&bends(random, 5, [12.0, 30.0], 25.0), 240.0);
    let speed = random.between(3.5, 9.0);
    let ground = Ground {
        strength_db: [random.between(-24.0, -16.0), 5.0],
        density: random.between(0.4, 0.8),
        reflectance: random.between(0.08, 0.2),
    };
    let swells = vec![[0.03, 55.0], [0.04, 80.0]];
    let mut draft = draft(Lie { slope: [0.0; 2], swells, ground }, random);
    let open = [draft.between(-10.0, 20.0), draft.between(40.0, 80.0)];
    stacks(&mut draft, &way, open);
    let edge = draft.between(22.0, 34.0);
    cranes(&mut draft, &way, edge);
    water_edge(&mut draft, &way, edge);
    traffic(&mut draft, &way, edge);
    Site { scene: draft.scene, way, speed }
}

/// Rows of stacks on both sides; on the left there is a gap.
fn stacks(draft: &mut Draft<'_>, way: &Way, open: [f64; 2]) {
    let beside = draft.between(6.5, 10.0);
    let full = draft.between(0.6, 0.95);
    for along in steps(-75.0, 150.0, 13.2) {
        for row in [0.0, 2.7, 5.4] {
            for side in [1.0, -1.0] {
                let gap = side > 0.0 && (open[0]..open[1]).contains(&along);
                if gap || !draft.chance(full) {
                    continue;
                }
                let at = way.at(along + draft.normal(0.0, 0.12), side * (beside + row));
                let count = 1 + (draft.between(0.0, 3.99)) as usize;
                stack(draft, at, count);
            }
        }
    }
    for along in steps(open[0], open[1], 3.2) {
        post(draft, way.at(along, beside - 1.2), 0.9, 0.06, -9.0);
    }
    if draft.chance(0.4) {
        for along in steps(-70.0, 140.0, 3.0) {
            fence(draft, way.at(along, -beside - 9.5), 3.0, 2.4, true);
        }
    }
}

/// Portals: legs in pairs, with a sill between them.
fn cranes(draft: &mut Draft<'_>, way: &Way, edge: f64) {
    for along in steps(draft.between(-40.0, 0.0), 130.0, draft.between(50.0, 80.0)) {
        for left in [edge - 8.0, edge - 1.5] {
            for ahead in [0.0, 16.0] {
                furniture(draft, way.at(along + ahead, left), [0.55, 0.7], [0.0, 26.0]);
            }
            furniture(draft, way.at(along + 8.0, left), [8.0, 0.5], [0.6, 2.4]);
        }
    }
    for along in steps(-60.0, 130.0, 38.0) {
        pole(draft, way.at(along, edge - 14.0), 24.0, 0.3, 3.0);
    }
}

fn water_edge(draft: &mut Draft<'_>, way: &Way, edge: f64) {
    for along in steps(-90.0, 150.0, 6.0) {
        kerb(draft, way.at(along, edge + 0.6), 6.0, 0.25);
    }
    for along in steps(-90.0, 150.0, 7.5) {
        post(draft, way.at(along, edge), 0.55, 0.22, -3.0);
    }
    for along in steps(4.0, 90.0, 4.0) {
        if draft.chance(0.3) {
            let [x, y, heading] = way.at(along, edge - 13.0);
            sign(draft, [x, y, heading + PI], 1.2, 0.2);
        }
    }
}

/// Tractors, carriers, cars of those who work there, and themselves.
fn traffic(draft: &mut Draft<'_>, way: &Way, edge: f64) {
    for _ in 0..4 {
        let [along, onward] = [draft.between(14.0, 110.0), draft.between(3.0, 8.0)];
        let oncoming = draft.chance(0.6);
        let [x, y, heading] =
            way.at(if oncoming { along } else { along - 90.0 }, if oncoming { 3.6 } else { 0.3 });
        lorry(draft, [x, y, heading + if oncoming { PI } else { 0.0 }], onward, 0.0);
    }
    for _ in 0..3 {
        let at = way.at(draft.between(-40.0, 110.0), draft.between(10.0, edge - 9.0));
        let speed = draft.one_of(&[0.0, 4.0, 5.0]);
        carrier(draft, at, speed);
    }
    for _ in 0..6 {
        let [x, y, heading] = way.at(draft.between(-40.0, 110.0), draft.one_of(&[-5.4, 5.2, 7.4, 15.0]));
        let turned = draft.normal(0.0, 0.1);
        car(draft, [x, y, heading + turned], 0.0, 0.0);
    }
    for _ in 0..10 {
        let left = draft.one_of(&[-5.0, 5.0, 8.0, 14.0, 20.0]) + draft.normal(0.0, 0.6);
        let [x, y, _] = way.at(draft.between(-15.0, 80.0), left);
        let (heading, speed) = (draft.between(-PI, PI), draft.one_of(&[0.0, 0.0, 1.2]));
        pedestrian(draft, [x, y, heading], speed);
    }
    for _ in 0..14 {
        let left = draft.one_of(&[5.6, 13.5, 20.0]) + draft.normal(0.0, 0.5);
        let at = way.at(draft.between(-20.0, 90.0), left);
        let height = draft.between(0.3, 1.1);
        furniture(draft, at, [0.6, 0.4], [0.0, height]);
    }
}
