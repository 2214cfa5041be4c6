//! What of a thing reflects radar waves, and how strongly.
//!
//! Cross-sections are those of the parts that a radar of 77 GHz tells apart, in dBsm. Of whole things literature has:
//! cars 0 to 20 with 10 in the middle (Suzuki et al. 2000; Kamel et al. 2017), lorries 15 to 35, people -8 with a
//! spread of 5 (Fortuny-Guasch and Chareau 2013; ISO 19206-2), cyclists -3 to 5 (ISO 19206-4), poles 0 to 10.

mod people;
mod walls;

pub(super) use walls::{Wall, walls};

use crate::kind::{DECK, Kind};
use crate::random::Random;
use ralf::space::{Point, Vector};

/// A point that reflects.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reflector {
    /// In the thing's frame.
    pub(super) at: Point,
    /// Where it is seen from; `None` from everywhere.
    pub(super) facing: Option<Vector>,
    /// dBsm.
    pub(super) strength_db: f64,
    /// How much it varies with the aspect, dB.
    pub(super) spread_db: f64,
    /// Behind a facade: an artifact by the paper's policy.
    pub(super) inside: bool,
    /// How fast it turns or swings along with the thing's motion, as a share of it: a wheel, a leg.
    pub(super) swing: f64,
    /// How fast it moves by itself, m/s: nobody stands still.
    pub(super) sway: f64,
}

/// A heap of parts in the making.
struct Parts<'a> {
    found: Vec<Reflector>,
    random: &'a mut Random,
}

impl Parts<'_> {
    fn put(
        &mut self,
        at: [f64; 3],
        facing: Option<Vector>,
        strength_db: f64,
        spread_db: f64,
    ) -> &mut Reflector {
        let strength_db = strength_db + self.random.normal(2.5);
        self.found.push(Reflector {
            at: Point::from(at),
            facing,
            strength_db,
            spread_db,
            inside: false,
            swing: 0.0,
            sway: 0.0,
        });
        let last = self.found.len() - 1;
        &mut self.found[last]
    }

    /// Anywhere within a box.
    fn scatter(
        &mut self,
        count: usize,
        [l, w]: [f64; 2],
        [low, high]: [f64; 2],
        strength_db: f64,
        spread_db: f64,
    ) {
        for _ in 0..count {
            let random = &mut self.random;
            let at = [random.between(-l, l), random.between(-w, w), random.between(low, high)];
            let level = strength_db + self.random.normal(3.0);
            self.put(at, None, level, spread_db);
        }
    }
}

/// The reflectors of a thing of a kind and size, in its own frame.
pub(super) fn reflectors(kind: Kind, size: Vector, random: &mut Random) -> Vec<Reflector> {
    let (l, w, height) = (size.x / 2.0, size.y / 2.0, size.z);
    let mut parts = Parts { found: Vec::new(), random };
    match kind {
        Kind::Car => car(l, w, height, &mut parts),
        Kind::Truck => truck(l, w, height, &mut parts),
        Kind::Building | Kind::Garage => building(l, w, height, &mut parts),
        Kind::Container => box_of_metal(l, w, height, &mut parts),
        Kind::Pedestrian => people::on_foot(w, height, &mut parts),
        Kind::Cyclist => people::on_bicycle(l, w, height, &mut parts),
        Kind::Tree | Kind::Hedge => leaves(kind, size, &mut parts),
        Kind::Pole | Kind::Sign => post(kind, [l, w], height, &mut parts),
        Kind::Fence | Kind::Rail | Kind::Wall => barrier(kind, l, w, height, &mut parts),
        Kind::Bridge => deck(l, w, height, &mut parts),
        Kind::Grass | Kind::Sidewalk | Kind::Road | Kind::Marking => {}
    }
    parts.found
}

/// So many on a stretch or in a room.
fn per(density: f64, extent: f64) -> usize {
    (density * extent).ceil() as usize
}

