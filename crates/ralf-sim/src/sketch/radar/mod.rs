//! A sketched radar: what reflects directly, what mirrors and bounces make of it, what the sensor adds by itself, and
//! which of it is one peak of the spectrum.

mod bounces;
mod direct;
mod images;
mod lobes;
mod peaks;
mod spurious;
mod view;

pub(super) use spurious::Weather;
pub(super) use view::{Echo, View};

use super::rig::RadarModel;
use crate::random::Random;
use crate::truth::Truth;
use ralf::sensors::{Radar, RadarScan};
use ralf::space::Spherical;

/// Levels are told as if this were the threshold, dB.
const TOLD_DB: f64 = 12.0;

/// All echoes that a scan tells of, by range.
pub(super) fn scan(view: &View<'_>, weather: &Weather, random: &mut Random) -> Vec<Echo> {
    let heard = direct::heard(view, random);
    let mut echoes = direct::echoes(view, &heard, random);
    echoes.extend(images::in_the_ground(view, &heard, random));
    echoes.extend(images::in_faces(view, &heard, random));
    echoes.extend(bounces::between_things(view, &heard, random));
    echoes.extend(bounces::under_vehicles(view, &heard, random));
    echoes.extend(bounces::with_the_own_front(view, &heard, random));
    echoes.extend(lobes::side_lobes(view, &echoes, random));
    echoes.extend(spurious::all(view, weather, random));
    peaks::peaks(view, echoes, random)
}

/// What is true of each echo of a scan.
pub(super) fn truth(echoes: &[Echo]) -> Vec<Truth> {
    echoes.iter().map(|echo| echo.truth).collect()
}

/// The scan as it lies in a file.
pub(super) fn radar_scan(
    model: &RadarModel,
    said: &Radar,
    t_ns: i64,
    echoes: &[Echo],
) -> Result<RadarScan, String> {
    let column = |field: &&str| {
        let value = |echo: &Echo| {
            let Echo { seen, rate, level_db, .. } = *echo;
            let place = seen.to_cartesian();
            let value = match *field {
                "x" => place.x,
                "y" => place.y,
                "z" => place.z,
                "range" => seen.range,
                "azimuth" => seen.azimuth,
                "elevation" => seen.elevation,
                "doppler" => rate,
                "rcs" => view::rcs_db(model, &seen, level_db),
                _ => level_db - view::THRESHOLD_DB + TOLD_DB,
            };
            value as f32
        };
        echoes.iter().map(value).collect()
    };
    RadarScan::new(said, t_ns, model.fields.iter().map(column).collect())
}

/// Seen there, m and rad.
fn spherical(range: f64, azimuth: f64, elevation: f64) -> Spherical {
    Spherical { range, azimuth, elevation }
}
