//! `_export.json`: tells that a folder is an export, of what, and which files belong to it.

use super::ExportOptions;
use crate::disk::files;
use crate::error::DataError;
use crate::result::OutFolder;
use crate::result::json::write_json;
use ralf_files::Kind;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::Path;

/// Tools that search folders for data pass over names with an underscore.
pub(super) const RECORD: &str = "_export.json";

/// The content of `_export.json`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Record {
    /// Version of the program.
    version: String,
    #[serde(flatten)]
    pub(super) options: ExportOptions,
    /// Names of the sequences.
    sequences: Vec<String>,
    /// What was written, see [`entries`]. Exports were made before without it: nothing tells what is theirs.
    #[serde(default)]
    files: Option<BTreeSet<String>>,
}

impl Record {
    /// Of an export of these sequences. What was asked for and the format can't hold isn't there.
    pub(super) fn new(options: &ExportOptions, sequences: Vec<String>) -> Self {
        let options = ExportOptions { sensors: options.sensors.and(options.format.sensors()), ..*options };
        Self { version: env!("CARGO_PKG_VERSION").to_owned(), options, sequences, files: None }
    }

    /// That of an export; `None` of any other folder.
    pub(super) fn of(folder: &Path) -> Option<Self> {
        serde_json::from_str(&files::read_text(&folder.join(RECORD), Kind::Table).ok()?).ok()
    }

    /// Writes it into a folder, all of whose files are the export's.
    pub(super) fn write(&self, folder: &OutFolder) -> Result<(), DataError> {
        let mut found = BTreeSet::new();
        entries(folder.path(), "", &mut found)?;
        found.remove(RECORD);
        let whole = Self { files: Some(found), ..self.clone() };
        write_json(&folder.own_file(RECORD), &whole)
    }

    /// Whether a folder has all that the export wrote, as far as it tells what that was.
    pub(super) fn is_whole(&self, folder: &Path) -> Result<bool, DataError> {
        let mut found = BTreeSet::new();
        entries(folder, "", &mut found)?;
        Ok(self.files.as_ref().is_none_or(|own| own.is_subset(&found)))
    }

    /// Refuses a folder with a file that the export did not write: somebody has put it there and wants to keep it.
    pub(super) fn refuse_others(&self, folder: &Path) -> Result<(), DataError> {
        let Some(own) = &self.files else {
            let expected = "an export that tells which files are its own, to be replaced";
            let found = "one of an earlier version, which doesn't: remove it, or choose another place";
            return Err(DataError::content(folder, RECORD, expected, found));
        };
        let mut found = BTreeSet::new();
        entries(folder, "", &mut found)?;
        match found.iter().find(|name| *name != RECORD && !own.contains(*name)) {
            None => Ok(()),
            Some(other) => {
                let expected = "an export's own files, which --force replaces";
                Err(DataError::content(folder, "folder", expected, format!("also `{other}`: move it away")))
            }
        }
    }
}

/// All that lies below a folder, by the names from there; an empty folder ends in a slash. Links are not followed.
fn entries(folder: &Path, prefix: &str, found: &mut BTreeSet<String>) -> Result<(), DataError> {
    let refused = || DataError::io(folder);
    for entry in files::entries(folder, "a folder of an export")? {
        let entry = entry.map_err(refused())?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if !entry.file_type().map_err(refused())?.is_dir() {
            found.insert(name);
            continue;
        }
        let (below, before) = (format!("{name}/"), found.len());
        entries(&entry.path(), &below, found)?;
        if found.len() == before {
            found.insert(below);
        }
    }
    Ok(())
}
