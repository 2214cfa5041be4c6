//! Which scans can't be read, found by reading each once.

use crate::read::SequenceReader;
use serde::Serialize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// A scan that can't be read.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Unreadable {
    /// Its sensor.
    pub sensor: String,
    /// Its number.
    pub scan: usize,
    /// File, place, expected, found.
    pub reason: String,
}

/// A scan of a sensor of either kind.
enum Scan {
    Radar(usize, usize),
    Lidar(usize, usize),
}

/// The radar and LiDAR scans that can't be read, by sensor and number.
pub(super) fn unreadable_scans(
    reader: &dyn SequenceReader,
    jobs: usize,
    progress: &(dyn Fn() + Sync),
) -> Vec<Unreadable> {
    let scans = all_scans(reader);
    let next = AtomicUsize::new(0);
    let found = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..jobs.max(1) {
            scope.spawn(|| {
                while let Some(scan) = scans.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if let Some(unreadable) = read(reader, scan) {
                        found.lock().unwrap_or_else(PoisonError::into_inner).push(unreadable);
                    }
                    progress();
                }
            });
        }
    });
    let mut found = found.into_inner().unwrap_or_else(PoisonError::into_inner);
    found.sort();
    found
}

fn all_scans(reader: &dyn SequenceReader) -> Vec<Scan> {
    let times = &reader.sequence().times;
    let mut scans = Vec::new();
    for (radar, times) in times.radars.iter().enumerate() {
        scans.extend((0..times.len()).map(|scan| Scan::Radar(radar, scan)));
    }
    for (lidar, times) in times.lidars.iter().enumerate() {
        scans.extend((0..times.len()).map(|scan| Scan::Lidar(lidar, scan)));
    }
    scans
}

fn read(reader: &dyn SequenceReader, scan: &Scan) -> Option<Unreadable> {
    let rig = &reader.sequence().rig;
    let (sensor, scan, error) = match *scan {
        Scan::Radar(radar, scan) => (&rig.radars[radar].name, scan, reader.radar_scan(radar, scan).err()?),
        Scan::Lidar(lidar, scan) => (&rig.lidars[lidar].name, scan, reader.lidar_scan(lidar, scan).err()?),
    };
    Some(Unreadable { sensor: sensor.clone(), scan, reason: error.to_string() })
}
