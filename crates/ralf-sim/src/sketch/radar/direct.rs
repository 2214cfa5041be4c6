//! What is there: spots of things and of the ground, and the glints of smooth sides.

use super::view::{Echo, THRESHOLD_DB, View, fading_db};
use crate::random::Random;
use crate::sketch::moment::GONE_DB;
use crate::truth::Truth;
use ralf::label::Cause;
use ralf::space::{Point, Spherical, Vector};

/// So far below the threshold there is no hope, dB.
const HOPE_DB: f64 = 8.0;
/// A glint of a side that takes nothing from it, dBsm, and its spread.
const GLINT_DB: [f64; 2] = [14.0, 4.0];
/// Outside of the view up and down the antenna hears so much less than at its edge, dB.
const BEYOND_DB: f64 = 14.0;
/// What the ground's strength is said for: the sine of the grazing angle.
const GRAZING: f64 = 0.1;
/// Stirring of the ground, m/s.
const STIR: f64 = 0.02;

/// A spot as it is heard.
#[derive(Debug, Clone, Copy)]
pub(super) struct Heard {
    pub(super) place: Point,
    pub(super) velocity: Vector,
    /// `None`: the ground.
    pub(super) thing: Option<usize>,
    /// Its number among the spots of all things, where it is one.
    pub(super) spot: Option<usize>,
    pub(super) strength_db: f64,
    pub(super) seen: Spherical,
    pub(super) rate: f64,
    /// Before anything stands in its way, and without fading.
    pub(super) clear_db: f64,
    /// With both.
    pub(super) level_db: f64,
}

/// Where something reflects.
struct Source {
    place: Point,
    velocity: Vector,
    thing: Option<usize>,
    spot: Option<usize>,
    facing: Option<Vector>,
    strength_db: f64,
    flutter: f64,
}

/// All that could be heard; what is hidden or too weak has a level below the threshold.
pub(super) fn heard(view: &View<'_>, random: &mut Random) -> Vec<Heard> {
    let reach = 1.9 * view.radar.max_range;
    let mut found = Vec::new();
    for source in things(view, random).into_iter().chain(ground(view)) {
        if (source.place - view.origin()).norm() < reach {
            found.extend(hear(view, &source, random));
        }
    }
    found
}

fn things(view: &View<'_>, random: &mut Random) -> Vec<Source> {
    let (scene, poses) = (view.moment.scene(), &view.moment.poses);
    let spots = scene.spots.iter().enumerate().map(|(number, spot)| {
        let pose = &poses[spot.thing];
        let place = pose.isometry * spot.at;
        Source {
            place,
            velocity: pose.velocity_at(&place),
            thing: Some(spot.thing),
            spot: Some(number),
            facing: spot.facing.map(|facing| pose.isometry.rotation * facing),
            strength_db: spot.strength_db,
            flutter: scene.things[spot.thing].flutter,
        }
    });
    let mut found: Vec<Source> = spots.collect();
    let origin = view.origin();
    for face in view.moment.faces(&origin, 1.5 * view.radar.max_range) {
        let aside = (origin - face.center).dot(&face.along);
        let up = origin.z - face.center.z;
        if aside.abs() < face.half[0] && up.abs() < face.half[1] + 0.1 {
            let level = up.clamp(-face.half[1], face.half[1]);
            found.push(Source {
                place: face.center + face.along * aside + Vector::z() * level,
                velocity: poses[face.thing].velocity,
                thing: Some(face.thing),
                spot: None,
                facing: Some(face.normal),
                strength_db: GLINT_DB[0] - face.loss_db + random.normal(GLINT_DB[1]),
                flutter: 0.0,
            });
        }
    }
    found
}

fn ground(view: &View<'_>) -> impl Iterator<Item = Source> {
    let (origin, height) = (view.origin(), view.height() + 0.05);
    let relief = &view.moment.scene().relief;
    let near =
        move |spot: &&[f64; 3]| (spot[0] - origin.x).hypot(spot[1] - origin.y) < view.radar.ground_range;
    view.ground.iter().filter(near).map(move |[x, y, strength_db]| {
        let place = Point::new(*x, *y, relief.height(*x, *y) + 0.01);
        let grazing = (height / (place - origin).norm()).clamp(0.005, 1.0);
        Source {
            place,
            velocity: Vector::zeros(),
            thing: None,
            spot: None,
            facing: None,
            strength_db: strength_db + 6.0 * (grazing / GRAZING).log10(),
            flutter: STIR,
        }
    })
}

