//! What reflects radar waves: points of objects that persist from scan to scan, each with its strength and its flicker.

use super::kind::{DECK, Kind};
use super::random::Random;
use ralf::space::{Point, Vector};

/// A point that reflects.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scatterer {
    /// In the object's frame.
    pub(super) position: Point,
    /// Where it is seen from; `None` from everywhere.
    pub(super) normal: Option<Vector>,
    /// dBsm.
    pub(super) strength_db: f64,
    /// Standard deviation of its strength from scan to scan, dB.
    pub(super) flicker_db: f64,
    /// Whether it lies behind a facade: an artifact by the paper's policy.
    pub(super) behind_facade: bool,
}

impl Scatterer {
    fn new(position: [f64; 3], strength_db: f64, flicker_db: f64) -> Self {
        let position = Point::from(position);
        Self { position, normal: None, strength_db, flicker_db, behind_facade: false }
    }
}

/// The scatterers of an object of a kind and size, in its own frame.
pub(super) fn scatterers(kind: Kind, size: Vector, random: &mut Random) -> Vec<Scatterer> {
    let [length, width, height] = size.into();
    let (l, w) = (length / 2.0, width / 2.0);
    let per = |density: f64, extent: f64| (density * extent).ceil() as usize;
    match kind {
        Kind::Car | Kind::Truck => car(l, w, height, random),
        Kind::Building => facades(l, w, height, 1.0, random),
        Kind::Garage => garage(l, w, height, random),
        Kind::Pole => {
            let count = (height / 0.7).clamp(2.0, 5.0) as usize;
            let step = (height / count as f64).min(0.7);
            (0..count).map(|i| Scatterer::new([0.0, 0.0, step * (0.4 + i as f64)], 5.0, 3.0)).collect()
        }
        Kind::Container => outer_walls(l, w, height, random),
        Kind::Cyclist | Kind::Sign | Kind::Rail | Kind::Wall => slender(size, random),
        Kind::Pedestrian => scattered(4, [l, w], [0.3, 0.9 * height], 0.0, 5.0, random),
        Kind::Tree => {
            let trunk = scattered(4, [0.12, 0.12], [0.2, 0.4 * height], 1.0, 4.0, random);
            let (leaves, sides) = (per(1.2, l * w * height), [0.8 * l, 0.8 * w]);
            let crown = scattered(leaves, sides, [0.35 * height, 0.7 * height], -5.0, 7.0, random);
            [trunk, crown].concat()
        }
        Kind::Hedge => scattered(per(7.0, length), [l, w], [0.2, height], -3.0, 6.0, random),
        Kind::Bridge => {
            scattered(per(0.3, length * width), [l, w], [height - DECK, height], 0.0, 5.0, random)
        }
        Kind::Fence => scattered(per(6.0, length), [l, w], [0.15, height], -1.0, 4.0, random),
        Kind::Grass => {
            scattered(per(0.5, length * width), [l, w], [0.03, height.max(0.22)], -9.0, 6.0, random)
        }
        Kind::Sidewalk => kerb(per(0.6, length), l, w, height, random),
        Kind::Road | Kind::Marking => Vec::new(),
    }
}

/// What stands by itself and is seen from everywhere.
fn slender(size: Vector, random: &mut Random) -> Vec<Scatterer> {
    let count = (1.5 * size.x).ceil() as usize + 3;
    scattered(count, [size.x / 2.0, size.y / 2.0], [0.3, 0.9 * size.z], 2.0, 4.0, random)
}

/// Anywhere within a box of half this length and width, between these heights, with a mean strength and a flicker.
fn scattered(
    count: usize,
    [l, w]: [f64; 2],
    [low, high]: [f64; 2],
    strength_db: f64,
    flicker_db: f64,
    random: &mut Random,
) -> Vec<Scatterer> {
    let mut one = || {
        let position = [random.between(-l, l), random.between(-w, w), random.between(low, high)];
        Scatterer::new(position, strength_db + random.normal(3.0), flicker_db)
    };
    (0..count).map(|_| one()).collect()
}

