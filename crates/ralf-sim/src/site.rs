//! A scenario built up: the ground, the objects on it, and the bodies they are made of.

use super::ground::Ground;
use super::kind::{DECK, Kind};
use super::random::{Purpose, Random};
use super::scatterer::{Scatterer, scatterers};
use super::scenario::{Scenario, Thing};
use super::shape::Shape;
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use ralf::space::{Point, Vector};

/// Radius of a tree's trunk, m.
pub(super) const TRUNK: f64 = 0.16;
/// From which share of its height a tree has a crown.
pub(super) const CROWN: f64 = 0.3;

/// One thing.
#[derive(Debug, Clone)]
pub(super) struct Object {
    pub(super) kind: Kind,
    /// At the start: x along its length, z up from its foot.
    pub(super) site_from_object: Isometry3<f64>,
    /// Length, width, height, m.
    pub(super) size: Vector,
    /// Along x and y of the site's frame, m/s.
    pub(super) level_velocity: Vector,
    /// In its own frame.
    pub(super) bodies: Vec<(Shape, Vector)>,
    /// In its own frame.
    pub(super) scatterers: Vec<Scatterer>,
}

impl Object {
    /// Where it is after so many seconds: upright, with its foot as high above the ground as at the start.
    pub(super) fn pose(&self, ground: &Ground, seconds: f64) -> Isometry3<f64> {
        let start = self.site_from_object.translation.vector;
        let mut way = self.level_velocity * seconds;
        way.z = ground.height(start.x + way.x, start.y + way.y) - ground.height(start.x, start.y);
        Translation3::from(way) * self.site_from_object
    }

    /// After so many seconds, in the site's frame, m/s.
    pub(super) fn velocity(&self, ground: &Ground, seconds: f64) -> Vector {
        let place = self.pose(ground, seconds).translation.vector;
        let [rise_x, rise_y] = ground.gradient(place.x, place.y);
        let level = self.level_velocity;
        Vector::new(level.x, level.y, rise_x * level.x + rise_y * level.y)
    }
}

/// All that doesn't depend on time.
#[derive(Debug)]
pub(super) struct Site {
    pub(super) ground: Ground,
    pub(super) objects: Vec<Object>,
}

impl Site {
    /// Builds a scenario; what a scenario leaves open follows from the seed.
    pub(super) fn new(scenario: &Scenario, seed: u64) -> Self {
        let ground = Ground::new(&scenario.ramp);
        let members = scenario.thing.iter().flat_map(|thing| (0..thing.count).map(move |i| (thing, i)));
        let build = |(number, (thing, member)): (usize, (&Thing, usize))| {
            let random = &mut Random::new(seed, Purpose::Placement, number, 0);
            let mut object = object(&ground, thing, member, random);
            let random = &mut Random::new(seed, Purpose::Scatterers, number, 0);
            object.scatterers = scatterers(object.kind, object.size, random);
            object
        };
        let objects = members.enumerate().map(build).collect();
        Self { ground, objects }
    }
}

/// A member of a row. Nobody parks or plants exactly in line.
fn object(ground: &Ground, thing: &Thing, member: usize, random: &mut Random) -> Object {
    let kind = thing.kind;
    let (place_sigma, yaw_sigma) = match kind {
        Kind::Car => (0.15, 0.03),
        Kind::Tree | Kind::Pole | Kind::Pedestrian => (0.2, 0.5),
        _ => (0.0, 0.0),
    };
    let n = member as f64;
    let x = thing.at[0] + n * thing.step[0] + random.normal(place_sigma);
    let y = thing.at[1] + n * thing.step[1] + random.normal(place_sigma);
    let yaw = thing.yaw_deg.to_radians() + random.normal(yaw_sigma);
    let size = Vector::from(thing.size.unwrap_or(kind.usual_size()));
    Object {
        kind,
        site_from_object: Isometry3::from_parts(
            Translation3::new(x, y, ground.height(x, y)),
            UnitQuaternion::from_axis_angle(&Vector::z_axis(), yaw),
        ),
        size,
        level_velocity: Vector::new(thing.velocity[0], thing.velocity[1], 0.0),
        bodies: bodies(kind, size),
        scatterers: Vec::new(),
    }
}

