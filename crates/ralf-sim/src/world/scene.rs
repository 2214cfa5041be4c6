//! A place, and the same at one moment, as rays and waves meet it.

use super::item::Item;
use super::terrain::{GroundHit, Terrain};
use crate::bvh::{Bounds, Tree};
use crate::kind::Kind;
use crate::shape::{Crossing, Ray};
use crate::solid::Solid;
use nalgebra::Isometry3;
use ralf::space::{Point, Vector};

/// The ground and everything on it.
#[derive(Debug)]
pub(super) struct Site {
    pub(super) terrain: Terrain,
    pub(super) items: Vec<Item>,
    /// At the start.
    poses: Vec<Isometry3<f64>>,
    /// Bodies of what stands.
    solids: Vec<Solid>,
    tree: Tree,
    pub(super) seed: u64,
}

impl Site {
    pub(super) fn new(terrain: Terrain, items: Vec<Item>, seed: u64) -> Self {
        let poses: Vec<Isometry3<f64>> = items.iter().map(|item| item.pose(&terrain, 0.0)).collect();
        let standing = items.iter().enumerate().filter(|(_, item)| !item.moves());
        let solids: Vec<Solid> =
            standing.flat_map(|(index, item)| solids(index, item, &poses[index])).collect();
        let bounds: Vec<Bounds> = solids.iter().map(Solid::bounds).collect();
        Self { tree: Tree::new(&bounds), terrain, items, poses, solids, seed }
    }

    /// After so many seconds.
    pub(super) fn at(&self, seconds: f64) -> Moment<'_> {
        let mut moment = Moment { site: self, seconds, poses: self.poses.clone(), moving: Vec::new() };
        moment.move_to(seconds);
        moment
    }
}

fn solids(index: usize, item: &Item, pose: &Isometry3<f64>) -> Vec<Solid> {
    let (sin, cos) = pose.rotation.euler_angles().2.sin_cos();
    let mut found = Vec::new();
    for (part, (shape, center)) in item.bodies.iter().enumerate() {
        let center = pose * Point::from(*center);
        found.push(Solid { kind: item.kind, object: index, part, shape: *shape, center, sin, cos });
    }
    found
}

/// Where a ray ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit<'a> {
    /// m.
    pub(super) distance: f64,
    /// Outward, in the site's frame.
    pub(super) normal: Vector,
    pub(super) on: Met<'a>,
}

/// What a ray meets.
#[derive(Debug, Clone, Copy)]
pub(super) enum Met<'a> {
    Ground(GroundHit),
    Body(&'a Solid),
}

/// A body that moves, and the ball around it.
#[derive(Debug)]
struct Moving {
    solid: Solid,
    radius: f64,
}

/// A place at one moment.
#[derive(Debug)]
pub(super) struct Moment<'a> {
    pub(super) site: &'a Site,
    /// Since the start.
    pub(super) seconds: f64,
    pub(super) poses: Vec<Isometry3<f64>>,
    moving: Vec<Moving>,
}

