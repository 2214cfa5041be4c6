//! What a radar saw again and again beside a LiDAR's scans, and how likely it lies where the LiDAR sees things begin.

use super::super::case::Case;
use super::fronts::Fronts;
use crate::change::SensorChange;
use crate::overlap::Setup;
use crate::sample::{LidarLook, RadarLook};
use ralf::space::{EgoMotion, Point, Transform};

/// A radar's scan belongs to a LiDAR's within this, ns.
const TOGETHER_NS: u64 = 80_000_000;
/// Detections nearer are the vehicle itself, farther ones are smeared by their azimuth, m.
const RANGES: std::ops::Range<f64> = 1.0..40.0;
/// A detection is seen again in the scan before or after within this, m, and this share of its range: the noise of
/// both.
const AGAIN: (f64, f64) = (0.2, 0.015);
/// Bands of range: nearer than 8 m, than 16 m, and farther. What deceives a measure, deceives it in one of them.
pub(super) const BANDS: usize = 3;
/// Where the first ends, m; each is as deep as all before it.
const FIRST_BAND: f64 = 8.0;

/// A radar's scan, with the detections that were seen again.
struct Seen {
    t_ns: i64,
    /// Where the LiDAR sees down to the foot of things.
    positions: Vec<Point>,
    /// Nearer, where it looks over the noses of cars that a radar sees.
    looked_over: Vec<Point>,
}

/// How many detections lie on the fronts of things.
pub(super) struct OnFronts {
    /// Of the positions, by band of range.
    pub(super) bands: [f64; BANDS],
    /// Of those that are looked over: of no use for more than a first guess.
    pub(super) looked_over: f64,
}

/// Scans of a radar beside each scan of the LiDARs.
pub(super) struct Beside<'a> {
    moments: Vec<Moment<'a>>,
}

/// A LiDAR's scan, and the radar's about its time.
struct Moment<'a> {
    lidar: &'a LidarLook,
    fronts: Fronts,
    seen: Vec<Seen>,
}

impl<'a> Beside<'a> {
    pub(super) fn of(case: &'a Case, radar: usize) -> Self {
        let (looks, mount) = (&case.sample.radars[radar], case.mount(radar));
        let (setup, change) = (case.setup(), &case.radar_changes[radar]);
        let mut moments = Vec::new();
        for lidar in &case.lidars {
            let together = |i: &usize| looks[*i].t_ns.abs_diff(lidar.t_ns) <= TOGETHER_NS;
            let seen = (0..looks.len()).filter(together).map(|i| {
                let t_ns = looks[i].t_ns;
                let way = setup.lidar_from_radar(radar, lidar, t_ns, change);
                let is_seen_whole =
                    |position: &Point| lidar.sees_down_to_the_foot(&way.of(&change.place(position)));
                let again = seen_again(looks, i, &case.motion, &mount).into_iter();
                let (positions, looked_over) = again.partition(is_seen_whole);
                Seen { t_ns, positions, looked_over }
            });
            let own_place = setup.lidar_from_radar(radar, lidar, lidar.t_ns, change).of(&Point::origin());
            let fronts = Fronts::of(&lidar.field, own_place.coords);
            moments.push(Moment { lidar, fronts, seen: seen.collect() });
        }
        Self { moments }
    }

    /// By moment: in which bands of range there is any detection.
    pub(super) fn observed(&self) -> impl ExactSizeIterator<Item = [bool; BANDS]> {
        self.moments.iter().map(|moment| {
            let mut found = [false; BANDS];
            let positions = moment.seen.iter().flat_map(|scan| &scan.positions);
            positions.for_each(|position| found[band(position)] = true);
            found
        })
    }

    /// By moment: how many detections lie so far behind the fronts of things, m, where a change puts them.
    pub(super) fn on_fronts(
        &self,
        setup: &Setup,
        radar: usize,
        change: &SensorChange,
        behind: f64,
    ) -> Vec<OnFronts> {
        let mut found = Vec::with_capacity(self.moments.len());
        for Moment { lidar, fronts, seen } in &self.moments {
            let mut sums = OnFronts { bands: [0.0; BANDS], looked_over: 0.0 };
            for scan in seen {
                let way = setup.lidar_from_radar(radar, lidar, scan.t_ns, change);
                let at = |position: &Point| {
                    let p = way.of(&change.place(position));
                    fronts.before(behind, p.x, p.y)
                };
                scan.positions.iter().for_each(|position| sums.bands[band(position)] += at(position));
                sums.looked_over += scan.looked_over.iter().map(at).sum::<f64>();
            }
            found.push(sums);
        }
        found
    }
}

fn band(position: &Point) -> usize {
    let range = position.coords.norm();
    (0..BANDS - 1).find(|band| range < FIRST_BAND * f64::from(1 << band)).unwrap_or(BANDS - 1)
}

/// Detections of a scan that the scan before or after has as well: clutter comes and goes.
fn seen_again(looks: &[RadarLook], own: usize, motion: &EgoMotion, mount: &Transform) -> Vec<Point> {
    let look = &looks[own];
    let mut others: Vec<Point> = Vec::new();
    for other in looks[own.saturating_sub(1)..(own + 2).min(looks.len())].iter() {
        if other.scan.abs_diff(look.scan) == 1 {
            let place = mount.inverse() * motion.between(look.t_ns, other.t_ns) * mount;
            others.extend(other.positions.iter().map(|position| place * position));
        }
    }
    let again = |position: &&Point| {
        let range = position.coords.norm();
        let reach = AGAIN.0 + AGAIN.1 * range;
        RANGES.contains(&range) && others.iter().any(|other| (other - *position).xy().norm() < reach)
    };
    look.positions.iter().filter(again).copied().collect()
}
