//! Whether what could not be read is to be had by now: a medium or a network may have failed for a moment, or one
//! machine may see less than another. What was labelled without it counts as long as it can't be read for the same
//! reason.

use crate::read::{Recording, SequenceReader};
use crate::result::{NotLabelled, SequenceRecord, UnreadMeasurement, UnreadableScan, told_within};
use ralf::scene::SensorKind;
use ralf::sensors::SourceError;
use std::path::Path;

/// The first of these measurements of a sequence that is to be had now, or not for another reason.
pub(super) fn changed<'a>(
    found: &'a [UnreadMeasurement],
    reader: &dyn SequenceReader,
    root: &Path,
) -> Option<&'a UnreadMeasurement> {
    found.iter().find(|measurement| {
        let reasons = reasons(measurement, reader);
        reasons.iter().all(|reason| told_within(&reason.to_string(), root) != measurement.scan.reason)
    })
}

/// The same of all that a labelled sequence of a recording lacks, with sensor and number.
pub(super) fn changed_since(record: &SequenceRecord, recording: &Recording) -> Option<UnreadableScan> {
    let mut readers = recording.sequences.iter().map(AsRef::as_ref);
    let reader = readers.find(|reader| reader.sequence().name == record.name)?;
    let radar = |NotLabelled { radar, scan, reason }: &NotLabelled| UnreadMeasurement {
        kind: SensorKind::Radar,
        scan: UnreadableScan { sensor: radar.clone(), scan: *scan, reason: reason.clone() },
    };
    let not_labelled: Vec<_> = record.not_labelled.iter().map(radar).collect();
    let found = changed(&record.not_read, reader, &recording.path);
    found.or_else(|| changed(&not_labelled, reader, &recording.path)).map(|found| found.scan.clone())
}

/// Why a measurement, or what is stored of it, can't be read; nothing where all of it can.
fn reasons(measurement: &UnreadMeasurement, reader: &dyn SequenceReader) -> Vec<SourceError> {
    let UnreadMeasurement { kind, scan: UnreadableScan { sensor, scan, .. } } = measurement;
    let rig = &reader.sequence().rig;
    let place = match kind {
        SensorKind::Radar => rig.radars.iter().position(|radar| radar.name == *sensor),
        SensorKind::Lidar => rig.lidars.iter().position(|lidar| lidar.name == *sensor),
        SensorKind::Camera => rig.cameras.iter().position(|camera| camera.name == *sensor),
    };
    let Some(place) = place else { return Vec::new() };
    match kind {
        SensorKind::Radar => reader.radar_scan(place, *scan).err().into_iter().collect(),
        SensorKind::Lidar => reader.lidar_scan(place, *scan).err().into_iter().collect(),
        SensorKind::Camera => {
            let of_network = [reader.depth(place, *scan).err(), reader.classes(place, *scan).err()];
            reader.image(place, *scan).err().into_iter().chain(of_network.into_iter().flatten()).collect()
        }
    }
}
