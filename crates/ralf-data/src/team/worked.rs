//! How much everybody has done.

use super::second::second_labellers;
use crate::disk::files;
use crate::error::DataError;
use ralf_corrections::{FILE, Reader, Workday};
use serde_json::{Value, json};
use std::path::Path;

/// What one person did on one day.
#[derive(Debug, Clone, PartialEq)]
pub struct Worked {
    /// Whether these are second labels.
    pub second: bool,
    /// What it was.
    pub on: Workday,
}

impl Worked {
    /// What everybody did below an output folder: first labels and then second ones, by person and day.
    ///
    /// # Errors
    /// A file that is no store of corrections.
    pub fn below(out: &Path) -> Result<Vec<Self>, DataError> {
        let first = out.join(FILE);
        let mut found =
            if files::exists(&first)? { Self::of(&Reader::open(&first)?, false)? } else { Vec::new() };
        for (_, file) in second_labellers(out)? {
            found.extend(Self::of(&Reader::open(&file)?, true)?);
        }
        Ok(found)
    }

    fn of(store: &Reader, second: bool) -> Result<Vec<Self>, DataError> {
        Ok(store.workdays()?.into_iter().map(|on| Self { second, on }).collect())
    }

    /// A day's work as `ralf evaluate --progress --json` prints it (docs/formats.md, section 3).
    pub fn json(&self) -> Value {
        let Workday { author, day, edits, detections, scans, worked_s } = &self.on;
        json!({ "author": author, "second": self.second, "day": day, "edits": edits, "detections": detections,
            "scans": scans, "worked_s": worked_s })
    }
}
