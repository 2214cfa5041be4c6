//! What the labels say by themselves: class balance and distinctiveness.

use super::long::{folded, is_long};
use super::{figure, heads, swatch};
use crate::content::Content;
use crate::number::{decimal, grouped, percent};
use crate::{ReportError, chart};
use maud::{Markup, html};
use ralf_data::Balance;

pub(super) fn balance(content: &Content) -> Result<Markup, ReportError> {
    let histogram = chart::histogram(&content.findings.labelled)?;
    let caption =
        html! { (swatch("plausible")) "labelled plausible " (swatch("artifact")) "labelled artifact" };
    Ok(html! {
        section #balance {
            h2 { "Class balance and distinctiveness" }
            p {
                "These need no corrected labels. Distinctiveness is the mean plausibility w of what is labelled "
                "plausible minus that of what is labelled artifact: 1 where the method is certain of everything."
            }
            (table(&html! {
                (row("Overall", &content.balance, "total"))
                @if content.sequences.len() > 1 && !is_long(content.sequences.len()) { (sequences(content)) }
            }))
            @if is_long(content.sequences.len()) {
                (folded(content.sequences.len(), "sequences", &table(&sequences(content))))
            }
            (figure("Plausibility of all detections", histogram, caption))
        }
    })
}

fn table(rows: &Markup) -> Markup {
    html! {
        div.scroll { table.bars {
            (heads(&["Sequence", "Detections", "Plausible", "", "Distinctiveness"]))
            tbody { (rows) }
        } }
    }
}

fn sequences(content: &Content) -> Markup {
    html! { @for sequence in &content.sequences { (row(&sequence.name, &sequence.balance, "")) } }
}

fn row(name: &str, balance: &Balance, class: &str) -> Markup {
    let width = 100.0 * balance.plausible_share.unwrap_or(0.0);
    html! {
        tr class=(class) {
            th scope="row" { (name) }
            td { (grouped(balance.detections)) }
            td { (percent(balance.plausible, balance.detections)) }
            td.bar.whole { span.plausible style={ "width:" (format!("{width:.1}")) "%" } {} }
            td { (decimal(balance.distinctiveness)) }
        }
    }
}
