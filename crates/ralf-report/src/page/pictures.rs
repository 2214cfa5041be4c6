//! Pictures from above, to be picked by sequence and scan.

use super::long::folded_if_long;
use crate::content::{Content, DrawnSequence, ScanContent};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};

pub(super) fn pictures(content: &Content) -> Markup {
    let drawn: Vec<&DrawnSequence> =
        content.sequences.iter().filter_map(|sequence| sequence.drawn.as_ref()).collect();
    let all = content.sequences.len();
    html! {
        section #pictures {
            h2 { "From above" }
            @if drawn.len() < all {
                p {
                    "Drawn are " (drawn.len()) " of " (all) " sequences, evenly chosen; "
                    code { "ralf plot" } " draws any."
                }
            }
            (lacking(content))
            div.picker hidden {
                label { "Sequence " select #pick-sequence {
                    @for (index, sequence) in drawn.iter().enumerate() {
                        option value=(index) {
                            (sequence.name) @if sequence.title != sequence.name { ": " (sequence.title) }
                        }
                    }
                } }
                label { "Scan " select #pick-scan {} }
            }
            @for sequence in &drawn { (of_sequence(sequence)) }
        }
    }
}

/// What the pictures lack.
fn lacking(content: &Content) -> Markup {
    let lines = &content.drawn_without;
    let list = html! { ul { @for line in lines { li { (line) } } } };
    html! { @if !lines.is_empty() { (folded_if_long(lines.len(), "LiDAR scans that can’t be read", list)) } }
}

fn of_sequence(sequence: &DrawnSequence) -> Markup {
    html! {
        article.sequence {
            figure {
                (image(
                    &sequence.overview,
                    &format!("All scans of sequence {} from above, raw beside plausible", sequence.name),
                ))
                figcaption { "Sequence " (sequence.name) ": all detections beside those labelled plausible." }
            }
            @for scan in &sequence.scans { (of_scan(sequence, scan)) }
        }
    }
}

fn of_scan(sequence: &DrawnSequence, scan: &ScanContent) -> Markup {
    let [raw, labelled] = &scan.pictures;
    let alt = |what: &str| format!("Scan {} of sequence {} from above, {what}", scan.scan, sequence.name);
    html! {
        figure.scan data-name={ (scan.scan) @if scan.uncertain { " (uncertain)" } } {
            div.pair { (image(raw, &alt("raw"))) (image(labelled, &alt("labelled"))) }
            figcaption {
                "Sequence " (sequence.name) ", scan " (scan.scan) " of " (sequence.radar)
                " with the scans of the other radars nearest to it: raw beside labelled."
                @if scan.uncertain {
                    " One of the scans with the largest share of detections within 0.1 of the threshold."
                }
            }
        }
    }
}

fn image(png: &[u8], alt: &str) -> Markup {
    html! { img alt=(alt) src={ "data:image/png;base64," (STANDARD.encode(png)) }; }
}
