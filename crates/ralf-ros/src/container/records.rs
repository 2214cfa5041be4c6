//! Walking over the records of a file of any size, most of which are skipped.

use super::error::Stop;
use crate::encoding::EncodingError;
use std::fs::File;
use std::io::{self, BufReader, Read};

/// The longest record that is read as a whole while walking: texts of definitions and parts of the index.
const RECORD_BYTES: u64 = 1 << 26;

/// A file and the place in it. Nothing beyond its end is ever read or allocated for.
pub(super) struct RecordFile {
    file: BufReader<File>,
    position: u64,
    size: u64,
}

impl RecordFile {
    pub(super) fn new(file: File) -> io::Result<Self> {
        let size = file.metadata()?.len();
        Ok(Self { file: BufReader::new(file), position: 0, size })
    }

    pub(super) fn position(&self) -> u64 {
        self.position
    }

    /// Bytes up to the end of the file.
    pub(super) fn left(&self) -> u64 {
        self.size - self.position
    }

    pub(super) fn is_at_end(&self) -> bool {
        self.left() == 0
    }

    pub(super) fn array<const N: usize>(&mut self) -> Result<[u8; N], Stop> {
        self.holds(N as u64)?;
        let mut bytes = [0; N];
        self.file.read_exact(&mut bytes).map_err(Stop::Io)?;
        self.position += N as u64;
        Ok(bytes)
    }

    pub(super) fn bytes(&mut self, length: u64) -> Result<Vec<u8>, Stop> {
        self.holds(length)?;
        if length > RECORD_BYTES {
            let expected = format!("a record of at most {RECORD_BYTES} bytes");
            return Err(Stop::Damaged(self.error(expected, format!("one of {length} bytes"))));
        }
        // Checked: it fits into memory and is there.
        let mut bytes = vec![0; length as usize];
        self.file.read_exact(&mut bytes).map_err(Stop::Io)?;
        self.position += length;
        Ok(bytes)
    }

    pub(super) fn skip(&mut self, length: u64) -> Result<(), Stop> {
        self.holds(length)?;
        self.file.seek_relative(length.cast_signed()).map_err(Stop::Io)?;
        self.position += length;
        Ok(())
    }

    /// Something that is wrong at this place.
    pub(super) fn error(&self, expected: impl Into<String>, found: impl Into<String>) -> EncodingError {
        EncodingError::new(self.position as usize, expected, found)
    }

    fn holds(&self, length: u64) -> Result<(), Stop> {
        if length <= self.left() {
            return Ok(());
        }
        let found = format!("the end of the file after {}", self.left());
        Err(Stop::Cut(self.error(format!("{length} more bytes"), found)))
    }
}
