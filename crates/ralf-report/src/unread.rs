//! LiDAR scans that can't be read: pictures go on without their points, as labels do.

use ralf::scene::Unreadable;
use ralf::sensors::{
    CameraImage, ClassImage, DepthImage, LidarScan, RadarScan, Sequence, Source, SourceError,
};
use ralf_data::SequenceReader;
use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

/// A sequence in whose place of LiDAR scans that can't be read empty ones stand, which are remembered. For pictures
/// alone: labels tell a scan that can't be read from one that saw nothing.
pub struct AsFarAsRead<'a> {
    inner: &'a dyn SequenceReader,
    unread: Mutex<BTreeSet<Unreadable>>,
}

impl<'a> AsFarAsRead<'a> {
    /// Nothing of it has been asked for yet.
    pub fn new(inner: &'a dyn SequenceReader) -> Self {
        Self { inner, unread: Mutex::default() }
    }

    /// What was asked for so far and could not be read, a sentence each, in order.
    pub fn drawn_without(&self) -> Vec<String> {
        let unread = self.unread.lock().unwrap_or_else(PoisonError::into_inner);
        unread.iter().map(|scan| drawn_without(&self.sequence().name, scan)).collect()
    }
}

/// The sentence about a LiDAR scan of a sequence that a picture lacks.
pub fn drawn_without(sequence: &str, Unreadable { sensor, index, reason }: &Unreadable) -> String {
    format!("drawn without: {sequence} {sensor} scan {index}: {reason}")
}

impl Source for AsFarAsRead<'_> {
    fn sequence(&self) -> &Sequence {
        self.inner.sequence()
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        self.inner.radar_scan(radar, scan)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        self.inner.lidar_scan(lidar, scan).or_else(|error| {
            let Sequence { rig, times, .. } = self.sequence();
            let known = rig.lidars.get(lidar).zip(times.lidars.get(lidar).and_then(|times| times.get(scan)));
            let Some((sensor, t_ns)) = known else { return Err(error) };
            let unread = Unreadable { sensor: sensor.name.clone(), index: scan, reason: error.to_string() };
            self.unread.lock().unwrap_or_else(PoisonError::into_inner).insert(unread);
            Ok(LidarScan { t_ns: *t_ns, ..LidarScan::default() })
        })
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        self.inner.image(camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        self.inner.depth(camera, image)
    }

    fn classes(&self, camera: usize, image: usize) -> Result<Option<Vec<ClassImage>>, SourceError> {
        self.inner.classes(camera, image)
    }
}

impl SequenceReader for AsFarAsRead<'_> {
    fn inner(&self) -> Option<&dyn SequenceReader> {
        Some(self.inner)
    }
}
