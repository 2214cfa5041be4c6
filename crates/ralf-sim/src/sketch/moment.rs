//! A site at one moment, as rays and waves meet it.

use super::scene::{Body, Scene, Thing};
use crate::bvh::{Bounds, Tree};
use crate::path::on_arc;
use crate::random::Random;
use crate::shape::{Crossing, Ray};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use ralf::space::{Point, Vector};

/// A wave that lost so much is gone, dB.
pub(super) const GONE_DB: f64 = 40.0;
/// A way ends so far before what it leads to, m.
const BEFORE: f64 = 0.03;

/// A site with what stands on it in its place.
#[derive(Debug)]
pub(super) struct Stage {
    pub(super) scene: Scene,
    standing: Vec<Placed>,
    tree: Tree,
}

/// A body in its place.
#[derive(Debug, Clone, Copy)]
struct Placed {
    /// Its number in the scene.
    body: usize,
    pose: Isometry3<f64>,
    velocity: Vector,
    radius: f64,
}

/// Where a thing is and how it moves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pose {
    pub(super) isometry: Isometry3<f64>,
    /// m/s, of its origin.
    pub(super) velocity: Vector,
    /// rad/s.
    turn_rate: f64,
}

impl Pose {
    fn of(thing: &Thing, scene: &Scene, seconds: f64) -> Self {
        let [x, y, heading] = on_arc(thing.start, thing.speed * seconds, thing.turn_rate * seconds);
        let place = Translation3::new(x, y, scene.relief.height(x, y));
        let turn = UnitQuaternion::from_axis_angle(&Vector::z_axis(), heading);
        Self {
            isometry: Isometry3::from_parts(place, turn),
            velocity: Vector::new(heading.cos(), heading.sin(), 0.0) * thing.speed,
            turn_rate: thing.turn_rate,
        }
    }

    /// Of a part of the thing, m/s.
    pub(super) fn velocity_at(&self, place: &Point) -> Vector {
        let arm = place.coords - self.isometry.translation.vector;
        self.velocity + Vector::z().cross(&arm) * self.turn_rate
    }
}

impl Placed {
    fn new(body: usize, scene: &Scene, pose: &Pose) -> Self {
        let Body { center, shape, .. } = &scene.bodies[body];
        let place = pose.isometry * center;
        let isometry = Isometry3::from_parts(Translation3::from(place.coords), pose.isometry.rotation);
        let radius = shape.half_size().norm();
        Self { body, pose: isometry, velocity: pose.velocity, radius }
    }

    fn center(&self) -> Point {
        self.pose.translation.vector.into()
    }

    fn bounds(&self, scene: &Scene) -> Bounds {
        let half = scene.bodies[self.body].shape.half_size();
        let reach = self.pose.rotation.to_rotation_matrix().matrix().abs() * half;
        Bounds { low: self.center() - reach, high: self.center() + reach }
    }

    /// Where a ray that is sent so many seconds later crosses it.
    fn crossing(&self, scene: &Scene, ray: &Ray, later: f64) -> Option<Crossing> {
        let from = ray.origin - self.velocity * later;
        let own = Ray {
            origin: self.pose.inverse_transform_point(&from),
            direction: self.pose.inverse_transform_vector(&ray.direction),
        };
        scene.bodies[self.body].shape.crossing(&own)
    }

    /// Whether a ray passes the ball around it.
    fn is_near(&self, ray: &Ray, later: f64) -> bool {
        ray.passes(&(self.center() + self.velocity * later), self.radius)
    }
}

impl Stage {
    pub(super) fn new(scene: Scene) -> Self {
        let standing: Vec<Placed> = (0..scene.bodies.len())
            .filter(|body| !moves(&scene, *body))
            .map(|body| Placed::new(body, &scene, &pose_of(&scene, body, 0.0)))
            .collect();
        let bounds: Vec<Bounds> = standing.iter().map(|placed| placed.bounds(&scene)).collect();
        Self { tree: Tree::new(&bounds), standing, scene }
    }

    /// After so many seconds.
    pub(super) fn at(&self, seconds: f64) -> Moment<'_> {
        let scene = &self.scene;
        let poses: Vec<Pose> = scene.things.iter().map(|thing| Pose::of(thing, scene, seconds)).collect();
        let moving = (0..scene.bodies.len())
            .filter(|body| moves(scene, *body))
            .map(|body| Placed::new(body, scene, &poses[scene.bodies[body].thing]))
            .collect();
        Moment { stage: self, poses, moving }
    }
}

fn moves(scene: &Scene, body: usize) -> bool {
    scene.things[scene.bodies[body].thing].speed != 0.0
}

fn pose_of(scene: &Scene, body: usize, seconds: f64) -> Pose {
    Pose::of(&scene.things[scene.bodies[body].thing], scene, seconds)
}

