//! A radar by physics: what could be heard, which of it lies in one cell, what rises above the floor, and how it is
//! measured. How many detections there are, and which share of them is plausible, follows.

mod antenna;
mod cells;
mod cfar;
mod clutter;
mod detection;
mod echo;
mod equation;
mod model;
mod multipath;
mod targets;

pub(super) use detection::{Detection, radar_scan};
pub(super) use equation::sensitivity_db;
pub(super) use model::{Amplitude, Cell, RadarModel, Waves};

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
    echoes.extend(multipath::mirrored(&view, &targets, random).into_iter());
    echoes.extend(multipath::second_trips(&view, &targets, random));
    echoes.extend(clutter::ground(&view, random));
    echoes.extend(clutter::rain(&view, random));
    echoes.extend(clutter::bumper(&view, random));
    let (burst, noise_db) = clutter::interference(&view, random);
    echoes.extend(burst);
    let mut merged = cells::merged(radar, &echoes, random);
    merged.extend(antenna::side_lobes(&view, &merged, random));
    merged.extend(clutter::noise(&view, random));
    let floor = Floor::new(radar, &merged, equation::ratio(noise_db));
    detection::detected(&view, &merged, &floor, random)
}
