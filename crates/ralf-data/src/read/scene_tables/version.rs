//! The folder of the tables, which is named after the data set's version.

use crate::disk::files;
use crate::error::DataError;
use std::path::{Path, PathBuf};

/// The table that every version has, by which its folder is known where it is the recording itself.
const TELLING: &str = "sample_data.json";

/// Where a data set lies.
pub(crate) struct Place {
    /// The folder that names of files begin at.
    pub(crate) root: PathBuf,
    /// The folder of the tables.
    pub(crate) version: PathBuf,
}

/// Whether this is a folder of tables with this file, or holds any whose name is one of theirs.
pub(crate) fn is_one(path: &Path, named: fn(&str) -> bool, file: &str) -> bool {
    let is_there = |folder: &Path| folder.join(file).is_file();
    is_version(path) && is_there(path)
        || folders(path, named).is_ok_and(|found| found.iter().any(|folder| is_there(folder)))
}

/// The only folder whose name is one of theirs, or, for versions may lie beside each other, the path itself where it
/// holds the tables; `pattern` is for people.
pub(crate) fn place(path: &Path, named: fn(&str) -> bool, pattern: &str) -> Result<Place, DataError> {
    if is_version(path) {
        return Ok(Place { root: above(path), version: path.to_owned() });
    }
    let mut found = folders(path, named)?;
    if let (1, Some(version)) = (found.len(), found.pop()) {
        return Ok(Place { root: path.to_owned(), version });
    }
    let names: Vec<_> = folders(path, named)?
        .iter()
        .filter_map(|f| Some(f.file_name()?.to_string_lossy().into_owned()))
        .collect();
    let expected = format!("exactly one version folder `{pattern}`");
    let (expected, found) = match names.first() {
        None => (expected, "none".to_owned()),
        Some(one) => {
            let one = path.join(one);
            (format!("{expected}, or the path of one, such as {}", one.display()), names.join(", "))
        }
    };
    Err(DataError::content(path, "folders", expected, found))
}

fn is_version(path: &Path) -> bool {
    path.join(TELLING).is_file()
}

/// The folder that a folder lies in, also where its path has no name (`.`).
fn above(folder: &Path) -> PathBuf {
    match (folder.file_name(), folder.parent()) {
        (Some(_), Some(parent)) => parent.to_owned(),
        _ => folder.join(".."),
    }
}

fn folders(path: &Path, named: fn(&str) -> bool) -> Result<Vec<PathBuf>, DataError> {
    let names = files::folders(path)?.into_iter().filter(|name| named(name));
    Ok(names.map(|name| path.join(name)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_folder_above_is_found_without_a_name() {
        let above = |folder| above(Path::new(folder));
        let found = ["set/v1.0-mini", "v1.0-mini/", ".", "set/.."].map(above);
        assert_eq!(found, ["set", "", "./..", "set/../.."].map(PathBuf::from));
    }
}
