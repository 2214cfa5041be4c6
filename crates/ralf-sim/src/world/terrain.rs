//! The ground: its height everywhere, and what it is covered with.

use crate::ground::Ground;
use crate::random::grain;
use crate::scenario::Ramp;
use crate::shape::Ray;
use crate::truth::Truth;
use ralf::label::Cause;
use ralf::space::{Point, Transform, Vector};

/// What the ground is covered with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Surface {
    Asphalt,
    /// Slabs, cobbles.
    Pavement,
    Gravel,
    /// Plausible by the paper's policy.
    Grass,
}

impl Surface {
    /// SemanticKITTI id of a radar detection.
    pub(super) fn class(self) -> u16 {
        if self == Self::Grass { 72 } else { 1 }
    }

    /// SemanticKITTI id of what a camera sees: other than a radar detection, it may be ground.
    pub(super) fn seen_class(self) -> u16 {
        match self {
            Self::Asphalt => 40,
            Self::Pavement => 48,
            Self::Gravel => 49,
            Self::Grass => self.class(),
        }
    }

    /// What is true of a detection of it.
    pub(super) fn truth(self) -> Truth {
        match self {
            Self::Grass => Truth { class: self.class(), cause: Cause::Plausible },
            _ => Truth::artifact(Cause::Road),
        }
    }
}

/// A rectangle of ground.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patch {
    pub(super) surface: Surface,
    pub(super) center: [f64; 2],
    /// Sine and cosine of its direction.
    pub(super) turn: [f64; 2],
    /// Half its length and width, m.
    pub(super) half: [f64; 2],
    /// Above what lies around it, m: a kerb.
    pub(super) rise: f64,
    /// Height of blades and stones, m.
    pub(super) pile: f64,
    /// What a LiDAR gets back at right angles, 0 to 1.
    pub(super) reflectance: f64,
}

impl Patch {
    /// What lies wherever nothing else does: level and bare.
    pub(super) fn base(surface: Surface, reflectance: f64) -> Self {
        Self {
            surface,
            center: [0.0; 2],
            turn: [0.0, 1.0],
            half: [0.0; 2],
            rise: 0.0,
            pile: 0.0,
            reflectance,
        }
    }

    /// A place in the patch's own frame.
    pub(super) fn own(&self, x: f64, y: f64) -> [f64; 2] {
        let [dx, dy] = [x - self.center[0], y - self.center[1]];
        let [sin, cos] = self.turn;
        [cos * dx + sin * dy, cos * dy - sin * dx]
    }

    /// A place of the patch's own frame in the site's.
    pub(super) fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [sin, cos] = self.turn;
        [self.center[0] + cos * x - sin * y, self.center[1] + sin * x + cos * y]
    }

    pub(super) fn contains(&self, x: f64, y: f64) -> bool {
        let [along, across] = self.own(x, y);
        along.abs() <= self.half[0] && across.abs() <= self.half[1]
    }
}

/// Where a ray meets the ground.
#[derive(Debug, Clone, Copy)]
pub(super) struct GroundHit {
    pub(super) distance: f64,
    pub(super) normal: Vector,
    pub(super) reflectance: f64,
}

/// The ground of a place.
#[derive(Debug)]
pub(super) struct Terrain {
    ground: Ground,
    /// Of several, the last counts.
    patches: Vec<Patch>,
    /// Where no patch is.
    base: Patch,
    seed: u64,
}

impl Terrain {
    pub(super) fn new(ramps: &[Ramp], patches: Vec<Patch>, base: Patch, seed: u64) -> Self {
        Self { ground: Ground::new(ramps), patches, base, seed }
    }

    pub(super) fn patches(&self) -> &[Patch] {
        &self.patches
    }

    pub(super) fn patch(&self, x: f64, y: f64) -> &Patch {
        self.patches.iter().rev().find(|patch| patch.contains(x, y)).unwrap_or(&self.base)
    }

