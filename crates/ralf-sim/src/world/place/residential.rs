//! Houses with gardens, hedges and fences.

use super::builder::Builder;
use super::traffic::{Road, on_bicycles, on_foot, on_road};
use crate::kind::Kind;
use crate::world::terrain::Surface;

/// A quiet street among gardens.
pub(super) fn residential(builder: &mut Builder<'_>) {
    builder.plan.title = "residential street";
    let way = builder.drive([0.0, -1.1, 0.0], 6.5);
    let reach = builder.sight(way, [50.0, 160.0]);
    let half = builder.between(2.8, 4.6);
    builder.hills(way);
    for side in [1.0, -1.0] {
        gardens(builder, side, half, reach);
    }
    let road = Road { reach, lanes: vec![-1.1, 1.4], speed: 8.0, cars: 30.0, trucks: 0.1 };
    on_road(builder, &road);
    on_foot(builder, 45.0, reach, half + 0.8);
    on_bicycles(builder, 20.0, reach, 2.2);
}

/// Plot by plot: a verge, an enclosure, a lawn or gravel, a house, a drive with a car.
fn gardens(builder: &mut Builder<'_>, side: f64, half: f64, [from, to]: [f64; 2]) {
    let verge = builder.between(0.3, 3.0);
    let green = builder.chance(0.6);
    let kerb = if builder.chance(0.6) { builder.between(0.03, 0.12) } else { 0.0 };
    let edge = half + verge;
    let surface = if green { Surface::Grass } else { Surface::Pavement };
    builder.cover(surface, [from, to], [side * half, side * edge], kerb);
    let mut x = from;
    while x < to {
        let [width, setback] = [builder.between(12.0, 24.0), builder.between(3.0, 9.0)];
        let lawn = if builder.chance(0.8) { Surface::Grass } else { Surface::Gravel };
        builder.cover(lawn, [x, x + width], [side * edge, side * (edge + setback + 12.0)], 0.0);
        enclosure(builder, side * (edge + 0.3), [x + 3.2, x + width]);
        let size = [builder.between(8.0, width - 3.0), builder.between(7.0, 11.0), builder.between(4.0, 9.0)];
        let at = [x + 3.0 + size[0] / 2.0, side * (edge + setback + size[1] / 2.0)];
        builder.put(Kind::Building, at, 0.0, size);
        if builder.chance(0.55) {
            let y = side * (edge + 2.7 + builder.between(0.0, 2.0));
            builder.place(Kind::Car, [x + 1.6, y], 90.0 * side);
        }
        for _ in 0..builder.random.poisson(1.0) {
            let at = [builder.between(x + 3.5, x + width), side * (edge + builder.between(1.0, setback))];
            let kind = if builder.chance(0.5) { Kind::Tree } else { Kind::Hedge };
            let size = match kind {
                Kind::Tree => builder.size(kind),
                _ => [builder.between(0.7, 2.0), builder.between(0.6, 1.2), builder.between(0.4, 1.4)],
            };
            builder.put(kind, at, 0.0, size);
        }
        parked(builder, x, side * (half - 0.95), width);
        x += width;
    }
}

fn parked(builder: &mut Builder<'_>, x: f64, y: f64, width: f64) {
    if builder.chance(0.3) && y.abs() > 2.9 {
        let at = [x + builder.between(3.0, width - 3.0), y];
        builder.place(Kind::Car, at, if y < 0.0 { 0.0 } else { 180.0 });
    }
    if builder.chance(0.3) {
        builder.place(Kind::Pole, [x, y.signum() * (y.abs() + 1.5)], 0.0);
    }
}

fn enclosure(builder: &mut Builder<'_>, y: f64, reach: [f64; 2]) {
    let height = builder.between(0.6, 1.9);
    match (builder.random.uniform() * 4.0) as usize {
        0 => builder.line(Kind::Hedge, reach, y, [3.0, 0.8, height]),
        1 => builder.line(Kind::Fence, reach, y, [3.0, 0.06, height]),
        2 => builder.line(Kind::Wall, reach, y, [3.0, 0.25, 0.5 * height]),
        _ => {}
    }
}