/// Corners and wheels shine, the rest less; waves also find what lies inside.
fn car(l: f64, w: f64, height: f64, random: &mut Random) -> Vec<Scatterer> {
    let mut found = Vec::new();
    let mut outside = |x: f64, y: f64, z: f64, strength: f64, random: &mut Random| {
        let normal = Vector::new(x / l, y / w, 0.0).try_normalize(1e-6);
        let position = [x, y, z + random.normal(0.08)];
        found.push(Scatterer { normal, ..Scatterer::new(position, strength + random.normal(3.0), 3.0) });
    };
    for (sx, sy) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        outside(sx * l, sy * 0.9 * w, 0.5, 9.0, random);
        outside(sx * 0.62 * l, sy * w, 0.3, 6.0, random);
        outside(sx * 0.25 * l, sy * w, 0.7, 3.0, random);
    }
    outside(l, 0.0, 0.45, 7.0, random);
    outside(-l, 0.0, 0.55, 8.0, random);
    outside(0.3 * l, w, 0.95, 2.0, random);
    outside(0.3 * l, -w, 0.95, 2.0, random);
    // Near by, doors, sills, mirrors and handles are seen each by itself.
    for _ in 0..14 {
        for side in [1.0, -1.0] {
            outside(random.between(-0.9, 0.9) * l, side * w, random.between(0.25, 0.85), -3.0, random);
        }
        let end = if random.chance(0.5) { 1.0 } else { -1.0 };
        outside(end * l, random.between(-0.85, 0.85) * w, random.between(0.3, 0.75), -2.0, random);
    }
    found.extend(scattered(6, [0.8 * l, 0.7 * w], [0.35, 0.8 * height], -3.0, 4.0, random));
    found
}

/// Four walls turned outward (`side` 1) or inward (-1), and what is behind them.
fn facades(l: f64, w: f64, height: f64, side: f64, random: &mut Random) -> Vec<Scatterer> {
    let mut found = Vec::new();
    let top = (height - 0.2).min(4.5);
    for (outward, distance, half) in
        [(Vector::x(), l, w), (-Vector::x(), l, w), (Vector::y(), w, l), (-Vector::y(), w, l)]
    {
        let along = Vector::new(-outward.y, outward.x, 0.0);
        let mut one = |depth: f64, strength_db: f64, flicker_db: f64, behind_facade| {
            let place = outward * (distance - side * depth) + along * random.between(-half, half);
            let position = [place.x, place.y, random.between(0.2, top)];
            let strength_db = strength_db + random.normal(4.0);
            let normal = Some(outward * side);
            found.push(Scatterer {
                normal,
                behind_facade,
                ..Scatterer::new(position, strength_db, flicker_db)
            });
        };
        let count = (half * 5.0).ceil() as usize;
        (0..count).for_each(|_| one(0.0, 3.0, 4.0, false));
        // Rooms: the farther in, the weaker.
        (0..count).for_each(|i| {
            let depth = 0.5 + 6.5 * (i as f64 + 0.5) / count as f64;
            one(depth, 3.0 - 0.6 * depth, 5.0, true);
        });
    }
    found
}

/// Three walls that are seen from their inside, too: the front is open.
fn garage(l: f64, w: f64, height: f64, random: &mut Random) -> Vec<Scatterer> {
    let mut found = Vec::new();
    for (side, within) in [(1.0, 0.0), (-1.0, 0.25)] {
        let walls = facades(l - within, w - within, height, side, random);
        let is_front = |wall: &Scatterer| wall.normal.is_some_and(|normal| side * normal.x > 0.5);
        found.extend(walls.into_iter().filter(|wall| !wall.behind_facade && !is_front(wall)));
    }
    found
}

/// The same without anything inside.
fn outer_walls(l: f64, w: f64, height: f64, random: &mut Random) -> Vec<Scatterer> {
    let walls = facades(l, w, height, 1.0, random);
    walls.into_iter().filter(|scatterer| !scatterer.behind_facade).collect()
}

/// Along the edges of a sidewalk.
fn kerb(count: usize, l: f64, w: f64, height: f64, random: &mut Random) -> Vec<Scatterer> {
    let mut one = |side: f64| {
        let position = [random.between(-l, l), side * w, random.between(0.3, 1.0) * height];
        Scatterer::new(position, random.normal(3.0) - 4.0, 5.0)
    };
    (0..count).flat_map(|_| [one(1.0), one(-1.0)]).collect()
}
