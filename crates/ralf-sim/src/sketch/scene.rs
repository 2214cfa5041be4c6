//! What a site is made of: things that stand or move, with bodies that rays meet and spots that reflect waves.

use super::relief::Relief;
use crate::random::Random;
use crate::shape::Shape;
use ralf::space::{Point, Vector};

/// Something rigid.
#[derive(Debug, Clone, Copy)]
pub(super) struct Thing {
    /// SemanticKITTI id; 1 of what is no more than a part of the ground.
    pub(super) class: u16,
    /// x, y (m) and heading (rad) at the start.
    pub(super) start: [f64; 3],
    /// Along its own x axis, m/s.
    pub(super) speed: f64,
    /// rad/s, to the left.
    pub(super) turn_rate: f64,
    /// Standard deviation of what its parts move by themselves, m/s.
    pub(super) flutter: f64,
}

/// What a ray or a wave meets.
#[derive(Debug, Clone, Copy)]
pub(super) struct Body {
    pub(super) thing: usize,
    pub(super) shape: Shape,
    /// In the thing's frame, whose origin is on the ground.
    pub(super) center: Point,
    /// What it takes from a wave that passes, there and back: dB, or dB/m where it is porous.
    pub(super) loss_db: f64,
    /// How many of a LiDAR's rays end in a metre of it; 0 where they end at its surface.
    pub(super) porous: f64,
    /// What a LiDAR gets back at right angles, 0 to 1.
    pub(super) reflectance: f64,
    /// Share of the rays that meet it and are lost: glass, wire.
    pub(super) gaps: f64,
    /// What its upright sides take from a wave that they mirror, dB, where they are smooth.
    pub(super) mirror_db: Option<f64>,
}

/// A point that reflects waves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot {
    pub(super) thing: usize,
    /// In the thing's frame.
    pub(super) at: Point,
    /// Where it is seen from; `None` from everywhere.
    pub(super) facing: Option<Vector>,
    /// dBsm.
    pub(super) strength_db: f64,
}

/// The ground's own spots.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ground {
    /// Mean (dBsm) and spread (dB).
    pub(super) strength_db: [f64; 2],
    /// For each square metre.
    pub(super) density: f64,
    /// What a LiDAR gets back at right angles, 0 to 1.
    pub(super) reflectance: f64,
}

/// A site, in its own frame.
#[derive(Debug)]
pub(super) struct Scene {
    pub(super) relief: Relief,
    pub(super) ground: Ground,
    pub(super) things: Vec<Thing>,
    pub(super) bodies: Vec<Body>,
    pub(super) spots: Vec<Spot>,
}

/// A box's middle (x, y), half its length and width, and from where to where it reaches, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    pub(super) middle: [f64; 2],
    pub(super) half: [f64; 2],
    pub(super) heights: [f64; 2],
}

impl Block {
    /// About its thing's own origin.
    pub(super) fn new(half: [f64; 2], heights: [f64; 2]) -> Self {
        Self { middle: [0.0; 2], half, heights }
    }

    fn center(&self) -> Point {
        Point::new(self.middle[0], self.middle[1], self.heights[0].midpoint(self.heights[1]))
    }

    fn half_size(&self) -> Vector {
        Vector::new(self.half[0], self.half[1], (self.heights[1] - self.heights[0]) / 2.0)
    }
}

/// What covers a box's sides with spots.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cover {
    /// Spots on a square metre.
    pub(super) density: f64,
    /// Mean (dBsm) and spread (dB).
    pub(super) strength_db: [f64; 2],
    /// Of spots at its edges, dBsm.
    pub(super) edges_db: Option<f64>,
}

/// Nothing above this is covered with spots, m above a box's lower end.
const COVERED: f64 = 9.0;

/// A site in the making.
pub(super) struct Draft<'a> {
    pub(super) scene: Scene,
    pub(super) random: &'a mut Random,
}

