//! The values of all quantities, gathered from a recording.

use super::values::Values;
use super::{Quantity, lidar, radar};
use crate::frames::{Frames, ScanIndex};
use crate::read::SequenceReader;
use ralf::config::Config;
use ralf_jobs::side_by_side;
use std::convert::Infallible;

/// Radar scans that are looked at, of a recording.
const RADAR_SCANS: usize = 320;
/// LiDAR scans that are looked at, of a recording.
const LIDAR_SCANS: usize = 64;

/// Values of every quantity, by the half of their sequence that they come from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Distributions {
    /// Radar scans that were looked at.
    pub radar_scans: usize,
    /// LiDAR scans that were looked at.
    pub lidar_scans: usize,
    /// Why a scan could not be, a sentence each.
    pub unreadable: Vec<String>,
    halves: [Values; 2],
}

/// What was read of a scan, in which half of its sequence; or why it could not be read.
type Looked = (usize, Result<Values, String>);

impl Distributions {
    /// Looks at the sequences of a recording: at scans spread evenly over each, so many of all sequences together that
    /// time and memory don't grow with the recording's length. A scan that can't be read is named and left out. The
    /// result doesn't depend on the number of `jobs`. `progress` is told how many scans are done, and of how many.
    pub fn gather(
        sequences: &[&dyn SequenceReader],
        jobs: usize,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Self {
        let mut found = Self::default();
        let config = config();
        let (mut done, mut plans) = (0, Vec::new());
        for (place, reader) in sequences.iter().enumerate() {
            let times = &reader.sequence().times;
            let share =
                |total: usize| total * (place + 1) / sequences.len() - total * place / sequences.len();
            let radar = spread(&times.radars, share(RADAR_SCANS));
            plans.push((*reader, radar, spread(&times.lidars, share(LIDAR_SCANS))));
        }
        let all = plans.iter().map(|(_, radar, lidar)| radar.len() + lidar.len()).sum();
        for (reader, radar, lidar) in plans {
            let looked = look_at_radars(reader, &config, &radar, jobs);
            done += radar.len();
            progress(done, all);
            found.radar_scans += found.add(looked);
            let Ok(looked) = side_by_side(&lidar, jobs, |index| {
                let half = half_of(&reader.sequence().times.lidars, *index);
                Ok::<_, Infallible>((half, lidar::values(reader, &config, index.radar, index.scan)))
            });
            done += lidar.len();
            progress(done, all);
            found.lidar_scans += found.add(looked);
        }
        for half in &mut found.halves {
            half.sort();
        }
        found
    }

    /// The values of a quantity in ascending order; empty where the recording lacks what it needs.
    pub fn values(&self, quantity: Quantity) -> Vec<f32> {
        let [first, second] = self.halves(quantity);
        let mut all = [first, second].concat();
        all.sort_by(f32::total_cmp);
        all
    }

    /// The values from the first and from the second half of each sequence, each in ascending order.
    pub fn halves(&self, quantity: Quantity) -> [&[f32]; 2] {
        [0, 1].map(|half| self.halves[half].of(quantity))
    }

    /// Adds scans, and tells how many could be read.
    fn add(&mut self, looked: Vec<Looked>) -> usize {
        let mut read = 0;
        for (half, values) in looked {
            match values {
                Ok(values) => {
                    self.halves[half].append(values);
                    read += 1;
                }
                Err(reason) => self.unreadable.push(reason),
            }
        }
        read
    }
}

fn look_at_radars(
    reader: &dyn SequenceReader,
    config: &Config,
    scans: &[ScanIndex],
    jobs: usize,
) -> Vec<Looked> {
    let rig = &reader.sequence().rig;
    let frames = Frames { reader, rig, config, evidence: false };
    let Ok(looked) = frames.each(scans, jobs, |window, place| {
        let half = half_of(&reader.sequence().times.radars, scans[place]);
        let frame = window.frame(scans[place].radar, scans[place].scan);
        let values = frame.map(|frame| radar::values(&frame)).map_err(|error| error.to_string());
        Ok::<_, Infallible>((half, values))
    });
    looked
}

/// The paper's method, as far as it is asked: no cameras, and five scans before and after.
fn config() -> Config {
    let mut config = Config::default();
    config.camera.enabled = false;
    config.tracking.scans = radar::NEIGHBOURS;
    config
}

/// 0 in the first half of a sensor's timeline, 1 in the second.
fn half_of(times: &[Vec<i64>], index: ScanIndex) -> usize {
    usize::from(2 * index.scan >= times[index.radar].len())
}

/// So many scans of all sensors of a kind, each sensor's evenly from its first to its last; all of them where there are
/// fewer.
fn spread(times: &[Vec<i64>], wanted: usize) -> Vec<ScanIndex> {
    let total: usize = times.iter().map(Vec::len).sum();
    let mut chosen = Vec::new();
    for (radar, times) in times.iter().enumerate() {
        let own = if total <= wanted { times.len() } else { (wanted * times.len()).div_ceil(total) };
        chosen.extend((0..own).map(|i| ScanIndex { radar, scan: i * times.len() / own }));
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scans_are_spread_over_all_sensors_and_their_whole_time() {
        let times = [vec![0; 100], vec![0; 50], vec![]];
        let chosen: Vec<(usize, usize)> = spread(&times, 6).iter().map(|i| (i.radar, i.scan)).collect();
        assert_eq!(chosen, [(0, 0), (0, 25), (0, 50), (0, 75), (1, 0), (1, 25)]);
        assert_eq!(spread(&times, 1000).len(), 150);
        let half = |scan| half_of(&times, ScanIndex { radar: 1, scan });
        assert_eq!([half(0), half(24), half(25), half(49)], [0, 0, 1, 1]);
    }
}
