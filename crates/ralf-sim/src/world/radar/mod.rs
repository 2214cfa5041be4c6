//! A radar by physics: what could be heard, which of it lies in one cell, what rises above the floor, and how it is
//! measured. How many detections there are, and which share of them is plausible, follows.

mod antenna;
mod bounces;
mod cells;
mod cfar;
mod clutter;
mod detection;
mod echo;
mod equation;
mod ground;
mod model;
mod multipath;
mod spikes;
mod targets;
mod unresolved;

pub(super) use detection::{Detection, radar_scan};
pub(super) use equation::sensitivity_db;
pub(in crate::world) use model::{Amplitude, Cell, Keeps, RadarModel, Spikiness, Waves};

use super::scene::Moment;
use crate::random::Random;
use cfar::Floor;
use echo::{Echo, View};
use ralf::space::{Transform, Vector};

/// One scan of a radar at `site_from_radar` that moves with `velocity` (m/s, in the site's frame).
pub(super) fn scan(
    moment: &Moment<'_>,
    radar: &RadarModel,
    waves: &Waves,
    site_from_radar: Transform,
    velocity: Vector,
    random: &mut Random,
) -> Vec<Detection> {
    let view =
        View { moment, radar, waves, site_from_radar, radar_from_site: site_from_radar.inverse(), velocity };
    let targets = targets::echoes(&view, random);
    let mut echoes: Vec<Echo> = targets.iter().map(|target| target.echo).collect();
    echoes.extend(multipath::mirrored(&view, &targets, random));
    echoes.extend(bounces::bounces(&view, &targets, random));
    echoes.extend(ground::pieces(&view, random));
    echoes.extend(ground::kerbs(&view, random));
    echoes.extend(spikes::staying(&view, random));
    echoes.extend(spikes::passing(&view, random));
    echoes.extend(clutter::rain(&view, random));
    echoes.extend(clutter::bumper(&view, random));
    let (burst, noise_db) = clutter::interference(&view, random);
    echoes.extend(burst);
    let merged = cells::merged(radar, &echoes, random);
    let mut merged = unresolved::peaks(radar, unresolved::pairs(radar, merged, random));
    merged.extend(antenna::side_lobes(&view, &merged, random));
    merged.extend(clutter::noise(&view, random));
    let floor = Floor::new(radar, &merged, equation::ratio(noise_db));
    detection::detected(&view, &merged, &floor, random)
}

#[cfg(test)]
mod tests {
    use super::model::tests::{radar, waves};
    use super::*;
    use crate::kind::Kind;
    use crate::random::Purpose;
    use crate::world::item::{Course, Item};
    use crate::world::scene::Site;
    use crate::world::terrain::{Patch, Surface, Terrain};
    use ralf::label::Cause;
    use ralf::space::Point;

    const STEP: f64 = 1e-4;

    fn site(kind: Kind, course: Course, ramp_deg: f64) -> Site {
        let base = Patch::base(Surface::Asphalt, 0.2);
        let ramp = crate::scenario::Ramp {
            at: [-500.0, 0.0],
            direction_deg: 0.0,
            length: 1000.0,
            slope_deg: ramp_deg,
        };
        let random = &mut Random::new(3, Purpose::Placement, 0, 0);
        let item = Item::new(kind, kind.usual_size(), course, random);
        Site::new(Terrain::new(&[ramp], Vec::new(), base, 1), vec![item], 1)
    }

    /// Where a radar that drives at 15 m/s along a slope is.
    fn antenna(site: &Site, seconds: f64) -> Transform {
        site.terrain.pose([15.0 * seconds, 0.0, 0.0]) * Transform::translation(3.6, 0.0, 0.5)
    }

    #[test]
    fn range_rates_of_what_moves_are_the_slopes_of_its_ranges() {
        let course = Course { start: [40.0, 3.0, 2.6], speed: 33.0, turn_rate: 0.0 };
        for slope_deg in [0.0, 6.0] {
            let site = site(Kind::Container, course, slope_deg);
            let place = |t: f64| Point::from(antenna(&site, t).translation.vector);
            let velocity = (place(STEP) - place(-STEP)) / (2.0 * STEP);
            let (radar, waves, moment) = (radar(), waves(), site.at(0.0));
            let site_from_radar = antenna(&site, 0.0);
            let view = View {
                moment: &moment,
                radar: &radar,
                waves: &waves,
                site_from_radar,
                radar_from_site: site_from_radar.inverse(),
                velocity,
            };
            let found = targets::echoes(&view, &mut Random::new(1, Purpose::Radar, 0, 0));
            assert!(found.len() > 5);
            let item = &site.items[0];
            for target in found {
                let own = item.pose(&site.terrain, 0.0).inverse() * target.place;
                let range = |t: f64| (item.pose(&site.terrain, t) * own - place(t)).norm();
                let slope = (range(STEP) - range(-STEP)) / (2.0 * STEP);
                assert!((slope - target.echo.range_rate).abs() < 1e-3, "{slope} {}", target.echo.range_rate);
                assert_eq!(target.echo.truth.cause, Cause::Plausible);
            }
        }
    }
}
