//! Waves that take another way: mirror images, and paths that are mirrored on one of their two ways.

use super::antenna::{APART, displaced};
use super::echo::{Echo, View, fluctuation_db};
use super::equation::{decibel, range_loss_db};
use super::targets::Target;
use crate::random::Random;
use crate::truth::Truth;
use crate::world::reflector::Wall;
use nalgebra::Isometry3;
use ralf::label::Cause;
use ralf::space::{Point, Spherical, Vector};
use std::f64::consts::{LOG10_E, PI};

/// Farther mirrors, and things farther from a mirror, are left out, m.
const REACH: f64 = 45.0;
/// Of 77 GHz, m.
const WAVELENGTH: f64 = 3.9e-3;

/// A mirror in its place that faces the radar.
struct Mirror {
    item: usize,
    center: Point,
    normal: Vector,
    half: [f64; 2],
    /// Of its material, one way, dB.
    loss_db: f64,
    roughness: f64,
    bulge: [f64; 2],
    /// How far the radar is before it, m.
    distance: f64,
    /// In the site's frame.
    velocity: Vector,
}

impl Mirror {
    fn new(
        view: &View<'_>,
        item: usize,
        wall: &Wall,
        pose: &Isometry3<f64>,
        velocity: Vector,
    ) -> Option<Self> {
        let (center, normal) = (pose * wall.center, pose.rotation * wall.normal);
        let to_radar = view.origin() - center;
        let distance = normal.dot(&to_radar);
        let near = distance > 0.3 && to_radar.norm() < REACH + wall.half[0];
        near.then(|| Self {
            item,
            center,
            normal,
            half: wall.half,
            loss_db: (view.waves.mirror_loss_db + wall.loss_db).max(0.3),
            roughness: wall.roughness * view.waves.mirror_heights,
            bulge: wall.bulge,
            distance,
            velocity,
        })
    }

    fn image(&self, p: &Point) -> Point {
        p - self.normal * (2.0 * self.normal.dot(&(p - self.center)))
    }

    /// Where the wave to the image of `p` is reflected.
    fn point_of_reflection(&self, origin: &Point, p: &Point) -> Option<Point> {
        let before = self.normal.dot(&(p - self.center));
        if before < 0.3 {
            return None;
        }
        let at = origin + (self.image(p) - origin) * (self.distance / (self.distance + before));
        let offset = at - self.center;
        let along = self.normal.x * offset.y - self.normal.y * offset.x;
        (along.abs() <= self.half[0] && offset.z.abs() <= self.half[1]).then_some(at)
    }

    /// What it takes from a wave to `p` that it reflects at `at`, one way, dB. Roughness takes
    /// `exp(-(4 pi s cos / wavelength)^2)` of what goes on in one direction (Ament 1953), and what bulges spreads it,
    /// by `1 + 2 d / (r cos)` in the plane of incidence and `1 + 2 d cos / r` across it, where `1 / d` is the sum of
    /// both ways' inverses (Kerr 1951).
    fn takes_db(&self, origin: &Point, at: &Point, p: &Point) -> f64 {
        let [before, after] = [(at - origin).norm(), (p - at).norm()];
        let cosine = (self.distance / before).clamp(0.01, 1.0);
        let rough = 4.0 * PI * self.roughness * cosine / WAVELENGTH;
        let way = 2.0 * before * after / (before + after);
        let spread = (1.0 + way * self.bulge[0] / cosine) * (1.0 + way * self.bulge[1] * cosine);
        self.loss_db + 10.0 * LOG10_E * rough * rough + decibel(spread)
    }

    /// How an image moves whose original moves.
    fn mirrored(&self, velocity: &Vector) -> Vector {
        velocity - self.normal * (2.0 * self.normal.dot(&(velocity - self.velocity)))
    }
}

/// The images of what was heard directly, in every wall that faces the radar.
pub(super) fn mirrored(view: &View<'_>, targets: &[Target], random: &mut Random) -> Vec<Echo> {
    let mut found = Vec::new();
    for mirror in mirrors(view) {
        for target in targets.iter().filter(|target| target.item != mirror.item && !target.flash) {
            found.extend(images(view, &mirror, target, random).into_iter().flatten().flatten());
        }
    }
    found
}

fn mirrors(view: &View<'_>) -> Vec<Mirror> {
    let site = view.moment.site;
    let mut found = Vec::new();
    for (index, item) in site.items.iter().enumerate() {
        let pose = &view.moment.poses[index];
        let velocity = item.velocity(&site.terrain, view.moment.seconds);
        found.extend(item.walls.iter().filter_map(|wall| Mirror::new(view, index, wall, pose, velocity)));
    }
    found
}

