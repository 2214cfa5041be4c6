//! Waves that are thrown to and fro before they come back: between the own front and a thing, between two things, and
//! between a vehicle's floor and the road.

use super::echo::{Echo, View, fluctuation_db};
use super::equation::{apparent_rcs_db, decibel, range_loss_db};
use super::targets::Target;
use crate::kind::Kind;
use crate::random::Random;
use crate::truth::Truth;
use nalgebra::Isometry3;
use ralf::label::Cause;
use ralf::space::{Point, Spherical};

/// A further trip is lost beyond this first one, m.
const FARTHEST: f64 = 30.0;
/// How many of the strongest echoes are thrown on.
const STRONGEST: usize = 32;
/// `4 pi`, of a wave that spreads once more, dB.
const SPREAD_DB: f64 = 11.0;
/// Farther from each other, two things don't throw waves to each other, m.
const NEIGHBOURS: f64 = 25.0;
/// Parts of vehicles below this height send waves under the floor, m.
const FLOOR: f64 = 1.0;
/// What a metre of way under a floor takes, dB (chosen).
const UNDER_FLOOR_DB: f64 = 3.0;
/// What is so near to a vehicle's outline belongs to it, m.
const OUTLINE: f64 = 1.0;

/// All of them.
pub(super) fn bounces(view: &View<'_>, targets: &[Target], random: &mut Random) -> Vec<Echo> {
    let mut strongest: Vec<&Target> = targets.iter().collect();
    strongest.sort_by(|a, b| b.echo.power.total_cmp(&a.echo.power));
    strongest.truncate(STRONGEST);
    let mut found = Vec::new();
    for target in &strongest {
        found.extend(trips(view, target, random).into_iter().flatten());
    }
    for (number, first) in strongest.iter().enumerate() {
        let others = strongest[number + 1..].iter().filter(|second| second.item != first.item);
        for second in others.filter(|second| !first.flash && !second.flash) {
            found.extend(triangle(view, first, second, random).into_iter().flatten());
        }
    }
    found.extend(targets.iter().filter_map(|target| under_floor(view, target, random)));
    found
}

/// To a thing, back to the own front, and the same way again, once or twice: so many times the range and range rate.
fn trips(view: &View<'_>, target: &Target, random: &mut Random) -> [Option<Echo>; 2] {
    let Spherical { range, azimuth, elevation } = target.echo.seen;
    let first_db = decibel(target.echo.power);
    // Radar equation once more: each trip spreads by 4 pi r^2 either way, and the thing's cross-section counts again.
    let again_db =
        rcs_db(view, target) + view.waves.own_front_db - 2.0 * SPREAD_DB - 40.0 * range.max(1.0).log10();
    [2.0, 3.0].map(|times| {
        let seen = Spherical { range: times * range, azimuth, elevation };
        let level = first_db + (times - 1.0) * again_db.min(-8.0) + random.normal(3.0);
        let heard = range < FARTHEST && seen.range < view.radar.max_range && is_heard(view, level);
        heard.then(|| Echo::artifact(seen, times * target.echo.range_rate, level, Cause::DoubleBounce))
    })
}

fn rcs_db(view: &View<'_>, target: &Target) -> f64 {
    let Spherical { range, azimuth, .. } = target.echo.seen;
    apparent_rcs_db(view.radar, decibel(target.echo.power), range, azimuth)
}

fn is_heard(view: &View<'_>, level_db: f64) -> bool {
    level_db > view.radar.threshold_db - 3.0
}

/// Radar, one thing, another thing, radar, and the other way about: it seems to come from either, half the detour
/// farther. Against the mean of both direct echoes it has `sqrt(rcs rcs') / (4 pi d^2)`.
fn triangle(view: &View<'_>, first: &Target, second: &Target, random: &mut Random) -> [Option<Echo>; 2] {
    let between = (first.place - second.place).norm();
    if !(0.5..NEIGHBOURS).contains(&between) {
        return [None, None];
    }
    let mean = |value: fn(&View<'_>, &Target) -> f64| f64::midpoint(value(view, first), value(view, second));
    let level = mean(|_, target| decibel(target.echo.power)) + mean(rcs_db).min(20.0)
        - SPREAD_DB
        - 20.0 * between.log10();
    let Some(level) = on_the_way_db(view, first, second, level) else { return [None, None] };
    let range = (first.echo.seen.range + between + second.echo.seen.range) / 2.0;
    let rate = f64::midpoint(first.echo.range_rate, second.echo.range_rate);
    [first, second].map(|last| {
        let level = level + random.normal(4.0);
        let off = range - last.echo.seen.range;
        let heard = is_heard(view, level) && off > 1.0 && range < view.radar.max_range;
        let seen = Spherical { range, ..last.echo.seen };
        heard.then(|| Echo::artifact(seen, rate, level, Cause::DoubleBounce))
    })
}

/// What is left where two things throw a wave of so much power to each other, if it is heard.
fn on_the_way_db(view: &View<'_>, first: &Target, second: &Target, level_db: f64) -> Option<f64> {
    let origin = view.origin();
    let level = level_db
        + first.other_way_db(view, &origin, &second.place)?
        + second.other_way_db(view, &origin, &first.place)?;
    if !is_heard(view, level + 12.0) {
        return None;
    }
    Some(level - view.between_db(&first.place, &second.place, &[first.item, second.item])? / 2.0)
}

/// To and fro between a vehicle's floor and the road: as fast as the vehicle, and some metres behind what was hit
/// (Kopp et al. 2021). What still lies within the outline is the vehicle.
fn under_floor(view: &View<'_>, target: &Target, random: &mut Random) -> Option<Echo> {
    let item = &view.moment.site.items[target.item];
    let pose = &view.moment.poses[target.item];
    let [bounces, way] = [random.uniform(), random.exponential(view.waves.floor_way)];
    let low = (pose.inverse() * target.place).z < FLOOR;
    if !matches!(item.kind, Kind::Car | Kind::Truck) || !low || bounces > view.waves.floor {
        return None;
    }
    let direct = target.echo.seen;
    let seen = Spherical { range: direct.range + way, ..direct };
    let spread_db = range_loss_db(seen.range) - range_loss_db(direct.range);
    let level =
        decibel(target.echo.power) - UNDER_FLOOR_DB * (1.0 + way) - spread_db + fluctuation_db(random);
    if !is_heard(view, level) || seen.range > view.radar.max_range {
        return None;
    }
    let place = view.site_from_radar * seen.to_cartesian();
    let truth = match is_within(pose, &place, [item.size.x, item.size.y]) {
        true => target.echo.truth,
        false => Truth::artifact(Cause::DoubleBounce),
    };
    Some(Echo::new(seen, target.echo.range_rate, level, truth))
}

fn is_within(pose: &Isometry3<f64>, place: &Point, [length, width]: [f64; 2]) -> bool {
    let own = pose.inverse() * place;
    own.x.abs() < length / 2.0 + OUTLINE && own.y.abs() < width / 2.0 + OUTLINE
}
