//! Opening files that others made: regular files alone, and none larger than its kind can be.
//!
//! A recording may hold anything under a name that looks like a measurement: a named pipe that nobody writes to, a
//! device that never ends, a sparse file of terabytes. Nothing of it may hang a program or take all of its memory, so
//! everything in RALF that opens a file does so here.
//!
//! ```
//! # fn main() -> std::io::Result<()> {
//! let folder = std::env::temp_dir();
//! let refused = ralf_files::read(&folder, ralf_files::Kind::Measurement).unwrap_err();
//! assert_eq!(refused.to_string(), "expected a regular file, found a folder");
//! # Ok(())
//! # }
//! ```

pub mod database;

use std::fs::{self, File, FileType};
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;
use std::sync::OnceLock;

/// The environment variable that raises all limits: a number of megabytes.
pub const LIMIT_VARIABLE: &str = "RALF_MAX_FILE_MB";

const MEGABYTE: u64 = 1_000_000;

/// What a file is for, and with it how large it can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Settings, calibrations, cards, lists of files: up to 16 MB.
    Settings,
    /// One scan, image, depth image or file of labels: up to 512 MB.
    Measurement,
    /// Times, odometry, poses, records, which are read as a whole: up to 1,024 MB.
    Table,
    /// The weights of a network: up to 2,048 MB, which is the most that such a file can hold.
    Network,
    /// Recordings and tables that are read piece by piece: of any size.
    Stream,
}

impl Kind {
    /// The largest size, bytes; `None` where any will do.
    ///
    /// # Errors
    /// The environment asks for another limit, and not by a [number](check_environment).
    pub fn limit(self) -> Result<Option<u64>> {
        let raised = raised()?;
        let megabytes = match self {
            Self::Settings => 16,
            Self::Measurement => 512,
            Self::Table => 1024,
            Self::Network => 2048,
            Self::Stream => return Ok(None),
        };
        Ok(Some((megabytes * MEGABYTE).max(raised)))
    }
}

/// Refuses an environment whose [`LIMIT_VARIABLE`] is no number, before any file is opened: whoever sets it wants
/// larger files read, and is not to find out by a file that is refused all the same.
pub fn check_environment() -> Result<()> {
    raised().map(drop)
}

/// What the environment asks for, bytes; 0 where it asks for nothing.
fn raised() -> Result<u64> {
    static RAISED: OnceLock<std::result::Result<u64, String>> = OnceLock::new();
    let asked = || std::env::var_os(LIMIT_VARIABLE).map_or(Ok(0), |value| bytes_of(&value.to_string_lossy()));
    RAISED.get_or_init(asked).clone().map_err(|found| Error::new(ErrorKind::InvalidInput, found))
}

/// A number of megabytes as bytes; 0 where nothing is said.
fn bytes_of(value: &str) -> std::result::Result<u64, String> {
    if value.trim().is_empty() {
        return Ok(0);
    }
    let megabytes: std::result::Result<u64, _> = value.trim().parse();
    megabytes.map(|megabytes| megabytes.saturating_mul(MEGABYTE)).map_err(|_| {
        format!("{LIMIT_VARIABLE} in the environment: expected a whole number of megabytes, found `{value}`")
    })
}

/// Refuses what is no regular file, and one that is larger than its kind can be. Returns its size, bytes.
pub fn check(file: &Path, kind: Kind) -> Result<u64> {
    // Asked before opening: opening a pipe waits for someone to write into it.
    let found = fs::metadata(file).map_err(|error| absent(error, "a regular file"))?;
    if !found.is_file() {
        let found = special(found.file_type());
        return Err(Error::new(ErrorKind::InvalidInput, format!("expected a regular file, found {found}")));
    }
    refuse_above(kind.limit()?, found.len()).map(|()| found.len())
}

/// Opens a file for reading.
pub fn open(file: &Path, kind: Kind) -> Result<File> {
    check(file, kind)?;
    File::open(file)
}

/// The whole file.
pub fn read(file: &Path, kind: Kind) -> Result<Vec<u8>> {
    let size = check(file, kind)?;
    let mut bytes = Vec::with_capacity(usize::try_from(size).unwrap_or_default());
    let open = File::open(file)?;
    match kind.limit()? {
        // It may have grown since it was looked at.
        Some(limit) => open.take(limit.saturating_add(1)).read_to_end(&mut bytes)?,
        None => { open }.read_to_end(&mut bytes)?,
    };
    refuse_above(kind.limit()?, bytes.len() as u64).map(|()| bytes)
}

/// The whole file as UTF-8 text, as [`text`] has it.
pub fn read_text(file: &Path, kind: Kind) -> Result<String> {
    text(read(file, kind)?).map_err(|place| {
        Error::new(ErrorKind::InvalidData, format!("byte {place}: expected UTF-8 text, found other bytes"))
    })
}

