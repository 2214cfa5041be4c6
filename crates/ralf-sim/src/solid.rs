//! A body in its place.

use super::bvh::Bounds;
use super::kind::Kind;
use super::shape::{Crossing, Ray, Shape};
use ralf::space::{Point, Vector};

/// A body in its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Solid {
    pub(super) kind: Kind,
    pub(super) object: usize,
    /// Which of the object's bodies it is.
    pub(super) part: usize,
    pub(super) shape: Shape,
    pub(super) center: Point,
    /// Sine of its yaw; the cosine follows.
    pub(super) sin: f64,
    pub(super) cos: f64,
}

impl Solid {
    /// A vector of the site's frame in the body's own.
    pub(super) fn turned_back(&self, v: Vector) -> Vector {
        Vector::new(self.cos * v.x + self.sin * v.y, self.cos * v.y - self.sin * v.x, v.z)
    }

    pub(super) fn turned(&self, v: Vector) -> Vector {
        Vector::new(self.cos * v.x - self.sin * v.y, self.cos * v.y + self.sin * v.x, v.z)
    }

    /// A point of the site's frame in the body's own.
    pub(super) fn local(&self, p: &Point) -> Point {
        Point::from(self.turned_back(p - self.center))
    }

    pub(super) fn crossing(&self, ray: &Ray) -> Option<Crossing> {
        let own = Ray { origin: self.local(&ray.origin), direction: self.turned_back(ray.direction) };
        self.shape.crossing(&own)
    }

    pub(super) fn bounds(&self) -> Bounds {
        let half = self.shape.half_size();
        let [sin, cos] = [self.sin.abs(), self.cos.abs()];
        let reach = Vector::new(cos * half.x + sin * half.y, sin * half.x + cos * half.y, half.z);
        Bounds { low: self.center - reach, high: self.center + reach }
    }
}
