//! Car parks: rows of cars, lanes between them, bushes, lamps, a building.

use super::builder::Builder;
use super::traffic::{Road, on_foot, on_road};
use crate::kind::{DECK, Kind};
use crate::world::terrain::Surface;

/// Clear height below a roof, m.
const STOREY: f64 = 2.8;

/// Rows of cars along the lane that is driven, and further ones.
pub(super) fn car_park(builder: &mut Builder<'_>) {
    builder.plan.title = "car park";
    let way = builder.drive([0.0, -1.3, 0.0], 2.6);
    let reach = builder.sight(way, [35.0, 100.0]);
    builder.hills(way);
    let [full, lane] = [builder.between(0.35, 0.95), builder.between(5.5, 7.5)];
    let roofed = builder.chance(0.2);
    let mut y = lane / 2.0;
    for row in 0..3 {
        for side in [1.0, -1.0] {
            cars(builder, side * (y + 2.5), full, reach);
            if roofed {
                pillars(builder, side * (y + 5.3), reach);
            } else if row % 2 == 0 && builder.chance(0.5) {
                strip(builder, side * (y + 5.6), reach);
            }
        }
        y += if row % 2 == 0 { 6.3 } else { 5.0 + lane };
    }
    if roofed {
        shell(builder, y + 3.0, reach);
    } else {
        for side in [1.0, -1.0] {
            edge(builder, side * (y + 3.0), reach);
        }
    }
    manoeuvre(builder);
    let road = Road { reach, lanes: vec![-1.3, 1.3], speed: 3.0, cars: 10.0, trucks: 0.0 };
    on_road(builder, &road);
    on_foot(builder, 50.0, reach, lane / 2.0 - 0.4);
}

/// A turn into a space, or around the end of a row.
fn manoeuvre(builder: &mut Builder<'_>) {
    let leg = |length: f64, turn_deg: f64| crate::scenario::Leg { length, turn_deg };
    if builder.chance(0.4) {
        let turn = builder.between(-60.0, 60.0);
        builder.plan.drive.legs = vec![leg(builder.between(1.0, 8.0), 0.0), leg(6.0, turn), leg(5.0, -turn)];
    }
}

fn cars(builder: &mut Builder<'_>, y: f64, full: f64, [from, to]: [f64; 2]) {
    let mut x = from;
    while x < to {
        x += builder.between(2.45, 2.8);
        // Nobody parks where the own vehicle stands or turns.
        if builder.chance(full) {
            let yaw = if builder.chance(0.6) { 90.0 } else { -90.0 } + builder.normal(2.0);
            let beside = builder.normal(0.2);
            builder.place(Kind::Car, [x, y + beside], yaw);
        } else if builder.chance(0.04) {
            builder.put(Kind::Container, [x, y], 0.0, [1.0, 0.6, 1.0]);
        }
    }
}

/// Of a car park with a roof: square ones of concrete, behind the cars.
fn pillars(builder: &mut Builder<'_>, y: f64, [from, to]: [f64; 2]) {
    let mut x = from;
    while x < to {
        x += 7.8;
        builder.put(Kind::Wall, [x, y], 0.0, [0.5, 0.5, STOREY]);
    }
}

/// Its ceiling and its outer walls.
fn shell(builder: &mut Builder<'_>, half: f64, [from, to]: [f64; 2]) {
    builder.line(Kind::Bridge, [from, to], 0.0, [8.0, 2.0 * half + 1.0, STOREY + DECK]);
    for side in [1.0, -1.0] {
        builder.line(Kind::Wall, [from, to], side * half, [6.0, 0.3, STOREY]);
    }
    for x in [from, to] {
        builder.put(Kind::Wall, [x, 0.0], 0.0, [0.3, 2.0 * half, STOREY]);
    }
}

/// Between two rows.
fn strip(builder: &mut Builder<'_>, y: f64, [from, to]: [f64; 2]) {
    builder.cover(Surface::Grass, [from, to], [y - 0.6, y + 0.6], 0.1);
    let mut x = from;
    while x < to {
        x += builder.between(4.0, 9.0);
        match (builder.random.uniform() * 4.0) as usize {
            0 => builder.place(Kind::Tree, [x, y], 0.0),
            1 => builder.put(Kind::Hedge, [x, y], 0.0, [3.5, 0.9, 0.8]),
            2 => builder.place(Kind::Pole, [x, y], 0.0),
            _ => {}
        }
    }
}

fn edge(builder: &mut Builder<'_>, y: f64, reach: [f64; 2]) {
    builder.cover(Surface::Grass, reach, [y, y + y.signum() * 8.0], 0.0);
    match (builder.random.uniform() * 4.0) as usize {
        0 => builder.line(Kind::Hedge, reach, y + y.signum(), [5.0, 1.2, 1.5]),
        1 => builder.line(Kind::Fence, reach, y + y.signum(), [5.0, 0.06, 1.8]),
        2 => builder.line(Kind::Rail, reach, y, [4.0, 0.15, 0.75]),
        _ => {
            let size = [(reach[1] - reach[0]) * 0.6, 20.0, builder.between(5.0, 9.0)];
            builder.put(Kind::Building, [reach[0].midpoint(reach[1]), y + y.signum() * 14.0], 0.0, size);
        }
    }
}