    /// m, in the site's frame, with the kerb.
    pub(super) fn height(&self, x: f64, y: f64) -> f64 {
        self.ground.height(x, y) + self.patch(x, y).rise
    }

    /// How much it rises per metre along x and y.
    pub(super) fn gradient(&self, x: f64, y: f64) -> [f64; 2] {
        self.ground.gradient(x, y)
    }

    /// Whether the ground, kerbs aside, lies between two places.
    pub(super) fn hides(&self, from: &Point, to: &Point) -> bool {
        self.ground.hides(from, to)
    }

    /// The pose of a vehicle that stands on it.
    pub(super) fn pose(&self, place: [f64; 3]) -> Transform {
        self.ground.pose(place)
    }

    /// Where a ray meets it.
    pub(super) fn hit(&self, ray: &Ray, limit: f64) -> Option<GroundHit> {
        // A ray that would just pass may still meet a kerb.
        let at = self.ground.hit(ray, limit + 2.0)?;
        let p = ray.origin + ray.direction * at;
        let normal = self.ground.normal(p.x, p.y);
        let patch = self.patch(p.x, p.y);
        let found =
            |distance: f64, normal: Vector| GroundHit { distance, normal, reflectance: patch.reflectance };
        let above = patch.rise + self.pile(patch, &p);
        let down = (-ray.direction.dot(&normal)).max(1e-3);
        let raised = at - above / down;
        let q = ray.origin + ray.direction * raised.max(0.0);
        let hit = if above <= 0.0 || patch.contains(q.x, q.y) {
            found(raised, normal)
        } else {
            let edge = edge(patch, ray, raised.max(0.0), at);
            let back = -ray.direction.xy().normalize();
            found(edge, Vector::new(back.x, back.y, 0.0))
        };
        (hit.distance > 0.0 && hit.distance < limit).then_some(hit)
    }

    /// Height of a blade or a stone at a place, m.
    fn pile(&self, patch: &Patch, p: &Point) -> f64 {
        if patch.pile <= 0.0 {
            return 0.0;
        }
        let place = [(p.x * 12.0).floor() as i64, (p.y * 12.0).floor() as i64, 0];
        let share = grain(self.seed, place);
        patch.pile * share * share
    }
}

/// Where a ray enters a patch, between a place outside and one inside of it.
fn edge(patch: &Patch, ray: &Ray, mut outside: f64, mut inside: f64) -> f64 {
    for _ in 0..10 {
        let middle = outside.midpoint(inside);
        let p = ray.origin + ray.direction * middle;
        if patch.contains(p.x, p.y) { inside = middle } else { outside = middle }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;

    fn patch(surface: Surface, rise: f64) -> Patch {
        Patch { center: [10.0, 0.0], half: [3.0, 2.0], rise, ..Patch::base(surface, 0.2) }
    }

    #[test]
    fn a_kerb_stands_up_and_has_a_face() {
        let base = Patch::base(Surface::Asphalt, 0.2);
        let terrain = Terrain::new(&[], vec![patch(Surface::Pavement, 0.12)], base, 1);
        let toward = |x: f64, z: f64| Vector::new(x, 0.0, z - 1.0).normalize();
        let ray = |direction| Ray { origin: Point::new(0.0, 0.0, 1.0), direction };
        let top = terrain.hit(&ray(toward(11.0, 0.12)), 50.0).unwrap();
        assert!((top.distance - 11.0_f64.hypot(0.88)).abs() < 1e-9);
        let face = terrain.hit(&ray(toward(7.0, 0.06)), 50.0).unwrap();
        assert!((face.distance - 7.0_f64.hypot(0.94)).abs() < 0.01 && face.normal.x < -0.99);
        let road = terrain.hit(&ray(toward(5.0, 0.0)), 50.0).unwrap();
        assert!((road.distance - 5.0_f64.hypot(1.0)).abs() < 1e-9);
    }
}
