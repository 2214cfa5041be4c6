//! Asking libraries that decode what others made.

use crate::error::DataError;
use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Asks a library, and says what it says of a file. None is known to panic whatever a file holds; should one do so some
/// day, the file is refused all the same.
pub(crate) fn guarded<T, E: Display>(
    file: &Path,
    place: &str,
    expected: &str,
    ask: impl FnOnce() -> Result<T, E>,
) -> Result<T, DataError> {
    let refused = |found: String| DataError::content(file, place, expected, found);
    match catch_unwind(AssertUnwindSafe(ask)) {
        Ok(answer) => answer.map_err(|error| refused(error.to_string())),
        Err(_) => Err(refused("bytes that can't be read".to_owned())),
    }
}
