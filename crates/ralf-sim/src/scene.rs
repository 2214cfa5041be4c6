//! The site at one moment, as rays see it.

use super::bvh::{Bounds, Tree};
use super::kind::Kind;
use super::shape::{Crossing, Ray};
use super::site::Site;
use super::solid::Solid;
use nalgebra::Isometry3;
use ralf::space::{Point, Vector};

/// Where a ray ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit<'a> {
    /// m.
    pub(super) distance: f64,
    /// Outward, in the site's frame.
    pub(super) normal: Vector,
    /// `None` is the ground.
    pub(super) solid: Option<&'a Solid>,
}

impl Hit<'_> {
    pub(super) fn kind(&self) -> Kind {
        self.solid.map_or(Kind::Road, |solid| solid.kind)
    }
}

/// The site at one moment.
#[derive(Debug)]
pub(super) struct Scene<'a> {
    pub(super) site: &'a Site,
    /// Where each object is.
    pub(super) poses: Vec<Isometry3<f64>>,
    /// How each object moves, m/s.
    pub(super) velocities: Vec<Vector>,
    solids: Vec<Solid>,
    tree: Tree,
}

impl<'a> Scene<'a> {
    /// After so many seconds.
    pub(super) fn new(site: &'a Site, seconds: f64) -> Self {
        let (ground, objects) = (&site.ground, &site.objects);
        let poses: Vec<Isometry3<f64>> = objects.iter().map(|object| object.pose(ground, seconds)).collect();
        let velocities = objects.iter().map(|object| object.velocity(ground, seconds)).collect();
        let solids: Vec<Solid> = objects
            .iter()
            .zip(&poses)
            .enumerate()
            .flat_map(|(index, (object, pose))| {
                let (sin, cos) = pose.rotation.euler_angles().2.sin_cos();
                object.bodies.iter().enumerate().map(move |(part, (shape, center))| Solid {
                    kind: object.kind,
                    object: index,
                    part,
                    shape: *shape,
                    center: pose * Point::from(*center),
                    sin,
                    cos,
                })
            })
            .collect();
        let bounds: Vec<Bounds> = solids.iter().map(Solid::bounds).collect();
        Self { site, poses, velocities, tree: Tree::new(&bounds), solids }
    }

    /// The first surface that a ray meets within `limit`.
    pub(super) fn cast(&self, ray: &Ray, limit: f64) -> Option<Hit<'_>> {
        self.cast_through(ray, limit, |_, crossing| Some(crossing.enter))
    }

    /// The same, where `stop` says how far a ray comes that meets a body: `None` passes through.
    pub(super) fn cast_through(
        &self,
        ray: &Ray,
        limit: f64,
        mut stop: impl FnMut(Kind, &Crossing) -> Option<f64>,
    ) -> Option<Hit<'_>> {
        let mut nearest: Option<(f64, Vector, &Solid)> = None;
        self.tree.visit(ray, limit, |index, limit| {
            let solid = &self.solids[index];
            let Some(crossing) = solid.crossing(ray).filter(|crossing| crossing.enter < limit) else {
                return limit;
            };
            match stop(solid.kind, &crossing).filter(|distance| *distance < limit) {
                Some(distance) => {
                    nearest = Some((distance, crossing.normal, solid));
                    distance
                }
                None => limit,
            }
        });
        let limit = nearest.map_or(limit, |(distance, ..)| distance);
        if let Some(distance) = self.site.ground.hit(ray, limit) {
            let p = ray.origin + ray.direction * distance;
            return Some(Hit { distance, normal: self.site.ground.normal(p.x, p.y), solid: None });
        }
        nearest.map(|(distance, normal, solid)| Hit {
            distance,
            normal: solid.turned(normal),
            solid: Some(solid),
        })
    }

    /// What lies between two points takes from a radar wave, dB; `None` where nothing comes through, as through the
    /// ground. The bodies of the object at the way's end, `own`, don't count, unless one looks into it.
    pub(super) fn radar_loss_db(&self, from: &Point, to: &Point, own: Option<usize>) -> Option<f64> {
        let way = to - from;
        let length = way.norm();
        if length < 1e-6 {
            return Some(0.0);
        }
        if self.site.ground.hides(from, to) {
            return None;
        }
        let own = own.filter(|own| self.site.objects[*own].kind != Kind::Garage);
        let ray = Ray { origin: *from, direction: way / length };
        let mut loss = Some(0.0);
        self.tree.visit(&ray, length, |index, limit| {
            let solid = &self.solids[index];
            if own == Some(solid.object) || solid.kind.is_flat() {
                return limit;
            }
            if solid.crossing(&ray).is_some_and(|crossing| crossing.enter < length - 0.05) {
                loss = loss.zip(solid.kind.radar_loss_db()).map(|(sum, more)| sum + more);
            }
            if loss.is_some() { limit } else { 0.0 }
        });
        loss
    }
}
