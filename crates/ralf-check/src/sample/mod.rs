//! Which scans are looked at, and what is kept of them: enough to judge, far less than labelling reads.

mod lidar;
mod radar;
mod shape;

use crate::picture::{Moment, Pictures};
use crate::thinning::spread;
pub(crate) use lidar::LidarLook;
pub(crate) use radar::RadarLook;
use ralf::sensors::{Sequence, Source};
pub(crate) use shape::is_absurd;
use std::collections::BTreeSet;

/// Times at which two LiDAR scans, half a second apart, are compared with each other and with the radars.
const MOMENTS: usize = 16;
/// Between the two, ns.
pub(crate) const LAG_NS: i64 = 500_000_000;
/// Scans of a radar, besides those beside a LiDAR scan, in pairs.
const RADAR_SCANS: usize = 120;

/// What was read of a sequence.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sample {
    /// Per radar, in time order.
    pub(crate) radars: Vec<Vec<RadarLook>>,
    /// Of all LiDARs, in the order of the rig and of time.
    pub(crate) lidars: Vec<LidarLook>,
    /// What was seen of images.
    pub(crate) pictures: Pictures,
    /// Why a scan could not be read, a sentence each.
    pub(crate) unreadable: Vec<String>,
}

/// That few scans can't be read says nothing of a sensor: of a short sequence no more may have been asked for.
const SEVERAL: usize = 5;

impl Sample {
    /// Whether there is a radar or a LiDAR none of whose scans could be read, of several.
    pub(crate) fn lacks_a_sensor(&self, sequence: &Sequence) -> bool {
        if self.unreadable.len() < SEVERAL {
            return false;
        }
        let times = &sequence.times;
        let mut radars = times.radars.iter().zip(&self.radars);
        let is_read = |lidar: usize| self.lidars.iter().any(|look| look.lidar == lidar);
        let mut lidars = times.lidars.iter().enumerate();
        radars.any(|(times, looks)| !times.is_empty() && looks.is_empty())
            || lidars.any(|(lidar, times)| !times.is_empty() && !is_read(lidar))
    }

    /// Reads evenly spread scans.
    pub(crate) fn of(source: &dyn Source) -> Self {
        Self::with_scans_around(source, 0)
    }

    /// Reads evenly spread scans, and of each radar the scans before and after those beside a LiDAR's: what is seen in
    /// these as well is less often clutter.
    pub(crate) fn in_rows(source: &dyn Source) -> Self {
        Self::with_scans_around(source, 1)
    }

    fn with_scans_around(source: &dyn Source, around: usize) -> Self {
        let mut sample = Self::default();
        let times = &source.sequence().times;
        let mut wanted = vec![BTreeSet::new(); times.radars.len()];
        for (lidar, own) in times.lidars.iter().enumerate() {
            for scan in paired(own) {
                sample.read_lidar(source, lidar, scan);
                for (radar, times) in times.radars.iter().enumerate() {
                    if let Some(near) = nearest(times, own[scan]) {
                        wanted[radar].extend(near.saturating_sub(around)..=near + around);
                    }
                }
            }
        }
        for (radar, (own, mut scans)) in times.radars.iter().zip(wanted).enumerate() {
            scans.extend(spread(own.len(), RADAR_SCANS / 2).into_iter().flat_map(|scan| [scan, scan + 1]));
            let looks = scans.into_iter().filter(|scan| *scan < own.len());
            let looks = looks.filter_map(|scan| sample.read_radar(source, radar, scan)).collect();
            sample.radars.push(looks);
        }
        let first = sample.lidars.iter().filter(|look| look.lidar == 0);
        let moments: Vec<Moment> = first.map(LidarLook::moment).collect();
        sample.pictures = crate::picture::read(source, &moments);
        sample
    }

    fn read_lidar(&mut self, source: &dyn Source, lidar: usize, scan: usize) {
        match source.lidar_scan(lidar, scan) {
            Ok(read) => self.lidars.push(LidarLook::of(source, (lidar, scan), &read)),
            Err(error) => self.unreadable.push(error.to_string()),
        }
    }

    fn read_radar(&mut self, source: &dyn Source, radar: usize, scan: usize) -> Option<RadarLook> {
        match RadarLook::read(source, radar, scan) {
            Ok(look) => Some(look),
            Err(error) => {
                self.unreadable.push(error.to_string());
                None
            }
        }
    }
}

/// Numbers as one: the same ones again have the same, and others, but for chance, another one.
fn digest<'a>(numbers: impl IntoIterator<Item = &'a f32>) -> u64 {
    let mixed = |digest: u64, number: &f32| {
        (digest.rotate_left(5) ^ u64::from(number.to_bits())).wrapping_mul(0x517c_c1b7_2722_0a95)
    };
    numbers.into_iter().fold(0, mixed)
}

/// Scans evenly over a timeline, each with the one that comes [`LAG_NS`] later.
fn paired(times: &[i64]) -> BTreeSet<usize> {
    let later = |scan: usize| times.partition_point(|t| *t < times[scan].saturating_add(LAG_NS));
    let firsts = (0..times.len()).filter(|scan| later(*scan) < times.len()).count().max(1);
    let chosen = spread(firsts.min(times.len()), MOMENTS);
    chosen.into_iter().flat_map(|scan| [scan, later(scan)]).filter(|scan| *scan < times.len()).collect()
}

/// The measurement nearest to a time.
pub(crate) fn nearest(times: &[i64], t_ns: i64) -> Option<usize> {
    let after = times.partition_point(|t| *t < t_ns);
    let around = after.saturating_sub(1)..(after + 1).min(times.len());
    around.min_by_key(|i| times[*i].abs_diff(t_ns))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_half_a_second_apart_and_a_lonely_scan_is_taken_too() {
        let times: Vec<i64> = (0..8).map(|i| i * 100_000_000).collect();
        assert_eq!(paired(&times), BTreeSet::from([0, 1, 2, 5, 6, 7]));
        assert_eq!(paired(&times[..1]), BTreeSet::from([0]));
        assert!(paired(&[]).is_empty());
    }

    #[test]
    fn the_nearest_measurement_is_found() {
        assert_eq!(nearest(&[0, 10, 20], 14), Some(1));
        assert_eq!(nearest(&[0, 10, 20], 99), Some(2));
        assert_eq!(nearest(&[], 0), None);
    }
}
