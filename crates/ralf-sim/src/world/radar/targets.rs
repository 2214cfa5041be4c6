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
/// Corners and edges throw a wave back; so far from the way back most of the world's loss is reached, rad (chosen).
const ASIDE: f64 = 0.35;

/// An echo and the place that sent it: what mirrors can show again.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    pub(super) echo: Echo,
    pub(super) place: Point,
    pub(super) velocity: Vector,
    pub(super) item: usize,
    /// Where it looks, in the site's frame; `None` everywhere.
    facing: Option<Vector>,
    /// A smooth wall that is seen at right angles: its other ways are those of mirrors.
    pub(super) flash: bool,
}

impl Target {
    /// What there is more of its echo on a way that comes from one place and goes on to another, dB; `None` where it
    /// isn't seen from there.
    pub(super) fn other_way_db(&self, view: &View<'_>, from: &Point, to: &Point) -> Option<f64> {
        let kind = view.moment.site.items[self.item].kind;
        let seen_db = |from: &Point| {
            let way = (from - self.place).normalize();
            facing_db(kind, self.facing.map_or(1.0, |facing| facing.dot(&way)))
        };
        let apart = (from - self.place).angle(&(to - self.place));
        let other = f64::midpoint(seen_db(from)?, seen_db(to)?) - seen_db(&view.origin())?;
        Some(other - view.waves.aside_db * (1.0 - (-apart / ASIDE).exp()))
    }
}

/// What a part loses by where it looks, dB: nothing but vehicles lets it be seen from its back.
fn facing_db(kind: Kind, facing: f64) -> Option<f64> {
    match (kind, facing < 0.05) {
        (Kind::Car | Kind::Truck, true) => Some(-OWN_BODY_DB),
        (_, true) => None,
        // Corners and edges don't follow Lambert; half of it is enough.
        _ => Some(0.5 * decibel(facing)),
    }
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
            + facing_db(self.item.kind, facing)?
            - if part.inside { view.waves.window_loss_db } else { 0.0 };
        let level = view.level_db(&seen, rcs)?;
        let loss = view.loss_db(&place, &[self.index])?;
        let range_rate = view.range_rate(&place, &self.velocity) + self.swing(part, own.x, random);
        let echo = Echo::new(seen, range_rate, level - loss, self.truth(part.inside));
        let facing = part.facing.map(|facing| self.pose.rotation * facing);
        Some(self.target(echo, place, facing, false))
    }

    /// How much faster than the thing a part goes towards or away, m/s, where the radar lies so far ahead of the thing.
    fn swing(&self, part: &Reflector, ahead: f64, random: &mut Random) -> f64 {
        let along = if part.swing > 0.0 { random.between(-part.swing, part.swing) } else { 0.0 };
        let by_itself = if part.sway > 0.0 { random.normal(part.sway) } else { 0.0 };
        self.item.course.speed * along * ahead + by_itself
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
        let level = view.level_db(&seen, rcs)? - view.loss_db(&foot, &[self.index])?;
        let echo = Echo::new(seen, view.range_rate(&foot, &self.velocity), level, self.truth(false));
        Some(self.target(echo, foot, Some(normal), true))
    }

    fn target(&self, echo: Echo, place: Point, facing: Option<Vector>, flash: bool) -> Target {
        Target { echo, place, velocity: self.velocity, item: self.index, facing, flash }
    }
}
