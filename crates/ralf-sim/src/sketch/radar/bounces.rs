//! Waves that meet two things, or one of them twice.

use super::direct::Heard;
use super::images::is_detected;
use super::spherical;
use super::view::{Echo, THRESHOLD_DB, View, fading_db, told_apart};
use crate::random::{Random, grain};
use crate::truth::Truth;
use ralf::label::Cause;
use ralf::space::Point;

/// Of what rises so far above the threshold pairs are drawn, dB, and how many of them.
const STRONG_DB: f64 = 15.0;
const PAIRS: usize = 160;
/// So far apart things are that send waves to one another, m.
const APART: [f64; 2] = [1.0, 14.0];
/// What is lost besides the ways, dB.
const ASIDE_DB: f64 = 8.0;
/// Up to here a thing and the own front send waves to and fro, m.
const NEAR: f64 = 22.0;

/// Parts of vehicles that are lower send waves under the floor, m.
const LOW: f64 = 0.8;
/// How far beyond a vehicle's bodies its outline is drawn, m.
const OUTLINE: f64 = 0.3;
/// Cars, lorries, other vehicles.
const VEHICLES: [u16; 3] = [10, 18, 20];

/// Over a neighbour and back.
pub(super) fn between_things(view: &View<'_>, heard: &[Heard], random: &mut Random) -> Vec<Echo> {
    let strong = |heard: &&Heard| is_detected(view, heard) && heard.level_db > THRESHOLD_DB + STRONG_DB;
    let strong: Vec<&Heard> = heard.iter().filter(strong).collect();
    if strong.len() < 2 {
        return Vec::new();
    }
    let mut one = || strong[(random.uniform() * strong.len() as f64) as usize];
    let pairs: Vec<[&Heard; 2]> = (0..PAIRS).map(|_| [one(), one()]).collect();
    pairs.into_iter().filter_map(|[a, b]| over(view, a, b, random)).collect()
}

fn over(view: &View<'_>, a: &Heard, b: &Heard, random: &mut Random) -> Option<Echo> {
    let way = b.place - a.place;
    let apart = way.norm();
    if a.thing == b.thing || !(APART[0]..APART[1]).contains(&apart) {
        return None;
    }
    let range = (a.seen.range + b.seen.range + apart) / 2.0;
    let pattern = |heard: &Heard| view.gain_db(heard.seen.azimuth, view.clamped(heard.seen.elevation)) / 2.0;
    let level_db = view.level_db((a.seen.range * b.seen.range).sqrt()) + a.strength_db + b.strength_db
        - 20.0 * apart.log10()
        - ASIDE_DB
        + pattern(a)
        + pattern(b)
        + fading_db(random);
    let told = range - a.seen.range > told_apart(view.radar) && range < view.radar.max_range;
    if level_db < THRESHOLD_DB || !told || a.seen.elevation.abs() > view.radar.half_view[1] {
        return None;
    }
    let between = (b.velocity - a.velocity).dot(&way) / apart;
    let seen = spherical(range, a.seen.azimuth, a.seen.elevation);
    Some(Echo {
        seen: view.measured(seen, level_db, 1.2, random),
        rate: (a.rate + b.rate + between) / 2.0,
        level_db,
        truth: Truth::artifact(Cause::DoubleBounce),
    })
}

/// To and fro between a vehicle's floor and the road: told some metres behind a part of it, again and again where that
/// part does so at all (Kopp et al. 2021). What still lies within the outline is the vehicle.
pub(super) fn under_vehicles(view: &View<'_>, heard: &[Heard], random: &mut Random) -> Vec<Echo> {
    let scene = view.moment.scene();
    let [share, mean] = view.radar.under_floor;
    let mut found = Vec::new();
    for heard in heard.iter().filter(|heard| is_detected(view, heard)) {
        let (Some(thing), Some(spot)) = (heard.thing, heard.spot) else { continue };
        let of_its_own = |what: i64| grain(spot as u64, [thing as i64, what, 0]);
        let vehicle = VEHICLES.contains(&scene.things[thing].class) && scene.spots[spot].at.z < LOW;
        let level_db = heard.level_db - random.between(2.0, 12.0);
        if !vehicle || of_its_own(0) > share || level_db < THRESHOLD_DB {
            continue;
        }
        let further = 0.5 - mean * (1.0 - of_its_own(1)).ln() + random.normal(0.3);
        let range = heard.seen.range + further.max(0.5);
        if range < view.radar.max_range {
            let seen = spherical(range, heard.seen.azimuth, view.clamped(heard.seen.elevation));
            let place = view.site_from_radar * seen.to_cartesian();
            found.push(Echo {
                seen: view.measured(seen, level_db, 1.2, random),
                rate: heard.rate + random.normal(0.1),
                level_db,
                truth: under_vehicle(view, thing, &place),
            });
        }
    }
    found
}

fn under_vehicle(view: &View<'_>, thing: usize, place: &Point) -> Truth {
    let own = view.moment.poses[thing].isometry.inverse_transform_point(place);
    let scene = view.moment.scene();
    let inside = scene.bodies.iter().filter(|body| body.thing == thing).any(|body| {
        let (half, off) = (body.shape.half_size(), own - body.center);
        off.x.abs() < half.x + OUTLINE && off.y.abs() < half.y + OUTLINE
    });
    match inside {
        true => Truth { class: scene.things[thing].class, cause: Cause::Plausible },
        false => Truth::artifact(Cause::DoubleBounce),
    }
}

/// To a thing, back to the own bumper, and once more.
pub(super) fn with_the_own_front(view: &View<'_>, heard: &[Heard], random: &mut Random) -> Vec<Echo> {
    let near = |heard: &&Heard| {
        is_detected(view, heard) && heard.seen.range < NEAR && heard.level_db > THRESHOLD_DB + 18.0
    };
    let mut found = Vec::new();
    for heard in heard.iter().filter(near) {
        let level_db = heard.level_db - 12.0 - random.between(6.0, 16.0);
        let range = 2.0 * heard.seen.range + 0.1;
        if level_db > THRESHOLD_DB && range < view.radar.max_range && random.chance(0.5) {
            let seen = spherical(range, heard.seen.azimuth, view.clamped(heard.seen.elevation));
            found.push(Echo {
                seen: view.measured(seen, level_db, 1.0, random),
                rate: 2.0 * heard.rate,
                level_db,
                truth: Truth::artifact(Cause::DoubleBounce),
            });
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sketch::tests::{mirror_and_car, view_of};

    #[test]
    fn under_a_vehicle_is_the_vehicle_and_behind_it_is_nothing() {
        let stage = mirror_and_car();
        let moment = stage.at(0.0);
        let view = view_of(&moment, 0.0);
        let lorry = &moment.poses[0].isometry;
        let inside = under_vehicle(&view, 0, &(lorry * Point::new(29.0, 0.0, 0.1)));
        assert_eq!((inside.class, inside.cause), (18, Cause::Plausible));
        let behind = under_vehicle(&view, 0, &(lorry * Point::new(31.0, 0.0, 0.1)));
        assert_eq!((behind.class, behind.cause), (1, Cause::DoubleBounce));
    }
}