fn hear(view: &View<'_>, source: &Source, random: &mut Random) -> Option<Heard> {
    let Source { place, velocity, thing, spot, .. } = *source;
    let seen = view.seen(&place);
    if seen.range < 0.25 || !view.is_ahead(seen.azimuth / 1.02) {
        return None;
    }
    let towards = (view.origin() - place) / seen.range;
    let facing = source.facing.map_or(1.0, |facing| facing.dot(&towards));
    if facing < -0.05 {
        return None;
    }
    let high = view.radar.half_view[1];
    let beyond = if seen.elevation.abs() < high { 0.0 } else { BEYOND_DB };
    let strength_db = source.strength_db + 12.0 * facing.clamp(0.05, 1.0).log10();
    let clear_db =
        strength_db + view.level_db(seen.range) + view.gain_db(seen.azimuth, view.clamped(seen.elevation))
            - beyond;
    if clear_db < THRESHOLD_DB - HOPE_DB {
        return None;
    }
    let loss = view.moment.loss_db(&view.origin(), &place, [thing, None]);
    let level_db = if loss < GONE_DB { clear_db - loss + fading_db(random) } else { f64::NEG_INFINITY };
    let rate = view.rate(&place, &velocity) + random.normal(source.flutter);
    let strength_db = source.strength_db;
    Some(Heard { place, velocity, thing, spot, strength_db, seen, rate, clear_db, level_db })
}

/// Of what is detected directly, or folded back from beyond the farthest range.
pub(super) fn echoes(view: &View<'_>, heard: &[Heard], random: &mut Random) -> Vec<Echo> {
    let above = heard.iter().filter(|heard| heard.level_db > THRESHOLD_DB);
    above.filter_map(|heard| echo(view, heard, random)).collect()
}

fn echo(view: &View<'_>, heard: &Heard, random: &mut Random) -> Option<Echo> {
    let Heard { seen, rate, level_db, .. } = *heard;
    let folded = seen.range - view.radar.max_range;
    if folded > 0.0 {
        let level_db = level_db - view.radar.fold_db;
        let seen = view.measured(Spherical { range: folded, ..seen }, level_db, 1.0, random);
        let truth = Truth::artifact(Cause::Ambiguity);
        return (level_db > THRESHOLD_DB && folded > 2.0).then_some(Echo { seen, rate, level_db, truth });
    }
    let (seen, is_there) = place(view, &seen, level_db, random);
    let truth = match heard.thing.map(|thing| view.moment.scene().things[thing].class) {
        None | Some(1) => Truth::artifact(Cause::Road),
        Some(_) if !is_there => Truth::artifact(Cause::Ambiguity),
        Some(class) => Truth { class, cause: Cause::Plausible },
    };
    Some(Echo { seen, rate, level_db, truth })
}

/// Where it is told to be, and whether that is still where it is: within three standard deviations.
fn place(view: &View<'_>, seen: &Spherical, level_db: f64, random: &mut Random) -> (Spherical, bool) {
    let errors = view.errors(seen.azimuth, level_db, 1.0, random);
    let [range, azimuth, elevation] = errors.off;
    let [sigma_range, sigma_azimuth, sigma_elevation] = view.radar.sigmas;
    let near = range.abs() < 3.0 * sigma_range && azimuth.abs() < 3.0 * sigma_azimuth * errors.edge;
    if view.radar.elevation {
        let high = view.radar.half_view[1];
        // What lies outside of the array's own view is told to lie anywhere in it.
        let told = if seen.elevation.abs() > high {
            random.between(-high, high)
        } else {
            view.clamped(seen.elevation + elevation)
        };
        let near = near && (told - seen.elevation).abs() < 3.0 * sigma_elevation;
        let seen = Spherical { range: seen.range + range, azimuth: seen.azimuth + azimuth, elevation: told };
        return (seen, near);
    }
    // A level array measures the cone about its own axis, and the slant range.
    let level = seen.range * seen.elevation.cos();
    let cone = (seen.azimuth.sin() * seen.elevation.cos()).clamp(-1.0, 1.0).asin();
    let near = near && (seen.range + range - level).abs() < 3.0 * sigma_range;
    (Spherical { range: seen.range + range, azimuth: cone + azimuth, elevation: 0.0 }, near)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Purpose;
    use crate::sketch::tests::{mirror_and_car, view_of};

    #[test]
    fn range_rates_are_the_slopes_of_ranges() {
        let stage = mirror_and_car();
        let range = |t: f64| {
            let moment = stage.at(t);
            let view = view_of(&moment, t);
            let spot = moment.scene().spots[0];
            view.seen(&(moment.poses[spot.thing].isometry * spot.at)).range
        };
        let moment = stage.at(0.0);
        let heard = heard(&view_of(&moment, 0.0), &mut Random::new(1, Purpose::Radar, 0, 0));
        let car = heard.iter().find(|heard| heard.thing == Some(1)).unwrap();
        let slope = (range(1e-4) - range(-1e-4)) / 2e-4;
        assert!((car.rate - slope).abs() < 1e-5, "{} {slope}", car.rate);
    }
}
