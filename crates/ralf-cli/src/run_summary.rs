//! What a run of `ralf label` made, as tables: a row per radar, and a row per camera whose images have depth.

use crate::outcome::Outcome;
use crate::progress::say;
use crate::text::{aligned, counted, grouped, percent};
use ralf::label::flag;
use ralf::scene::{Failure, ViewState};
use ralf_data::NotUsed;
use ralf_data::run::{
    CameraRecord, ImageRecord, RadarRecord, RunRecord, SequenceRecord, UnreadableScan, told_gone,
};
use ralf_data::views::Lacking;
use std::path::Path;

/// What to do where images have no depth.
const MAKES_DEPTH: &str = match cfg!(feature = "depth") {
    true => "--depth-model or `ralf depth` makes depth",
    false => "a build of ralf with the feature `depth` makes depth",
};

/// So many cameras are named that were not matched.
const SHOWN_CAMERAS: usize = 8;
/// Of more sequences each sensor is summed up over all of them; `run.json` and the report tell them apart.
const SHOWN_SEQUENCES: usize = 24;

/// The tables of a run.
pub(crate) fn run_summary(record: &RunRecord) -> String {
    let head =
        ["sequence", "radar", "scans", "detections", "plausible", "", "no LiDAR scan", "no neighbours"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let radars = by_sensor(record, |sequence| &sequence.radars, |radar| &radar.name);
    rows.extend(radars.iter().map(|(of, name, radars)| radar_row(of, name, radars)));
    aligned(&rows) + &doubtful_radars(record) + &cameras(record) + &unused_cameras(record)
}

/// Says what could not be labelled, and how it ended by that.
pub(crate) fn say_not_labelled(record: &RunRecord) -> Outcome {
    let mut outcome = Outcome::Done;
    for line in not_labelled(record) {
        say(&format!("not labelled: {line}"));
        outcome = Outcome::Partial;
    }
    outcome
}

/// Says which sequences were labelled, and are not there any more: a place's, of the recording or of its results.
pub(crate) fn say_gone(place: &Path, gone: &[String]) {
    if !gone.is_empty() {
        say(&format!("warning: {}: {}", place.display(), told_gone(gone)));
    }
}

/// Says what of a sequence could not be learned from, and how it ended by that.
pub(crate) fn say_not_used(NotUsed { sequence, left_out, without }: &NotUsed) -> Outcome {
    for UnreadableScan { sensor, scan, reason } in without {
        say(&format!("matched without: {sequence} {sensor} scan {scan}: {reason}"));
    }
    for scan in left_out {
        say(&format!("left out: {}", scan.told(sequence)));
    }
    Outcome::done_if(left_out.is_empty())
}

/// Says which sequences have no `what`, truth or labels, and are left out.
pub(crate) fn say_without<'a>(what: &str, sequences: impl IntoIterator<Item = &'a String>) {
    sequences.into_iter().for_each(|name| say(&format!("sequence {name} has no {what}: left out")));
}

/// What scans of all sequences were labelled without, a line each.
pub(crate) fn all_labelled_without(record: &RunRecord) -> impl Iterator<Item = String> {
    let sequences = &record.sequences;
    let scans = sequences.iter().flat_map(|of| unreadable_scans(&of.name, &of.unreadable));
    scans.chain(sequences.iter().flat_map(|of| unusable_images(&of.name, &of.cameras)))
}

/// The same of scans of one sequence.
pub(crate) fn labelled_without(
    sequence: &str,
    unreadable: &[UnreadableScan],
    cameras: &[CameraRecord],
) -> impl Iterator<Item = String> {
    unreadable_scans(sequence, unreadable).chain(unusable_images(sequence, cameras))
}

fn unreadable_scans(sequence: &str, unreadable: &[UnreadableScan]) -> impl Iterator<Item = String> {
    unreadable.iter().map(move |UnreadableScan { sensor, scan, reason }| {
        format!("labelled without: {sequence} {sensor} scan {scan}: {reason}")
    })
}

fn unusable_images(sequence: &str, cameras: &[CameraRecord]) -> impl Iterator<Item = String> {
    let problems = cameras.iter().map(|camera| {
        let problem = |image: &ImageRecord| Some((image.image, image.problem.clone()?));
        (camera.name.as_str(), camera.images.iter().filter_map(problem).collect::<Vec<_>>())
    });
    unusable("labelled without", sequence, problems)
}

/// For each camera with images that can't be read (their numbers, and why), the first of them: mostly all are alike.
pub(crate) fn unusable<'a>(
    what: &str,
    sequence: &str,
    cameras: impl Iterator<Item = (&'a str, impl AsRef<[(usize, String)]>)>,
) -> impl Iterator<Item = String> {
    cameras.filter_map(move |(camera, images)| {
        let ((first, reason), others) = images.as_ref().split_first()?;
        let others = match others.len() {
            0 => String::new(),
            others => format!(" and {}", counted(others, "other")),
        };
        Some(format!("{what}: {sequence} {camera} image {first}{others}: {reason}"))
    })
}

/// Says of which cameras a store holds some images, and not all.
pub(crate) fn say_lacking(lacking: &[Lacking]) {
    lacking.iter().for_each(|lacking| say(&lacking.words()));
}

