//! Bytes on disk: reading whole files, rows of float32, and writing so that a file appears whole or not at all.

use super::alone::open_alone;
use super::real_path::through_link;
use crate::error::DataError;
use ralf_files::Kind;
use std::collections::HashMap;
use std::ffi::OsString;
use std::fs;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// A whole measurement, or what belongs to one. Everything in this crate that reads a file does so through this module:
/// it refuses what is no regular file, and what is larger than its kind can be ([`ralf_files`]).
pub(crate) fn read(file: &Path) -> Result<Vec<u8>, DataError> {
    ralf_files::read(file, Kind::Measurement).map_err(DataError::io(file))
}

/// Whether there is such a file or folder. Nothing lies below a file: a recording may be one.
pub(crate) fn exists(file: &Path) -> Result<bool, DataError> {
    match file.try_exists() {
        Err(error) if is_nowhere(&error) => Ok(false),
        found => found.map_err(DataError::io(file)),
    }
}

/// A path that leads to the same place from every folder. Where the system doesn't tell which one this is, it stays as
/// it was given.
pub(crate) fn whole(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Opens a file that is read piece by piece, of any size.
pub(crate) fn open(file: &Path) -> Result<fs::File, DataError> {
    ralf_files::open(file, Kind::Stream).map_err(DataError::io(file))
}

/// Opens an input to be read piece by piece, however large a file of its kind may be, and tells its size.
pub(crate) fn open_input(file: &Path) -> Result<(fs::File, u64), DataError> {
    const MEASUREMENTS: [&str; 9] = ["bin", "pcd", "laz", "npy", "label", "time", "jpg", "jpeg", "png"];
    let extension = file.extension().unwrap_or_default();
    let is_measurement = MEASUREMENTS.iter().any(|known| extension.eq_ignore_ascii_case(known));
    let kind = if is_measurement { Kind::Measurement } else { Kind::Stream };
    let size = ralf_files::check(file, kind).map_err(DataError::io(file))?;
    Ok((fs::File::open(file).map_err(DataError::io(file))?, size))
}

/// The whole file as UTF-8 text, as [`ralf_files::text`] has it.
pub(crate) fn read_text(file: &Path, kind: Kind) -> Result<String, DataError> {
    let bytes = ralf_files::read(file, kind).map_err(DataError::io(file))?;
    ralf_files::text(bytes)
        .map_err(|place| DataError::content(file, format!("byte {place}"), "UTF-8 text", "other bytes"))
}

/// A file of packed little-endian float32 rows, as one vector per column; there is at least one.
pub(crate) fn read_f32_columns(file: &Path, columns: usize) -> Result<Vec<Vec<f32>>, DataError> {
    let bytes = read(file)?;
    check_f32_rows(file, bytes.len(), columns)?;
    let values = bytes.as_chunks::<4>().0;
    let column = |first| values.iter().skip(first).step_by(columns).map(|b| f32::from_le_bytes(*b)).collect();
    Ok((0..columns).map(column).collect())
}

/// The rows of `N` packed little-endian float32 that a file's content holds, each as its bytes.
pub(crate) fn f32_rows<'a, const N: usize>(
    file: &Path,
    bytes: &'a [u8],
) -> Result<&'a [[[u8; 4]; N]], DataError> {
    check_f32_rows(file, bytes.len(), N)?;
    Ok(bytes.as_chunks::<4>().0.as_chunks::<N>().0)
}

/// The bytes of packed little-endian float32.
pub(crate) fn f32_bytes(values: impl Iterator<Item = f32>) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(4 * values.size_hint().0);
    values.for_each(|value| bytes.extend_from_slice(&value.to_le_bytes()));
    bytes
}

fn check_f32_rows(file: &Path, size: usize, columns: usize) -> Result<(), DataError> {
    check_rows(file, size, columns * size_of::<f32>(), &format!("rows of {columns} float32"))
}

/// Refuses a file that ends within a row, or whatever it consists of.
pub(crate) fn check_rows(file: &Path, size: usize, row_bytes: usize, rows: &str) -> Result<(), DataError> {
    let left_over = size % row_bytes;
    if left_over == 0 {
        return Ok(());
    }
    let bytes = if left_over == 1 { "byte" } else { "bytes" };
    Err(DataError::content(
        file,
        format!("byte {}", size - left_over),
        format!("{rows} ({row_bytes} bytes)"),
        format!("{left_over} {bytes} left over at the end"),
    ))
}

