//! Names of places on disk.

use std::path::{Path, PathBuf};

/// How many digits such a name has.
const DIGITS: usize = 32;

/// Digits that name a file or folder by where it lies, whichever way it is asked for.
pub(crate) fn digits(path: &Path) -> String {
    blake3::hash(whole(path).as_os_str().as_encoded_bytes()).to_hex()[..DIGITS].to_owned()
}

/// What a folder is called, for people.
pub(crate) fn folder_name(path: &Path) -> String {
    let whole = whole(path);
    whole.file_name().unwrap_or(whole.as_os_str()).to_string_lossy().into_owned()
}

fn whole(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}
