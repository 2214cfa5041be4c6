//! What no thing sends back: noise, tones, the own bumper, other radars, drops and spray.

use super::spherical;
use super::view::{Echo, THRESHOLD_DB, View};
use crate::random::Random;
use crate::truth::Truth;
use ralf::label::Cause;
use ralf::space::{Point, Vector};

/// Vehicles that are faster raise spray, m/s, up to so far away, m.
const SPRAYING: f64 = 12.0;
const SPRAY_SEEN: f64 = 45.0;

/// What the weather and other radars do in a scan.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::sketch) struct Weather {
    /// Whether it rains.
    pub(in crate::sketch) rains: bool,
    /// Azimuth (rad) and mean number of detections of another radar's burst.
    pub(in crate::sketch) burst: Option<[f64; 2]>,
}

pub(super) fn all(view: &View<'_>, weather: &Weather, random: &mut Random) -> Vec<Echo> {
    let mut found = noise(view, random);
    found.extend(tones(view, random));
    found.extend(bumper(view, random));
    found.extend(weather.burst.map_or(Vec::new(), |burst| another_radar(view, burst, random)));
    if weather.rains {
        found.extend(drops(view, random));
        found.extend(spray(view, random));
    }
    found
}

fn echo(range: f64, [azimuth, elevation]: [f64; 2], rate: f64, above_db: f64, cause: Cause) -> Echo {
    Echo {
        seen: spherical(range, azimuth, elevation),
        rate,
        level_db: THRESHOLD_DB + above_db,
        truth: Truth::artifact(cause),
    }
}

/// A direction anywhere in the view: sines of azimuths are alike.
fn anywhere(view: &View<'_>, random: &mut Random) -> [f64; 2] {
    let [wide, high] = view.radar.half_view;
    let sine = wide.min(1.5).sin();
    [random.between(-sine, sine).asin(), random.between(-high, high)]
}

fn any_rate(view: &View<'_>, random: &mut Random) -> f64 {
    random.between(-view.radar.half_interval, view.radar.half_interval)
}

fn noise(view: &View<'_>, random: &mut Random) -> Vec<Echo> {
    let count = random.poisson(view.radar.noise);
    let one = |_| {
        let (range, rate) = (random.between(1.0, view.radar.max_range), any_rate(view, random));
        echo(range, anywhere(view, random), rate, random.exponential(1.6), Cause::Noise)
    };
    (0..count).map(one).collect()
}

fn tones(view: &View<'_>, random: &mut Random) -> Vec<Echo> {
    let [wide, _] = view.radar.half_view;
    let count = random.poisson(2.0);
    let one = |_| {
        let range = view.radar.spurs[(random.uniform() * 3.0) as usize] + random.normal(0.05);
        let at = [random.normal(0.5).clamp(-wide, wide), view.clamped(random.normal(0.05))];
        echo(range, at, random.normal(0.04), random.exponential(3.0), Cause::Noise)
    };
    (0..count).map(one).collect()
}

fn bumper(view: &View<'_>, random: &mut Random) -> Vec<Echo> {
    let count = random.poisson(view.radar.bumper);
    let [_, high] = view.radar.half_view;
    let one = |_| {
        let azimuth = view.radar.bumper_at[(random.uniform() * 3.0) as usize] + random.normal(0.06);
        let at = [azimuth, random.between(-high, high)];
        let (range, above) = (random.between(0.15, 0.9), random.between(3.0, 23.0));
        echo(range, at, random.normal(0.05), above, Cause::OwnVehicle)
    };
    (0..count).map(one).collect()
}

fn another_radar(view: &View<'_>, [azimuth, mean]: [f64; 2], random: &mut Random) -> Vec<Echo> {
    let [wide, high] = view.radar.half_view;
    let count = random.poisson(mean);
    let one = |_| {
        let towards = random.chance(0.6);
        let aside = if towards { azimuth + random.normal(0.05) } else { random.between(-wide, wide) };
        let at = [aside.clamp(-wide, wide), view.clamped(random.normal(0.4 * high))];
        let range = view.radar.max_range * random.uniform().powf(0.8);
        echo(range, at, any_rate(view, random), random.exponential(3.0), Cause::Interference)
    };
    (0..count).map(one).collect()
}

/// Falling, and blown by the wind.
fn drops(view: &View<'_>, random: &mut Random) -> Vec<Echo> {
    let [wide, high] = view.radar.half_view;
    let count = random.poisson(view.radar.drops);
    let one = |_| {
        let at = [random.between(-wide, wide), random.between(-high, high)];
        let range = 0.8 + random.exponential(2.6) + random.exponential(2.6);
        let place = view.site_from_radar * spherical(range, at[0], at[1]).to_cartesian();
        let fall = Vector::new(2.0 + random.normal(1.2), random.normal(1.2) - 1.5, random.normal(1.2) - 5.0);
        echo(range, at, view.rate(&place, &fall), random.exponential(3.0), Cause::Noise)
    };
    (0..count).map(one).collect()
}

/// Behind what drives fast.
fn spray(view: &View<'_>, random: &mut Random) -> Vec<Echo> {
    let mut found = Vec::new();
    for pose in view.moment.poses.iter().filter(|pose| pose.velocity.norm() > SPRAYING) {
        let from = Point::from(pose.isometry.translation.vector);
        if (from - view.origin()).norm() > SPRAY_SEEN {
            continue;
        }
        for _ in 0..random.poisson(4.0) {
            let behind = -(4.0 + random.exponential(4.0));
            let at = Point::new(behind, random.normal(1.0), random.between(0.1, 1.8));
            let place = pose.isometry * at;
            let seen = view.seen(&place);
            let hidden = view.moment.loss_db(&view.origin(), &place, [None, None]) > 10.0;
            if hidden || !view.is_ahead(seen.azimuth) || seen.elevation.abs() > view.radar.half_view[1] {
                continue;
            }
            let velocity = pose.velocity * random.between(0.2, 0.9);
            let rate = view.rate(&place, &velocity);
            let at = [seen.azimuth, seen.elevation];
            found.push(echo(seen.range, at, rate, random.exponential(3.0), Cause::Noise));
        }
    }
    found
}
