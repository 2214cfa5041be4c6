//! What has a row for each of very many things: folded away, so that the page stays one to read.

use crate::number::grouped;
use maud::{Markup, html};

/// Rows that are shown at once.
const SHOWN: usize = 24;

/// Whether so many rows are too many to be shown at once.
pub(super) fn is_long(rows: usize) -> bool {
    rows > SHOWN
}

/// A part of the page with a row for each of so many things (`what` they are), folded away.
pub(super) fn folded(rows: usize, what: &str, part: &Markup) -> Markup {
    html! { details { summary { (grouped(rows as u64)) " " (what) } (part) } }
}

/// The same where they are many, else as it is.
pub(super) fn folded_if_long(rows: usize, what: &str, part: Markup) -> Markup {
    if is_long(rows) { folded(rows, what, &part) } else { part }
}
