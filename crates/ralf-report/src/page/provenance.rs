//! What the labels were made with, so that they can be made again.

use super::long::folded_if_long;
use crate::content::Content;
use crate::number::grouped;
use maud::{Markup, html};

pub(super) fn provenance(content: &Content) -> Markup {
    let record = &content.record;
    let bytes: u64 = record.inputs.iter().map(|input| input.bytes).sum();
    html! {
        section #provenance {
            h2 { "Provenance" }
            dl.facts {
                dt { "Program" } dd { "ralf " (record.version) }
                dt { "Format" } dd { (record.format) }
                dt { "Inputs" } dd { (grouped(record.inputs.len() as u64)) " files, " (grouped(bytes)) " bytes" }
            }
            (folded_if_long(record.sequences.len(), "fingerprints", html! { dl.facts {
                @for sequence in &record.sequences {
                    dt { "Fingerprint of " (sequence.name) } dd { code { (sequence.fingerprint) } }
                }
            } }))
            details {
                summary { "All settings" }
                pre { (record.settings.to_toml().unwrap_or_else(|error| error.to_string())) }
            }
            footer { p { "Method: S. T. Isele et al., Radar Artifact Labeling Framework (RALF), VEHITS 2021." } }
        }
    }
}
