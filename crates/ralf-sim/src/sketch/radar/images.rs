//! Images of things: below the ground, and behind smooth sides.

use super::direct::Heard;
use super::spherical;
use super::view::{Echo, THRESHOLD_DB, View, fading_db, told_apart};
use crate::random::Random;
use crate::sketch::moment::Face;
use crate::truth::Truth;
use ralf::label::Cause;
use ralf::space::{Point, Spherical, Vector};

/// Nothing farther off is a mirror, m.
const FAR: f64 = 60.0;
/// A mirror is at least so long, m.
const SHORTEST: f64 = 2.0;
/// Mirrors and things that are looked at, the nearest and the strongest.
const MIRRORS: usize = 60;
const MIRRORED: usize = 240;
/// Half of a way over a mirror is told where the mirror is, half where the thing is.
const BY_THE_MIRROR: f64 = 0.5;
/// Ways over a mirror and back straight that are told.
const ONE_WAY: f64 = 0.7;

/// The ground as a mirror: there and back over it, or one way.
pub(super) fn in_the_ground(view: &View<'_>, heard: &[Heard], random: &mut Random) -> Vec<Echo> {
    let mut found = Vec::new();
    if !view.radar.elevation {
        return found;
    }
    let relief = &view.moment.scene().relief;
    for heard in heard.iter().filter(|heard| is_detected(view, heard)) {
        let above = heard.place.z - relief.height(heard.place.x, heard.place.y);
        if above < 0.25 || !random.chance(view.radar.ground_mirror) {
            continue;
        }
        let both = random.chance(0.5);
        let image = view.seen(&(heard.place - Vector::z() * (2.0 * above)));
        let level_db = heard.level_db - random.between(2.0, 12.0) - if both { 4.0 } else { 0.0 };
        let range = if both { image.range } else { image.range.midpoint(heard.seen.range) };
        let elevation = image.elevation * if both { 1.0 } else { random.between(0.5, 1.0) };
        let seen = view.measured(spherical(range, image.azimuth, elevation), level_db, 1.0, random);
        let apart = (elevation - heard.seen.elevation).abs() > 2.0 * view.radar.sigmas[2];
        if level_db > THRESHOLD_DB && apart {
            found.push(Echo { seen, rate: heard.rate, level_db, truth: Truth::artifact(Cause::Mirror) });
        }
    }
    found
}

pub(super) fn is_detected(view: &View<'_>, heard: &Heard) -> bool {
    heard.thing.is_some() && heard.level_db > THRESHOLD_DB && heard.seen.range < view.radar.max_range
}

/// Walls, rails, containers and sides of vehicles as mirrors.
pub(super) fn in_faces(view: &View<'_>, heard: &[Heard], random: &mut Random) -> Vec<Echo> {
    let mut faces = view.moment.faces(&view.origin(), FAR);
    faces.retain(|face| 2.0 * face.half[0] >= SHORTEST);
    faces.truncate(MIRRORS);
    let mut found = Vec::new();
    let things = strongest(heard, random);
    for face in &faces {
        for heard in things.iter().filter(|heard| heard.thing != Some(face.thing)) {
            found.extend(over(view, face, heard, random));
        }
    }
    found
}

fn strongest<'a>(heard: &'a [Heard], random: &mut Random) -> Vec<&'a Heard> {
    let things = heard.iter().filter(|heard| heard.thing.is_some() && heard.clear_db > THRESHOLD_DB + 4.0);
    let mut ranked: Vec<(f64, &Heard)> = things
        .map(|heard| {
            let moves = if heard.velocity.norm() > 1.0 { 8.0 } else { 0.0 };
            (heard.clear_db + moves + random.normal(6.0), heard)
        })
        .collect();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    ranked.into_iter().take(MIRRORED).map(|(_, heard)| heard).collect()
}

/// A way over a mirror.
struct Way {
    /// Where it meets the mirror.
    at: Point,
    /// The antenna's image.
    from: Point,
}

fn way(view: &View<'_>, face: &Face, place: &Point) -> Option<Way> {
    let origin = view.origin();
    let [near, far] = [(origin - face.center).dot(&face.normal), (place - face.center).dot(&face.normal)];
    if near < 0.2 || far < 0.25 {
        return None;
    }
    let from = origin - face.normal * (2.0 * near);
    let at = from + (place - from) * (near / (near + far));
    let aside = (at - face.center).dot(&face.along);
    let inside = aside.abs() < face.half[0] && (at.z - face.center.z).abs() < face.half[1];
    inside.then_some(Way { at, from })
}

/// What is heard of a thing over a mirror: there and back, and there or back.
fn over(view: &View<'_>, face: &Face, heard: &Heard, random: &mut Random) -> Vec<Echo> {
    let Some(Way { at, from }) = way(view, face, &heard.place) else { return Vec::new() };
    let towards = view.seen(&at);
    let range = (heard.place - from).norm();
    let clear = heard.strength_db + view.level_db(range) - 2.0 * face.loss_db;
    if clear + 12.0 < THRESHOLD_DB || !view.is_ahead(towards.azimuth) {
        return Vec::new();
    }
    let mirror = Some(face.thing);
    let image = Image {
        face,
        heard,
        towards,
        range,
        rate: image_rate(view, face, heard, &from),
        loss_db: view.moment.loss_db(&view.origin(), &at, [mirror, None])
            + view.moment.loss_db(&at, &heard.place, [heard.thing, mirror]),
    };
    let both = image.both_ways(view, random);
    both.into_iter().chain(image.one_way(view, random)).collect()
}

