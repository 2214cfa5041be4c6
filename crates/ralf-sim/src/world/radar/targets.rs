//! Echoes of what really is there: parts of things, flashes of smooth walls, what lies behind facades.

use super::echo::{Echo, View, fluctuation_db, glint_db};
use super::equation::decibel;
use crate::kind::Kind;
use crate::random::Random;
use crate::truth::Truth;
use crate::world::item::Item;
use crate::world::reflector::{Reflector, Wall};
use nalgebra::Isometry3;
use ralf::label::Cause;
use ralf::space::{Point, Vector};
use std::f64::consts::PI;

/// What a car takes from what lies on its far side or on top of its floor, there and back, dB.
const OWN_BODY_DB: f64 = 10.0;
/// Parts are told apart by lobes of so many radians: wavelength over twice a part's size of 10 cm.
const LOBE: f64 = 0.03;

/// An echo and the place that sent it: what mirrors can show again.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    pub(super) echo: Echo,
    pub(super) place: Point,
    pub(super) velocity: Vector,
    pub(super) item: usize,
}

/// Every part that could be heard.
pub(super) fn echoes(view: &View<'_>, random: &mut Random) -> Vec<Target> {
    let mut found = Vec::new();
    for (index, item) in view.moment.site.items.iter().enumerate() {
        let pose = &view.moment.poses[index];
        let distance = (Point::from(pose.translation.vector) - view.origin()).norm();
        if distance > view.radar.max_range + item.reach() {
            continue;
        }
        let velocity = velocity(view, item);
        let thing = Thing { view, index, item, pose, velocity };
        for (number, reflector) in item.reflectors.iter().enumerate() {
            found.extend(thing.part(number, reflector, random));
        }
        for wall in &item.walls {
            found.extend(thing.flash(wall, random));
        }
    }
    found
}

fn velocity(view: &View<'_>, item: &Item) -> Vector {
    if item.moves() { item.velocity(&view.moment.site.terrain, view.moment.seconds) } else { Vector::zeros() }
}

/// A thing in its place.
struct Thing<'a> {
    view: &'a View<'a>,
    index: usize,
    item: &'a Item,
    pose: &'a Isometry3<f64>,
    velocity: Vector,
}

impl Thing<'_> {
    fn truth(&self, inside: bool) -> Truth {
        if inside {
            return Truth::artifact(Cause::InsideBuilding);
        }
        Truth { class: self.item.kind.class(), cause: Cause::Plausible }
    }

    fn part(&self, number: usize, part: &Reflector, random: &mut Random) -> Option<Target> {
        let view = self.view;
        let place = self.pose * part.at;
        let seen = view.seen(&place)?;
        let back = (view.origin() - place) / seen.range;
        let own = self.pose.rotation.inverse_transform_vector(&back);
        let aspect = own.y.atan2(own.x);
        let facing = part.facing.map_or(1.0, |facing| facing.dot(&own));
        let name = (self.index * 1000 + number) as i64;
        let rcs = part.strength_db
            + glint_db(view.moment.site.seed, name, aspect, LOBE, part.spread_db)
            + fluctuation_db(random)
            + self.facing_db(facing, part.inside)?;
        let level = view.level_db(&seen, rcs)?;
        let loss = view.loss_db(&place, Some(self.index))?;
        let swing =
            if part.swings { self.item.course.speed * random.between(-1.0, 1.0) * own.x } else { 0.0 };
        Some(self.target(
            place,
            seen,
            level - loss,
            view.range_rate(&place, &self.velocity) + swing,
            part.inside,
        ))
    }

    /// What a part loses by looking away, dB.
    fn facing_db(&self, facing: f64, inside: bool) -> Option<f64> {
        let away = facing < 0.05;
        match (self.item.kind, away) {
            (Kind::Car | Kind::Truck, true) => Some(-OWN_BODY_DB),
            (_, true) => None,
            _ if inside => Some(-self.view.waves.window_loss_db),
            // Corners and edges don't follow Lambert; half of it is enough.
            _ => Some(0.5 * decibel(facing.max(0.05))),
        }
    }

    /// A smooth wall shows the radar to itself at the foot of its perpendicular: the cross-section of a large plate is
    /// `pi r^2` in its near field, less what roughness leaves of it.
    fn flash(&self, wall: &Wall, random: &mut Random) -> Option<Target> {
        let view = self.view;
        let normal = self.pose.rotation * wall.normal;
        let center = self.pose * wall.center;
        let to_radar = view.origin() - center;
        let distance = normal.dot(&to_radar);
        if distance < 0.2 || distance > view.radar.max_range {
            return None;
        }
        let along = normal.x * to_radar.y - normal.y * to_radar.x;
        let up = to_radar.z.clamp(-wall.half[1], wall.half[1]);
        if along.abs() > wall.half[0] || (to_radar.z - up).abs() > 0.15 * distance {
            return None;
        }
        let foot = center + Vector::new(-normal.y, normal.x, 0.0) * along + Vector::z() * up;
        let seen = view.seen(&foot)?;
        let rcs = decibel(PI * distance * distance) - 2.0 * view.waves.mirror_loss_db.min(6.0)
            + wall.flash_db
            - wall.loss_db.max(0.0)
            + fluctuation_db(random);
        let level = view.level_db(&seen, rcs)? - view.loss_db(&foot, Some(self.index))?;
        Some(self.target(foot, seen, level, view.range_rate(&foot, &self.velocity), false))
    }

    fn target(
        &self,
        place: Point,
        seen: ralf::space::Spherical,
        level_db: f64,
        range_rate: f64,
        inside: bool,
    ) -> Target {
        let echo = Echo::new(seen, range_rate, level_db, self.truth(inside));
        Target { echo, place, velocity: self.velocity, item: self.index }
    }
}
