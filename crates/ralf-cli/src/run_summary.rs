//! What a run of `ralf label` made, as tables: a row per radar, and a row per camera whose images have depth.

use crate::text::{aligned, counted, grouped, percent};
use ralf::label::flag;
use ralf::scene::{Failure, ViewState};
use ralf_data::run::{CameraRecord, NotLabelled, RadarRecord, RunRecord};

/// So many cameras are named that were not matched.
const SHOWN_CAMERAS: usize = 8;

/// The tables of a run.
pub(crate) fn run_summary(record: &RunRecord) -> String {
    let head =
        ["sequence", "radar", "scans", "detections", "plausible", "", "no LiDAR scan", "no neighbours"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for sequence in &record.sequences {
        rows.extend(sequence.radars.iter().map(|radar| radar_row(&sequence.name, radar)));
    }
    aligned(&rows) + &doubtful_radars(record) + &cameras(record) + &unused_cameras(record)
}

/// What could not be labelled, a line each: scans, and what may have held some.
pub(crate) fn not_labelled(record: &RunRecord) -> impl Iterator<Item = String> {
    let scans = record.not_labelled();
    let scans = scans.map(|(sequence, NotLabelled { radar, scan, reason })| {
        format!("{sequence} {radar} scan {scan}: {reason}")
    });
    scans.chain(record.lost().map(|(sequence, lost)| format!("{sequence}: {lost}")))
}

/// Names the radars that deliver no numbers, and those whose labels are unlike their sisters'.
fn doubtful_radars(record: &RunRecord) -> String {
    let found = record.radars_without_numbers().chain(record.radars_unlike_sisters());
    found.map(|(sequence, radar, words)| format!("\n{sequence} {radar}: {words}\n")).collect()
}

/// Names the cameras that labelling was allowed to ask and that had nothing to say.
fn unused_cameras(record: &RunRecord) -> String {
    let mut unused = Vec::new();
    for sequence in record.sequences.iter().filter(|_| record.settings.method.camera.enabled) {
        let silent = sequence.cameras.iter().filter(|camera| camera.images.is_empty());
        unused.extend(silent.map(|camera| format!("{} {}", sequence.name, camera.name)));
    }
    if unused.is_empty() {
        return String::new();
    }
    let cameras = grouped(unused.len() as u64);
    let shown = unused.iter().take(SHOWN_CAMERAS).cloned().collect::<Vec<_>>().join(", ");
    let more = if unused.len() > SHOWN_CAMERAS { ", ..." } else { "" };
    format!(
        "\n{cameras} camera(s) not matched, for no image near a radar scan has depth \
         (--depth-model or `ralf depth` makes it): {shown}{more}\n"
    )
}

fn radar_row(sequence: &str, radar: &RadarRecord) -> Vec<String> {
    let total = |counts: &[u32]| counts.iter().copied().map(u64::from).sum::<u64>();
    let (detections, plausible) = (total(&radar.detections), total(&radar.plausible));
    let flagged = |flag: u16| match radar.flags.iter().filter(|flags| **flags & flag != 0).count() {
        0 => "-".to_owned(),
        count => counted(count, "scan"),
    };
    vec![
        sequence.to_owned(),
        radar.name.clone(),
        grouped(radar.detections.len() as u64),
        grouped(detections),
        grouped(plausible),
        percent(plausible, detections),
        flagged(flag::NO_LIDAR),
        flagged(flag::NO_NEIGHBOURS),
    ]
}

/// Nothing where no camera was asked.
fn cameras(record: &RunRecord) -> String {
    let mut rows = Vec::new();
    for sequence in &record.sequences {
        let asked = sequence.cameras.iter().filter(|camera| !camera.images.is_empty());
        rows.extend(asked.map(|camera| camera_row(&sequence.name, camera)));
    }
    if rows.is_empty() {
        return String::new();
    }
    let head = ["sequence", "camera", "images", "views", "failed", "", "why"];
    rows.insert(0, head.map(str::to_owned).to_vec());
    format!("\n{}", aligned(&rows))
}

fn camera_row(sequence: &str, camera: &CameraRecord) -> Vec<String> {
    vec![
        sequence.to_owned(),
        camera.name.clone(),
        grouped(camera.images.len() as u64),
        grouped(camera.views as u64),
        grouped(camera.failed as u64),
        percent(camera.failed as u64, camera.views as u64),
        reasons(camera),
    ]
}

/// How often each reason made a view fail.
fn reasons(camera: &CameraRecord) -> String {
    let all = [
        (Failure::Unusable, "unusable"),
        (Failure::NoScan, "no LiDAR scan"),
        (Failure::Dark, "dark"),
        (Failure::FewSamples, "few LiDAR points"),
        (Failure::Residual, "residual"),
    ];
    let count = |failure: Failure| {
        let views = camera.images.iter().flat_map(|image| &image.views);
        views.filter(|view| view.state == ViewState::Failed(failure)).count()
    };
    let counted = all.map(|(failure, name)| (count(failure), name));
    let said: Vec<_> =
        counted.iter().filter(|(n, _)| *n > 0).map(|(n, name)| format!("{n} {name}")).collect();
    if said.is_empty() { "-".to_owned() } else { said.join(", ") }
}
