//! What evidence looks at besides: the scans of all radars and LiDARs of a few tenths of a second to seconds around a
//! radar scan, whatever the settings let the paper's method see.

use super::super::lidar_window::{LidarWindow, LidarWindowView};
use super::super::neighbouring::NeighbouringScan;
use super::{FrameWindow, MOMENTS, NearLidars, moments_at_once};
use crate::config::{EvidenceConfig, nanoseconds};
use crate::space::{Recent, sync};
use std::sync::Arc;

impl FrameWindow<'_> {
    /// The same window, whose frames carry what evidence looks at: the settings `evidence` say how much. For the
    /// paper's method nothing changes.
    pub fn with_evidence(mut self) -> Self {
        self.evidence = true;
        if self.usable().is_err() {
            return self;
        }
        let settings = &self.config.evidence;
        let times = &self.source.sequence().times;
        let scans: usize = times.radars.iter().map(|times| settings.radar_scans_at_most(times)).sum();
        let moments = settings.lidar_scans + MOMENTS + moments_at_once(self.config);
        self.radar_scans = Recent::new(self.radar_scans.capacity() + scans);
        self.lidar_scans = Recent::new(moments * self.rig.lidars.len());
        self.moments = Recent::new(moments + self.rig.cameras.len());
        self
    }

    /// All radars' scans around a time but the scan itself, in time order; of a radar that detects very much in them
    /// only every so many, counted from the one that is nearest in time.
    pub(super) fn radar_window(&mut self, radar: usize, scan: usize, t_ns: i64) -> Vec<NeighbouringScan> {
        let settings = &self.config.evidence;
        let mut around: Vec<NeighbouringScan> = Vec::new();
        for (other, times) in self.source.sequence().times.radars.iter().enumerate() {
            let near = sync::around(times, t_ns, nanoseconds(settings.radar_reach_ms), settings.radar_scans);
            let nearest = if other == radar { Some(scan) } else { sync::nearest(times, t_ns, i64::MAX) };
            let mut of_radar = Vec::with_capacity(near.len());
            for near in near.filter(|near| (other, *near) != (radar, scan)) {
                let steps = near.abs_diff(nearest.unwrap_or(near));
                of_radar.extend(self.neighbouring_scan(other, near, t_ns).map(|scan| (steps, scan)));
            }
            let stride = settings.stride_of(of_radar.iter().map(|(_, scan)| scan.scan.len()).sum());
            let taken = of_radar.into_iter().filter(|(steps, _)| steps % stride == 0);
            around.extend(taken.map(|(_, scan)| scan));
        }
        around.sort_by_key(|near| (near.scan.t_ns(), near.radar));
        around
    }

    /// The LiDAR scans around a time; `None` where there are none, or none that can be read.
    ///
    /// Only every so many scans are taken of the first LiDAR that measured around this time, counted from the
    /// recording's begin, and the window is the one around one of these. So radar scans that follow each other share a
    /// window, and windows share their scans.
    pub(super) fn lidar_window(&mut self, t_ns: i64) -> Option<LidarWindowView> {
        let reach = nanoseconds(self.config.evidence.lidar_reach_ms);
        let mut timelines = self.source.sequence().times.lidars.iter().enumerate();
        let (lidar, chosen, middle) = timelines.find_map(|(lidar, times)| {
            let stride = stride(times, &self.config.evidence);
            let chosen: Vec<i64> = times.iter().copied().step_by(stride).collect();
            sync::nearest(&chosen, t_ns, reach).map(|middle| (lidar, chosen, middle))
        })?;
        let middle_time = chosen[middle];
        let vehicle_from_window = self.source.sequence().motion.between(t_ns, middle_time);
        let known = self.lidar_windows.get(&(lidar, middle));
        let window = known.unwrap_or_else(|| {
            let window = self.noting(|all| Arc::new(all.lidar_window_around(&chosen, middle_time)));
            self.lidar_windows.insert((lidar, middle), window.clone());
            window
        });
        let window = self.noted(window);
        // What nothing was read of isn't empty.
        (!window.views.is_empty()).then_some(LidarWindowView { window, vehicle_from_window })
    }

    /// The LiDAR scans around one of the chosen times.
    fn lidar_window_around(&mut self, chosen: &[i64], middle_time: i64) -> LidarWindow {
        let reach = nanoseconds(self.config.evidence.lidar_reach_ms);
        let mut views = Vec::new();
        for near in sync::around(chosen, middle_time, reach, self.config.evidence.lidar_scans) {
            let NearLidars { view, .. } = self.near_lidars(chosen[near]);
            let Some(mut view) = view else { continue };
            view.vehicle_from_moment = self.source.sequence().motion.between(middle_time, view.moment.t_ns);
            views.push(view);
        }
        LidarWindow::new(middle_time, views)
    }
}

