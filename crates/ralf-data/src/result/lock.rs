//! One writer at a time: a lock that the system takes back when its holder ends, however it ends.

use crate::disk::alone::{is_at, lacks_locks};
use crate::error::DataError;
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

/// The right to write to a place, until it is dropped.
#[derive(Debug)]
pub(crate) struct WriterLock {
    file: PathBuf,
    /// Folders that were made for the lock file, the innermost first.
    made: Vec<PathBuf>,
    /// The lock is on the open file, so that it ends with the process.
    _open: File,
    /// Whether others may hold it, too.
    shared: bool,
}

impl WriterLock {
    /// Locks `place` by means of the file `file`, whose folder is made as needed.
    ///
    /// # Errors
    /// [`DataError::Busy`] where another writer is at work.
    pub(crate) fn take(file: PathBuf, place: &Path) -> Result<Self, DataError> {
        Self::lock(file, place, false)
    }

    /// Takes part in writing to `place`, beside others that do so by this function: who [takes](Self::take) it keeps
    /// all of them out, and they keep him out.
    ///
    /// # Errors
    /// [`DataError::Busy`] where a writer is at work that is alone.
    pub(crate) fn share(file: PathBuf, place: &Path) -> Result<Self, DataError> {
        Self::lock(file, place, true)
    }

    fn lock(file: PathBuf, place: &Path, shared: bool) -> Result<Self, DataError> {
        let folder = file.parent().unwrap_or(Path::new("."));
        let missing =
            folder.ancestors().take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists());
        let made: Vec<PathBuf> = missing.map(Path::to_owned).collect();
        if folder.exists() && !folder.is_dir() {
            return Err(DataError::content(folder, "path", "a folder, or nothing yet", "a file"));
        }
        let made_folder = fs::create_dir_all(folder);
        made_folder
            .map_err(|error| DataError::io(folder)(ralf_files::absent(error, "a folder, or nothing yet")))?;
        if file.is_symlink() {
            return Err(DataError::content(&file, "lock", "a file, or nothing yet", "a link"));
        }
        loop {
            // To be read, too: network file systems share no lock of a file that is only written.
            let open = File::options().create(true).truncate(false).read(true).write(true).open(&file);
            let open = open.map_err(DataError::io(&file))?;
            match if shared { open.try_lock_shared() } else { open.try_lock() } {
                // Another writer may have ended, and removed the file, between the two lines above.
                Ok(()) if !is_at(&open, &file) => {}
                Ok(()) => return Ok(Self { file, made, shared, _open: open }),
                Err(TryLockError::WouldBlock) => return Err(DataError::Busy { place: place.to_owned() }),
                Err(TryLockError::Error(error)) if lacks_locks(&error) => {
                    return Ok(Self { file, made, shared, _open: open });
                }
                Err(TryLockError::Error(error)) => return Err(DataError::Io { file, error }),
            }
        }
    }

    /// Locks a file or folder by a hidden file beside it.
    pub(crate) fn beside(place: &Path) -> Result<Self, DataError> {
        let name = place.file_name().unwrap_or_default().to_string_lossy();
        Self::take(place.with_file_name(format!(".{name}.lock")), place)
    }
}

impl Drop for WriterLock {
    /// Nothing is left of the lock. A folder that holds something stays: that is no failure.
    fn drop(&mut self) {
        // Who shares leaves the file to the one who will be alone: to take it away from under another who is just
        // opening it would let that one share with nobody.
        if self.shared {
            return;
        }
        let _ = fs::remove_file(&self.file);
        self.made.iter().all(|folder| fs::remove_dir(folder).is_ok());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_writer_is_told_and_nothing_is_left() {
        let root = tempfile::tempdir().unwrap();
        let out = root.path().join("a/out");
        let lock = WriterLock::take(out.join(".lock"), &out).unwrap();
        let error = WriterLock::take(out.join(".lock"), &out).unwrap_err();
        assert!(error.to_string().contains("another run"), "{error}");
        drop(lock);
        assert!(!root.path().join("a").exists());
        fs::create_dir_all(&out).unwrap();
        drop(WriterLock::take(out.join(".lock"), &out).unwrap());
        assert!(out.exists() && fs::read_dir(&out).unwrap().next().is_none());
    }

    #[test]
    fn those_who_share_are_many_and_who_is_alone_waits_for_all_of_them() {
        let root = tempfile::tempdir().unwrap();
        let out = root.path().join("out");
        let file = out.join(".lock");
        let busy = |lock: Result<WriterLock, DataError>| matches!(lock, Err(DataError::Busy { .. }));
        let first = WriterLock::share(file.clone(), &out).unwrap();
        let second = WriterLock::share(file.clone(), &out).unwrap();
        assert!(busy(WriterLock::take(file.clone(), &out)));
        drop(first);
        assert!(busy(WriterLock::take(file.clone(), &out)));
        drop(second);
        let alone = WriterLock::take(file.clone(), &out).unwrap();
        assert!(busy(WriterLock::share(file.clone(), &out)));
        drop(alone);
        assert!(!file.exists());
    }

    /// Many threads lock, count without an atomic step, and unlock: no two are at work at once.
    #[test]
    fn there_is_one_writer_at_a_time() {
        let root = tempfile::tempdir().unwrap();
        let (out, count) = (root.path().join("out"), root.path().join("count"));
        fs::write(&count, "0").unwrap();
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    let mut done = 0;
                    while done < 25 {
                        let Ok(_lock) = WriterLock::beside(&out) else { continue };
                        let before: u32 = fs::read_to_string(&count).unwrap().parse().unwrap();
                        fs::write(&count, (before + 1).to_string()).unwrap();
                        done += 1;
                    }
                });
            }
        });
        assert_eq!(fs::read_to_string(&count).unwrap(), "100");
    }
}
