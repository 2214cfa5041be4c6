//! Where the labels are wrong.

use super::{NO_TRUTH, figure, heads, swatch};
use crate::breakdown::Group;
use crate::content::Content;
use crate::number::{grouped, percent};
use crate::{ReportError, chart};
use maud::{Markup, html};

pub(super) fn errors(content: &Content) -> Result<Markup, ReportError> {
    let body = match content.comparison {
        None => html! { p.absent { (NO_TRUTH) } },
        Some(_) => found(content)?,
    };
    Ok(html! { section #errors { h2 { "Where the labels are wrong" } (body) } })
}

fn found(content: &Content) -> Result<Markup, ReportError> {
    let range = chart::profile(&content.findings.profiles.over_range(), "range (m)")?;
    let azimuth =
        chart::profile(&content.findings.profiles.over_azimuth(), "azimuth from the radar’s axis (°)")?;
    let legend = || {
        html! {
            (swatch("plausible")) "plausible detections labelled artifact "
            (swatch("artifact")) "artifacts labelled plausible. Below: how many detections there are."
        }
    };
    Ok(html! {
        div.figures {
            (figure("Errors over range", range, legend()))
            (figure("Errors over azimuth", azimuth, legend()))
        }
        div.figures {
            (classes(&content.findings.groups.by_class()))
            (causes(&content.findings.groups.by_cause()))
        }
    })
}

fn classes(groups: &[Group]) -> Markup {
    html! {
        div {
            h3 { "Right by class" }
            table.bars {
                (heads(&["Class", "Detections", "Labelled right", ""]))
                tbody { @for group in groups {
                    @let right = if group.plausible { group.kept } else { group.count - group.kept };
                    (row(group, right, if group.plausible { "plausible" } else { "artifact" }))
                } }
            }
            p.note { "Of plausible classes this is the recall; an artifact is right when it is labelled so." }
        }
    }
}

fn causes(groups: &[Group]) -> Markup {
    html! {
        div {
            h3 { "False positives by cause" }
            @if groups.is_empty() { p.absent { "The causes of artifacts are not known in this recording." } }
            @else {
                table.bars {
                    (heads(&["Cause", "Artifacts", "Labelled plausible", ""]))
                    tbody { @for group in groups { (row(group, group.kept, "artifact")) } }
                }
            }
        }
    }
}

fn row(group: &Group, part: u64, class: &str) -> Markup {
    let width = 100.0 * part as f64 / group.count.max(1) as f64;
    html! {
        tr {
            th scope="row" { (group.name) }
            td { (grouped(group.count)) }
            td { (percent(part, group.count)) }
            td.bar { span class=(class) style={ "width:" (format!("{width:.1}")) "%" } {} }
        }
    }
}
