//! Country roads: hills and bends, grass, ditches, trees, a farm now and then.

use super::builder::Builder;
use super::traffic::{Road, on_bicycles, on_road};
use crate::kind::Kind;
use crate::world::terrain::Surface;

/// A road through fields.
pub(super) fn country(builder: &mut Builder<'_>) {
    builder.plan.title = "country road";
    let way = builder.drive([0.0, -1.6, 0.0], 18.0);
    let reach = builder.sight(way, [80.0, 220.0]);
    let half = builder.between(2.7, 3.8);
    builder.hills(way);
    for side in [1.0, -1.0] {
        let surface = if builder.chance(0.8) { Surface::Grass } else { Surface::Gravel };
        builder.cover(surface, reach, [side * half, side * 60.0], 0.0);
        if builder.chance(0.5) {
            builder.cover(Surface::Gravel, reach, [side * half, side * (half + 0.8)], 0.0);
        }
        let slope = builder.between(-1.0, 1.0) * (6.0 * builder.motion.slope.high).min(28.0);
        builder.bank(side * (half + 1.0), slope);
        verge(builder, side, half, reach);
    }
    let road = Road { reach, lanes: vec![-1.6, 1.6], speed: 20.0, cars: 30.0, trucks: 0.15 };
    on_road(builder, &road);
    on_bicycles(builder, 4.0, reach, 2.3);
}

fn verge(builder: &mut Builder<'_>, side: f64, half: f64, [from, to]: [f64; 2]) {
    let [trees, step] = [builder.between(0.05, 0.7), builder.between(6.0, 16.0)];
    let near = half + builder.between(1.5, 5.0);
    if builder.chance(0.3) {
        builder.line(Kind::Fence, [from, to], side * (near + 2.0), [4.0, 0.06, 1.2]);
    }
    if builder.chance(0.25) {
        let bend = [builder.between(from, to - 40.0), 0.0];
        builder.line(Kind::Rail, [bend[0], bend[0] + 40.0], side * (half + 0.6), [4.0, 0.15, 0.75]);
    }
    let mut x = from;
    while x < to {
        x += step * builder.between(0.7, 1.3);
        let y = side * (near + builder.random.exponential(4.0));
        match builder.random.uniform() {
            chosen if chosen < trees => builder.place(Kind::Tree, [x, y], 0.0),
            chosen if chosen < trees + 0.1 => {
                let size = [builder.between(1.0, 4.0), builder.between(0.8, 2.0), builder.between(0.5, 2.0)];
                builder.put(Kind::Hedge, [x, y], 0.0, size);
            }
            chosen if chosen < trees + 0.2 => {
                builder.put(Kind::Pole, [x, side * near], 0.0, [0.12, 0.12, 1.0])
            }
            chosen if chosen < trees + 0.23 => builder.place(Kind::Sign, [x, side * near], 180.0),
            chosen if chosen < trees + 0.26 => {
                let size =
                    [builder.between(8.0, 20.0), builder.between(7.0, 11.0), builder.between(4.0, 8.0)];
                builder.put(Kind::Building, [x, side * (near + size[1] / 2.0 + 6.0)], 0.0, size);
            }
            _ => {}
        }
    }
}
