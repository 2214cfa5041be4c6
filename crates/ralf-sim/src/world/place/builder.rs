//! What all places are built with.

use crate::kind::Kind;
use crate::random::Random;
use crate::scenario::{Leg, Ramp};
use crate::world::family::MotionRanges;
use crate::world::item::{Course, Item};
use crate::world::span::span;
use crate::world::terrain::{Patch, Surface};

/// A place in the making, or made.
#[derive(Debug)]
pub(in crate::world) struct Plan {
    /// For people.
    pub(in crate::world) title: &'static str,
    pub(in crate::world) items: Vec<Item>,
    pub(in crate::world) patches: Vec<Patch>,
    pub(in crate::world) base: Patch,
    pub(in crate::world) ramps: Vec<Ramp>,
    pub(in crate::world) drive: DrivePlan,
}

/// The own vehicle's drive.
#[derive(Debug)]
pub(in crate::world) struct DrivePlan {
    /// x, y (m), heading (degrees).
    pub(in crate::world) start: [f64; 3],
    pub(in crate::world) legs: Vec<Leg>,
    /// Mean speed, m/s; below 0 in reverse, 0 standing.
    pub(in crate::world) speed: f64,
    /// How much it swings about the mean, as a share, and how long that takes, s.
    pub(in crate::world) swing: (f64, f64),
}

/// Length, width and height, m: radars hear it above a LiDAR's highest beam.
const TALL_TREE: [f64; 3] = [6.0, 6.0, 13.0];
/// The drive lasts no longer in the place than this, s.
const LASTING: f64 = 14.0;

/// Puts things into a plan.
pub(super) struct Builder<'a> {
    pub(super) plan: Plan,
    pub(super) motion: &'a MotionRanges,
    pub(super) random: &'a mut Random,
    /// How many people are about, of what is usual for the place.
    crowd: f64,
}

impl<'a> Builder<'a> {
    pub(super) fn new(motion: &'a MotionRanges, random: &'a mut Random) -> Self {
        let reflectance = random.between(0.06, 0.3);
        let base = Patch::base(Surface::Asphalt, reflectance);
        let drive = DrivePlan { start: [0.0; 3], legs: Vec::new(), speed: 5.0, swing: (0.0, 7.0) };
        let plan = Plan { title: "", items: Vec::new(), patches: Vec::new(), base, ramps: Vec::new(), drive };
        let crowd = motion.crowd.ratio(random);
        Self { plan, motion, random, crowd }
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.random.between(low, high)
    }

    pub(super) fn normal(&mut self, sigma: f64) -> f64 {
        self.random.normal(sigma)
    }

    pub(super) fn chance(&mut self, probability: f64) -> bool {
        self.random.chance(probability)
    }

    /// Something that stands, at x, y (m), turned by so many degrees.
    pub(super) fn put(&mut self, kind: Kind, [x, y]: [f64; 2], yaw_deg: f64, size: [f64; 3]) {
        let course = Course { start: [x, y, yaw_deg.to_radians()], ..Course::default() };
        self.plan.items.push(Item::new(kind, size, course, self.random));
    }

    /// Something that moves along its own length with so many m/s.
    pub(super) fn send(&mut self, kind: Kind, [x, y]: [f64; 2], yaw_deg: f64, speed: f64, turn_rate: f64) {
        let course = Course { start: [x, y, yaw_deg.to_radians()], speed, turn_rate };
        let size = self.size(kind);
        self.plan.items.push(Item::new(kind, size, course, self.random));
    }

    /// A usual size of a kind.
    pub(super) fn size(&mut self, kind: Kind) -> [f64; 3] {
        let tall = kind == Kind::Tree && self.chance(0.5);
        let [length, width, height] = if tall { TALL_TREE } else { kind.usual_size() };
        let (a, b, c) = match kind {
            Kind::Car => (0.2, 0.08, 0.2),
            Kind::Truck => (0.35, 0.04, 0.1),
            Kind::Tree => (0.4, 0.0, 0.4),
            Kind::Pedestrian | Kind::Cyclist => (0.1, 0.0, 0.1),
            Kind::Pole => (0.3, 0.0, 0.5),
            _ => (0.1, 0.1, 0.2),
        };
        let mut stretched = |value: f64, share: f64| value * (1.0 + self.random.between(-share, share));
        let length = stretched(length, a);
        // Round things stay round.
        let width = if matches!(kind, Kind::Tree | Kind::Pole | Kind::Pedestrian) {
            length
        } else {
            stretched(width, b)
        };
        [length, width, stretched(height, c)]
    }

