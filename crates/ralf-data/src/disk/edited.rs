//! Text files that people are meant to edit: one that is as the program wrote it may be written again, another is kept.

use super::files;
use crate::error::DataError;
use ralf_files::Kind;
use std::path::Path;

/// Begins the last line of such a file; the hash of all lines before follows.
const MARK: &str = "# Written by ralf, which replaces this file unless it was edited: ";

/// Digits of the hash.
const DIGITS: usize = 16;

/// Writes a text whose lines may end with a comment behind `#`, whole or not at all, through a link as
/// [`write_named`](super::files::write_named) does. Its last line tells whether it is as it was written.
///
/// # Errors
/// Those of [`refuse_edited`], and what the system says.
pub fn write_editable(file: &Path, text: &str) -> Result<(), DataError> {
    refuse_edited(file)?;
    files::write_named(file, format!("{text}{MARK}{}\n", hash(text)).as_bytes())
}

/// Refuses a place for [`write_editable`] where a file lies that somebody wrote or edited: all but an empty one and
/// what it has written itself.
///
/// # Errors
/// Such a file, or one that can't be read.
pub fn refuse_edited(file: &Path) -> Result<(), DataError> {
    if !files::exists(file)? {
        return Ok(());
    }
    let text = files::read_text(file, Kind::Settings)?;
    let written = text.trim_end().rsplit_once(MARK).is_some_and(|(before, found)| found == hash(before));
    if written || text.is_empty() {
        return Ok(());
    }
    let expected = "nothing yet, or what ralf wrote and nobody has edited since";
    let found = "another text, which would be lost: move it away, or choose another name";
    Err(DataError::content(file, "output", expected, found))
}

fn hash(text: &str) -> String {
    blake3::hash(text.as_bytes()).to_hex()[..DIGITS].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn what_was_written_is_written_again_and_what_was_edited_is_kept() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("ralf.toml");
        for text in ["alpha = 0.5\n", "alpha = 0.7\n", ""] {
            write_editable(&file, text).unwrap();
            assert!(fs::read_to_string(&file).unwrap().starts_with(text));
        }
        write_editable(&file, "alpha = 0.5\n").unwrap();
        let written = fs::read_to_string(&file).unwrap();
        let edited = [written.replace("0.5", "0.6"), written.clone() + "beta = 2\n", "alpha = 0.5\n".into()];
        for text in edited.into_iter().chain([format!("# mine\n{written}")]) {
            fs::write(&file, &text).unwrap();
            let told = write_editable(&file, "alpha = 1\n").unwrap_err().to_string();
            assert!(told.contains("ralf.toml: output: expected nothing yet"), "{told}");
            assert_eq!(fs::read_to_string(&file).unwrap(), text);
        }
        fs::write(&file, "").unwrap();
        write_editable(&file, "alpha = 1\n").unwrap();
    }
}
