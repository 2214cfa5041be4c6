//! Colours: enough of walls, windows, paint and leaves that straight edges and textures are there to be seen.

use super::{Painted, Visible};
use crate::kind::Kind;
use crate::scene::Scene;
use crate::shape::{Ray, Shape};
use crate::solid::Solid;
use ralf::space::{Point, Vector};

/// Half of a thing's colour is gone in the haze at this distance, m.
const HAZE: f64 = 180.0;
/// Share of the light that comes from everywhere.
const AMBIENT: f64 = 0.5;

/// The sun's direction.
pub(super) struct Light(Vector);

impl Default for Light {
    fn default() -> Self {
        Self(Vector::new(0.35, -0.5, 0.79).normalize())
    }
}

/// The sky is paler towards the horizon.
pub(super) fn sky(ray: &Ray) -> [f64; 3] {
    let up = ray.direction.z.clamp(0.0, 1.0);
    mixed([205.0, 215.0, 228.0], [110.0, 155.0, 215.0], up)
}

/// The colour of a surface as it is lit, 0 to 255.
pub(super) fn lit(scene: &impl Visible, light: &Light, ray: &Ray, surface: &Painted) -> [f64; 3] {
    let facing = surface.normal.dot(&light.0).max(0.0);
    // Just off the surface, so that it does not shade itself.
    let origin = ray.origin + ray.direction * surface.distance + surface.normal * 1e-3;
    let sunny = facing > 0.0 && scene.distance(&Ray { origin, direction: light.0 }, 60.0).is_none();
    let brightness = AMBIENT + if sunny { (1.0 - AMBIENT) * facing * 1.3 } else { 0.0 };
    let haze = 1.0 - 0.5_f64.powf(surface.distance / HAZE);
    mixed(surface.colour.map(|value| value * brightness), [205.0, 215.0, 228.0], haze)
}

impl Visible for Scene<'_> {
    fn distance(&self, ray: &Ray, limit: f64) -> Option<f64> {
        self.cast(ray, limit).map(|hit| hit.distance)
    }

    fn surface(&self, ray: &Ray, limit: f64) -> Option<Painted> {
        let hit = self.cast(ray, limit)?;
        let p = ray.origin + ray.direction * hit.distance;
        let height = p.z - self.site.ground.height(p.x, p.y);
        let colour =
            hit.solid.map_or_else(|| asphalt(&p), |solid| solid_colour(solid, &p, height, &hit.normal));
        Some(Painted { distance: hit.distance, normal: hit.normal, colour })
    }

    fn class(&self, ray: &Ray, limit: f64) -> Option<u16> {
        self.cast(ray, limit).map(|hit| hit.kind().seen_class())
    }
}

/// The colour of a body at a place of its surface, so high above the ground.
pub(crate) fn solid_colour(solid: &Solid, p: &Point, height: f64, normal: &Vector) -> [f64; 3] {
    let own = solid.local(p);
    let half = solid.shape.half_size();
    let tint = grain(solid.object as f64, 3.0, 7.0);
    // Along the wall, whichever of the four it is.
    let along = if half.x - own.x.abs() < 0.01 { own.y } else { own.x };
    match solid.kind {
        Kind::Building => facade(along, height, normal, tint),
        Kind::Car => car(solid, height, normal, tint),
        Kind::Tree if matches!(solid.shape, Shape::Cylinder(..)) => [96.0, 74.0, 56.0],
        Kind::Tree | Kind::Hedge => leaves(p, [66.0, 112.0, 52.0]),
        Kind::Grass => leaves(p, [92.0, 142.0, 70.0]),
        Kind::Fence => striped(along, 0.16, 0.75, [[150.0, 112.0, 76.0], [70.0, 54.0, 40.0]]),
        Kind::Garage => striped(height, 0.5, 0.95, [[150.0, 148.0, 142.0], [120.0, 118.0, 112.0]]),
        Kind::Sidewalk => slabs(p),
        Kind::Pedestrian if height > 1.5 => [214.0, 172.0, 146.0],
        Kind::Pedestrian => mixed([176.0, 48.0, 44.0], [44.0, 66.0, 150.0], tint),
        Kind::Pole => [138.0, 140.0, 144.0],
        Kind::Marking => [236.0; 3],
        Kind::Cyclist | Kind::Truck | Kind::Container | Kind::Sign => {
            mixed([210.0, 210.0, 214.0], [40.0, 80.0, 140.0], tint)
        }
        Kind::Rail | Kind::Wall | Kind::Bridge => [168.0, 168.0, 164.0],
        Kind::Road => asphalt(p),
    }
}

