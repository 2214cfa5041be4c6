//! A file that one writes at a time, whoever else has it open.

use std::fs::{self, File};
use std::io::{Error, ErrorKind};
use std::path::Path;

/// Opens an empty file to be written, and locks it until it is closed: others who open it so wait until then. What a
/// kill left there is taken over; what is no regular file is removed first: through a link, what it leads to would be
/// overwritten.
pub(crate) fn open_alone(path: &Path) -> Result<File, Error> {
    loop {
        let open = match options().create_new(true).open(path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => open_existing(path)?,
            opened => opened?,
        };
        unless(lacks_locks, open.lock())?;
        // The one before may have put it in its place meanwhile, or removed it.
        if is_at(&open, path) {
            // Emptying one that is empty would cost as much as writing it.
            return if open.metadata()?.len() == 0 { Ok(open) } else { open.set_len(0).map(|()| open) };
        }
    }
}

/// Does something while nobody else does who names the same file: others wait. It is gone afterwards.
pub(crate) fn alone<T>(path: &Path, work: impl FnOnce() -> T) -> Result<T, Error> {
    let open = open_alone(path)?;
    let done = work();
    // It stays open, and with it locked, until it is gone; one that stays is in nobody's way.
    drop(fs::remove_file(path));
    drop(open);
    Ok(done)
}

fn open_existing(path: &Path) -> Result<File, Error> {
    if fs::symlink_metadata(path).is_ok_and(|found| !found.is_file()) {
        unless(|error| error.kind() == ErrorKind::NotFound, fs::remove_file(path))?;
    }
    options().create(true).truncate(false).open(path)
}

/// To be read, too: network file systems share no lock of a file that is only written.
fn options() -> fs::OpenOptions {
    let mut options = File::options();
    options.read(true).write(true);
    options
}

/// Whether a lock failed because the file system has none, as NFS without its lock daemon: its users go on as they did
/// without.
pub(crate) fn lacks_locks(error: &Error) -> bool {
    /// Linux's ENOLCK, which has no kind of its own.
    const NO_LOCKS: i32 = 37;
    let no_locks = cfg!(target_os = "linux") && error.raw_os_error() == Some(NO_LOCKS);
    no_locks || error.kind() == ErrorKind::Unsupported
}

fn unless(is_harmless: impl Fn(&Error) -> bool, result: Result<(), Error>) -> Result<(), Error> {
    if result.as_ref().is_err_and(is_harmless) { Ok(()) } else { result }
}

/// Whether the open file is the one that lies at this path.
#[cfg(unix)]
pub(crate) fn is_at(open: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let same = |a: fs::Metadata, b: fs::Metadata| (a.dev(), a.ino()) == (b.dev(), b.ino());
    open.metadata().is_ok_and(|open| fs::symlink_metadata(path).is_ok_and(|found| same(open, found)))
}

#[cfg(not(unix))]
pub(crate) fn is_at(_open: &File, path: &Path) -> bool {
    path.exists()
}