/// The bodies of a thing: shape and centre, in its own frame.
pub(super) fn bodies(kind: Kind, size: Vector) -> Vec<(Shape, Vector)> {
    let [length, width, height] = size.into();
    let block = |x: [f64; 2], y: [f64; 2], z: [f64; 2]| {
        let low = Point::new(x[0], y[0], z[0]);
        let high = Point::new(x[1], y[1], z[1]);
        (Shape::Box((high - low) / 2.0), nalgebra::center(&low, &high).coords)
    };
    let (l, w) = (length / 2.0, width / 2.0);
    match kind {
        Kind::Car => car(&block, l, w, height),
        Kind::Garage => garage(&block, l, w, height),
        Kind::Truck => truck(&block, l, w, height),
        Kind::Cyclist => cyclist(&block, l, w, height),
        Kind::Rail => vec![block([-l, l], [-w, w], [height - 0.31, height])],
        Kind::Bridge => vec![block([-l, l], [-w, w], [height - DECK, height])],
        Kind::Sign => vec![
            block([-l, l], [-w, w], [height - 2.0 * w, height]),
            (Shape::Cylinder(0.04, height / 2.0), Vector::new(-l - 0.04, 0.0, height / 2.0)),
        ],
        Kind::Tree => tree(l, w, height),
        Kind::Pole | Kind::Pedestrian => {
            vec![(Shape::Cylinder(l, height / 2.0), Vector::new(0.0, 0.0, height / 2.0))]
        }
        _ if kind.is_flat() => vec![block([-l, l], [-w, w], [-0.3, height])],
        _ => vec![block([-l, l], [-w, w], [0.0, height])],
    }
}

type Block<'a> = dyn Fn([f64; 2], [f64; 2], [f64; 2]) -> (Shape, Vector) + 'a;

/// Body, cabin, four wheels, and a gap below through which radars see.
fn car(block: &Block<'_>, l: f64, w: f64, height: f64) -> Vec<(Shape, Vector)> {
    let waist = 0.58 * height;
    let wheel = |x: f64, y: f64| block([x - 0.3, x + 0.3], [y - 0.1, y + 0.1], [0.0, 0.6]);
    vec![
        block([-l, l], [-w, w], [0.22, waist]),
        block([-0.85 * l, 0.35 * l], [-0.88 * w, 0.88 * w], [waist, height]),
        wheel(0.62 * l, w - 0.1),
        wheel(0.62 * l, 0.1 - w),
        wheel(-0.62 * l, w - 0.1),
        wheel(-0.62 * l, 0.1 - w),
    ]
}

/// Cab, load, and a gap below.
fn truck(block: &Block<'_>, l: f64, w: f64, height: f64) -> Vec<(Shape, Vector)> {
    let wheels = |x: f64| block([x - 0.5, x + 0.5], [-w, w], [0.0, 1.0]);
    vec![
        block([l - 2.0, l], [-0.96 * w, 0.96 * w], [0.4, 0.8 * height]),
        block([-l, l - 2.4], [-w, w], [0.9, height]),
        wheels(l - 1.2),
        wheels(0.3 * l),
        wheels(-0.7 * l),
    ]
}

/// Trunk, and crown.
fn tree(l: f64, w: f64, height: f64) -> Vec<(Shape, Vector)> {
    let crown = Vector::new(l, w, 0.5 * (1.0 - CROWN) * height);
    vec![
        (Shape::Cylinder(TRUNK, 0.25 * height), Vector::new(0.0, 0.0, 0.25 * height)),
        (Shape::Ellipsoid(crown), Vector::new(0.0, 0.0, 0.5 * (1.0 + CROWN) * height)),
    ]
}

/// Frame and wheels, and the rider above them.
fn cyclist(block: &Block<'_>, l: f64, w: f64, height: f64) -> Vec<(Shape, Vector)> {
    let rider = Vector::new(0.35, w, (height - 0.8) / 2.0);
    vec![
        block([-l, l], [-0.05, 0.05], [0.0, 0.9]),
        (Shape::Ellipsoid(rider), Vector::new(-0.1, 0.0, height - rider.z)),
    ]
}

/// Three walls and a roof.
fn garage(block: &Block<'_>, l: f64, w: f64, height: f64) -> Vec<(Shape, Vector)> {
    let wall = 0.25;
    vec![
        block([-l, l], [w - wall, w], [0.0, height]),
        block([-l, l], [-w, wall - w], [0.0, height]),
        block([-l, wall - l], [-w, w], [0.0, height]),
        block([-l, l], [-w, w], [height - wall, height]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_drives_up_a_ramp_stays_on_the_ground() {
        let ramp = "
        title = 'A ramp'
        ego = { start = [0, 0, 0], speed_kmh = 7 }
        ramp = [{ at = [10, 0], direction_deg = 30, length = 30, slope_deg = 8 }]
        thing = [{ kind = 'truck', at = [5, 3], velocity = [10, 0] }]";
        let site = Site::new(&Scenario::from_toml(ramp).unwrap(), 1);
        let (truck, ground) = (&site.objects[0], &site.ground);
        let height = |seconds: f64| truck.pose(ground, seconds).translation.z;
        for (seconds, rises) in
            [(0.0, 0.0), (1.5, 10.0 * 30_f64.to_radians().cos() * 8_f64.to_radians().tan())]
        {
            let place = truck.pose(ground, seconds).translation;
            assert!((place.z - ground.height(place.x, place.y)).abs() < 1e-9);
            let velocity = truck.velocity(ground, seconds);
            assert!((velocity - Vector::new(10.0, 0.0, rises)).norm() < 1e-9, "{velocity}");
        }
        assert!(height(3.0) > 1.5 && (height(9.0) - height(8.0)).abs() < 1e-9);
    }
}
