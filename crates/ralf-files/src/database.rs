//! What SQLite lays beside a database, and how a path becomes an address that takes options.

use crate::special;
use std::fmt::Write;
use std::fs;
use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};

/// What the names of the files that SQLite lays beside a database have after its own, and that it opens before it.
const ENDINGS: [&str; 3] = [JOURNAL, LOG, "-shm"];
/// Where a change lies that has not ended.
const JOURNAL: &str = "-journal";
/// Where changes lie that were not written back to the database.
const LOG: &str = "-wal";

/// The log of a database: changes that were not written back to it. Of a link it lies beside what that leads to.
pub fn log(file: &Path) -> PathBuf {
    beside(file, LOG)
}

/// Whether changes lie beside a database that are not in it, or that may have to be taken back in it.
pub fn has_changes_beside(file: &Path) -> bool {
    [LOG, JOURNAL].iter().any(|ending| beside(file, ending).metadata().is_ok_and(|found| found.len() > 0))
}

fn beside(file: &Path, ending: &str) -> PathBuf {
    let mut name = file.canonicalize().unwrap_or_else(|_| file.to_owned()).into_os_string();
    name.push(ending);
    name.into()
}

/// Refuses what lies beside a database under the name of a file of SQLite's own, and is no regular file: SQLite would
/// wait for a pipe for ever, and write through a link.
///
/// # Errors
/// The first of them by name, and what it is; or the system doesn't tell.
pub fn check_beside(file: &Path) -> Result<()> {
    for ending in ENDINGS {
        let beside = beside(file, ending);
        let found = match fs::symlink_metadata(&beside) {
            Err(error) if error.kind() == ErrorKind::NotFound => continue,
            found => found?.file_type(),
        };
        if !found.is_file() {
            let (found, name) = (special(found), beside.file_name().unwrap_or_default().display());
            let told = format!("expected a regular file in the place of {name}, found {found}");
            return Err(Error::new(ErrorKind::InvalidInput, told));
        }
    }
    Ok(())
}

/// The address by which SQLite opens a file with an option of its own, such as `mode=ro`.
pub fn uri(file: &Path, option: &str) -> String {
    // What begins with two slashes would be taken for the name of a machine.
    let mut uri =
        String::from(if file.as_os_str().as_encoded_bytes().starts_with(b"/") { "file://" } else { "file:" });
    for byte in file.as_os_str().as_encoded_bytes() {
        match byte {
            b'/' | b'\\' | b':' | b'.' | b'-' | b'_' | b'~' => uri.push(char::from(*byte)),
            byte if byte.is_ascii_alphanumeric() => uri.push(char::from(*byte)),
            byte => write!(uri, "%{byte:02x}").unwrap_or_default(),
        }
    }
    uri + "?" + option
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_keeps_the_path_whatever_is_in_it() {
        assert_eq!(uri(Path::new("a b/50% #1?.db"), "mode=ro"), "file:a%20b/50%25%20%231%3f.db?mode=ro");
        assert_eq!(uri(Path::new("/t\u{e9}.db"), "immutable=1"), "file:///t%c3%a9.db?immutable=1");
        assert_eq!(uri(Path::new("//t"), "mode=ro"), "file:////t?mode=ro");
    }

    #[cfg(unix)]
    #[test]
    fn pipes_links_and_folders_beside_a_database_are_named_also_of_a_linked_one() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        fs::create_dir(place("there")).unwrap();
        fs::write(place("there/a.db"), "").unwrap();
        std::os::unix::fs::symlink(place("there/a.db"), place("named.db")).unwrap();
        let told = || check_beside(&place("named.db")).unwrap_err().to_string();
        fs::write(place("there/a.db-wal"), "").unwrap();
        check_beside(&place("named.db")).unwrap();
        assert!(!has_changes_beside(&place("named.db")));
        fs::write(place("there/a.db-wal"), "x").unwrap();
        assert!(has_changes_beside(&place("named.db")));
        fs::create_dir(place("there/a.db-shm")).unwrap();
        assert_eq!(told(), "expected a regular file in the place of a.db-shm, found a folder");
        std::os::unix::fs::symlink(place("nowhere"), place("there/a.db-journal")).unwrap();
        assert_eq!(told(), "expected a regular file in the place of a.db-journal, found a link");
        fs::remove_file(place("there/a.db-journal")).unwrap();
        assert!(
            std::process::Command::new("mkfifo").arg(place("there/a.db-journal")).status().unwrap().success()
        );
        assert_eq!(told(), "expected a regular file in the place of a.db-journal, found a named pipe");
    }
}
