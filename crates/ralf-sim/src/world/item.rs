//! A thing of a world: what rays meet, what reflects waves, what mirrors them, and how it moves.

use super::reflector::{Reflector, Wall, reflectors, walls};
use super::terrain::Terrain;
use crate::kind::Kind;
use crate::path::on_arc;
use crate::random::Random;
use crate::shape::Shape;
use crate::site::{CROWN, TRUNK, bodies};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use ralf::space::Vector;

/// A vehicle passes below what is higher, m.
const HEADROOM: f64 = 3.0;

/// Where a thing starts and how it goes on.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Course {
    /// x, y (m) and yaw (rad) at the start.
    pub(super) start: [f64; 3],
    /// Along its own x axis, m/s.
    pub(super) speed: f64,
    /// rad/s, to the left.
    pub(super) turn_rate: f64,
}

impl Course {
    /// x, y and yaw after so many seconds.
    fn at(&self, seconds: f64) -> [f64; 3] {
        on_arc(self.start, self.speed * seconds, self.turn_rate * seconds)
    }
}

/// One thing.
#[derive(Debug)]
pub(super) struct Item {
    pub(super) kind: Kind,
    /// Length, width, height, m.
    pub(super) size: Vector,
    pub(super) course: Course,
    /// In its own frame.
    pub(super) bodies: Vec<(Shape, Vector)>,
    pub(super) reflectors: Vec<Reflector>,
    pub(super) walls: Vec<Wall>,
}

impl Item {
    pub(super) fn new(kind: Kind, size: [f64; 3], course: Course, random: &mut Random) -> Self {
        let size = Vector::from(size);
        Self {
            kind,
            size,
            course,
            bodies: bodies(kind, size),
            reflectors: reflectors(kind, size, random),
            walls: walls(kind, size, random),
        }
    }

    pub(super) fn moves(&self) -> bool {
        self.course.speed != 0.0
    }

    /// Half its length and width where a vehicle would meet it, m; `None` where it would pass below.
    fn outline(&self) -> Option<[f64; 2]> {
        match self.kind {
            Kind::Bridge => None,
            Kind::Tree if CROWN * self.size.z > HEADROOM => Some([TRUNK; 2]),
            _ => Some([self.size.x / 2.0, self.size.y / 2.0]),
        }
    }

    /// Whether what drives over a place on the ground, half so wide (m), would run into it where it stands.
    pub(super) fn is_in_the_way(&self, [x, y]: [f64; 2], wider: f64) -> bool {
        let Some([l, w]) = self.outline().filter(|_| !self.moves()) else { return false };
        let [x0, y0, yaw] = self.course.start;
        let (sin, cos) = yaw.sin_cos();
        let [dx, dy] = [x - x0, y - y0];
        (cos * dx + sin * dy).abs() < l + wider && (cos * dy - sin * dx).abs() < w + wider
    }

    /// Where it is after so many seconds: upright, with its foot on the ground.
    pub(super) fn pose(&self, terrain: &Terrain, seconds: f64) -> Isometry3<f64> {
        let [x, y, yaw] = self.course.at(seconds);
        Isometry3::from_parts(
            Translation3::new(x, y, terrain.height(x, y)),
            UnitQuaternion::from_axis_angle(&Vector::z_axis(), yaw),
        )
    }

    /// In the site's frame, m/s.
    pub(super) fn velocity(&self, terrain: &Terrain, seconds: f64) -> Vector {
        let [x, y, yaw] = self.course.at(seconds);
        let (sin, cos) = yaw.sin_cos();
        let [rise_x, rise_y] = terrain.gradient(x, y);
        Vector::new(cos, sin, rise_x * cos + rise_y * sin) * self.course.speed
    }

    /// Nothing of it is farther from its foot, m.
    pub(super) fn reach(&self) -> f64 {
        self.size.norm()
    }
}
