//! A file whose messages lie in chunks: what bags and MCAP files have in common.

use super::catalogue::{Catalogue, MessageRef, Place};
use super::chunks::Chunks;
use super::error::{ContainerError, Stop};
use super::records::RecordFile;
use crate::encoding::EncodingError;
use ralf_files::Kind;
use std::fmt::Debug;
use std::path::Path;

/// What bags and MCAP files don't have in common.
pub(super) trait Format: Debug + Send + Sync {
    /// For people.
    fn name(&self) -> &'static str;

    /// Whether a file with this beginning is of this format.
    fn begins(&self, bytes: &[u8]) -> bool;

    /// Walks over the whole file, chunks unread.
    fn walk(&self, file: &mut RecordFile, catalogue: &mut Catalogue) -> Result<(), Stop>;

    /// Channels, and messages if they are wanted, of a chunk; what comes before an error counts.
    fn scan(
        &self,
        chunk: &[u8],
        number: u32,
        messages: bool,
        catalogue: &mut Catalogue,
    ) -> Result<(), EncodingError>;

    /// The message that begins here.
    fn message<'a>(&self, bytes: &'a [u8]) -> Result<&'a [u8], EncodingError>;
}

/// A bag or an MCAP file.
#[derive(Debug)]
pub(super) struct ChunkedFile {
    format: &'static dyn Format,
    chunks: Chunks,
}

impl ChunkedFile {
    /// Reads what the file holds, and says what is lost.
    pub(super) fn open(
        path: &Path,
        format: &'static dyn Format,
        losses: &mut Vec<String>,
    ) -> Result<(Self, Catalogue), ContainerError> {
        let mut catalogue = Catalogue::default();
        let open = || ralf_files::open(path, Kind::Stream).map_err(ContainerError::io(path));
        let mut records = RecordFile::new(open()?).map_err(ContainerError::io(path))?;
        match format.walk(&mut records, &mut catalogue) {
            Ok(()) => {}
            Err(Stop::Io(error)) => return Err(ContainerError::Io { file: path.to_owned(), error }),
            Err(Stop::Refused(error)) => return Err(ContainerError::inside(path, format.name(), error)),
            Err(Stop::Damaged(error)) => {
                losses.push(format!("{}: cut short or damaged, read up to there: {error}", path.display()));
                catalogue.forget_last_index();
            }
        }
        let chunks = Chunks::new(path.to_owned(), open()?, catalogue.chunks.clone());
        let file = Self { format, chunks };
        for chunk in catalogue.without_index() {
            file.scan(chunk, true, &mut catalogue, losses)?;
        }
        let in_use = catalogue.channels_in_use();
        for chunk in 0..file.chunks.len() {
            if in_use.iter().all(|channel| catalogue.channels.contains_key(channel)) {
                break;
            }
            file.scan(chunk, false, &mut catalogue, losses)?;
        }
        Ok((file, catalogue))
    }

    /// The bytes of a message.
    pub(super) fn read(&self, message: &MessageRef) -> Result<Vec<u8>, ContainerError> {
        let path = self.chunks.path();
        let message_at = |bytes: &[u8], part: &str| {
            let found = self.format.message(bytes).map(<[u8]>::to_owned);
            found.map_err(|error| ContainerError::inside(path, part, error))
        };
        match Place::from_message(message) {
            Place::Chunk(chunk, offset) => {
                let bytes = self.chunks.chunk(chunk as usize)?;
                let part = format!("{}, message at byte {offset}", self.chunks.describe(chunk as usize));
                message_at(bytes.get(offset as usize..).unwrap_or_default(), &part)
            }
            Place::File(position) => {
                let head = self.chunks.bytes(position, 9)?;
                let length =
                    head.iter().skip(1).rev().fold(0u64, |length, byte| (length << 8) | u64::from(*byte));
                let bytes = self.chunks.bytes(position, length.saturating_add(9))?;
                message_at(&bytes, &format!("message at byte {position}"))
            }
        }
    }

    /// Looks into a chunk. One that can't be read is a loss, unless the system is to blame.
    fn scan(
        &self,
        chunk: usize,
        messages: bool,
        catalogue: &mut Catalogue,
        losses: &mut Vec<String>,
    ) -> Result<(), ContainerError> {
        let bytes = match self.chunks.chunk(chunk) {
            Ok(bytes) => bytes,
            Err(error @ ContainerError::Io { .. }) => return Err(error),
            Err(error) => {
                losses.push(error.to_string());
                return Ok(());
            }
        };
        if let Err(error) = self.format.scan(&bytes, chunk as u32, messages, catalogue) {
            let (path, part) = (self.chunks.path(), self.chunks.describe(chunk));
            losses.push(ContainerError::inside(path, &part, error).to_string());
        }
        Ok(())
    }
}
