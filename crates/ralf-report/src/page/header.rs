//! What the page is about, and its main figures.

use crate::content::Content;
use crate::number::{counted, decimal, grouped, percent};
use maud::{Markup, html};

pub(super) fn header(content: &Content) -> Markup {
    let Content { record, balance, .. } = content;
    let scans: usize = record.radars().map(|radar| radar.detections.len()).sum();
    let scores =
        content.comparison.as_ref().map(|comparison| comparison.evaluation().overall.scan_mean.rates);
    html! {
        header {
            p.kicker { "Radar Artifact Labeling Framework" }
            h1 { "Labels of " em { (content.dataset) } }
            p.lead {
                "Every radar detection is rated by LiDAR, cameras and tracking, and labelled plausible or artifact. "
                @if scores.is_some() { "Here is how well that agrees with the corrected labels. " (truth(content)) }
                @else { "There are no corrected labels to compare with: here is what the labels say by themselves." }
            }
            dl.tiles {
                (tile(
                    "Detections",
                    &grouped(balance.detections),
                    &format!("{}, {}", counted(scans, "scan"), counted(content.sequences.len(), "sequence")),
                ))
                (tile(
                    "Plausible",
                    &percent(balance.plausible, balance.detections),
                    &format!("{} detections", grouped(balance.plausible)),
                ))
                (tile("Distinctiveness", &decimal(balance.distinctiveness), "mean w, plausible minus artifact"))
                @if let Some(rates) = scores {
                    (tile("Accuracy", &decimal(rates.accuracy), "mean over scans"))
                    (tile("F1 plausible", &decimal(rates.f1_plausible), "mean over scans"))
                    (tile("Mean IoU", &decimal(rates.mean_iou), "mean over scans"))
                }
            }
            nav {
                a href="#agreement" { "Agreement" } a href="#score" { "Plausibility" } a href="#errors" { "Errors" }
                a href="#balance" { "Balance" } a href="#pictures" { "Pictures" } a href="#health" { "Health" }
                a href="#provenance" { "Provenance" }
            }
        }
    }
}

/// How much truth there is, and where it comes from.
fn truth(content: &Content) -> Markup {
    let known = content.findings.confusion.total();
    html! {
        "They tell of " (grouped(known)) " of " (grouped(content.findings.detections)) " detections."
        @for sentence in &content.truth.told { " In corrections.sqlite: " (sentence) "." }
    }
}

fn tile(name: &str, value: &str, note: &str) -> Markup {
    html! { div { dt { (name) } dd { (value) } dd.note { (note) } } }
}
