//! Yards: halls of sheet metal, containers, lorries, fences, gravel.

use super::builder::Builder;
use super::traffic::{Road, on_foot, on_road};
use crate::kind::Kind;
use crate::world::terrain::Surface;

/// A lane between halls and stacks.
pub(super) fn yard(builder: &mut Builder<'_>) {
    builder.plan.title = "industrial yard";
    let way = builder.drive([0.0, -1.8, 0.0], 5.0);
    let reach = builder.sight(way, [45.0, 120.0]);
    builder.hills(way);
    let half = builder.between(4.0, 8.0);
    for side in [1.0, -1.0] {
        if builder.chance(0.6) {
            builder.cover(Surface::Gravel, reach, [side * half, side * (half + 15.0)], 0.0);
        }
        stacks(builder, side * (half + 2.0), reach);
        let far = side * (half + builder.between(10.0, 22.0));
        halls(builder, far, reach);
        if builder.chance(0.4) {
            builder.line(Kind::Fence, reach, side * (half + 8.5), [4.0, 0.06, 2.0]);
        }
    }
    let road = Road { reach, lanes: vec![-1.8, 1.8], speed: 6.0, cars: 30.0, trucks: 0.5 };
    on_road(builder, &road);
    on_foot(builder, 50.0, reach, half - 0.5);
}

fn stacks(builder: &mut Builder<'_>, y: f64, [from, to]: [f64; 2]) {
    let mut x = from;
    while x < to {
        let wide = builder.between(5.0, 14.0);
        x += wide;
        let across = builder.chance(0.3);
        let yaw = if across { 90.0 } else { 0.0 } + builder.normal(3.0);
        let at =
            [x, y + y.signum() * builder.between(0.0, 3.0) + if across { y.signum() * 2.5 } else { 0.0 }];
        match (builder.random.uniform() * 7.0) as usize {
            0 | 1 => {
                let [long, stacked] = [builder.chance(0.5), builder.chance(0.3)];
                let size = [if long { 12.2 } else { 6.1 }, 2.44, if stacked { 5.2 } else { 2.6 }];
                builder.put(Kind::Container, at, yaw, size);
                x += size[0] / 2.0;
            }
            2 => builder.place(Kind::Truck, at, yaw),
            3 => builder.place(Kind::Car, at, yaw),
            4 => builder.put(Kind::Container, at, yaw, [1.2, 0.8, 1.0]),
            5 => builder.place(Kind::Pole, at, 0.0),
            _ => {}
        }
    }
}

fn halls(builder: &mut Builder<'_>, y: f64, [from, to]: [f64; 2]) {
    let mut x = from;
    while x < to {
        let [length, depth, height] =
            [builder.between(18.0, 45.0), builder.between(15.0, 30.0), builder.between(5.0, 11.0)];
        let kind = if builder.chance(0.5) { Kind::Container } else { Kind::Building };
        if builder.chance(0.8) {
            let at = [x + length / 2.0, y + y.signum() * depth / 2.0];
            builder.put(kind, at, 0.0, [length, depth, height]);
        }
        x += length + builder.between(3.0, 15.0);
    }
}
