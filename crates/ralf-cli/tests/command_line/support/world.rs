//! A street whose truth is known: a wall to the left, a parked car to the right, flat ground, and what radars make up.

/// SemanticKITTI's building.
pub(crate) const WALL: u16 = 50;
/// SemanticKITTI's car.
pub(crate) const CAR: u16 = 10;
/// SemanticKITTI's road.
const ROAD: u16 = 40;
/// SemanticKITTI's outlier.
pub(crate) const ARTIFACT: u16 = 1;

/// The vehicle drives along x, m/s.
pub(super) const SPEED: f64 = 5.0;

/// A point of the world, m, with its class.
pub(super) type Thing = ([f64; 3], u16);

/// What a LiDAR sees.
pub(super) fn surfaces() -> Vec<Thing> {
    let wall = grid(281, 12).map(|(i, j)| ([-10.0 + 0.25 * i, 10.0, 0.1 + 0.25 * j], WALL));
    let rear = grid(13, 9).map(|(i, j)| ([20.0, -4.0 + 0.15 * i, 0.3 + 0.15 * j], CAR));
    let side = grid(27, 9).map(|(i, j)| ([20.0 + 0.15 * i, -2.2, 0.3 + 0.15 * j], CAR));
    let road = grid(80, 21).map(|(i, j)| ([-20.0 + i, -12.0 + j, 0.0], ROAD));
    wall.chain(rear).chain(side).chain(road).collect()
}

/// What a radar that looks ahead detects in a scan: wall, car, artifacts, and one reflection from below the road.
pub(super) fn seen_ahead(chance: &mut Chance) -> Vec<Thing> {
    let mut things: Vec<Thing> = (0..10).map(|i| ([8.0 + 3.0 * f64::from(i), 10.0, 1.0], WALL)).collect();
    things.extend((0..6).map(|i| ([20.0, -3.9 + 0.3 * f64::from(i), 0.9], CAR)));
    shake(&mut things, chance);
    things.extend((0..9).map(|_| {
        ([chance.between(5.0, 50.0), chance.between(-40.0, -12.0), chance.between(0.5, 2.0)], ARTIFACT)
    }));
    things.push(([25.0, 3.0, -1.5], ARTIFACT));
    things
}

/// What a radar that looks to the left detects: the wall, and artifacts behind it.
pub(super) fn seen_left(chance: &mut Chance) -> Vec<Thing> {
    let mut things: Vec<Thing> = (0..12).map(|i| ([-6.0 + f64::from(i), 10.0, 0.5], WALL)).collect();
    shake(&mut things, chance);
    things.extend((0..8).map(|_| ([chance.between(-20.0, 20.0), chance.between(18.0, 50.0), 0.5], ARTIFACT)));
    things
}

fn shake(things: &mut [Thing], chance: &mut Chance) {
    things.iter_mut().flat_map(|(p, _)| p).for_each(|value| *value += chance.between(-0.03, 0.03));
}

fn grid(columns: i32, rows: i32) -> impl Iterator<Item = (f64, f64)> {
    (0..columns).flat_map(move |i| (0..rows).map(move |j| (f64::from(i), f64::from(j))))
}

/// Numbers that look like chance and are the same every time.
pub(super) struct Chance(pub(super) u64);

impl Chance {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}