/// What lies in a folder, which has to be there; `expected` says what it is looked into for.
pub(crate) fn entries(folder: &Path, expected: &str) -> Result<fs::ReadDir, DataError> {
    fs::read_dir(folder).map_err(|error| DataError::io(folder)(ralf_files::absent(error, expected)))
}

/// The names of all that lies in a folder, sorted, hidden ones left out; empty where there is no such folder (a
/// recording may be one file).
pub(crate) fn names(folder: &Path) -> Result<Vec<String>, DataError> {
    let entries = match fs::read_dir(folder) {
        Err(error) if is_nowhere(&error) => return Ok(Vec::new()),
        entries => entries.map_err(DataError::io(folder))?,
    };
    let mut names = Vec::new();
    for entry in entries {
        let name = entry.map_err(DataError::io(folder))?.file_name().into_string().map_err(|name| {
            DataError::content(folder, "file names", "UTF-8 text", format!("`{}`", name.display()))
        })?;
        names.push(name);
    }
    names.retain(|name| !name.starts_with('.'));
    names.sort_unstable();
    Ok(names)
}

fn is_nowhere(error: &std::io::Error) -> bool {
    matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory)
}

/// The names of the folders in a folder, sorted, hidden ones left out; empty where there is no such folder.
pub(crate) fn folders(folder: &Path) -> Result<Vec<String>, DataError> {
    let mut names = names(folder)?;
    names.retain(|name| folder.join(name).is_dir());
    Ok(names)
}

/// Which files are on disk, with one look into each folder rather than at each of millions of files.
#[derive(Debug, Default)]
pub(crate) struct Folders {
    /// Sorted names per folder.
    known: HashMap<PathBuf, Vec<String>>,
}

impl Folders {
    /// Whether the file is there. A folder that is missing holds nothing.
    pub(crate) fn hold(&mut self, file: &Path) -> Result<bool, DataError> {
        let (Some(folder), Some(name)) = (file.parent(), file.file_name()) else { return Ok(false) };
        let name = name.to_string_lossy();
        if !self.known.contains_key(folder) {
            self.known.insert(folder.to_owned(), names(folder)?);
        }
        Ok(self
            .known
            .get(folder)
            .is_some_and(|names| names.binary_search_by(|found| found.as_str().cmp(&name)).is_ok()))
    }
}

/// Writes a file whole or not at all: beside its place first, then renamed. Folders are made as needed. Who writes the
/// same file at the same time waits, and writes it again.
pub fn write_whole(file: &Path, bytes: &[u8]) -> Result<(), DataError> {
    write_whole_with(file, |out| out.write_all(bytes))
}

/// Writes a file that a person has named, whole or not at all ([`write_whole`]): where a link of this name lies, what
/// it leads to is written. All other files replace a link, for it may lead out of the folder that is written to.
pub fn write_named(file: &Path, bytes: &[u8]) -> Result<(), DataError> {
    write_whole(&through_link(file), bytes)
}

/// Tells early whether [`write_named`] can make this file, which takes longer to find out by the work that fills it: an
/// empty one is made where it would be written, or as near as there is a folder, and removed again.
pub fn check_writable(file: &Path) -> Result<(), DataError> {
    let place = beside(&through_link(file));
    let is_there = |folder: &&Path| folder.as_os_str().is_empty() || folder.exists();
    let folder = place.ancestors().skip(1).find(is_there).unwrap_or(Path::new(""));
    let tried = folder.join(place.file_name().unwrap_or_default());
    if tried.symlink_metadata().is_ok() {
        // Somebody's own, or of a writer at work or killed: not to be emptied by a question.
        return Ok(());
    }
    // It stays open, and with it locked, until it is gone: whoever writes the same file waits.
    let made = open_alone(&tried).and_then(|open| fs::remove_file(&tried).map(|()| drop(open)));
    made.map_err(|error| DataError::io(file)(ralf_files::absent(error, "a place for a file")))
}

/// Writes a file as [`write_whole`] does, with content that is made while it is written, so that it need not be in
/// memory at once.
pub(crate) fn write_whole_with(
    file: &Path,
    content: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<(), DataError> {
    let beside = beside(file);
    let opened = match (open_alone(&beside), file.parent()) {
        (Err(error), Some(folder)) if error.kind() == ErrorKind::NotFound => {
            fs::create_dir_all(folder).and_then(|()| open_alone(&beside))
        }
        (opened, _) => opened,
    };
    let written = opened.and_then(|mut open| {
        // The file stays open, and with it locked, until it is in its place or gone.
        let written = content(&mut open).and_then(|()| fs::rename(&beside, file));
        // The half-written file is of no use to anyone; the error that matters is the first one.
        written.inspect_err(|_| drop(fs::remove_file(&beside)))
    });
    written.map_err(DataError::io(file))
}

/// Creates a file. What lies there is removed first: through a link, what it leads to would be overwritten.
pub(crate) fn create_new(file: &Path) -> std::io::Result<fs::File> {
    let create = || fs::File::options().write(true).create_new(true).open(file);
    match create() {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            fs::remove_file(file).and_then(|()| create())
        }
        created => created,
    }
}