/// What bytes say as UTF-8 text, without the byte order mark that Windows' editors put before it.
///
/// ```
/// assert_eq!(ralf_files::text(b"\xEF\xBB\xBF1,2".to_vec()), Ok("1,2".to_owned()));
/// ```
///
/// # Errors
/// The place of the first byte that is no UTF-8.
pub fn text(bytes: Vec<u8>) -> std::result::Result<String, usize> {
    let mut text = String::from_utf8(bytes).map_err(|error| error.utf8_error().valid_up_to())?;
    if text.starts_with('\u{feff}') {
        text.remove(0);
    }
    Ok(text)
}

/// An error of the system as a sentence, where there is no such file or folder; any other stays as it is.
///
/// ```
/// let error = std::fs::read_dir("no folder of this name").unwrap_err();
/// assert_eq!(ralf_files::absent(error, "a folder").to_string(), "expected a folder, found none of this name");
/// ```
pub fn absent(error: Error, expected: &str) -> Error {
    match error.kind() {
        kind @ ErrorKind::NotFound => {
            Error::new(kind, format!("expected {expected}, found none of this name"))
        }
        kind @ ErrorKind::NotADirectory => {
            Error::new(kind, format!("expected {expected}, found a file in the place of a folder"))
        }
        _ => error,
    }
}

fn refuse_above(limit: Option<u64>, size: u64) -> Result<()> {
    let Some(limit) = limit.filter(|limit| size > *limit) else { return Ok(()) };
    let [limit, found] = [limit, size].map(|bytes| bytes.div_ceil(MEGABYTE));
    let sentence = format!(
        "expected at most {limit} MB ({LIMIT_VARIABLE} in the environment raises it), found {found} MB"
    );
    Err(Error::new(ErrorKind::FileTooLarge, sentence))
}

#[cfg(unix)]
fn special(found: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    match () {
        () if found.is_dir() => "a folder",
        () if found.is_fifo() => "a named pipe",
        () if found.is_socket() => "a socket",
        () if found.is_symlink() => "a link",
        () => "a device",
    }
}

#[cfg(not(unix))]
fn special(found: FileType) -> &'static str {
    match () {
        () if found.is_dir() => "a folder",
        () if found.is_symlink() => "a link",
        () => "a device",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_whole_and_text_is_text() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a");
        fs::write(&file, "caf\u{e9}").unwrap();
        assert_eq!(read(&file, Kind::Measurement).unwrap(), "caf\u{e9}".as_bytes());
        assert_eq!(read_text(&file, Kind::Settings).unwrap(), "caf\u{e9}");
        assert_eq!(check(&file, Kind::Stream).unwrap(), 5);
        fs::write(&file, [b'a', 0xff]).unwrap();
        let error = read_text(&file, Kind::Settings).unwrap_err().to_string();
        assert_eq!(error, "byte 1: expected UTF-8 text, found other bytes");
        let error = read(&folder.path().join("b"), Kind::Stream).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::NotFound);
        assert_eq!(error.to_string(), "expected a regular file, found none of this name");
        let error = read(&file.join("b"), Kind::Stream).unwrap_err().to_string();
        assert_eq!(error, "expected a regular file, found a file in the place of a folder");
    }

    #[test]
    fn a_limit_is_a_whole_number_of_megabytes() {
        assert_eq!(bytes_of(" 4000 "), Ok(4_000_000_000));
        assert_eq!((bytes_of(""), bytes_of("99999999999999999999").is_err()), (Ok(0), true));
        let told = "RALF_MAX_FILE_MB in the environment: expected a whole number of megabytes, found `abc`";
        assert_eq!(bytes_of("abc"), Err(told.to_owned()));
    }

    #[test]
    fn a_sparse_file_beyond_its_kind_is_refused_before_it_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("000000.bin");
        File::create(&file).unwrap().set_len(3_000 * MEGABYTE).unwrap();
        for kind in [Kind::Settings, Kind::Measurement, Kind::Table, Kind::Network] {
            let error = read(&file, kind).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::FileTooLarge);
            let told = error.to_string();
            assert!(told.contains("RALF_MAX_FILE_MB") && told.contains("found 3000 MB"), "{told}");
        }
        assert!(open(&file, Kind::Stream).is_ok());
    }

    #[cfg(unix)]
    #[test]
    fn a_device_a_pipe_and_a_folder_are_named_and_not_opened() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status().unwrap();
        assert!(made.success());
        let socket = folder.path().join("socket");
        let _bound = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        for (file, name) in [
            (Path::new("/dev/zero"), "a device"),
            (&pipe, "a named pipe"),
            (&socket, "a socket"),
            (folder.path(), "a folder"),
        ] {
            let error = read(file, Kind::Stream).unwrap_err().to_string();
            assert_eq!(error, format!("expected a regular file, found {name}"));
        }
    }
}
