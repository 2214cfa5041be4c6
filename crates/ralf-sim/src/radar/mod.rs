//! A radar: echoes of real scatterers and of what isn't there, and which of them become detections.
//!
//! Every echo has a level; of each cause the strongest are detected, as many as the scan has room for. Strong
//! scatterers therefore persist from scan to scan, and weak ones flicker.

mod clutter;
mod ghosts;
mod measure;
mod mirror;
mod select;
mod targets;

pub(super) use measure::{Detection, radar_scan};
pub(super) use mirror::Mirror;

use super::random::Random;
use super::scene::Scene;
use super::truth::Truth;
use ralf::sensors::Radar;
use ralf::space::{Point, Transform, Vector};

/// Nearest and farthest detection, m.
const RANGE: (f64, f64) = (0.6, 70.0);

/// A radar at work.
pub(super) struct View<'a> {
    pub(super) scene: &'a Scene<'a>,
    pub(super) radar: &'a Radar,
    pub(super) site_from_radar: Transform,
    /// The antenna's velocity in the site's frame, m/s.
    pub(super) velocity: Vector,
}

/// What could be detected.
#[derive(Debug, Clone, Copy)]
pub(super) struct Echo {
    /// Where it seems to come from, in the site's frame.
    position: Point,
    /// m/s, positive when receding.
    range_rate: f64,
    /// Decides whether it is detected, dB.
    level_db: f64,
    truth: Truth,
}

impl View<'_> {
    /// The antenna's position in the site's frame.
    fn origin(&self) -> Point {
        self.site_from_radar.translation.vector.into()
    }

    /// Range, and whether a place lies in the field of view, with half a degree to spare.
    fn range_in_view(&self, place: &Point) -> Option<f64> {
        let p = self.site_from_radar.inverse_transform_point(place);
        let (range, level) = (p.coords.norm(), p.coords.xy().norm());
        let inside = range > RANGE.0
            && range < RANGE.1
            && p.z.abs() <= level * (self.radar.fov_elevation / 2.0).tan()
            && p.y.atan2(p.x).abs() <= self.radar.fov_azimuth / 2.0;
        inside.then_some(range)
    }

    /// Range rate of a place that moves, m/s.
    fn range_rate(&self, place: &Point, velocity: &Vector) -> f64 {
        let ray = place - self.origin();
        (velocity - self.velocity).dot(&ray) / ray.norm().max(1e-6)
    }

    /// One scan. `size` is the mean number of detections, `share` that of the plausible ones among them.
    pub(super) fn scan(
        &self,
        mirrors: &[Mirror],
        size: f64,
        share: f64,
        random: &mut Random,
    ) -> Vec<Detection> {
        let real = targets::echoes(self, random);
        let mut ghosts = mirror::echoes(self, mirrors, random);
        ghosts.extend(ghosts::double_bounces(self, &real, random));
        ghosts.extend(ghosts::side_lobes(self, &real, random));
        ghosts.extend(clutter::road(self, size, random));
        ghosts.extend(clutter::noise(self, size, random));
        let detected = select::detected(real, ghosts, size, share, random);
        measure::measured(self, &detected, random)
    }
}

/// What the distance takes from an echo, dB. Radars keep their threshold adapted, so it is less than the fourth power
/// of range.
fn distance_loss_db(range: f64) -> f64 {
    20.0 * (range.max(2.0) / 10.0).log10()
}
