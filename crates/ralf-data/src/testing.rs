//! What the tests of several readers share.

use crate::read::{Recording, SequenceReader};
use std::path::{Path, PathBuf};

/// A folder of the real recordings, where the environment names them; else the test says that it is skipped.
pub(crate) fn data(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("RALF_TEST_DATA").map(|root| Path::new(&root).join(name));
    if folder.is_none() {
        println!("skipped: RALF_TEST_DATA is not set");
    }
    folder
}

/// Writes a file, with its folders.
pub(crate) fn write(file: &Path, bytes: &[u8]) {
    crate::disk::files::write_whole(file, bytes).unwrap();
}

/// The sequence of a recording that has one.
pub(crate) fn only(recording: &Recording) -> &dyn SequenceReader {
    recording.sequences[0].as_ref()
}
