//! Files that hold a whole sequence, of which a scan is asked for at a time: the last ones read stay in memory.

use crate::error::DataError;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// What was read of the files that were asked for last.
pub(crate) struct LastRead<T> {
    read: fn(&Path) -> Result<T, DataError>,
    most: usize,
    /// The last one is the youngest.
    kept: Mutex<Vec<(PathBuf, Arc<T>)>>,
}

impl<T> LastRead<T> {
    /// Of files that are read so, of which so many stay: at least two, for whoever goes from one sequence to the next
    /// still asks for scans of both.
    pub(crate) fn new(read: fn(&Path) -> Result<T, DataError>, most: usize) -> Self {
        Self { read, most: most.max(2), kept: Mutex::default() }
    }

    /// What a file holds. Whoever asks meanwhile waits, rather than to read it, too.
    pub(crate) fn of(&self, file: &Path) -> Result<Arc<T>, DataError> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, held)) = kept.iter().find(|(known, _)| known == file) {
            return Ok(held.clone());
        }
        let held = Arc::new((self.read)(file)?);
        if kept.len() == self.most {
            kept.remove(0);
        }
        kept.push((file.to_owned(), held.clone()));
        Ok(held)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_two_files_are_not_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let files = ["a", "b", "c"].map(|name| folder.path().join(name));
        for file in &files {
            std::fs::write(file, "before").unwrap();
        }
        let last = LastRead::new(|file| std::fs::read_to_string(file).map_err(DataError::io(file)), 2);
        let all = || files.each_ref().map(|file| last.of(file).unwrap().as_str().to_owned());
        assert_eq!(all(), ["before"; 3]);
        for file in &files {
            std::fs::write(file, "after").unwrap();
        }
        let [_, b, c] = &files;
        assert_eq!([b, c].map(|file| last.of(file).unwrap().as_str().to_owned()), ["before"; 2]);
        assert_eq!(all(), ["after"; 3]);
        assert!(last.of(&folder.path().join("d")).is_err());
    }
}
