//! One radar scan with all that is known of its detections.

use super::{matrix, time};
use crate::app::{App, ScanPlace};
use crate::causes;
use crate::columns::meaning;
use crate::http::{Answer, ApiError, Table, content};
use crate::labelled::SequenceLabels;
use ralf::config::nanoseconds;
use ralf::sensors::Sequence;
use ralf::space::sync;
use ralf_corrections::{ContentHash, ScanState, ScanVersion};
use ralf_data::Label;
use ralf_data::result::{ClassSource, Group, Table as Rows, Values};
use ralf_data::truth::effective_labels;
use serde_json::{Map, Value, json};

/// Without a scan within the method's tolerance one this near in time is shown, ns.
const NEARBY_NS: i64 = 2_000_000_000;

/// The detections of a scan: as measured, as labelled, as corrected.
pub(crate) fn detections(app: &App, sequence: &str, radar: &str, scan: usize) -> Answer {
    let place = app.scan(sequence, radar, scan)?;
    let labels = app.labels(place.sequence)?;
    let rows = labels.table(radar, scan)?;
    let version = app.version(&place)?;
    check_size(&version, &rows)?;
    let said = app.said(|store| store.scan(&version))?;
    let known = app.causes.of_scan(place.sequence, &place.key.clone().into(), rows.len())?;
    let mut table = Table::new(rows.len());
    let shown = |group| matches!(group, Group::Measured | Group::Answers | Group::Evidence);
    for (column, values) in rows.columns().filter(|(column, _)| shown(column.group)) {
        if let Values::F32(values) = values {
            table.f32(&column.name, values.iter().copied());
            table.explain(&meaning(column));
        }
    }
    table.u16("flags", rows.get::<u16>("flags")?.iter().copied());
    let machine = machine_labels(&rows)?;
    table.u16("machine", machine.iter().copied());
    let number = |from: Option<ClassSource>| from.map_or(0, |from| from as u8 + 1);
    table.u8("class_from", rows.class_sources()?.into_iter().map(number));
    let stamp = stamp(version.content.hash.as_ref(), &machine);
    table.u16("label", effective(rows.labels()?, &said));
    table.u8("corrected", numbers(rows.len(), said.corrections.iter().map(|(point, _)| (*point, 1))));
    table.u8("said_cause", numbers(rows.len(), causes::numbered(&said)));
    if let Some(known) = known {
        table.u8("cause", known);
    }
    let mut header = header(&place, &labels, &said);
    if let Some((names, numbers)) = causes::by_machine(&rows) {
        table.u8("machine_cause", numbers);
        header.insert("machine_causes".to_owned(), names.iter().map(|name| json!(**name)).collect());
    }
    header.insert("content".to_owned(), json!(version.content.hash.map(|hash| hash.to_string())));
    header.insert("stamp".to_owned(), json!(stamp));
    Ok(content("application/octet-stream", table.finish(header)))
}

/// Labels of other detections than the recording holds now must not be shown, nor corrected.
pub(crate) fn check_size(version: &ScanVersion, rows: &Rows) -> Result<(), ApiError> {
    let recorded = version.content.detections as usize;
    if recorded == rows.len() {
        return Ok(());
    }
    let (scan, labelled) = (&version.key, rows.len());
    Err(ApiError::Broken(format!(
        "scan {scan}: expected labels of its {recorded} detections, found {labelled}: label the recording again"
    )))
}

/// What a mark of review names: a hash of the labels on screen, and of what they are about. Other labels have another.
pub(crate) fn stamp(content: Option<&ContentHash>, machine: &[u16]) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(content.map_or(&[][..], ContentHash::as_bytes));
    for id in machine {
        hasher.update(&id.to_le_bytes());
    }
    hasher.finalize().to_hex()[..32].to_owned()
}

/// The machine's label ids.
pub(crate) fn machine_labels(rows: &Rows) -> Result<Vec<u16>, ApiError> {
    Ok(rows.labels()?.into_iter().map(|label| label.id).collect())
}

/// The label ids that count.
fn effective(machine: Vec<Label>, said: &ScanState) -> Vec<u16> {
    let accepted = said.review.as_ref().map(|review| review.accepted.as_slice());
    effective_labels(machine, accepted, &said.corrections).into_iter().map(|label| label.id).collect()
}

/// The number of each detection of which something is said, else 0.
fn numbers(detections: usize, said: impl Iterator<Item = (u32, u8)>) -> Vec<u8> {
    let mut numbers = vec![0; detections];
    for (point, number) in said {
        if let Some(told) = numbers.get_mut(point as usize) {
            *told = number;
        }
    }
    numbers
}

fn header(place: &ScanPlace, labels: &SequenceLabels, said: &ScanState) -> Map<String, Value> {
    let sequence = place.reader.sequence();
    let failed = labels.failed_cameras_at(&sequence.times.cameras, place.t_ns);
    let failed: Vec<&str> =
        failed.into_iter().map(|camera| sequence.rig.cameras[camera].name.as_str()).collect();
    Map::from_iter([
        ("run".to_owned(), json!(labels.run())),
        ("t_ns".to_owned(), time(place.t_ns)),
        ("revision".to_owned(), json!(said.revision)),
        ("reviewed".to_owned(), reviewed(said)),
        ("odom_from_vehicle".to_owned(), matrix(&sequence.motion.odom_from_vehicle(place.t_ns))),
        (
            "origin".to_owned(),
            json!(labels.rig.radars[place.scan.radar].vehicle_from_radar.translation.vector.as_slice()),
        ),
        ("lidar".to_owned(), lidar_at(labels, sequence, place.t_ns)),
        ("cameras".to_owned(), cameras_at(sequence, place.t_ns)),
        ("failed_cameras".to_owned(), json!(failed)),
    ])
}

/// Who marked a scan, and when.
pub(crate) fn reviewed(said: &ScanState) -> Value {
    said.review.as_ref().map_or(Value::Null, |mark| json!({ "author": mark.author, "at": mark.at }))
}

/// The LiDAR scan that the method takes, else the nearest one nearby; of several LiDARs the first that has one.
fn lidar_at(labels: &SequenceLabels, sequence: &Sequence, t_ns: i64) -> Value {
    let found =
        [nanoseconds(labels.settings.sync.lidar_tolerance_ms), NEARBY_NS].into_iter().find_map(|tolerance| {
            let nearest = |times: &Vec<i64>| sync::nearest(times, t_ns, tolerance);
            let mut lidars = sequence.rig.lidars.iter().zip(&sequence.times.lidars);
            lidars.find_map(|(lidar, times)| Some((&lidar.name, nearest(times)?)))
        });
    found.map_or(Value::Null, |(name, scan)| json!({ "name": name, "scan": scan }))
}

/// The nearest image of each camera.
fn cameras_at(sequence: &Sequence, t_ns: i64) -> Value {
    let cameras = sequence.rig.cameras.iter().zip(&sequence.times.cameras);
    let nearest = cameras.filter_map(|(camera, times)| {
        let image = sync::nearest(times, t_ns, NEARBY_NS)?;
        Some(json!({ "name": camera.name, "image": image, "t_ns": time(times[image]) }))
    });
    nearest.collect()
}
