//! What was observed besides the paper's answers.

use super::heads;
use crate::content::Content;
use crate::evidence::EvidenceColumn;
use crate::number::{decimal, grouped};
use maud::{Markup, html};

pub(super) fn evidence(content: &Content) -> Markup {
    html! {
        @if !content.evidence.is_empty() {
            section #evidence {
                h2 { "Evidence" }
                p { "Means over what is labelled plausible and over the artifacts, where it was observed." }
                div.scroll { table.plain {
                    (heads(&["Column", "Observed", "Plausible", "Artifacts", "Unit", "Meaning"]))
                    tbody { @for observed in &content.evidence { (row(observed)) } }
                } }
            }
        }
    }
}

fn row(observed: &EvidenceColumn) -> Markup {
    html! {
        tr {
            th scope="row" { (observed.column.name) }
            td { (grouped(observed.counts.iter().sum())) }
            td { (decimal(observed.mean(true))) } td { (decimal(observed.mean(false))) }
            td { (observed.column.unit) } td { (observed.column.meaning) }
        }
    }
}