/// What could not be labelled, a line each: scans, and what may have held some.
pub(crate) fn not_labelled(record: &RunRecord) -> impl Iterator<Item = String> {
    let scans = record.not_labelled().map(|(sequence, scan)| scan.told(sequence));
    scans.chain(record.lost().map(|(sequence, lost)| format!("{sequence}: {lost}")))
}

/// The records of each sensor with the sequence and the name that stand in its row: sequence by sequence, or all
/// sequences together where they are many.
fn by_sensor<R>(
    record: &RunRecord,
    sensors: fn(&SequenceRecord) -> &Vec<R>,
    name: fn(&R) -> &String,
) -> Vec<(String, &str, Vec<&R>)> {
    let many = record.sequences.len() > SHOWN_SEQUENCES;
    let mut found: Vec<(String, &str, Vec<&R>)> = Vec::new();
    for sequence in &record.sequences {
        for sensor in sensors(sequence) {
            let name = name(sensor).as_str();
            match found.iter_mut().find(|(_, known, _)| many && *known == name) {
                Some((_, _, records)) => records.push(sensor),
                None => found.push((sequence.name.clone(), name, vec![sensor])),
            }
        }
    }
    for (of, _, records) in found.iter_mut().filter(|_| many) {
        *of = format!("({})", counted(records.len(), "sequence"));
    }
    found
}

/// Names the radars that deliver no numbers, those whose labels are unlike their sisters', and those with hardly any
/// plausible detection.
fn doubtful_radars(record: &RunRecord) -> String {
    record
        .doubtful_radars()
        .map(|(sequence, radar, words)| format!("\n{sequence} {radar}: {words}\n"))
        .collect()
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
        "\n{cameras} camera(s) not matched, for no image that has depth is near a radar scan \
         ({MAKES_DEPTH}): {shown}{more}\n"
    )
}

fn radar_row(sequence: &str, name: &str, radars: &[&RadarRecord]) -> Vec<String> {
    let total = |counts: fn(&RadarRecord) -> &Vec<u32>| {
        radars.iter().flat_map(|radar| counts(radar)).copied().map(u64::from).sum::<u64>()
    };
    let (detections, plausible) = (total(|radar| &radar.detections), total(|radar| &radar.plausible));
    let all_flags = || radars.iter().flat_map(|radar| &radar.flags);
    let flagged = |flag: u16| match all_flags().filter(|flags| **flags & flag != 0).count() {
        0 => "-".to_owned(),
        count => counted(count, "scan"),
    };
    vec![
        sequence.to_owned(),
        name.to_owned(),
        grouped(radars.iter().map(|radar| radar.detections.len() as u64).sum()),
        grouped(detections),
        grouped(plausible),
        percent(plausible, detections),
        flagged(flag::NO_LIDAR),
        flagged(flag::NO_NEIGHBOURS),
    ]
}

/// Nothing where no camera was asked.
fn cameras(record: &RunRecord) -> String {
    let mut cameras = by_sensor(record, |sequence| &sequence.cameras, |camera| &camera.name);
    for (_, _, records) in &mut cameras {
        records.retain(|camera| !camera.images.is_empty());
    }
    let asked = cameras.iter().filter(|(_, _, records)| !records.is_empty());
    let mut rows: Vec<_> = asked.map(|(of, name, cameras)| camera_row(of, name, cameras)).collect();
    if rows.is_empty() {
        return String::new();
    }
    let head = ["sequence", "camera", "images", "views", "failed", "", "why"];
    rows.insert(0, head.map(str::to_owned).to_vec());
    format!("\n{}", aligned(&rows))
}

fn camera_row(sequence: &str, name: &str, cameras: &[&CameraRecord]) -> Vec<String> {
    let sum = |of: fn(&CameraRecord) -> usize| cameras.iter().map(|camera| of(camera) as u64).sum::<u64>();
    let [images, views, failed] =
        [sum(|camera| camera.images.len()), sum(|camera| camera.views), sum(|camera| camera.failed)];
    vec![
        sequence.to_owned(),
        name.to_owned(),
        grouped(images),
        grouped(views),
        grouped(failed),
        percent(failed, views),
        reasons(cameras),
    ]
}

/// How often each reason made a view fail.
fn reasons(cameras: &[&CameraRecord]) -> String {
    let all = [
        (Failure::Unusable, "unusable"),
        (Failure::NoScan, "no LiDAR scan"),
        (Failure::Dark, "dark"),
        (Failure::FewSamples, "few LiDAR points"),
        (Failure::Residual, "residual"),
    ];
    let count = |failure: Failure| {
        let images = cameras.iter().flat_map(|camera| &camera.images);
        let views = images.flat_map(|image| &image.views);
        views.filter(|view| view.state == ViewState::Failed(failure)).count()
    };
    let counted = all.map(|(failure, name)| (count(failure), name));
    let said: Vec<_> =
        counted.iter().filter(|(n, _)| *n > 0).map(|(n, name)| format!("{n} {name}")).collect();
    if said.is_empty() { "-".to_owned() } else { said.join(", ") }
}