/// Where a file is written before it is renamed: hidden, for people have files `NAME.part` of their own.
pub(crate) fn beside(file: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(file.file_name().unwrap_or_default());
    name.push(".part");
    file.with_file_name(name)
}

/// Removes a file, if it is there, and what a kill while it was written left beside it.
pub(crate) fn remove(file: &Path) -> Result<(), DataError> {
    for file in [beside(file), file.to_owned()] {
        match fs::remove_file(&file) {
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(DataError::Io { file, error }),
            _ => {}
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn a_file_is_never_written_through_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (file, victim) = (folder.path().join("a"), folder.path().join("victim"));
        fs::write(&victim, "mine").unwrap();
        for link in [file.clone(), beside(&file)] {
            std::os::unix::fs::symlink(&victim, link).unwrap();
            write_whole(&file, b"new").unwrap();
            assert_eq!(
                (fs::read(&file).unwrap(), fs::read(&victim).unwrap()),
                (b"new".into(), b"mine".into())
            );
            fs::remove_file(&file).unwrap();
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_link_that_a_person_named_stays_and_what_it_leads_to_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let [link, target] = ["link", "there/target"].map(|name| folder.path().join(name));
        fs::create_dir(folder.path().join("there")).unwrap();
        std::os::unix::fs::symlink("there/target", &link).unwrap();
        for content in ["new", "newer"] {
            write_named(&link, content.as_bytes()).unwrap();
            assert!(link.is_symlink() && fs::read(&target).unwrap() == content.as_bytes());
        }
        assert_eq!(names(&folder.path().join("there")).unwrap(), ["target"]);
    }

    #[test]
    fn whether_a_file_can_be_made_is_told_before_and_nothing_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        fs::write(place("file"), "mine").unwrap();
        for name in ["new", "file", "no/such/folder/new"] {
            check_writable(&place(name)).unwrap();
        }
        for name in ["file/new".to_owned(), "file/no/such".to_owned(), "n".repeat(300)] {
            let error = check_writable(&place(&name)).unwrap_err().to_string();
            assert!(error.contains(&name), "{error}");
        }
        fs::write(place(".other.part"), "mine").unwrap();
        check_writable(&place("no/such/other")).unwrap();
        assert_eq!(names(folder.path()).unwrap(), ["file"]);
        for name in [".other.part", "file"] {
            assert_eq!(fs::read(place(name)).unwrap(), b"mine");
        }
    }

    /// Parts of a run may be done twice at the same time.
    #[test]
    fn two_who_write_the_same_file_at_once_both_succeed_and_all_that_is_ever_read_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a/000000.label");
        let content = [vec![b'a'; 100_000], vec![b'b'; 50_000]];
        write_whole(&file, &content[0]).unwrap();
        fs::write(beside(&file), "left by a kill").unwrap();
        std::thread::scope(|scope| {
            for content in &content {
                scope.spawn(|| (0..300).for_each(|_| write_whole(&file, content).unwrap()));
            }
            scope.spawn(|| (0..300).for_each(|_| assert!(content.contains(&fs::read(&file).unwrap()))));
        });
        assert_eq!(names(&folder.path().join("a")).unwrap(), ["000000.label"]);
    }

    #[test]
    fn rows_become_columns_and_a_cut_row_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a/000000.bin");
        let bytes: Vec<u8> = [1.0f32, 2.0, 3.0, 4.0].iter().flat_map(|v| v.to_le_bytes()).collect();
        write_whole(&file, &bytes).unwrap();
        assert_eq!(read_f32_columns(&file, 2).unwrap(), [[1.0, 3.0], [2.0, 4.0]]);
        let rows = f32_rows::<2>(&file, &bytes).unwrap();
        assert_eq!(
            rows.as_flattened().iter().map(|b| f32::from_le_bytes(*b)).collect::<Vec<_>>(),
            [1.0, 2.0, 3.0, 4.0]
        );
        write_whole(&file, &bytes[..15]).unwrap();
        let error = read_f32_columns(&file, 2).unwrap_err().to_string();
        assert!(error.contains("000000.bin: byte 8: expected rows of 2 float32"), "{error}");
        assert!(!beside(&file).exists());
    }
}