/// The image (there and back by the mirror), and the paths by the mirror on one way alone: these seem to come from the
/// mirror or from the thing itself, at the mean of both ranges.
fn images(
    view: &View<'_>,
    mirror: &Mirror,
    target: &Target,
    random: &mut Random,
) -> Option<[Option<Echo>; 3]> {
    let at = mirror.point_of_reflection(&view.origin(), &target.place)?;
    let direct = target.echo.seen;
    let image = mirror.image(&target.place);
    let around = view.seen(&image)?;
    if around.range > direct.range + 2.0 * REACH {
        return None;
    }
    let level_db = decibel(target.echo.power) + fluctuation_db(random);
    let spread_db = range_loss_db(around.range) - range_loss_db(direct.range);
    let origin = view.origin();
    // The way by the mirror, once.
    let longer_db = mirror.takes_db(&origin, &at, &target.place) + spread_db / 2.0;
    let hope = view.radar.threshold_db - 3.0;
    if level_db - longer_db < hope {
        return None;
    }
    let on_db = view.between_db(&(at + mirror.normal * 0.02), &target.place, &[target.item])?;
    let there_db = view.between_db(&origin, &at, &[mirror.item])?;
    let way_db = longer_db + (on_db + there_db) / 2.0;
    let aside_db = target.other_way_db(view, &at, &origin);
    let behind_db = target.other_way_db(view, &at, &at);
    let image_rate = view.range_rate(&image, &mirror.mirrored(&target.velocity));
    let mixed_rate = f64::midpoint(image_rate, target.echo.range_rate);
    let heard = |seen: Spherical, rate: f64, level_db: f64| {
        (level_db > hope).then(|| Echo::new(seen, rate, level_db, truth(&target.echo, &seen)))
    };
    let pure = behind_db.and_then(|more| heard(around, image_rate, level_db - 2.0 * way_db + more));
    let mixed = |seen: Spherical| {
        let seen = Spherical { range: f64::midpoint(around.range, direct.range), ..seen };
        heard(seen, mixed_rate, level_db - way_db + aside_db?)
    };
    Some([pure, mixed(around), mixed(direct)])
}

/// An image beside its original is on the same surface as good as.
fn truth(original: &Echo, seen: &Spherical) -> Truth {
    if displaced(original, seen) > APART { Truth::artifact(Cause::Mirror) } else { original.truth }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A smooth, flat, upright mirror at x = 10 m.
    fn mirror() -> Mirror {
        Mirror {
            item: 0,
            center: Point::new(10.0, 0.0, 0.0),
            normal: -Vector::x(),
            half: [100.0, 2.0],
            loss_db: 3.0,
            roughness: 0.0,
            bulge: [0.0; 2],
            distance: 10.0,
            velocity: Vector::zeros(),
        }
    }

    /// What it takes from a wave that leaves it as steeply as it came.
    fn taken_db(roughness: f64, bulge: [f64; 2], aside: f64) -> f64 {
        let mirror = Mirror { roughness, bulge, ..mirror() };
        let (origin, other) = (Point::origin(), Point::new(0.0, 2.0 * aside, 0.0));
        let at = mirror.point_of_reflection(&origin, &other).unwrap();
        assert!((at - Point::new(10.0, aside, 0.0)).norm() < 1e-9);
        mirror.takes_db(&origin, &at, &other)
    }

    #[test]
    fn an_image_moves_as_its_places_say_whatever_moves() {
        const STEP: f64 = 1e-4;
        let (thing, drives) = (Point::new(14.0, 2.0, 1.2), Vector::new(-9.0, 1.5, 0.3));
        for (velocity, normal) in [
            (Vector::zeros(), -Vector::y()),
            (Vector::new(12.0, -2.0, 0.0), -Vector::y()),
            (Vector::new(4.0, 7.0, 0.0), Vector::new(-0.6, -0.8, 0.0)),
        ] {
            let center = Point::new(8.0, 6.0, 1.0);
            let at =
                |seconds: f64| Mirror { center: center + velocity * seconds, normal, velocity, ..mirror() };
            let image = |seconds: f64| at(seconds).image(&(thing + drives * seconds));
            let slope = (image(STEP) - image(-STEP)) / (2.0 * STEP);
            assert!((slope - at(0.0).mirrored(&drives)).norm() < 1e-6, "{slope}");
        }
    }

    #[test]
    fn a_smooth_flat_mirror_takes_what_its_material_does() {
        for aside in [0.0, 5.0, 30.0] {
            assert!((taken_db(0.0, [0.0; 2], aside) - 3.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_rough_mirror_is_one_to_grazing_waves_alone() {
        let [ahead, grazing] = [0.0, 60.0].map(|aside| taken_db(1e-3, [0.0; 2], aside));
        // (4 pi 1 mm / 3.9 mm)^2 is 10.4: 45 dB.
        assert!((ahead - 48.1).abs() < 0.2 && grazing < 5.0, "{ahead} {grazing}");
    }

    #[test]
    fn a_bent_mirror_spreads_a_wave() {
        // At right angles both axes do alike: 1 + 2 * 5 m / 5 m.
        for bulge in [[0.2, 0.0], [0.0, 0.2]] {
            assert!((taken_db(0.0, bulge, 0.0) - 3.0 - decibel(3.0)).abs() < 1e-9);
        }
    }
}
