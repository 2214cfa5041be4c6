//! Which share of what one sensor saw lies on what another of its kind saw at the same time, where their views overlap.

use super::{Tally, is_in_view};
use crate::change::SensorChange;
use crate::plan_field::PlanField;
use crate::sample::{LidarLook, RadarLook, nearest};
use ralf::sensors::Rig;
use ralf::space::{EgoMotion, Transform};
use std::cell::OnceCell;

/// Two radars see the same within this distance of either, m; the vehicle itself is nearer.
const RANGES: std::ops::Range<f64> = 1.0..40.0;
/// Scans of the other radar this far from its nearest one are laid over it, for one alone is sparse, ns.
const LAID_OVER_NS: u64 = 150_000_000;
/// Scans belong together within this, ns.
const TOGETHER_NS: u64 = 80_000_000;
/// Scans of a radar that are asked.
const SCANS: usize = 60;

/// One radar's scans with what its neighbour saw about their times.
pub(crate) struct RadarPair<'a> {
    motion: &'a EgoMotion,
    mount: Transform,
    neighbour: Side<'a>,
    neighbour_mount: Transform,
    half_view: f64,
    moments: Vec<(&'a RadarLook, Seen)>,
}

/// What the neighbour saw about a time: distances in the vehicle frame at that time.
struct Seen {
    t_ns: i64,
    /// Made once it's asked: most radars look elsewhere than most others.
    field: OnceCell<PlanField>,
}

/// A radar with the scans that were read of it.
#[derive(Clone, Copy)]
pub(crate) struct Side<'a> {
    pub(crate) radar: usize,
    pub(crate) looks: &'a [RadarLook],
    pub(crate) change: SensorChange,
}

impl<'a> RadarPair<'a> {
    pub(crate) fn new(rig: &'a Rig, motion: &'a EgoMotion, asked: Side<'a>, neighbour: Side<'a>) -> Self {
        let neighbour_mount = neighbour.change.mount(&rig.radars[neighbour.radar].vehicle_from_radar);
        let times: Vec<i64> = neighbour.looks.iter().map(|look| neighbour.change.time(look.t_ns)).collect();
        let step = asked.looks.len().div_ceil(SCANS).max(1);
        let mut moments = Vec::new();
        for look in asked.looks.iter().step_by(step) {
            let Some(t_ns) = nearest(&times, asked.change.time(look.t_ns)).map(|i| times[i]) else {
                continue;
            };
            if t_ns.abs_diff(asked.change.time(look.t_ns)) <= TOGETHER_NS {
                moments.push((look, Seen { t_ns, field: OnceCell::new() }));
            }
        }
        Self {
            motion,
            mount: rig.radars[asked.radar].vehicle_from_radar,
            neighbour,
            neighbour_mount,
            half_view: rig.radars[neighbour.radar].fov_azimuth / 2.0,
            moments,
        }
    }

    /// Of the detections in the neighbour's field of view: those beside one of its own.
    pub(crate) fn tally(&self, change: &SensorChange) -> Tally {
        let mut tally = Tally::default();
        let mount = change.mount(&self.mount);
        let radar_from_vehicle = self.neighbour_mount.inverse();
        for (look, seen) in &self.moments {
            let place = self.motion.between(seen.t_ns, change.time(look.t_ns)) * mount;
            let mut found = [0.0; 2];
            for position in look.positions.iter().filter(|p| RANGES.contains(&p.coords.norm())) {
                let p = place * change.place(position);
                let own = radar_from_vehicle * p;
                if !is_in_view(&own, &RANGES, self.half_view) {
                    continue;
                }
                let field = seen.field.get_or_init(|| self.laid_over(seen.t_ns));
                if let Some(is_beside) = field.is_beside(p.x, p.y) {
                    found[0] += f64::from(is_beside);
                    found[1] += 1.0;
                }
            }
            tally.moments.push(found);
        }
        tally
    }

    /// What the neighbour saw about a time, in the vehicle frame then.
    fn laid_over(&self, t_ns: i64) -> PlanField {
        let mut places = Vec::new();
        for look in self.neighbour.looks {
            let own_ns = self.neighbour.change.time(look.t_ns);
            if own_ns.abs_diff(t_ns) <= LAID_OVER_NS {
                let place = self.motion.between(t_ns, own_ns) * self.neighbour_mount;
                places.extend(look.positions.iter().map(|p| place * self.neighbour.change.place(p)));
            }
        }
        PlanField::new(places.iter().map(|p| [p.x, p.y, p.z]))
    }
}

/// Two LiDARs of a rig, with changes of each: the first one's obstacles are sought among the second's.
pub(crate) struct LidarPair<'a> {
    pub(crate) rig: &'a Rig,
    pub(crate) motion: &'a EgoMotion,
    pub(crate) looks: &'a [&'a LidarLook],
    pub(crate) asked: usize,
    pub(crate) neighbour: usize,
    pub(crate) neighbour_change: SensorChange,
}

impl LidarPair<'_> {
    /// Of the first one's obstacles: those beside one of the second's.
    pub(crate) fn tally(&self, change: &SensorChange) -> Tally {
        let of = |lidar: usize| self.looks.iter().copied().filter(move |look| look.lidar == lidar);
        let neighbours: Vec<&LidarLook> = of(self.neighbour).collect();
        let recorded = |lidar: usize| self.rig.lidars[lidar].vehicle_from_lidar;
        let (own, other) = (recorded(self.asked), recorded(self.neighbour));
        let back = other * self.neighbour_change.mount(&other).inverse();
        let mut tally = Tally::default();
        for look in of(self.asked) {
            let Some(seen) = neighbours.iter().min_by_key(|seen| seen.t_ns.abs_diff(look.t_ns)) else {
                continue;
            };
            if seen.t_ns.abs_diff(look.t_ns) > TOGETHER_NS {
                continue;
            }
            let moved = self.motion.between(self.neighbour_change.time(seen.t_ns), change.time(look.t_ns));
            let place = back * moved * change.mount(&own);
            let sensor_from_recorded = own.inverse();
            let mut found = [0.0; 2];
            for probe in &look.probes {
                let p = place * change.place(&(sensor_from_recorded * probe));
                if let Some(is_beside) = seen.field.is_beside(p.x, p.y) {
                    found[0] += f64::from(is_beside);
                    found[1] += 1.0;
                }
            }
            tally.moments.push(found);
        }
        tally
    }
}
