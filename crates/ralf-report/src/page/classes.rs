//! Which classes plausible detections have, and which sensor tells them.

use super::heads;
use crate::classes::Classes;
use crate::content::Content;
use crate::number::{grouped, percent};
use maud::{Markup, html};
use ralf::label::class_name;
use ralf_data::result::ClassSource;

pub(super) fn classes(content: &Content) -> Markup {
    html! {
        @if let Some(classes) = &content.classes {
            section #classes {
                h2 { "Classes" }
                p { "Of detections called plausible, by which sensor tells them: labels of LiDAR points, and where "
                    "there are none the segmentations of images." }
                (table(classes))
            }
        }
    }
}

fn table(classes: &Classes) -> Markup {
    let all = classes.total();
    let together = |count: u64| html! { td { (grouped(count)) } td { (percent(count, all)) } };
    html! {
        div.scroll { table.plain {
            (heads(&["Class", "By LiDAR", "By camera", "Together", "Share"]))
            tbody {
                @for (id, counts) in &classes.counts {
                    tr {
                        th scope="row" { (class_name(*id).map_or_else(|| format!("class {id}"), str::to_owned)) }
                        @for source in ClassSource::ALL { td { (grouped(counts[source as usize])) } }
                        (together(counts.iter().sum()))
                    }
                }
                tr {
                    th scope="row" { "no class" }
                    @for _ in ClassSource::ALL { td { "–" } }
                    (together(classes.without))
                }
            }
        } }
    }
}
