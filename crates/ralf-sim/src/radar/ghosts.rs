//! What strong echoes bring with them: bounces off the own vehicle, and side lobes.

use super::{Echo, View};
use crate::random::Random;
use crate::truth::Truth;
use nalgebra::{Rotation3, Unit};
use ralf::label::Cause;
use ralf::space::Point;

/// How many of the strongest echoes have company.
const STRONGEST: usize = 14;
/// A second trip is lost beyond this first one, m.
const FARTHEST_BOUNCE: f64 = 25.0;
/// What the second trip takes, dB.
const BOUNCE_LOSS_DB: f64 = 10.0;
/// Azimuths of the side lobes off the main one (degrees), and how far they are below it (dB).
const LOBES: [(f64, f64); 6] =
    [(-29.0, 16.0), (-19.0, 14.0), (-11.0, 12.0), (11.0, 12.0), (19.0, 14.0), (29.0, 16.0)];
/// Scatter of a lobe's azimuth, degrees.
const LOBE_SIGMA: f64 = 0.5;

/// The strongest echoes of real surfaces.
fn strongest(real: &[Echo]) -> Vec<Echo> {
    let mut surfaces: Vec<Echo> =
        real.iter().filter(|echo| echo.truth.cause == Cause::Plausible).copied().collect();
    surfaces.sort_by(|a, b| b.level_db.total_cmp(&a.level_db));
    surfaces.truncate(STRONGEST);
    surfaces
}

/// From the object to the own vehicle and back once more: twice the range, twice the range rate.
pub(super) fn double_bounces(view: &View<'_>, real: &[Echo], random: &mut Random) -> Vec<Echo> {
    let origin = view.origin();
    let near = strongest(real).into_iter().filter(|echo| (echo.position - origin).norm() < FARTHEST_BOUNCE);
    let bounce = |echo: Echo| Echo {
        position: origin + (echo.position - origin) * 2.0,
        range_rate: 2.0 * echo.range_rate,
        level_db: echo.level_db - BOUNCE_LOSS_DB + random.normal(3.0),
        truth: Truth::artifact(Cause::DoubleBounce),
    };
    near.map(bounce).collect()
}

/// The same range, at azimuths where nothing is.
pub(super) fn side_lobes(view: &View<'_>, real: &[Echo], random: &mut Random) -> Vec<Echo> {
    let origin = view.origin();
    let up = Unit::new_normalize(view.site_from_radar.rotation * ralf::space::Vector::z());
    let mut found = Vec::new();
    for echo in strongest(real) {
        for (azimuth_deg, loss_db) in LOBES {
            let turn: f64 = azimuth_deg + random.normal(LOBE_SIGMA);
            let ray = Rotation3::from_axis_angle(&up, turn.to_radians()) * (echo.position - origin);
            let position: Point = origin + ray;
            let level_db = echo.level_db - loss_db + random.normal(4.0);
            if view.range_in_view(&position).is_some() {
                found.push(Echo { position, level_db, truth: Truth::artifact(Cause::SideLobe), ..echo });
            }
        }
    }
    found
}
