//! Which share of a radar's detections has a LiDAR point beside it, as recorded and under changes.

use super::{Tally, is_in_view};
use crate::change::SensorChange;
use crate::plan_field::FAR;
use crate::sample::{LidarLook, RadarLook, nearest};
use ralf::sensors::Rig;
use ralf::space::EgoMotion;
use ralf::space::{Point, Transform};

/// Farther detections are smeared by their azimuth, m.
const FARTHEST: f64 = 40.0;
/// Nearer ones are the vehicle itself, m.
const NEAREST: f64 = 1.0;
/// A radar's scan belongs to a LiDAR's within this, ns.
pub(crate) const TOGETHER_NS: u64 = 80_000_000;
/// Things lower than this show both their ends, so that too high and too low count alike, m. Of walls a LiDAR sees no
/// top.
const LOW_THINGS: f64 = 2.2;
/// A detection is as high as what it lies on within this, m.
const HEIGHT: f64 = 0.3;

/// Clutter of the road is told by its height within this range, m.
const ROAD_WITHIN: f64 = 20.0;

/// What is compared with what.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Setup<'a> {
    pub(crate) rig: &'a Rig,
    pub(crate) motion: &'a EgoMotion,
    pub(crate) lidars: &'a [&'a LidarLook],
    /// Changes of the LiDARs that are taken for granted, in the order of the rig.
    pub(crate) lidar_changes: &'a [SensorChange],
}

/// How a detection counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Measure {
    /// 1 beside an obstacle in plan.
    Beside,
    /// Of detections beside low things: 1 between the road and their tops.
    AsHigh,
    /// Of nearby detections far from all obstacles: 1 on the road.
    OnRoad,
    /// `1 - (d / 1 m)^2`: smooth, to make a change exact.
    Smooth,
}

/// A radar's tally over all moments under a change of it; changes of the LiDAR are in the setup.
pub(crate) fn overlap(
    setup: &Setup,
    radar: usize,
    looks: &[RadarLook],
    change: &SensorChange,
    measure: Measure,
) -> Tally {
    let times: Vec<i64> = looks.iter().map(|look| look.t_ns).collect();
    let mut tally = Tally::default();
    for lidar in setup.lidars {
        let Some(look) = nearest(&times, lidar.t_ns).map(|i| &looks[i]) else { continue };
        if look.t_ns.abs_diff(lidar.t_ns) <= TOGETHER_NS {
            tally.moments.push(of_moment(setup, radar, (*lidar, look), change, measure));
        }
    }
    tally
}

/// The same of one scan of each.
pub(crate) fn of_moment(
    setup: &Setup,
    radar: usize,
    (lidar, look): (&LidarLook, &RadarLook),
    change: &SensorChange,
    measure: Measure,
) -> [f64; 2] {
    let way = setup.lidar_from_radar(radar, lidar, look.t_ns, change);
    count(lidar, look, &way, change, measure)
}

impl Setup<'_> {
    /// From the radar's frame at its time to the vehicle frame as recorded at the LiDAR's.
    pub(crate) fn lidar_from_radar(
        &self,
        radar: usize,
        lidar: &LidarLook,
        t_ns: i64,
        change: &SensorChange,
    ) -> Way {
        let of_lidar = self.lidar_changes.get(lidar.lidar).copied().unwrap_or_default();
        let recorded = &self.rig.lidars[lidar.lidar].vehicle_from_lidar;
        let back = recorded * of_lidar.mount(recorded).inverse();
        let moved = self.motion.between(of_lidar.time(lidar.t_ns), change.time(t_ns));
        let rigid = back * moved * change.mount(&self.rig.radars[radar].vehicle_from_radar);
        Way { rigid, mirrored: of_lidar.mirrored.then_some(*recorded) }
    }
}

/// From a radar's frame to a vehicle frame as recorded, in which a LiDAR's obstacles lie.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Way {
    rigid: Transform,
    /// The mounting of a LiDAR that has left for right: what it should see lies on its other side.
    mirrored: Option<Transform>,
}

impl Way {
    /// Where a place comes to lie.
    pub(crate) fn of(&self, p: &Point) -> Point {
        let p = self.rigid * p;
        self.mirrored.map_or(p, |mount| mount * SensorChange::mirror().place(&(mount.inverse() * p)))
    }
}

/// Obstacles that LiDARs see in a radar's field of view, of those that are kept of a scan: the mean over scans.
pub(crate) fn obstacles_in_view(setup: &Setup, radar: usize, change: &SensorChange) -> f64 {
    let sensor = &setup.rig.radars[radar];
    let radar_from_vehicle = change.mount(&sensor.vehicle_from_radar).inverse();
    let is_seen = |probe: &&Point| {
        is_in_view(&(radar_from_vehicle * *probe), &(NEAREST..FARTHEST), sensor.fov_azimuth / 2.0)
    };
    let seen = setup.lidars.iter().map(|lidar| lidar.probes.iter().filter(is_seen).count());
    seen.sum::<usize>() as f64 / setup.lidars.len().max(1) as f64
}

fn count(
    lidar: &LidarLook,
    look: &RadarLook,
    way: &Way,
    change: &SensorChange,
    measure: Measure,
) -> [f64; 2] {
    let mut found = [0.0; 2];
    // What moves is elsewhere by the LiDAR's time, and a turning LiDAR draws it askew: a lorry that follows looks like
    // a clock that lags.
    for position in &look.standing {
        let range = position.coords.norm();
        if !(NEAREST..FARTHEST).contains(&range) {
            continue;
        }
        let p = way.of(&change.place(position));
        let Some(is_beside) = lidar.field.is_beside(p.x, p.y) else { continue };
        let is_far = || lidar.field.distance(p.x, p.y).is_some_and(|distance| distance >= FAR);
        let counted = match measure {
            Measure::Beside => Some(f64::from(is_beside)),
            Measure::OnRoad => is_on_road(lidar, &p, range).filter(|_| is_far()).map(f64::from),
            Measure::AsHigh => is_as_high(lidar, &p).filter(|_| is_beside).map(f64::from),
            Measure::Smooth => {
                lidar.field.smooth_distance(p.x, p.y).map(|distance| 1.0 - distance * distance)
            }
        };
        if let Some(score) = counted {
            found[0] += score;
            found[1] += 1.0;
        }
    }
    found
}

/// Whether a place beside a low thing is as high; `None` beside others.
fn is_as_high(lidar: &LidarLook, p: &Point) -> Option<bool> {
    let top = lidar.field.top(p.x, p.y).filter(|top| *top < LOW_THINGS)?;
    Some((-HEIGHT..=top + HEIGHT).contains(&p.z))
}

/// Whether a place far from obstacles lies on the road; `None` far away, where a small angle is much of a height.
fn is_on_road(lidar: &LidarLook, p: &Point, range: f64) -> Option<bool> {
    let height = lidar.ground.as_ref().map_or(p.z, |ground| ground.height(p));
    (range < ROAD_WITHIN).then_some(height.abs() < HEIGHT)
}