fn leaves(kind: Kind, size: Vector, parts: &mut Parts<'_>) {
    let (l, w, height) = (size.x / 2.0, size.y / 2.0, size.z);
    if kind == Kind::Hedge {
        return parts.scatter(per(8.0, l), [l, w], [0.15, height], -8.0, 5.0);
    }
    parts.scatter(4, [0.15, 0.15], [0.3, 0.4 * height], -2.0, 3.0);
    let crown = per(0.35, size.product()).min(60);
    parts.scatter(crown, [0.85 * l, 0.85 * w], [0.35 * height, 0.9 * height], -9.0, 5.0);
}

fn post(kind: Kind, [l, w]: [f64; 2], height: f64, parts: &mut Parts<'_>) {
    if kind == Kind::Sign {
        parts.put([l, 0.0, height - 0.8 * w], Some(Vector::x()), 8.0, 5.0);
        return parts.scatter(2, [l, w], [0.3, height], -4.0, 3.0);
    }
    parts.scatter(per(1.0, height).min(5), [l, w], [0.2, height.min(3.5)], -1.0, 3.0);
}

/// Posts shine at any angle; what runs along does at right angles, see [`walls`].
fn barrier(kind: Kind, l: f64, w: f64, height: f64, parts: &mut Parts<'_>) {
    match kind {
        Kind::Fence => {
            let posts = per(0.8, l);
            for i in 0..posts {
                let x = -l + (i as f64 + 0.5) * 2.0 * l / posts as f64;
                parts.put([x, 0.0, 0.6 * height], None, 0.0, 4.0);
            }
            parts.scatter(per(4.0, l), [l, w], [0.1, height], -8.0, 5.0);
        }
        Kind::Rail => {
            for x in [-0.5 * l, 0.5 * l] {
                parts.put([x, 0.0, 0.55], None, 2.0, 4.0);
            }
            parts.scatter(per(1.0, l), [l, w], [0.45, height], -6.0, 5.0);
        }
        _ => parts.scatter(per(2.4, l), [l, w], [0.2, height], -6.0, 5.0),
    }
}

/// Its edges, and beams, lamps, pipes and signs below it: what hangs there is made of corners.
fn deck(l: f64, w: f64, height: f64, parts: &mut Parts<'_>) {
    for end in [1.0, -1.0] {
        for _ in 0..per(1.6, w) {
            let (y, z) = (parts.random.between(-w, w), height - DECK * parts.random.uniform());
            parts.put([end * l, y, z], Some(Vector::new(end, 0.0, 0.0)), 0.0, 5.0);
        }
    }
    let below = height - DECK;
    parts.scatter(per(0.4, l * w), [l, w], [below - 0.4, below], -2.0, 5.0);
}

/// Corners and wheels shine, the rest less; waves also find what lies inside.
fn car(l: f64, w: f64, height: f64, parts: &mut Parts<'_>) {
    let outward = |x: f64, y: f64| Vector::new(x / l, y / w, 0.0).try_normalize(1e-6);
    for (sx, sy) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let (x, y) = (sx * l, sy * 0.9 * w);
        parts.put([x, y, 0.5], outward(x, y), 5.0, 4.0);
        parts.put([sx * 0.62 * l, sy * w, 0.3], outward(0.0, sy * w), 1.0, 4.0).swing = 1.0;
        parts.put([sx * 0.25 * l, sy * w, 0.7], outward(0.0, sy * w), -3.0, 5.0);
        parts.put([0.3 * l, sy * w, 0.95], outward(0.0, sy * w), -4.0, 5.0);
    }
    parts.put([l, 0.0, 0.45], outward(l, 0.0), 5.0, 5.0);
    parts.put([-l, 0.0, 0.6], outward(-l, 0.0), 7.0, 5.0);
    for _ in 0..8 {
        for side in [1.0, -1.0] {
            let random = &mut parts.random;
            let (x, z) = (random.between(-0.9, 0.9) * l, random.between(0.25, 0.85));
            parts.put([x, side * w, z], outward(0.0, side * w), -9.0, 5.0);
        }
        let end = if parts.random.chance(0.5) { l } else { -l };
        let (y, z) = (parts.random.between(-0.85, 0.85) * w, parts.random.between(0.3, 0.75));
        parts.put([end, y, z], outward(end, 0.0), -7.0, 5.0);
    }
    // Seats, wheel, engine: through glass and under the floor.
    parts.scatter(6, [0.75 * l, 0.7 * w], [0.3, 0.8 * height], -8.0, 5.0);
}

