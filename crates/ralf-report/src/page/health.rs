//! What was missing while the labels were made: flags, failed cameras, scans without labels.

use super::heads;
use super::long::folded_if_long;
use crate::content::Content;
use crate::number::{grouped, percent, ranges};
use maud::{Markup, html};
use ralf::label::flag;
use ralf::scene::{Failure, ViewState};
use ralf_data::run::{CameraRecord, RadarRecord};

/// Flags that tell of something missing in a whole scan, then those that are everyday.
const FLAGS: [(u16, &str); 8] = [
    (flag::NO_LIDAR, "no LiDAR scan near in time"),
    (flag::NO_NEIGHBOURS, "no neighbouring radar scan"),
    (flag::CAMERA_FAILED, "in a failed camera view"),
    (flag::UNOBSERVED, "seen by no branch"),
    (flag::UNCONFIRMED, "told of by the radar alone"),
    (flag::PAPER, "unlike what the model knows, answered by the paper's method"),
    (flag::BLIND_SPOT, "in the LiDAR’s blind spot"),
    (flag::GROUND, "on the ground"),
];
const FAILURES: [(Failure, &str); 5] = [
    (Failure::Unusable, "unusable"),
    (Failure::NoScan, "no LiDAR scan"),
    (Failure::Dark, "too dark"),
    (Failure::FewSamples, "too few samples"),
    (Failure::Residual, "depth too far off"),
];

pub(super) fn health(content: &Content) -> Markup {
    html! {
        section #health {
            h2 { "Flagged scans and failed cameras" }
            (check(content))
            (radars("Radars without numbers", content.record.radars_without_numbers()))
            (radars("Radars unlike their sisters", content.record.radars_unlike_sisters()))
            (radars("Radars with hardly any plausible detection", content.record.radars_hardly_plausible()))
            (flags(content))
            (scans_to_look_at(content))
            (cameras(content))
            (not_labelled(content))
            (left_out(content))
        }
    }
}

/// What the check of the recording doubted.
fn check(content: &Content) -> Markup {
    let lines =
        content.record.check.iter().flat_map(|check| check.doubts.iter().map(|line| (&check.sequence, line)));
    let lines: Vec<_> = lines.collect();
    html! {
        @if !lines.is_empty() {
            h3 { "Doubts about the recording" }
            ul { @for (sequence, line) in lines {
                li {
                    (sequence) ", " (line.subject) ": "
                    @if let Some(remedy) = &line.remedy { strong { (remedy) } ": " }
                    (line.evidence)
                }
            } }
        }
    }
}

/// Radars of sequences, with what there is to say of each; nothing where there are none.
fn radars<'a>(title: &str, found: impl Iterator<Item = (&'a str, &'a str, String)>) -> Markup {
    let mut found = found.peekable();
    html! {
        @if found.peek().is_some() {
            h3 { (title) }
            ul { @for (sequence, radar, words) in found {
                li { (sequence) ", " (radar) ": " (words) }
            } }
        }
    }
}

fn flags(content: &Content) -> Markup {
    let all = content.findings.detections;
    html! {
        table.bars {
            (heads(&["Detections", "Number", "Share", ""]))
            tbody { @for (bit, name) in FLAGS {
                @let count = content.findings.with_flag(bit);
                @let width = 100.0 * count as f64 / all.max(1) as f64;
                tr {
                    th scope="row" { (name) }
                    td { (grouped(count)) }
                    td { (percent(count, all)) }
                    td.bar { span.neutral style={ "width:" (format!("{width:.1}")) "%" } {} }
                }
            } }
        }
    }
}

/// Scans of a radar that have a flag of a whole scan.
fn flagged(radar: &RadarRecord, bit: u16) -> Vec<usize> {
    (0..radar.flags.len()).filter(|scan| radar.flags[*scan] & bit != 0).collect()
}

fn scans_to_look_at(content: &Content) -> Markup {
    let sequences = content.record.sequences.iter();
    let radars =
        sequences.flat_map(|sequence| sequence.radars.iter().map(|radar| (sequence.name.as_str(), radar)));
    let found: Vec<_> = radars
        .flat_map(|(sequence, radar)| {
            FLAGS[..2]
                .iter()
                .map(move |(bit, why)| (sequence, radar.name.as_str(), flagged(radar, *bit), *why))
        })
        .filter(|(_, _, scans, _)| !scans.is_empty())
        .collect();
    let table = html! {
        div.scroll { table.plain {
            (heads(&["Sequence", "Radar", "Missing", "Scans"]))
            tbody { @for (sequence, radar, scans, why) in &found {
                tr { td { (sequence) } td { (radar) } td { (why) } td { (ranges(scans)) } }
            } }
        } }
    };
    html! {
        h3 { "Scans for which a sensor was missing" }
        @if found.is_empty() { p.absent { "None." } }
        @else { (folded_if_long(found.len(), "radars of sequences", table)) }
    }
}

fn cameras(content: &Content) -> Markup {
    let sequences = content.record.sequences.iter();
    let found: Vec<_> = sequences
        .flat_map(|sequence| sequence.cameras.iter().map(|camera| (sequence.name.as_str(), camera)))
        .filter(|(_, camera)| !camera.images.is_empty())
        .collect();
    let columns = [&["Sequence", "Camera", "Images", "Views"][..], &FAILURES.map(|(_, name)| name)].concat();
    let table = html! {
        div.scroll { table.plain {
            (heads(&columns))
            tbody { @for (sequence, camera) in &found { (camera_row(sequence, camera)) } }
        } }
    };
    html! {
        h3 { "Cameras" }
        @if found.is_empty() { p.absent { "No camera was asked." } }
        @else { (folded_if_long(found.len(), "cameras of sequences", table)) }
    }
}

fn camera_row(sequence: &str, camera: &CameraRecord) -> Markup {
    html! {
        tr {
            td { (sequence) } td { (camera.name) }
            td { (camera.images.len()) } td { (states(camera).count()) }
            @for (failure, _) in FAILURES {
                td { (states(camera).filter(|state| *state == ViewState::Failed(failure)).count()) }
            }
        }
    }
}

fn states(camera: &CameraRecord) -> impl Iterator<Item = ViewState> {
    camera.images.iter().flat_map(|image| &image.views).map(|view| view.state)
}

fn not_labelled(content: &Content) -> Markup {
    let found: Vec<_> = content.record.not_labelled().collect();
    let lost: Vec<_> = content.record.lost().collect();
    html! {
        @if !lost.is_empty() {
            h3 { "What can't be read and may have held scans" }
            ul { @for (sequence, lost) in lost { li { (sequence) ": " (lost) } } }
        }
        @if !found.is_empty() {
            h3 { "Scans without labels" }
            ul { @for (sequence, scan) in found {
                li { (sequence) "/" (scan.radar) "/" (scan.scan) ": " (scan.reason) }
            } }
        }
    }
}

/// What of the recording the page can't tell of.
fn left_out(content: &Content) -> Markup {
    html! {
        @if !content.without_labels.is_empty() {
            h3 { "Sequences without labels" }
            ul { @for sequence in &content.without_labels { li { (sequence) } } }
        }
        @let without_truth = content.without_truth();
        @if !without_truth.is_empty() {
            h3 { "Sequences without truth" }
            p { "Labels are compared with the truth of the others." }
            ul { @for sequence in &without_truth { li { (sequence) } } }
        }
        @let orphaned = content.truth.orphaned();
        @if !orphaned.is_empty() {
            h3 { "Corrections that are not applied" }
            ul { @for scan in &orphaned { li { (scan) } } }
        }
    }
}
