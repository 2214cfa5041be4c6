//! Which scans can't be read, found by reading each once.

use crate::read::SequenceReader;
use ralf_jobs::side_by_side;
use serde::Serialize;
use std::convert::Infallible;

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
    let Ok(told) = side_by_side(&all_scans(reader), jobs, |scan| {
        let unreadable = read(reader, scan);
        progress();
        Ok::<_, Infallible>(unreadable)
    });
    let mut found: Vec<Unreadable> = told.into_iter().flatten().collect();
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
