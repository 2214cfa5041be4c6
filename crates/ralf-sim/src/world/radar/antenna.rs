//! Angles that are taken for others: side lobes of strong echoes, and ambiguities.

use super::echo::{Echo, View};
use super::equation::decibel;
use crate::random::{Random, grain};
use crate::truth::Truth;
use ralf::label::Cause;
use ralf::space::{Point, Spherical};

/// How many of the strongest echoes have company.
const STRONGEST: usize = 40;
/// A wrong angle that leads less far than this from where the echo comes from is but an inexact one, m.
pub(super) const APART: f64 = 1.0;

/// Lobes stand at the antenna's own angles, 1.5, 2.5, ... beam widths off, each with a height of its own: they persist.
pub(super) fn side_lobes(view: &View<'_>, merged: &[Echo], random: &mut Random) -> Vec<Echo> {
    let mut strongest: Vec<&Echo> = merged.iter().collect();
    strongest.sort_by(|a, b| b.power.total_cmp(&a.power));
    let width = view.radar.cell.azimuth.sin();
    let mut found = Vec::new();
    for echo in strongest.into_iter().take(STRONGEST) {
        for number in [-5, -4, -3, -2, -1, 1, 2, 3, 4, 5_i64] {
            let height = 3.5 * (grain(view.radar.fov[0].to_bits(), [number, 7, 7]) - 0.5);
            let below = view.radar.side_lobe_db + height + (number.abs() - 1) as f64 + random.normal(3.0);
            let sine = echo.seen.azimuth.sin() + (number as f64 + 0.5 * number.signum() as f64) * width;
            let level = decibel(echo.power) - below;
            if below > view.radar.accepted_db || sine.abs() >= 1.0 || level < view.radar.threshold_db {
                continue;
            }
            let seen = Spherical { azimuth: sine.asin(), ..echo.seen };
            if seen.azimuth.abs() < view.radar.fov[0] / 2.0 && displaced(echo, &seen) > APART {
                found.push(Echo::artifact(seen, echo.range_rate, level, Cause::SideLobe));
            }
        }
    }
    found
}

/// Near the threshold another peak of the angle's spectrum may be the higher one.
pub(super) fn confused(view: &View<'_>, echo: Echo, margin_db: f64, random: &mut Random) -> Echo {
    let [wrong, upward, right] = [random.uniform(), random.uniform(), random.uniform()];
    if wrong > view.radar.angle_failure * (-margin_db / 8.0).exp() {
        return echo;
    }
    let by = if right < 0.5 { view.radar.ambiguity } else { -view.radar.ambiguity };
    let mut seen = echo.seen;
    if view.radar.elevation && upward < 0.4 {
        seen.elevation = (seen.elevation.sin() + 0.5 * by).clamp(-0.9, 0.9).asin();
        seen.elevation = seen.elevation.clamp(-view.radar.fov[1] / 2.0, view.radar.fov[1] / 2.0);
    } else {
        let sine = seen.azimuth.sin() + by;
        seen.azimuth =
            if sine.abs() < 1.0 { sine.asin() } else { (sine - 2.0 * by).clamp(-0.99, 0.99).asin() };
    }
    let inside = seen.azimuth.abs() < view.radar.fov[0] / 2.0;
    match (inside, displaced(&echo, &seen) > APART, echo.truth.cause) {
        (false, ..) => echo,
        (true, true, Cause::Plausible) => Echo { seen, truth: Truth::artifact(Cause::Ambiguity), ..echo },
        (true, ..) => Echo { seen, ..echo },
    }
}

/// By way of the road a thing is seen as far below it as it stands above. In the same cell of range both add up, and
/// now and then the image wins: measured radars of this kind have a fifth of their detections below the road.
pub(super) fn reflected_by_road(view: &View<'_>, echo: Echo, random: &mut Random) -> Echo {
    let [chance, share] = [random.uniform(), random.uniform()];
    if !view.radar.elevation || chance > view.waves.road_mirror || echo.truth.cause == Cause::Noise {
        return echo;
    }
    let place = view.site_from_radar * echo.seen.to_cartesian();
    let below = view.moment.site.terrain.height(place.x, place.y);
    let height = place.z - below;
    let image = Point::new(place.x, place.y, below - height * share.sqrt());
    let seen =
        Spherical { range: echo.seen.range, ..Spherical::from_cartesian(&(view.radar_from_site * image)) };
    if height < 0.1 || seen.elevation.abs() > view.radar.fov[1] / 2.0 {
        return echo;
    }
    match echo.truth.cause {
        Cause::Plausible if displaced(&echo, &seen) > APART => {
            Echo { seen, truth: Truth::artifact(Cause::Mirror), ..echo }
        }
        _ => Echo { seen, ..echo },
    }
}

pub(super) fn displaced(echo: &Echo, seen: &Spherical) -> f64 {
    (echo.seen.to_cartesian() - seen.to_cartesian()).norm()
}
