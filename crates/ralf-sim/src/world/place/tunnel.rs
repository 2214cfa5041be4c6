//! Tunnels: walls and a ceiling of concrete, walkways, cabinets and signs.

use super::builder::Builder;
use super::traffic::{Road, on_road};
use crate::kind::{DECK, Kind};
use crate::world::terrain::Surface;

/// A road that runs in a tube, from here on or all the way.
pub(super) fn tunnel(builder: &mut Builder<'_>) {
    builder.plan.title = "tunnel";
    let way = builder.drive([0.0, -1.8, 0.0], 20.0);
    let reach = builder.sight(way, [80.0, 220.0]);
    builder.hills(way);
    let half = builder.between(4.2, 6.5);
    let mouth = if builder.chance(0.3) { builder.between(0.0, way + 40.0) } else { reach[0] };
    tube(builder, half, [mouth, reach[1]]);
    if mouth > reach[0] {
        cutting(builder, half, [reach[0], mouth]);
    }
    on_road(builder, &Road { reach, lanes: vec![-1.8, 1.8], speed: 21.0, cars: 60.0, trucks: 0.25 });
}

fn tube(builder: &mut Builder<'_>, half: f64, inside: [f64; 2]) {
    let clear = builder.between(4.6, 6.5);
    let [walk, rise] = [builder.between(0.5, 1.2), builder.between(0.05, 0.2)];
    for side in [1.0, -1.0] {
        builder.cover(Surface::Pavement, inside, [side * half, side * (half + walk)], rise);
        builder.line(Kind::Wall, inside, side * (half + walk + 0.2), [6.0, 0.4, clear + 0.4]);
        fittings(builder, side, half + walk - 0.15, inside);
    }
    builder.line(Kind::Bridge, inside, 0.0, [8.0, 2.0 * (half + walk) + 0.6, clear + DECK]);
}

/// Cabinets of extinguishers, doors of metal, and signs along a wall.
fn fittings(builder: &mut Builder<'_>, side: f64, y: f64, [from, to]: [f64; 2]) {
    let step = builder.between(12.0, 40.0);
    let mut x = from;
    while x < to {
        x += step * builder.between(0.8, 1.2);
        match (builder.random.uniform() * 4.0) as usize {
            0 => builder.put(Kind::Container, [x, side * y], 0.0, [1.0, 0.25, 1.6]),
            1 => builder.put(Kind::Container, [x, side * y], 0.0, [2.0, 0.1, 2.2]),
            2 => builder.put(Kind::Sign, [x, side * y], 180.0, [0.08, 0.5, 2.8]),
            _ => {}
        }
    }
}

/// Before the mouth: grass, rails and bushes, and the hill that the tube runs into.
fn cutting(builder: &mut Builder<'_>, half: f64, outside: [f64; 2]) {
    for side in [1.0, -1.0] {
        builder.cover(Surface::Grass, outside, [side * (half + 1.0), side * (half + 20.0)], 0.0);
        builder.line(Kind::Rail, outside, side * (half + 0.6), [4.0, 0.15, 0.75]);
        builder.line(Kind::Hedge, outside, side * (half + 6.0), [6.0, 2.0, 1.6]);
        let hill = [outside[1] + 0.5, side * (half + 14.0)];
        builder.put(Kind::Wall, hill, 0.0, [1.0, 24.0, 7.5]);
    }
}
