//! A file whose messages lie in chunks: what bags and MCAP files have in common.

use super::catalogue::{Catalogue, MessageRef, Place};
use super::chunks::Chunks;
use super::error::{ContainerError, Stop};
use super::loss::Loss;
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

    /// Where the index at the end of a file begins: all messages lie before it. `None` of a file that lacks it, for the
    /// recorder was killed or the file is cut.
    fn index(&self, file: &mut RecordFile) -> Result<Option<u64>, Stop>;

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
        losses: &mut Vec<Loss>,
    ) -> Result<(Self, Catalogue), ContainerError> {
        let mut catalogue = Catalogue::default();
        let open = || ralf_files::open(path, Kind::Stream).map_err(ContainerError::io(path));
        let mut records = RecordFile::new(open()?).map_err(ContainerError::io(path))?;
        match format.walk(&mut records, &mut catalogue) {
            Ok(()) => {}
            Err(Stop::Io(error)) => return Err(ContainerError::Io { file: path.to_owned(), error }),
            Err(Stop::Refused(error)) => return Err(ContainerError::inside(path, format.name(), error)),
            Err(stop @ (Stop::Cut(_) | Stop::Damaged(_))) => {
                let mut again = RecordFile::new(open()?).map_err(ContainerError::io(path))?;
                losses.push(unread_end(path, &stop, &records, format.index(&mut again).ok().flatten()));
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

    /// Looks into a chunk. One that can't be read is a loss, unless the system is to blame. Nothing lies behind a cut.
    fn scan(
        &self,
        chunk: usize,
        messages: bool,
        catalogue: &mut Catalogue,
        losses: &mut Vec<Loss>,
    ) -> Result<(), ContainerError> {
        let hides_messages = messages && !self.chunks.is_cut(chunk);
        let mut lose = |error: ContainerError| {
            losses.push(Loss { sentence: error.to_string(), hides_messages });
        };
        let bytes = match self.chunks.chunk(chunk) {
            Ok(bytes) => bytes,
            Err(error @ ContainerError::Io { .. }) => return Err(error),
            Err(error) => {
                lose(error);
                return Ok(());
            }
        };
        if let Err(error) = self.format.scan(&bytes, chunk as u32, messages, catalogue) {
            let (path, part) = (self.chunks.path(), self.chunks.describe(chunk));
            lose(ContainerError::inside(path, &part, error));
        }
        Ok(())
    }
}

/// What is said of a file that can be read no further than this. Before its index there may be messages, and where it
/// has none behind damage, but not behind a cut.
fn unread_end(path: &Path, stop: &Stop, records: &RecordFile, index: Option<u64>) -> Loss {
    let is_damaged = matches!(stop, Stop::Damaged(_));
    let end = index.unwrap_or(if is_damaged { records.position() + records.left() } else { 0 });
    let (path, unread) = (path.display(), end.saturating_sub(records.position()));
    if unread > 0 {
        return Loss::hiding(format!(
            "{path}: damaged, and {unread} bytes from there on are not read: {stop}"
        ));
    }
    let sentence = format!("{path}: cut short or damaged, read up to there: {stop}");
    Loss { sentence, hides_messages: false }
}