/// Plaster with rows of windows.
fn facade(along: f64, height: f64, normal: &Vector, tint: f64) -> [f64; 3] {
    let floor = height.rem_euclid(3.0);
    let window = repeats(along + 0.6, 2.4, 0.5) && (0.9..2.3).contains(&floor);
    let ledge = (2.85..3.0).contains(&floor);
    match (normal.z > 0.5, window, ledge) {
        (true, ..) => [128.0, 74.0, 62.0],
        (_, true, _) => [62.0, 76.0, 94.0],
        (_, _, true) => [160.0, 156.0, 150.0],
        _ => mixed([212.0, 196.0, 164.0], [182.0, 118.0, 96.0], tint),
    }
}

/// Glass, tyres, paint.
fn car(solid: &Solid, height: f64, normal: &Vector, tint: f64) -> [f64; 3] {
    let paints = [
        [186.0, 30.0, 34.0],
        [40.0, 72.0, 140.0],
        [225.0, 225.0, 222.0],
        [60.0, 62.0, 66.0],
        [164.0, 168.0, 172.0],
    ];
    let wheel = solid.shape.half_size().x < 0.4;
    let glass = height > 0.9 && normal.z < 0.5;
    match (wheel, glass) {
        (true, _) => [34.0; 3],
        (_, true) => [48.0, 58.0, 68.0],
        _ => paints[(tint * paints.len() as f64) as usize % paints.len()],
    }
}

pub(crate) fn asphalt(p: &Point) -> [f64; 3] {
    let coarse = grain((p.x * 2.0).floor(), (p.y * 2.0).floor(), 0.0);
    let fine = grain((p.x * 16.0).floor(), (p.y * 16.0).floor(), 1.0);
    [92.0, 93.0, 96.0].map(|value| value + 8.0 * coarse + 14.0 * fine)
}

pub(crate) fn leaves(p: &Point, base: [f64; 3]) -> [f64; 3] {
    let value = grain((p.x * 7.0).floor(), (p.y * 7.0).floor(), (p.z * 7.0).floor());
    base.map(|channel| channel * (0.6 + 0.8 * value))
}

pub(crate) fn slabs(p: &Point) -> [f64; 3] {
    if repeats(p.x, 0.6, 0.95) && repeats(p.y, 0.6, 0.95) { [172.0; 3] } else { [140.0; 3] }
}

pub(crate) fn gravel(p: &Point) -> [f64; 3] {
    let stone = grain((p.x * 25.0).floor(), (p.y * 25.0).floor(), 2.0);
    [150.0, 142.0, 130.0].map(|channel| channel * (0.8 + 0.4 * stone))
}

/// One colour in the first `share` of each period, and another in the rest.
fn striped(place: f64, period: f64, share: f64, colours: [[f64; 3]; 2]) -> [f64; 3] {
    colours[usize::from(!repeats(place, period, share))]
}

/// Whether a place lies in the first `share` of its period.
fn repeats(place: f64, period: f64, share: f64) -> bool {
    place.rem_euclid(period) < share * period
}

/// A number in [0, 1) that three numbers determine.
fn grain(a: f64, b: f64, c: f64) -> f64 {
    let mixed = (a * 12.9898 + b * 78.233 + c * 37.719).sin() * 43_758.545_3;
    mixed - mixed.floor()
}

fn mixed(a: [f64; 3], b: [f64; 3], share: f64) -> [f64; 3] {
    std::array::from_fn(|channel| a[channel] + (b[channel] - a[channel]) * share)
}