impl EvidenceConfig {
    /// How many scans of a radar there are at most around any time.
    fn radar_scans_at_most(&self, times: &[i64]) -> usize {
        let span = nanoseconds(self.radar_reach_ms).saturating_mul(2);
        let from =
            |first: usize| times[first..].partition_point(|time| time.saturating_sub(times[first]) <= span);
        (0..times.len()).map(from).max().unwrap_or(0).min(self.radar_scans)
    }

    /// One in how many scans of a radar is taken whose scans around have so many detections.
    fn stride_of(&self, detections: usize) -> usize {
        detections.div_ceil(self.radar_detections).max(1)
    }
}

/// One in how many LiDAR scans is taken, so that no more than wanted lie around any of them.
fn stride(times: &[i64], config: &EvidenceConfig) -> usize {
    let mut periods: Vec<i64> = times.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).collect();
    periods.sort_unstable();
    let Some(period) = periods.get(periods.len() / 2) else { return 1 };
    let reach = nanoseconds(config.lidar_reach_ms);
    let mut to_each_side = reach.unsigned_abs() / period.unsigned_abs().max(1);
    // Where scans come in pairs or have each time twice, most periods say nothing of how many there are.
    let all = times.first().zip(times.last()).map_or(0, |(first, last)| last.saturating_sub(*first));
    if period.saturating_mul(2 * periods.len() as i64) < all || *period == 0 {
        to_each_side = to_each_side.min(fullest(times, reach) as u64);
    }
    let wanted = (config.lidar_scans as u64 - 1) / 2;
    usize::try_from(to_each_side.div_ceil(wanted.max(1))).unwrap_or(usize::MAX).max(1)
}

/// How many of some times follow any of them within a reach at most, ns.
fn fullest(times: &[i64], reach: i64) -> usize {
    let after = |(at, time): (usize, &i64)| {
        times[at..].partition_point(|other| other.saturating_sub(*time) <= reach) - 1
    };
    times.iter().enumerate().map(after).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scans_are_spread_over_the_window() {
        let config = EvidenceConfig { lidar_scans: 12, lidar_reach_ms: 1000.0, ..EvidenceConfig::default() };
        let every = |ms: i64| -> Vec<i64> { (0..100).map(|scan| scan * ms * 1_000_000).collect() };
        // 20 Hz: 20 to each side, of which 5 are wanted; 10 Hz: every second; 2 Hz: all of them.
        assert_eq!([50, 100, 500].map(|ms| stride(&every(ms), &config)), [4, 2, 1]);
        assert_eq!(stride(&[], &config), 1);
        assert_eq!(stride(&[7, 7, 7], &config), 1, "a clock that stands still");
        let pairs = |apart: i64| -> Vec<i64> {
            (0..100).flat_map(|scan| [100_000_000 * scan, 100_000_000 * scan + apart]).collect()
        };
        assert_eq!([0, 1, 1_000_000].map(|apart| stride(&pairs(apart), &config)), [5, 4, 4], "two at a time");
    }

    #[test]
    fn the_fullest_stretch_of_a_timeline_is_counted() {
        let config = EvidenceConfig { radar_reach_ms: 1.0, radar_scans: 3, ..EvidenceConfig::default() };
        assert_eq!(config.radar_scans_at_most(&[0, 5_000_000, 6_000_000, 9_000_000]), 2);
        assert_eq!(config.radar_scans_at_most(&[0, 1, 2, 3, 4]), 3, "no more than the settings allow");
        assert_eq!(config.radar_scans_at_most(&[]), 0);
    }

    #[test]
    fn scans_are_thinned_until_they_hold_no_more_than_wanted() {
        let config = EvidenceConfig { radar_detections: 100, ..EvidenceConfig::default() };
        assert_eq!([0, 100, 101, 200, 201].map(|detections| config.stride_of(detections)), [1, 1, 2, 2, 3]);
    }
}