    /// The same, with a usual size.
    pub(super) fn place(&mut self, kind: Kind, at: [f64; 2], yaw_deg: f64) {
        let size = self.size(kind);
        self.put(kind, at, yaw_deg, size);
    }

    /// Pieces of a long thing from one x to another, along y.
    pub(super) fn line(&mut self, kind: Kind, [from, to]: [f64; 2], y: f64, size: [f64; 3]) {
        let count = ((to - from) / size[0]).floor().max(0.0) as usize;
        for i in 0..count {
            self.put(kind, [from + (i as f64 + 0.5) * size[0], y], 0.0, size);
        }
    }

    /// A rectangle of ground along x: from where to where, along x and y.
    pub(super) fn cover(&mut self, surface: Surface, [x0, x1]: [f64; 2], [y0, y1]: [f64; 2], rise: f64) {
        let pile = match surface {
            // From a lawn to a meadow.
            Surface::Grass => span(0.01, 0.35).ratio(self.random),
            Surface::Gravel => self.between(0.01, 0.05),
            Surface::Asphalt | Surface::Pavement => 0.0,
        };
        let reflectance = match surface {
            Surface::Grass => self.between(0.15, 0.65),
            Surface::Gravel => self.between(0.15, 0.45),
            Surface::Pavement => self.between(0.2, 0.45),
            Surface::Asphalt => self.plan.base.reflectance,
        };
        self.plan.patches.push(Patch {
            surface,
            center: [x0.midpoint(x1), y0.midpoint(y1)],
            turn: [0.0, 1.0],
            half: [(x1 - x0).abs() / 2.0, (y1 - y0).abs() / 2.0],
            rise,
            pile,
            reflectance,
        });
    }

    /// Slopes along and across the way of x, of the motion's steepness.
    pub(super) fn hills(&mut self, reach: f64) {
        let steepest = self.motion.slope.draw(self.random);
        for _ in 0..2 {
            let at = [self.between(0.0, reach), 0.0];
            let [length, direction_deg] = [self.between(15.0, 80.0), self.between(-20.0, 20.0)];
            let slope_deg = self.between(-1.0, 1.0) * steepest;
            self.plan.ramps.push(Ramp { at, direction_deg, length, slope_deg });
        }
        // Camber.
        let slope_deg = self.between(-1.0, 1.0) * steepest.min(2.0);
        self.plan.ramps.push(Ramp { at: [0.0, -15.0], direction_deg: 90.0, length: 30.0, slope_deg });
    }

    /// A bank beside the road: from y outward, up or down.
    pub(super) fn bank(&mut self, y: f64, slope_deg: f64) {
        let direction_deg = if y > 0.0 { 90.0 } else { -90.0 };
        let length = self.between(3.0, 12.0);
        self.plan.ramps.push(Ramp { at: [0.0, y], direction_deg, length, slope_deg });
    }

    /// The drive: where from, and at what speed by usage, m/s. Returns how far it goes.
    pub(super) fn drive(&mut self, start: [f64; 3], usual: f64) -> f64 {
        let speed = usual * self.motion.speed.draw(self.random);
        let [standing, reversing] = [self.chance(self.motion.standing), self.chance(self.motion.reversing)];
        let speed = match (standing, reversing) {
            (true, _) => 0.0,
            (_, true) => -speed.min(2.5),
            _ => speed,
        };
        let swing = (self.between(0.0, 0.25), self.between(4.0, 12.0));
        self.plan.drive = DrivePlan { start, legs: Vec::new(), speed, swing };
        speed.abs() * LASTING
    }

    /// From where to where along x a place goes on about a drive of so many metres: until it bends away or ends.
    pub(super) fn sight(&mut self, way: f64, [near, far]: [f64; 2]) -> [f64; 2] {
        [-self.between(near, far), way + self.between(near, far)]
    }

    /// How many people of what is usual for a place: streets differ in them more than in cars.
    pub(super) fn people(&mut self, usual: f64) -> usize {
        let mean = usual * self.crowd;
        self.random.poisson(mean)
    }

    /// How many of what is usual for a place.
    pub(super) fn traffic(&mut self, usual: f64) -> usize {
        let mean = usual * self.motion.traffic.draw(self.random);
        self.random.poisson(mean)
    }
}