impl Draft<'_> {
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.random.between(low, high)
    }

    pub(super) fn normal(&mut self, mean: f64, sigma: f64) -> f64 {
        mean + self.random.normal(sigma)
    }

    pub(super) fn chance(&mut self, probability: f64) -> bool {
        self.random.chance(probability)
    }

    /// One of some, each as likely as the others.
    pub(super) fn one_of(&mut self, values: &[f64]) -> f64 {
        values[(self.random.uniform() * values.len() as f64) as usize]
    }

    /// A new thing that stands; its number.
    pub(super) fn thing(&mut self, class: u16, start: [f64; 3]) -> usize {
        self.mover(class, start, 0.0, 0.0)
    }

    /// A new thing that moves; its number.
    pub(super) fn mover(&mut self, class: u16, start: [f64; 3], speed: f64, turn_rate: f64) -> usize {
        self.scene.things.push(Thing { class, start, speed, turn_rate, flutter: 0.0 });
        self.scene.things.len() - 1
    }

    /// A body of a thing with the usual surface.
    pub(super) fn body(&mut self, thing: usize, shape: Shape, center: Point, loss_db: f64) -> &mut Body {
        self.scene.bodies.push(Body {
            thing,
            shape,
            center,
            loss_db,
            porous: 0.0,
            reflectance: 0.4,
            gaps: 0.0,
            mirror_db: None,
        });
        let last = self.scene.bodies.len() - 1;
        &mut self.scene.bodies[last]
    }

    pub(super) fn block(&mut self, thing: usize, block: Block, loss_db: f64) -> &mut Body {
        self.body(thing, Shape::Box(block.half_size()), block.center(), loss_db)
    }

    /// An upright cylinder about a place of the thing.
    pub(super) fn column(
        &mut self,
        thing: usize,
        [x, y]: [f64; 2],
        radius: f64,
        [low, high]: [f64; 2],
        loss_db: f64,
    ) -> &mut Body {
        let shape = Shape::Cylinder(radius, (high - low) / 2.0);
        self.body(thing, shape, Point::new(x, y, low.midpoint(high)), loss_db)
    }

    pub(super) fn spot(&mut self, thing: usize, at: [f64; 3], facing: Option<Vector>, strength_db: f64) {
        self.scene.spots.push(Spot { thing, at: Point::from(at), facing, strength_db });
    }

    /// Spots anywhere in a block, seen from everywhere.
    pub(super) fn scatter(&mut self, thing: usize, count: usize, block: Block, [mean, spread]: [f64; 2]) {
        let Block { middle: [x, y], half: [l, w], heights: [low, high] } = block;
        for _ in 0..count {
            let at = [x + self.between(-l, l), y + self.between(-w, w), self.between(low, high)];
            let strength = self.normal(mean, spread);
            self.spot(thing, at, None, strength);
        }
    }

    /// Spots on the four upright sides of a block, and at its edges.
    pub(super) fn cover(&mut self, thing: usize, block: Block, cover: Cover) {
        let Block { middle: [x, y], half, heights: [low, high] } = block;
        let high = high.min(low + COVERED);
        let [mean, spread] = cover.strength_db;
        for (axis, side) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
            let along = half[1 - axis];
            let count = self.random.poisson((2.0 * along * (high - low) * cover.density).min(300.0));
            let facing = if axis == 0 { Vector::x() } else { Vector::y() } * side;
            for _ in 0..count {
                let (u, z) = (self.between(-along, along), self.between(low, high));
                let at =
                    if axis == 0 { [x + side * half[0], y + u, z] } else { [x + u, y + side * half[1], z] };
                let strength = self.normal(mean, spread);
                self.spot(thing, at, Some(facing), strength);
            }
        }
        let Some(edges_db) = cover.edges_db else { return };
        for (a, b) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let facing = Vector::new(a, b, 0.0).normalize();
            for _ in 0..2 {
                let at = [x + a * half[0], y + b * half[1], self.between(low, high)];
                let strength = self.normal(edges_db, 3.0);
                self.spot(thing, at, Some(facing), strength);
            }
        }
    }
}
