//! Motorways: two carriageways, guard rails, banks, lorries, high speed.

use super::builder::Builder;
use super::traffic::{Road, on_road};
use crate::kind::Kind;
use crate::world::terrain::Surface;

/// Width of a lane and of the hard shoulder, m.
const LANE: f64 = 3.75;
const SHOULDER: f64 = 2.5;

/// Own carriageway at y below 0, the other above.
pub(super) fn motorway(builder: &mut Builder<'_>) {
    builder.plan.title = "motorway";
    let lanes = if builder.chance(0.5) { 2 } else { 3 };
    let median = builder.between(1.0, 4.0);
    let own = (builder.random.uniform() * f64::from(lanes)) as i32;
    let center = |lane: i32| median / 2.0 + 0.5 + LANE * (f64::from(lane) + 0.5);
    let way = builder.drive([0.0, -center(own), 0.0], 31.0);
    let reach = builder.sight(way, [180.0, 260.0]);
    builder.hills(way);
    middle(builder, median, reach);
    let outer = median / 2.0 + 0.5 + LANE * f64::from(lanes) + SHOULDER;
    for side in [1.0, -1.0] {
        beside(builder, side, outer, reach);
    }
    overhead(builder, outer, reach);
    let mut centers: Vec<f64> = (0..lanes).map(|lane| -center(lane)).collect();
    centers.extend((0..lanes).map(center));
    // Drivers of the inner lanes are faster; what is drawn per car is spread enough.
    let jam = builder.chance(0.15);
    let speed = if jam { builder.between(0.5, 5.0) } else { 31.0 };
    on_road(builder, &Road { reach, lanes: centers, speed, cars: 45.0, trucks: 0.3 });
}

/// Between the carriageways: rails, a wall of concrete, bushes on grass.
fn middle(builder: &mut Builder<'_>, width: f64, reach: [f64; 2]) {
    let edge = width / 2.0;
    if width > 1.8 {
        builder.cover(Surface::Grass, reach, [-edge, edge], 0.0);
    }
    if builder.chance(0.3) {
        builder.line(Kind::Wall, reach, 0.0, [6.0, 0.3, 0.95]);
        return;
    }
    let step = if builder.chance(0.5) { 4.0 } else { 2.0 };
    for y in [-0.8 * edge, 0.8 * edge] {
        builder.line(Kind::Rail, reach, y, [step, 0.15, 0.75]);
    }
    if width > 2.5 && builder.chance(0.5) {
        builder.line(Kind::Hedge, reach, 0.0, [6.0, 0.9, 1.3]);
    }
}

/// Beyond the shoulder: a rail here and there, grass on a bank, a thicket, bushes, trees, a noise barrier, signs.
fn beside(builder: &mut Builder<'_>, side: f64, outer: f64, [from, to]: [f64; 2]) {
    builder.cover(Surface::Grass, [from, to], [side * outer, side * (outer + 30.0)], 0.0);
    let slope = builder.between(-25.0, 25.0);
    builder.bank(side * (outer + 2.5), slope);
    let [rail_from, rail_to] = [builder.between(from, 0.0), builder.between(60.0, to)];
    if builder.chance(0.75) {
        builder.line(Kind::Rail, [rail_from, rail_to], side * (outer + 0.6), [4.0, 0.15, 0.75]);
    }
    if builder.chance(0.35) {
        let height = builder.between(2.0, 5.0);
        builder.line(Kind::Wall, [rail_from, rail_to], side * (outer + 2.2), [6.0, 0.2, height]);
    }
    thicket(builder, side, outer, [from, to]);
    let mut x = from;
    let green = builder.between(0.1, 0.8);
    while x < to {
        x += builder.between(5.0, 14.0);
        let y = side * (outer + builder.between(4.0, 16.0));
        if builder.chance(green) {
            let kind = if builder.chance(0.5) { Kind::Tree } else { Kind::Hedge };
            let yaw = builder.between(0.0, 180.0);
            builder.place(kind, [x, y], yaw);
        }
    }
    // Delineators every 50 m, and signs.
    let mut x = from;
    while x < to {
        x += 50.0;
        builder.put(Kind::Pole, [x, side * (outer + 0.2)], 0.0, [0.12, 0.12, 1.0]);
        if builder.chance(0.3) {
            let size = [0.1, builder.between(1.0, 4.0), builder.between(3.0, 6.0)];
            builder.put(
                Kind::Sign,
                [x + 7.0, side * (outer + 3.5)],
                if side < 0.0 { 180.0 } else { 0.0 },
                size,
            );
        }
    }
}

/// Bridges on their piers, and gantries with signs.
fn overhead(builder: &mut Builder<'_>, outer: f64, [from, to]: [f64; 2]) {
    let wide = 2.0 * (outer + 1.5);
    for _ in 0..builder.random.poisson((to - from) / 600.0) {
        let [x, length, top] =
            [builder.between(from, to), builder.between(6.0, 16.0), builder.between(5.3, 7.0)];
        builder.put(Kind::Bridge, [x, 0.0], 0.0, [length, wide + 10.0, top]);
        for y in [-outer - 3.5, 0.0, outer + 3.5] {
            builder.put(Kind::Wall, [x, y], 0.0, [0.6 * length, 0.8, top]);
        }
    }
    for _ in 0..builder.random.poisson((to - from) / 800.0) {
        let x = builder.between(from, to);
        builder.put(Kind::Bridge, [x, 0.0], 0.0, [0.6, wide, 6.5]);
        for side in [1.0, -1.0] {
            builder.put(Kind::Pole, [x, side * wide / 2.0], 0.0, [0.5, 0.5, 6.4]);
        }
    }
}

/// On every other side. Measured, aiMotive: seven of ten LiDAR points lie above the ground, most of them on what grows
/// beside the road.
fn thicket(builder: &mut Builder<'_>, side: f64, outer: f64, reach: [f64; 2]) {
    if builder.chance(0.5) {
        let [near, height] = [builder.between(4.0, 9.0), builder.between(2.0, 7.0)];
        builder.line(Kind::Hedge, reach, side * (outer + near), [6.0, 3.0, height]);
    }
}
