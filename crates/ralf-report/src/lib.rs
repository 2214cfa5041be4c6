//! A labelled recording as one page for people: how good the labels are, where they are wrong, what they look like.
//!
//! [`Report::html`] gathers a run's results, the recording and, where there are some, the corrected labels, and gives one
//! self-contained HTML page: charts as inline SVG, pictures as data, nothing from a network. The same data give the same
//! bytes. [`Pictures`] draws single pictures of a sequence.

mod breakdown;
mod chart;
mod content;
mod curves;
mod error;
mod page;
mod pictures;
mod scored;
mod settings_map;

pub use error::ReportError;
pub use pictures::{Detections, Pictures};

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

impl Report<'_> {
    /// The page. `progress` is told what is done next.
    ///
    /// # Errors
    /// Results or corrected labels that are missing, unreadable or of another recording.
    pub fn html(&self, progress: &dyn Fn(&str)) -> Result<String, ReportError> {
        let content = Content::gather(self, progress)?;
        progress("writing the page");
        page::render(&content)
    }
}
