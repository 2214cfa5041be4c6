//! The folder of the tables, which is named after the data set's version.

use crate::disk::files;
use crate::error::DataError;
use std::path::{Path, PathBuf};

/// Whether any folder of tables whose name is one of theirs holds this file.
pub(crate) fn is_one(path: &Path, named: fn(&str) -> bool, file: &str) -> bool {
    folders(path, named).is_ok_and(|found| found.iter().any(|folder| folder.join(file).is_file()))
}

/// The only folder whose name is one of theirs; `pattern` is for people.
pub(crate) fn only_folder(path: &Path, named: fn(&str) -> bool, pattern: &str) -> Result<PathBuf, DataError> {
    let mut found = folders(path, named)?;
    if let (1, Some(only)) = (found.len(), found.pop()) {
        return Ok(only);
    }
    let names: Vec<_> = folders(path, named)?
        .iter()
        .filter_map(|f| Some(f.file_name()?.to_string_lossy().into_owned()))
        .collect();
    let found = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    Err(DataError::content(path, "folders", format!("exactly one version folder `{pattern}`"), found))
}

fn folders(path: &Path, named: fn(&str) -> bool) -> Result<Vec<PathBuf>, DataError> {
    let names = files::folders(path)?.into_iter().filter(|name| named(name));
    Ok(names.map(|name| path.join(name)).collect())
}