/// A site at one moment.
#[derive(Debug)]
pub(super) struct Moment<'a> {
    stage: &'a Stage,
    /// Of every thing.
    pub(super) poses: Vec<Pose>,
    moving: Vec<Placed>,
}

/// Where a LiDAR's ray ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Met {
    /// m.
    pub(super) distance: f64,
    /// Cosine of the angle at which it meets the surface.
    pub(super) cosine: f64,
    /// 0 where it is lost.
    pub(super) reflectance: f64,
    pub(super) ground: bool,
}

/// A smooth upright side of a body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Face {
    pub(super) thing: usize,
    pub(super) center: Point,
    pub(super) normal: Vector,
    /// Level, along the side.
    pub(super) along: Vector,
    /// Half its length and height, m.
    pub(super) half: [f64; 2],
    pub(super) loss_db: f64,
}

impl Moment<'_> {
    pub(super) fn scene(&self) -> &Scene {
        &self.stage.scene
    }

    /// All bodies, in their places.
    fn bodies(&self) -> impl Iterator<Item = &Placed> {
        self.stage.standing.iter().chain(&self.moving)
    }

    /// What a LiDAR's ray that is sent so many seconds later meets first.
    pub(super) fn cast(&self, ray: &Ray, limit: f64, later: f64, random: &mut Random) -> Option<Met> {
        let scene = self.scene();
        let mut met: Option<Met> = None;
        let mut meet = |placed: &Placed, later: f64, limit: f64| {
            let Some(crossing) = placed.crossing(scene, ray, later) else { return limit };
            let body = &scene.bodies[placed.body];
            let deep = if body.porous > 0.0 { random.exponential(1.0 / body.porous) } else { 0.0 };
            let distance = crossing.enter + deep;
            if distance >= limit || distance >= crossing.leave && deep > 0.0 {
                return limit;
            }
            let cosine = if deep > 0.0 {
                random.between(0.3, 1.0)
            } else {
                -crossing.normal.dot(&placed.pose.inverse_transform_vector(&ray.direction))
            };
            let lost = random.chance(body.gaps);
            let reflectance = if lost { 0.0 } else { body.reflectance };
            met = Some(Met { distance, cosine, reflectance, ground: false });
            distance
        };
        let standing = &self.stage.standing;
        let mut limit = self.stage.tree.visit(ray, limit, |index, limit| meet(&standing[index], 0.0, limit));
        for placed in self.moving.iter().filter(|placed| placed.is_near(ray, later)) {
            limit = meet(placed, later, limit);
        }
        let reflectance = scene.ground.reflectance;
        let ground = scene.relief.hit(ray, limit).map(|distance| Met {
            distance,
            cosine: ray.direction.z.abs() + 0.01,
            reflectance,
            ground: true,
        });
        ground.or(met)
    }

    /// What a wave loses from one place to another, there and back, dB, other than through some things.
    pub(super) fn loss_db(&self, from: &Point, to: &Point, but: [Option<usize>; 2]) -> f64 {
        let scene = self.scene();
        let way = to - from;
        let length = way.norm();
        if length < 0.05 {
            return 0.0;
        }
        let ray = Ray { origin: *from, direction: way / length };
        let mut loss = 0.0;
        let mut meet = |placed: &Placed, limit: f64| {
            let body = &scene.bodies[placed.body];
            if !but.contains(&Some(body.thing))
                && let Some(crossing) = placed.crossing(scene, &ray, 0.0)
                && crossing.enter < length - BEFORE
            {
                let within = crossing.leave.min(length) - crossing.enter;
                loss += body.loss_db * if body.porous > 0.0 { within } else { 1.0 };
            }
            if loss > GONE_DB { 0.0 } else { limit }
        };
        let standing = &self.stage.standing;
        self.stage.tree.visit(&ray, length, |index, limit| meet(&standing[index], limit));
        for placed in self.moving.iter().filter(|placed| placed.is_near(&ray, 0.0)) {
            meet(placed, length);
        }
        loss
    }

    /// Smooth sides that look at a place and are nearer than so many metres, the nearest first.
    pub(super) fn faces(&self, place: &Point, within: f64) -> Vec<Face> {
        let mut found = Vec::new();
        for placed in self.bodies() {
            let body = &self.scene().bodies[placed.body];
            let Some(loss_db) = body.mirror_db else { continue };
            if (placed.center() - place).xy().norm() - placed.radius > within {
                continue;
            }
            found.extend(self.looking_sides(placed, place, loss_db));
        }
        let distance = |face: &Face| (face.center - place).xy().norm() - face.half[0];
        found.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        found
    }

    fn looking_sides(&self, placed: &Placed, place: &Point, loss_db: f64) -> Vec<Face> {
        let body = &self.scene().bodies[placed.body];
        let half = body.shape.half_size();
        let own = placed.pose.inverse_transform_point(place);
        let side = |axis: usize| {
            let outside = own[axis].abs() > half[axis] + 0.05;
            let (mut normal, mut along) = (Vector::zeros(), Vector::zeros());
            (normal[axis], along[1 - axis]) = (own[axis].signum(), 1.0);
            let normal = placed.pose.rotation * normal;
            outside.then(|| Face {
                thing: body.thing,
                center: placed.center() + normal * half[axis],
                normal,
                along: placed.pose.rotation * along,
                half: [half[1 - axis], half.z],
                loss_db,
            })
        };
        [0, 1].into_iter().filter_map(side).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Purpose;
    use crate::sketch::relief::Relief;
    use crate::sketch::scene::{Block, Draft, Ground};

    /// A wall at x = 10 of 20 dB, a hedge from 12 to 14 m of 5 dB/m, and a car that leaves at x = 30 with 10 m/s.
    fn stage() -> Stage {
        let random = &mut Random::new(1, Purpose::Placement, 0, 0);
        let relief = Relief::new([0.0; 2], &[], random);
        let ground = Ground { strength_db: [-20.0, 5.0], density: 0.0, reflectance: 0.2 };
        let scene = Scene { relief, ground, things: Vec::new(), bodies: Vec::new(), spots: Vec::new() };
        let mut draft = Draft { scene, random };
        let wall = draft.thing(51, [10.5, 0.0, 0.0]);
        draft.block(wall, Block::new([0.5, 4.0], [0.0, 2.0]), 20.0).mirror_db = Some(3.0);
        let hedge = draft.thing(70, [13.0, 0.0, 0.0]);
        draft.block(hedge, Block::new([1.0, 4.0], [0.0, 2.0]), 5.0).porous = 1e6;
        let car = draft.mover(10, [30.0, 0.0, 0.0], 10.0, 0.0);
        draft.block(car, Block::new([2.0, 1.0], [0.2, 1.5]), 7.0);
        Stage::new(draft.scene)
    }

    fn ahead(x: f64) -> Ray {
        Ray { origin: Point::new(x, 0.0, 1.0), direction: Vector::x() }
    }

    #[test]
    fn a_wave_loses_what_lies_on_its_way_and_nothing_in_what_it_leads_to() {
        let stage = stage();
        let moment = stage.at(0.0);
        let from = Point::new(0.0, 0.0, 1.0);
        let loss = |x: f64, but| moment.loss_db(&from, &Point::new(x, 0.0, 1.0), but);
        assert!(loss(9.9, [None, None]).abs() < 1e-9);
        assert!((loss(12.0, [None, None]) - 20.0).abs() < 1e-9);
        assert!((loss(13.0, [None, None]) - 25.0).abs() < 1e-9);
        assert!((loss(20.0, [None, None]) - 30.0).abs() < 1e-9);
        assert!((loss(40.0, [None, None]) - 37.0).abs() < 1e-9);
        assert!((loss(40.0, [Some(0), Some(2)]) - 10.0).abs() < 1e-9);
    }

    #[test]
    fn a_ray_ends_at_the_first_surface_and_what_moves_is_met_where_it_then_is() {
        let stage = stage();
        let moment = stage.at(0.0);
        let random = &mut Random::new(1, Purpose::Lidar, 0, 0);
        let mut distance = |x: f64, later: f64| moment.cast(&ahead(x), 80.0, later, random).unwrap().distance;
        assert!((distance(0.0, 0.0) - 10.0).abs() < 1e-9);
        assert!((distance(11.5, 0.0) - 0.5).abs() < 1e-3);
        assert!((distance(20.0, 0.0) - 8.0).abs() < 1e-9);
        assert!((distance(20.0, 0.05) - 8.5).abs() < 1e-9);
        let down = Ray { origin: Point::new(0.0, 0.0, 1.0), direction: Vector::new(0.6, 0.0, -0.8) };
        let met = moment.cast(&down, 80.0, 0.0, random).unwrap();
        assert!(met.ground && (met.distance - 1.25).abs() < 0.03);
    }

    #[test]
    fn the_side_that_looks_at_a_place_is_a_mirror() {
        let stage = stage();
        let moment = stage.at(0.0);
        let faces = moment.faces(&Point::new(0.0, 0.0, 1.0), 30.0);
        assert_eq!(faces.len(), 1);
        assert!((faces[0].normal + Vector::x()).norm() < 1e-9 && (faces[0].center.x - 10.0).abs() < 1e-9);
        assert_eq!(faces[0].half, [4.0, 1.0]);
    }
}