impl Moment<'_> {
    /// Moves all that moves to another time.
    pub(super) fn move_to(&mut self, seconds: f64) {
        self.seconds = seconds;
        self.moving.clear();
        for (index, item) in self.site.items.iter().enumerate().filter(|(_, item)| item.moves()) {
            self.poses[index] = item.pose(&self.site.terrain, seconds);
            for solid in solids(index, item, &self.poses[index]) {
                self.moving.push(Moving { radius: solid.shape.half_size().norm(), solid });
            }
        }
    }

    /// The first surface that a ray meets within `limit`, where `stop` says how far a ray comes that meets a body:
    /// `None` passes through.
    pub(super) fn cast(
        &self,
        ray: &Ray,
        limit: f64,
        mut stop: impl FnMut(&Solid, &Crossing) -> Option<f64>,
    ) -> Option<Hit<'_>> {
        let mut nearest: Option<(f64, Vector, &Solid)> = None;
        let mut meet = |solid, limit| match crossing(solid, ray, limit) {
            Some(met) => match stop(solid, &met).filter(|distance| *distance < limit) {
                Some(distance) => {
                    nearest = Some((distance, met.normal, solid));
                    distance
                }
                None => limit,
            },
            None => limit,
        };
        let mut limit =
            self.site.tree.visit(ray, limit, |index, limit| meet(&self.site.solids[index], limit));
        for moving in self.moving.iter().filter(|moving| moving.is_near(ray)) {
            limit = meet(&moving.solid, limit);
        }
        if let Some(hit) = self.site.terrain.hit(ray, limit) {
            return Some(Hit { distance: hit.distance, normal: hit.normal, on: Met::Ground(hit) });
        }
        nearest.map(|(distance, normal, solid)| Hit {
            distance,
            normal: solid.turned(normal),
            on: Met::Body(solid),
        })
    }

    /// What lies between two points takes from a radar wave, there and back, dB; `None` where nothing comes through, as
    /// through the ground. The bodies of `own` don't count.
    pub(super) fn loss_db(&self, from: &Point, to: &Point, own: &[usize], leaf_db: f64) -> Option<f64> {
        let way = to - from;
        let length = way.norm();
        if length < 1e-6 {
            return Some(0.0);
        }
        if self.site.terrain.hides(from, to) {
            return None;
        }
        let ray = Ray { origin: *from, direction: way / length };
        let mut loss = Some(0.0);
        let mut meet = |solid: &Solid, limit: f64| {
            if !own.contains(&solid.object)
                && let Some(met) = crossing(solid, &ray, length - 0.05)
            {
                loss = loss
                    .zip(through_db(solid.kind, met.leave.min(length) - met.enter, leaf_db))
                    .map(|(a, b)| a + b);
            }
            if loss.is_some() { limit } else { 0.0 }
        };
        self.site.tree.visit(&ray, length, |index, limit| meet(&self.site.solids[index], limit));
        for moving in self.moving.iter().filter(|moving| moving.is_near(&ray)) {
            meet(&moving.solid, length);
        }
        loss
    }
}

impl Moving {
    fn is_near(&self, ray: &Ray) -> bool {
        ray.passes(&self.solid.center, self.radius)
    }
}

fn crossing(solid: &Solid, ray: &Ray, limit: f64) -> Option<Crossing> {
    solid.crossing(ray).filter(|met| met.enter < limit)
}

/// What so many metres of a thing take, there and back, dB. Waves find their way around and under cars.
fn through_db(kind: Kind, metres: f64, leaf_db: f64) -> Option<f64> {
    match kind {
        Kind::Building | Kind::Garage | Kind::Bridge | Kind::Container => None,
        // Over its top edge waves are bent.
        Kind::Wall => Some(25.0),
        Kind::Truck => Some(14.0),
        Kind::Car => Some(8.0),
        Kind::Tree | Kind::Hedge => Some(leaf_db * metres),
        Kind::Rail | Kind::Sign | Kind::Fence | Kind::Cyclist => Some(3.0),
        Kind::Pedestrian => Some(5.0),
        Kind::Pole => Some(1.0),
        Kind::Grass | Kind::Sidewalk | Kind::Road | Kind::Marking => Some(0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Ramp;
    use crate::world::terrain::{Patch, Surface};

    #[test]
    fn nothing_is_heard_through_a_crest() {
        let ramp = |x: f64, slope_deg| Ramp { at: [x, 0.0], direction_deg: 0.0, length: 20.0, slope_deg };
        let base = Patch::base(Surface::Asphalt, 0.2);
        let terrain = Terrain::new(&[ramp(10.0, 6.0), ramp(30.0, -6.0)], Vec::new(), base, 1);
        let site = Site::new(terrain, Vec::new(), 1);
        let loss = |height: f64| {
            let [from, to] = [Point::new(0.0, 0.0, 0.6), Point::new(60.0, 0.0, height)];
            site.at(0.0).loss_db(&from, &to, &[], 1.0)
        };
        assert_eq!([loss(0.5), loss(5.0)], [None, Some(0.0)]);
    }
}
