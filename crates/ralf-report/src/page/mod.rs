//! The page. Everything that comes from data is escaped by the template engine.

mod balance;
mod classes;
mod errors;
mod evidence;
mod header;
mod health;
mod long;
mod pictures;
mod provenance;
mod realism;
mod score;
mod tables;
mod told;

pub(crate) use realism::render as realism;

use crate::ReportError;
use crate::content::Content;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");
/// Nothing may be loaded from anywhere.
const POLICY: &str = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'; \
                      base-uri 'none'; form-action 'none'";

/// What sections about the truth say where there is none.
const NO_TRUTH: &str = "This recording has no corrected labels, so nothing can be said about this.";

/// A table's head; a column without a name holds bars.
fn heads(names: &[&str]) -> Markup {
    html! {
        thead { tr {
            @for name in names {
                @if name.is_empty() { th {} } @else { th scope="col" { (name) } }
            }
        } }
    }
}

/// The whole page.
pub(crate) fn render(content: &Content) -> Result<String, ReportError> {
    let body = html! {
        (header::header(content))
        (tables::agreement(content))
        (score::score(content)?)
        (errors::errors(content)?)
        (balance::balance(content)?)
        (classes::classes(content))
        (told::told(content))
        (evidence::evidence(content))
        (pictures::pictures(content))
        (health::health(content))
        (provenance::provenance(content))
    };
    Ok(document(&format!("RALF report: {}", content.dataset), &body))
}

/// A page that needs nothing else.
fn document(title: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                main { (body) }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    page.into_string()
}

/// A chart with a heading and what it shows.
fn figure(heading: &str, svg: String, caption: Markup) -> Markup {
    html! {
        figure.chart {
            h3 { (heading) }
            // Made by the chart library from numbers and words of this program alone.
            div role="img" aria-label=(heading) { (PreEscaped(svg)) }
            figcaption { (caption) }
        }
    }
}

/// A swatch of a legend.
fn swatch(class: &str) -> Markup {
    html! { span class={ "swatch " (class) } {} }
}
