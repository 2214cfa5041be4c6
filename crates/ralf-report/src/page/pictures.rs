//! Pictures from above, to be picked by sequence and scan.

use crate::content::{Content, ScanContent, SequenceContent};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};

pub(super) fn pictures(content: &Content) -> Markup {
    html! {
        section #pictures {
            h2 { "From above" }
            div.picker hidden {
                label { "Sequence " select #pick-sequence {
                    @for (index, sequence) in content.sequences.iter().enumerate() {
                        option value=(index) {
                            (sequence.name) @if sequence.title != sequence.name { ": " (sequence.title) }
                        }
                    }
                } }
                label { "Scan " select #pick-scan {} }
            }
            @for sequence in &content.sequences { (of_sequence(sequence)) }
        }
    }
}

fn of_sequence(sequence: &SequenceContent) -> Markup {
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

fn of_scan(sequence: &SequenceContent, scan: &ScanContent) -> Markup {
    let [raw, labelled] = &scan.pictures;
    let alt = |what: &str| format!("Scan {} of sequence {} from above, {what}", scan.scan, sequence.name);
    html! {
        figure.scan data-name={ (scan.scan) @if scan.uncertain { " (uncertain)" } } {
            div.pair { (image(raw, &alt("raw"))) (image(labelled, &alt("labelled"))) }
            figcaption {
                "Sequence " (sequence.name) ", scan " (scan.scan) " of " (sequence.radar)
                " with the scans of the other radars nearest to it: raw beside labelled."
                @if scan.uncertain { " One of the scans whose plausibilities are closest to the threshold." }
            }
        }
    }
}

fn image(png: &[u8], alt: &str) -> Markup {
    html! { img alt=(alt) src={ "data:image/png;base64," (STANDARD.encode(png)) }; }
}
