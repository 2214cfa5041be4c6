//! What a radar saw again and again beside a LiDAR's scans, and how likely it lies where the LiDAR sees things begin.

use super::super::case::Case;
use super::fronts::Fronts;
use crate::change::SensorChange;
use crate::overlap::Setup;
use crate::sample::{LidarLook, RadarLook};
use ralf::space::{EgoMotion, Point, Transform, Vector};

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
    /// Where the LiDAR sees down to the foot of things, by band of range.
    seen_whole: [Vec<Point>; BANDS],
    /// Nearer, where it looks over the noses of cars that a radar sees.
    looked_over: Vec<Point>,
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
                let (positions, looked_over): (Vec<Point>, _) = again.partition(is_seen_whole);
                let in_band = |own: usize| positions.iter().filter(|at| band(at) == own).copied().collect();
                Seen { t_ns, seen_whole: std::array::from_fn(in_band), looked_over }
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
            std::array::from_fn(|band| moment.seen.iter().any(|scan| !scan.seen_whole[band].is_empty()))
        })
    }

    /// By moment and band of range: how many detections lie so far behind the fronts of things, m, where a change puts
    /// them.
    pub(super) fn on_fronts(&self, put: &Put) -> Vec<[f64; BANDS]> {
        let of_moment = |moment: &Moment| {
            let mut bands = [0.0; BANDS];
            for scan in &moment.seen {
                let on_front = put.on_front(moment, scan.t_ns);
                for (sum, positions) in bands.iter_mut().zip(&scan.seen_whole) {
                    *sum += positions.iter().map(&on_front).sum::<f64>();
                }
            }
            bands
        };
        self.moments.iter().map(of_moment).collect()
    }

    /// The same of those that are looked over, all together: of no use for more than a first guess.
    pub(super) fn looked_over(&self, put: &Put) -> f64 {
        let scans = self.moments.iter().flat_map(|moment| moment.seen.iter().map(move |scan| (moment, scan)));
        scans.map(|(at, scan)| scan.looked_over.iter().map(put.on_front(at, scan.t_ns)).sum::<f64>()).sum()
    }
}

/// Where a radar's detections are put.
pub(super) struct Put<'a> {
    pub(super) setup: Setup<'a>,
    pub(super) radar: usize,
    pub(super) change: &'a SensorChange,
    /// So far behind the fronts of things, m.
    pub(super) behind: f64,
}

impl Put<'_> {
    /// How much a detection of a radar's scan lies on the front of a thing.
    fn on_front(&self, moment: &Moment, t_ns: i64) -> impl Fn(&Point) -> f64 {
        let way = self.setup.lidar_from_radar(self.radar, moment.lidar, t_ns, self.change);
        let plan = Plan::of(|position| way.of(&self.change.place(position)));
        move |position| {
            let [x, y] = plan.place(position);
            moment.fronts.before(self.behind, x, y)
        }
    }
}

/// Where places come to lie in plan, by an affine map.
struct Plan {
    origin: Vector,
    axes: [Vector; 3],
}

impl Plan {
    fn of(way: impl Fn(&Point) -> Point) -> Self {
        let origin = way(&Point::origin()).coords;
        let axis = |axis: usize| way(&Vector::ith(axis, 1.0).into()).coords - origin;
        Self { origin, axes: std::array::from_fn(axis) }
    }

    fn place(&self, p: &Point) -> [f64; 2] {
        let Self { origin, axes: [a, b, c] } = self;
        [origin.x + a.x * p.x + b.x * p.y + c.x * p.z, origin.y + a.y * p.x + b.y * p.y + c.y * p.z]
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
