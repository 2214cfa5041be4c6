//! Radar scans beside LiDAR scans, as recorded and in another order.

use super::ASIDE_NS;
use super::orders::{Order, Orders};
use crate::change::SensorChange;
use crate::overlap::{Measure, Setup, TOGETHER_NS, Tally, of_moment};
use crate::sample::{LidarLook, RadarLook, Sample, nearest};
use ralf::sensors::Source;
use ralf::space::EgoMotion;
use std::collections::BTreeMap;

/// Whose files lie in another order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    Lidar,
    Radars,
    Both,
}

/// A few of the moments are every so manyth.
const FEW: usize = 4;

/// What was read of a recording, and what else is.
pub(super) struct Scans<'a> {
    pub(super) source: &'a dyn Source,
    pub(super) sample: &'a Sample,
    pub(super) motion: &'a EgoMotion,
    /// Of each radar, the order that was found.
    pub(super) found: Vec<Option<Order>>,
    orders: &'a Orders,
    /// By radar and scan; none of those that can't be read.
    read: BTreeMap<(usize, usize), Option<RadarLook>>,
}

/// A radar's file beside a LiDAR scan, and when both were measured.
struct Pair {
    file: usize,
    radar_ns: i64,
    lidar_ns: i64,
}

impl<'a> Scans<'a> {
    pub(super) fn new(
        source: &'a dyn Source,
        sample: &'a Sample,
        motion: &'a EgoMotion,
        orders: &'a Orders,
        found: Vec<Option<Order>>,
    ) -> Self {
        Self { source, sample, motion, found, orders, read: BTreeMap::new() }
    }

    /// Tallies of radars beside LiDARs as recorded and in another order: of moments at which this is another. Where a
    /// few of them show nothing better the others are not read.
    pub(super) fn tallies(&mut self, order: Order, of: Of, radars: &[usize], lidars: &[usize]) -> [Tally; 2] {
        let [now, then] = self.of_every(FEW, order, of, radars, lidars);
        if then.share() <= now.share() {
            return [now, then];
        }
        self.of_every(1, order, of, radars, lidars)
    }

    /// The same of every so manyth LiDAR scan.
    fn of_every(
        &mut self,
        every: usize,
        order: Order,
        of: Of,
        radars: &[usize],
        lidars: &[usize],
    ) -> [Tally; 2] {
        let mut tallies = [Tally::default(), Tally::default()];
        let looks = self.sample.lidars.iter().filter(|look| lidars.contains(&look.lidar));
        for look in looks.step_by(every) {
            for radar in radars {
                let pairs = [self.recorded(*radar, look), self.in_order(order, of, *radar, look)];
                let [Some(now), Some(then)] = pairs else { continue };
                if !self.is_aside(*radar, &now, &then) {
                    continue;
                }
                let counted = [now, then].map(|pair| self.count(*radar, look, &pair));
                let [Some(now), Some(then)] = counted else { continue };
                tallies[0].moments.push(now);
                tallies[1].moments.push(then);
            }
        }
        tallies
    }

    /// The radar's scan nearest to a LiDAR's, by their times and what was found.
    fn recorded(&self, radar: usize, look: &LidarLook) -> Option<Pair> {
        let times = &self.source.sequence().times.radars[radar];
        let near = nearest(times, look.t_ns)?;
        let file = self.found[radar].map_or(near, |order| self.orders.get(order, times.len()).places[near]);
        let pair = Pair { file, radar_ns: times[near], lidar_ns: look.t_ns };
        pair.is_together().then_some(pair)
    }

    /// The radar's scan nearest to a LiDAR's if files lie in this order.
    fn in_order(&self, order: Order, of: Of, radar: usize, look: &LidarLook) -> Option<Pair> {
        let times = &self.source.sequence().times;
        let [of_radar, of_lidar] = [&times.radars[radar], &times.lidars[look.lidar]];
        let lidar_ns = match of {
            Of::Radars => look.t_ns,
            Of::Lidar | Of::Both => of_lidar[self.orders.get(order, of_lidar.len()).files[look.scan]],
        };
        let near = nearest(of_radar, lidar_ns)?;
        let of_files = match of {
            Of::Lidar => self.found[radar],
            Of::Radars | Of::Both => Some(order),
        };
        let file = of_files.map_or(near, |order| self.orders.get(order, of_radar.len()).places[near]);
        let pair = Pair { file, radar_ns: of_radar[near], lidar_ns };
        pair.is_together().then_some(pair)
    }

    /// Whether two files of a radar were measured at clearly different times.
    fn is_aside(&self, radar: usize, now: &Pair, then: &Pair) -> bool {
        let times = &self.source.sequence().times.radars[radar];
        times[now.file].abs_diff(times[then.file]) > ASIDE_NS
    }

    /// The radar's detections beside the LiDAR's points; none where the file can't be read.
    fn count(&mut self, radar: usize, look: &LidarLook, pair: &Pair) -> Option<[f64; 2]> {
        let rig = &self.source.sequence().rig;
        let mut lidar_changes = vec![SensorChange::default(); rig.lidars.len()];
        lidar_changes[look.lidar] = SensorChange::clock((pair.lidar_ns - look.t_ns) as f64 * 1e-6);
        let setup = Setup { rig, motion: self.motion, lidars: &[], lidar_changes: &lidar_changes };
        let (source, sample) = (self.source, self.sample);
        let read = || {
            let own = sample.radars[radar].iter().find(|look| look.scan == pair.file);
            own.cloned().or_else(|| RadarLook::read(source, radar, pair.file).ok())
        };
        let seen = self.read.entry((radar, pair.file)).or_insert_with(read).as_ref()?;
        let change = SensorChange::clock((pair.radar_ns - seen.t_ns) as f64 * 1e-6);
        Some(of_moment(&setup, radar, (look, seen), &change, Measure::Beside))
    }
}

impl Pair {
    fn is_together(&self) -> bool {
        self.radar_ns.abs_diff(self.lidar_ns) <= TOGETHER_NS
    }
}