/// A thing behind a mirror.
struct Image<'a> {
    face: &'a Face,
    heard: &'a Heard,
    /// Where the mirror shows it.
    towards: Spherical,
    /// m.
    range: f64,
    /// m/s.
    rate: f64,
    /// On the way over the mirror, there and back.
    loss_db: f64,
}

impl Image<'_> {
    fn pattern_db(&self, view: &View<'_>) -> f64 {
        view.gain_db(self.towards.azimuth, self.towards.elevation)
    }

    fn both_ways(&self, view: &View<'_>, random: &mut Random) -> Option<Echo> {
        let Self { face, heard, towards, range, rate, loss_db } = *self;
        let clear = heard.strength_db + view.level_db(range) - 2.0 * face.loss_db;
        let level_db = clear - loss_db + self.pattern_db(view) - view.radar.mirror_db + fading_db(random);
        let inside = towards.elevation.abs() < view.radar.half_view[1] && range < view.radar.max_range;
        if level_db < THRESHOLD_DB || !inside {
            return None;
        }
        let seen = spherical(range, towards.azimuth, towards.elevation);
        let seen = view.measured(seen, level_db, 1.3, random);
        Some(Echo { seen, rate, level_db, truth: Truth::artifact(Cause::Mirror) })
    }

    fn one_way(&self, view: &View<'_>, random: &mut Random) -> Option<Echo> {
        let Self { face, heard, towards, range, rate, loss_db } = *self;
        let straight = view.moment.loss_db(&view.origin(), &heard.place, [heard.thing, None]);
        let mean = range.midpoint(heard.seen.range);
        let own = view.gain_db(heard.seen.azimuth, view.clamped(heard.seen.elevation));
        let level_db = heard.strength_db + view.level_db((range * heard.seen.range).sqrt())
            - face.loss_db
            - (loss_db + straight) / 2.0
            + (self.pattern_db(view) + own) / 2.0
            - view.radar.mirror_db / 2.0
            + fading_db(random);
        let apart = mean - heard.seen.range > told_apart(view.radar) && mean < view.radar.max_range;
        if level_db < THRESHOLD_DB || !apart || !random.chance(ONE_WAY) {
            return None;
        }
        let told = if random.chance(BY_THE_MIRROR) { towards } else { heard.seen };
        let seen = spherical(mean, told.azimuth, told.elevation);
        let rate = rate.midpoint(heard.rate);
        let seen = view.measured(seen, level_db, 1.3, random);
        Some(Echo { seen, rate, level_db, truth: Truth::artifact(Cause::Mirror) })
    }
}

/// Range rate of a thing as it is seen from the antenna's image, which moves as the mirror lets it.
fn image_rate(view: &View<'_>, face: &Face, heard: &Heard, from: &Point) -> f64 {
    let mirror = view.moment.poses[face.thing].velocity;
    let own = view.velocity - mirror;
    let imaged = own - face.normal * (2.0 * own.dot(&face.normal)) + mirror;
    let way = heard.place - from;
    (heard.velocity - imaged).dot(&way) / way.norm()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sketch::tests::{mirror_and_car, view_of};

    const STEP: f64 = 1e-4;

    #[test]
    fn the_rate_of_an_image_is_the_slope_of_its_range() {
        let stage = mirror_and_car();
        let length = |t: f64| {
            let moment = stage.at(t);
            let view = view_of(&moment, t);
            let face = view.moment.faces(&view.origin(), 40.0)[0];
            let heard = heard_car(&view);
            let way = way(&view, &face, &heard.place).unwrap();
            (heard.place - way.from).norm()
        };
        let moment = stage.at(0.0);
        let view = view_of(&moment, 0.0);
        let face = view.moment.faces(&view.origin(), 40.0)[0];
        let heard = heard_car(&view);
        let from = way(&view, &face, &heard.place).unwrap().from;
        let slope = (length(STEP) - length(-STEP)) / (2.0 * STEP);
        let rate = image_rate(&view, &face, &heard, &from);
        assert!((slope - rate).abs() < 1e-5 && rate < -5.0, "{slope} {rate}");
    }

    fn heard_car(view: &View<'_>) -> Heard {
        let pose = &view.moment.poses[1];
        let place = pose.isometry * view.moment.scene().spots[0].at;
        let velocity = pose.velocity_at(&place);
        Heard {
            place,
            velocity,
            thing: Some(1),
            spot: Some(0),
            strength_db: 10.0,
            seen: view.seen(&place),
            rate: view.rate(&place, &velocity),
            clear_db: 40.0,
            level_db: 40.0,
        }
    }
}
