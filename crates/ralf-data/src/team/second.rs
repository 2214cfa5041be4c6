//! Where second labels lie.

use super::person::person;
use crate::disk::files;
use crate::error::DataError;
use crate::result::refuse_links_on_way;
use crate::tree::SECOND as FOLDER;
use std::path::{Path, PathBuf};

/// The ending of files in it.
const ENDING: &str = ".sqlite";

/// Where somebody's second labels lie, whether there are some or not, to be written.
///
/// # Errors
/// A name that can't be a file's, or a link that leads out of the output folder.
pub fn second_file(out: &Path, name: &str) -> Result<PathBuf, DataError> {
    refuse_links_on_way(out, &[FOLDER])?;
    let folder = out.join(FOLDER);
    let expected = "a name that a file can have";
    let part =
        person(name).map_err(|found| DataError::content(&folder, format!("`{name}`"), expected, found))?;
    Ok(folder.join(format!("{}{ENDING}", part.as_str())))
}

/// Those whose second labels lie below an output folder, by name, with the files.
///
/// # Errors
/// A folder that can't be read.
pub fn second_labellers(out: &Path) -> Result<Vec<(String, PathBuf)>, DataError> {
    let folder = out.join(FOLDER);
    let names = files::names(&folder)?;
    let found =
        names.iter().filter_map(|file| Some((file.strip_suffix(ENDING)?.to_owned(), folder.join(file))));
    Ok(found.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn a_folder_that_leads_elsewhere_takes_no_labels() {
        let place = tempfile::tempdir().unwrap();
        let out = place.path().join("out");
        std::fs::create_dir(&out).unwrap();
        for target in ["victim", "nowhere"] {
            if target == "victim" {
                std::fs::create_dir(place.path().join(target)).unwrap();
            }
            std::os::unix::fs::symlink(place.path().join(target), out.join(FOLDER)).unwrap();
            let told = second_file(&out, "bob").unwrap_err().to_string();
            assert!(
                told.contains("second: link: expected a folder") && told.contains("found a link to"),
                "{told}"
            );
            assert_eq!(second_labellers(&out).unwrap(), [], "they are read from wherever they lie");
            std::fs::remove_file(out.join(FOLDER)).unwrap();
        }
    }

    #[test]
    fn only_stores_with_names_are_found_and_no_name_leads_elsewhere() {
        let out = tempfile::tempdir().unwrap();
        assert_eq!(second_labellers(out.path()).unwrap(), []);
        let file = second_file(out.path(), "Zoë").unwrap();
        std::fs::create_dir(file.parent().unwrap()).unwrap();
        for name in ["bob.sqlite", "bob.sqlite-wal", "notes.txt"] {
            std::fs::write(out.path().join(FOLDER).join(name), "").unwrap();
        }
        std::fs::write(&file, "").unwrap();
        let bob = ("bob".to_owned(), second_file(out.path(), "bob").unwrap());
        assert_eq!(second_labellers(out.path()).unwrap(), [("Zoë".to_owned(), file), bob]);
        for wrong in ["", "..", "a/b", ".bob"] {
            let told = second_file(out.path(), wrong).unwrap_err().to_string();
            assert!(told.contains("second: `") && told.contains("expected a name"), "{told}");
        }
    }
}