fn truck(l: f64, w: f64, height: f64, parts: &mut Parts<'_>) {
    let top = height.min(3.0);
    for (sx, sy) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let facing = Vector::new(sx, sy, 0.0).normalize();
        for z in [0.6, 1.3] {
            parts.put([sx * l, sy * w, z], Some(facing), 9.0, 5.0);
        }
        for x in [0.3, 0.7] {
            parts.put([sx * x * l, sy * w, 0.5], Some(Vector::new(0.0, sy, 0.0)), 5.0, 5.0).swing = 1.0;
        }
    }
    for _ in 0..(3.0 * l) as usize {
        let side = if parts.random.chance(0.5) { 1.0 } else { -1.0 };
        let (x, z) = (parts.random.between(-l, l), parts.random.between(0.3, top));
        parts.put([x, side * w, z], Some(Vector::new(0.0, side, 0.0)), -2.0, 5.0);
    }
    for end in [1.0, -1.0] {
        for _ in 0..4 {
            let (y, z) = (parts.random.between(-w, w), parts.random.between(0.4, top));
            parts.put([end * l, y, z], Some(Vector::new(end, 0.0, 0.0)), 4.0, 5.0);
        }
    }
    // The underbody.
    parts.scatter(8, [0.9 * l, 0.7 * w], [0.3, 0.9], -3.0, 5.0);
}

/// Four outward directions with their distance and half the width across.
fn sides(l: f64, w: f64) -> [(Vector, f64, f64); 4] {
    [(Vector::x(), l, w), (-Vector::x(), l, w), (Vector::y(), w, l), (-Vector::y(), w, l)]
}

/// Four facades with their reveals and corners, and rooms behind.
fn building(l: f64, w: f64, height: f64, parts: &mut Parts<'_>) {
    let top = (height - 0.2).min(7.0);
    for (outward, distance, half) in sides(l, w) {
        let along = Vector::new(-outward.y, outward.x, 0.0);
        let count = (half * 5.0).ceil() as usize;
        for i in 0..2 * count {
            let inside = i >= count;
            let share = (i - if inside { count } else { 0 }) as f64 / count as f64;
            let depth = if inside { 0.6 + 6.0 * share.min(distance / 4.0) } else { 0.0 };
            let place = outward * (distance - depth) + along * parts.random.between(-half, half);
            let z = parts.random.between(0.2, top);
            // Balconies, window reveals and drain pipes are corners, and so are shelves and radiators: few, and strong.
            let corner = parts.random.chance(0.12);
            let level = if corner { 8.0 } else { -4.0 } + if inside { 3.0 } else { 0.0 };
            parts.put([place.x, place.y, z], Some(outward), level, 5.0).inside = inside;
        }
    }
}

fn box_of_metal(l: f64, w: f64, height: f64, parts: &mut Parts<'_>) {
    for (outward, distance, half) in sides(l, w) {
        let along = Vector::new(-outward.y, outward.x, 0.0);
        for _ in 0..(half * 3.0).ceil() as usize {
            let place = outward * distance + along * parts.random.between(-half, half);
            let z = parts.random.between(0.1, height.min(3.0));
            parts.put([place.x, place.y, z], Some(outward), 0.0, 6.0);
        }
        for end in [-half, half] {
            let place = outward * distance + along * end;
            parts.put([place.x, place.y, 0.15], Some(outward), 7.0, 5.0);
        }
    }
}
