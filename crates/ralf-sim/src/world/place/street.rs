//! Streets between buildings, and where two of them cross.

use super::builder::Builder;
use super::traffic::{Road, on_bicycles, on_foot, on_road};
use crate::kind::Kind;
use crate::world::terrain::Surface;

/// What usually moves in a kilometre of a lane.
const CARS_IN_LANE: f64 = 30.0;

/// What a street is like across.
struct Profile {
    /// Half the roadway's width, with the cars that park on it, m.
    road: f64,
    /// Centre lines of its lanes, m.
    lanes: Vec<f64>,
    /// Width of the sidewalk, m.
    walk: f64,
    /// Height of the kerb, m.
    kerb: f64,
}

impl Profile {
    /// What traffic makes of it, usually so fast (m/s).
    fn roadway(&self, reach: [f64; 2], speed: f64) -> Road {
        let cars = CARS_IN_LANE * self.lanes.len() as f64;
        Road { reach, lanes: self.lanes.clone(), speed, cars, trucks: 0.1 }
    }
}

/// A street between buildings, with parked cars.
pub(super) fn street(builder: &mut Builder<'_>) {
    builder.plan.title = "street";
    let way = builder.drive([0.0, -1.7, 0.0], 9.0);
    let profile = profile(builder);
    let reach = builder.sight(way, [60.0, 220.0]);
    builder.hills(way);
    for side in [1.0, -1.0] {
        flank(builder, &profile, side, reach, None);
    }
    on_road(builder, &profile.roadway(reach, 10.0));
    on_foot(builder, 60.0, reach, profile.road + 1.0);
    on_bicycles(builder, 12.0, reach, 3.2);
}

/// Two streets that cross.
pub(super) fn crossing(builder: &mut Builder<'_>) {
    builder.plan.title = "crossing";
    let way = builder.drive([0.0, -1.7, 0.0], 7.0);
    let profile = profile(builder);
    let reach = builder.sight(way, [50.0, 200.0]);
    let at = (0.6 * way).max(builder.between(8.0, 30.0));
    let half = profile.road + profile.walk + 1.0;
    builder.hills(way);
    for side in [1.0, -1.0] {
        flank(builder, &profile, side, reach, Some([at - half, at + half]));
        corner(builder, at, side, &profile);
    }
    crossing_traffic(builder, at);
    on_road(builder, &profile.roadway(reach, 7.0));
    on_foot(builder, 120.0, [at - 30.0, at + 30.0], profile.road + 1.0);
    on_bicycles(builder, 12.0, reach, 3.2);
    if way < 5.0 {
        return;
    }
    // Straight on, or around the corner.
    let turn_deg = [0.0, 0.0, 85.0, -85.0][(builder.random.uniform() * 4.0) as usize];
    let straight = (at - 6.0).max(1.0);
    let leg = |length: f64, turn_deg: f64| crate::scenario::Leg { length, turn_deg };
    builder.plan.drive.legs = vec![leg(straight, 0.0), leg(11.0, turn_deg)];
}

fn profile(builder: &mut Builder<'_>) -> Profile {
    let wide = builder.chance(0.35);
    Profile {
        road: if wide { builder.between(8.0, 13.0) } else { builder.between(4.2, 7.5) },
        lanes: if wide { vec![-5.2, -1.7, 1.7, 5.2] } else { vec![-1.7, 1.7] },
        walk: builder.between(1.5, 4.0),
        kerb: if builder.chance(0.85) { builder.between(0.04, 0.16) } else { 0.0 },
    }
}

/// Everything on one side: parked cars, sidewalk, trees and poles, buildings. Nothing stands in the gap.
fn flank(
    builder: &mut Builder<'_>,
    profile: &Profile,
    side: f64,
    [from, to]: [f64; 2],
    gap: Option<[f64; 2]>,
) {
    let free = |x: f64, half: f64| gap.is_none_or(|[a, b]| x + half < a || x - half > b);
    let inner = side * profile.road;
    let outer = side * (profile.road + profile.walk);
    for [a, b] in gap.map_or(vec![[from, to]], |[a, b]| vec![[from, a], [b, to]]) {
        builder.cover(Surface::Pavement, [a, b], [inner, outer], profile.kerb);
        if builder.chance(0.35) {
            builder.cover(Surface::Grass, [a, b], [inner, inner + side * 1.2], profile.kerb);
        }
    }
    let parked = builder.between(0.2, 0.9);
    let mut x = from;
    while x < to {
        x += builder.between(5.2, 7.0);
        if free(x, 4.0) && builder.chance(parked) && profile.road > 5.4 {
            let yaw = if builder.chance(0.8) == (side < 0.0) { 0.0 } else { 180.0 };
            let y = side * (profile.road - 1.05) + builder.normal(0.1);
            let yaw = yaw + builder.normal(1.5);
            builder.place(Kind::Car, [x, y], yaw);
        }
    }
    furniture(builder, side * (profile.road + 0.6), [from, to], &free);
    let setback = side * (profile.road + profile.walk + builder.between(0.0, 10.0));
    buildings(builder, setback, side, [from, to], &free);
}

