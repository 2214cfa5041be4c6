//! A stretch of a recording.

use ralf::sensors::{CameraImage, DepthImage, LidarScan, RadarScan, Sequence, Source, SourceError};
use ralf_sim::SimulatedSequence;
use std::ops::Range;

/// What was measured in a stretch of time. The motion is known beyond it.
pub struct Cut<'a> {
    whole: &'a SimulatedSequence,
    sequence: Sequence,
    /// The first measurement of each radar, LiDAR and camera.
    firsts: [Vec<usize>; 3],
}

impl<'a> Cut<'a> {
    /// From one of the first radar's scans to another.
    pub fn of(whole: &'a SimulatedSequence, scans: Range<usize>) -> Self {
        let mut sequence = whole.sequence().clone();
        let own = &whole.sequence().times.radars[0];
        let (begin, end) = (own[scans.start], own.get(scans.end).copied().unwrap_or(i64::MAX));
        let times = &mut sequence.times;
        let firsts = [&mut times.radars, &mut times.lidars, &mut times.cameras].map(|sensors| {
            let cut = |times: &mut Vec<i64>| {
                let first = times.partition_point(|t| *t < begin);
                times.retain(|t| (begin..end).contains(t));
                first
            };
            sensors.iter_mut().map(cut).collect()
        });
        Self { whole, sequence, firsts }
    }
}

impl Source for Cut<'_> {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        self.whole.radar_scan(radar, self.firsts[0][radar] + scan)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        self.whole.lidar_scan(lidar, self.firsts[1][lidar] + scan)
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        self.whole.image(camera, self.firsts[2][camera] + image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        self.whole.depth(camera, self.firsts[2][camera] + image)
    }
}
