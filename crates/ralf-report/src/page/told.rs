//! What a model tells of detections in words.

use super::heads;
use crate::content::Content;
use crate::number::grouped;
use crate::reasons::Weight;
use crate::told::Told;
use maud::{Markup, html};

pub(super) fn told(content: &Content) -> Markup {
    html! {
        @if !content.told.is_empty() {
            section #told {
                h2 { "What the model tells" }
                p { "Why detections are artifacts, and how most of the LiDAR scans around see their places." }
                @for told in &content.told { (table(told)) }
                (reasons(&content.reasons))
            }
        }
    }
}

/// The groups of evidence that weigh most in some detection, the most frequent first.
fn reasons(weights: &[Weight]) -> Markup {
    let mut weights: Vec<&Weight> = weights.iter().filter(|weight| weight.counts != [0; 2]).collect();
    weights.sort_by_key(|weight| std::cmp::Reverse(weight.counts[0] + weight.counts[1]));
    html! {
        @if !weights.is_empty() {
            p {
                "What weighs most: the group of evidence that adds most to the log odds that a detection is plausible, \
                 up or down; and the reason of the one in which it adds most."
            }
            div.scroll { table.plain {
                (heads(&["largest reason", "Artifacts", "Plausible", "Where it adds most"]))
                tbody {
                    @for Weight { group, counts: [artifacts, plausible], most: (_, words) } in weights {
                        tr {
                            th scope="row" { (group) }
                            td { (grouped(*artifacts)) }
                            td { (grouped(*plausible)) }
                            td { (words) }
                        }
                    }
                }
            } }
        }
    }
}

fn table(told: &Told) -> Markup {
    html! {
        div.scroll { table.plain {
            (heads(&[&told.column, "Artifacts", "Plausible"]))
            tbody {
                @for (word, [artifacts, plausible]) in &told.counts {
                    tr { th scope="row" { (word) } td { (grouped(*artifacts)) } td { (grouped(*plausible)) } }
                }
            }
        } }
    }
}