/// Trees, lamps, signs, bollards and cabinets along the kerb.
fn furniture(builder: &mut Builder<'_>, y: f64, [from, to]: [f64; 2], free: &dyn Fn(f64, f64) -> bool) {
    let [trees, step] = [builder.between(0.0, 0.6), builder.between(7.0, 14.0)];
    let mut x = from;
    while x < to {
        x += step * builder.between(0.8, 1.2);
        if !free(x, 1.0) {
            continue;
        }
        let at = [x, y + builder.normal(0.1)];
        match builder.random.uniform() {
            chosen if chosen < trees => builder.place(Kind::Tree, at, 0.0),
            chosen if chosen < trees + 0.2 => builder.place(Kind::Pole, at, 0.0),
            chosen if chosen < trees + 0.3 => builder.place(Kind::Sign, at, 180.0),
            chosen if chosen < trees + 0.35 => builder.put(Kind::Container, at, 0.0, [0.9, 0.45, 1.2]),
            chosen if chosen < trees + 0.45 => builder.put(Kind::Pole, at, 0.0, [0.12, 0.12, 0.95]),
            chosen if chosen < trees + 0.5 => builder.put(Kind::Hedge, at, 0.0, [3.0, 0.8, 0.7]),
            _ => {}
        }
    }
}

fn buildings(
    builder: &mut Builder<'_>,
    y: f64,
    side: f64,
    [from, to]: [f64; 2],
    free: &dyn Fn(f64, f64) -> bool,
) {
    let closed = builder.chance(0.5);
    let mut x = from;
    while x < to {
        let [length, depth] = [builder.between(9.0, 24.0), builder.between(8.0, 13.0)];
        let height = builder.between(4.0, 16.0);
        let middle = x + length / 2.0;
        if free(middle, length / 2.0) && builder.chance(0.88) {
            let back = builder.between(0.0, if closed { 0.4 } else { 3.0 });
            builder.put(
                Kind::Building,
                [middle, y + side * (back + depth / 2.0)],
                0.0,
                [length, depth, height],
            );
        }
        x += length + if closed { 0.05 } else { builder.between(0.5, 7.0) };
    }
}

/// The corners of a crossing along the other street, with what stands there.
fn corner(builder: &mut Builder<'_>, at: f64, side: f64, profile: &Profile) {
    let beside = profile.road + 0.8;
    for x in [at - beside, at + beside] {
        builder.place(Kind::Sign, [x, side * beside], 180.0);
        builder.put(Kind::Pole, [x, side * (beside + 0.9)], 0.0, [0.16, 0.16, 3.4]);
        // Cars that park in the other street.
        for number in 0..3 {
            let y = side * (profile.road + 9.0 + 6.3 * f64::from(number));
            if builder.chance(0.5) {
                builder.place(Kind::Car, [x + (at - x).signum() * 1.8, y], 90.0);
            }
        }
    }
}

/// What drives across, and what waits or turns.
fn crossing_traffic(builder: &mut Builder<'_>, at: f64) {
    for _ in 0..builder.traffic(4.0) {
        let up = builder.chance(0.5);
        let (x, yaw) = if up { (at + 1.7, 90.0) } else { (at - 1.7, -90.0) };
        let distance = builder.between(10.0, 60.0);
        let y = if up { -distance } else { distance };
        let speed = if builder.chance(0.3) { 0.0 } else { builder.between(3.0, 12.0) };
        builder.send(Kind::Car, [x, y], yaw, speed, 0.0);
    }
    if builder.chance(0.5) {
        let speed = builder.between(3.0, 7.0);
        builder.send(Kind::Car, [at + 22.0, 1.7], 180.0, speed, builder_turn(speed));
    }
}

/// Turn rate on a wide circle at a speed, rad/s.
fn builder_turn(speed: f64) -> f64 {
    speed / 25.0
}
