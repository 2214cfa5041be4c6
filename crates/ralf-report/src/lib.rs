//! A labelled recording as one page for people: how good the labels are, where they are wrong, what they look like.
//!
//! [`Report::page`] gathers a run's results, the recording and, where there are some, the corrected labels, and gives
//! one self-contained HTML page: charts as inline SVG, pictures as data, nothing from a network. The same data give the
//! same bytes. [`Pictures`] draws single pictures of a sequence.
//! [`RealismPage`] sets a simulated recording beside a real one.

mod breakdown;
mod chart;
mod choice;
mod classes;
mod content;
mod curves;
mod error;
mod evidence;
mod findings;
mod missing;
mod number;
mod page;
mod pictures;
mod realism;
mod reasons;
mod scored;
mod settings_map;
mod told;
mod truth;
mod unread;

pub use choice::{one_below, one_of};
pub use error::ReportError;
pub use number::{counted, grouped, listed};
pub use pictures::{Detections, Pictures, mark_label};
pub use realism::RealismPage;
pub use truth::told_corrections;
pub use unread::{AsFarAsRead, drawn_without};

use content::Content;
use ralf_data::Recording;
use std::path::Path;

/// What a report is made of.
pub struct Report<'a> {
    /// The recording; corrected labels are looked for in it.
    pub recording: &'a Recording,
    /// What `ralf label` wrote of it.
    pub out: &'a Path,
    /// Scans of each sequence that are drawn.
    pub scans_per_sequence: usize,
}

/// A report, and what it could not tell of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Page {
    /// The page.
    pub html: String,
    /// Sequences of the recording that are not labelled: the page names them.
    pub without_labels: Vec<String>,
    /// Sequences that are not compared with the truth, for there is none of them, while there is of others: the page
    /// names them.
    pub without_truth: Vec<String>,
    /// A sentence for each scan of which people said something that is not applied, for it held something else then or
    /// can't be read.
    pub orphaned: Vec<String>,
    /// LiDAR scans that can't be read, whose points the pictures lack: a sentence each.
    pub drawn_without: Vec<String>,
    /// Where the truth comes from, where people corrected it, and what it lacks: a sentence each, with the file.
    pub of_truth: Vec<String>,
}

impl Report<'_> {
    /// The page. `progress` is told what is done next. Detections pass one row group at a time, so that a page about
    /// millions of them needs little memory.
    ///
    /// # Errors
    /// Results or corrected labels that are damaged, unreadable or of another recording; a run that has labelled none
    /// of the recording's sequences.
    pub fn page(&self, progress: &dyn Fn(&str)) -> Result<Page, ReportError> {
        let content = Content::gather(self, progress)?;
        progress("writing the page");
        let html = page::render(&content)?;
        let (orphaned, of_truth) = (content.truth.orphaned(), content.truth.lines());
        let without_truth = content.without_truth();
        let Content { without_labels, drawn_without, .. } = content;
        Ok(Page { html, without_labels, without_truth, orphaned, drawn_without, of_truth })
    }
}

impl RealismPage {
    /// One self-contained HTML page: charts as inline SVG, nothing from a network. The same data give the same bytes.
    ///
    /// # Errors
    /// A chart that can't be drawn.
    pub fn html(&self) -> Result<String, ReportError> {
        page::realism(self)
    }
}
