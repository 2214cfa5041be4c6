//! What a model tells of detections in words.

use super::heads;
use crate::content::Content;
use crate::number::grouped;
use crate::told::Told;
use maud::{Markup, html};

pub(super) fn told(content: &Content) -> Markup {
    html! {
        @if !content.told.is_empty() {
            section #told {
                h2 { "What the model tells" }
                p { "Why detections are artifacts, and how most of the LiDAR scans around see their places." }
                @for told in &content.told { (table(told)) }
            }
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
