//! Chunks, decompressed. No more memory is taken than what really comes out.

use bzip2::bufread::BzDecoder;
use lz4_flex::frame::FrameDecoder;
use std::io::{self, Read};

/// The largest chunk that is read, decompressed. Recorders write chunks of about 1 MB.
pub(super) const CHUNK_BYTES: u64 = 1 << 30;
/// What zstd writes begins with this.
const ZSTD_MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// How a chunk is compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    Bz2,
    Lz4,
    Zstd,
}

impl Compression {
    /// By the name that bags and MCAP files have for it.
    pub(super) fn named(name: &str) -> Option<Self> {
        match name {
            "" | "none" => Some(Self::None),
            "bz2" => Some(Self::Bz2),
            "lz4" => Some(Self::Lz4),
            "zstd" => Some(Self::Zstd),
            _ => None,
        }
    }

    /// All that comes out, which has to be `size` bytes. The error says what is wrong.
    pub(super) fn decompress(self, stored: Vec<u8>, size: u64) -> Result<Vec<u8>, String> {
        let (bytes, failed) = self.decompress_beginning(stored, size);
        match failed {
            Some(error) => Err(error.to_string()),
            None if bytes.len() as u64 != size => Err(format!("{} bytes", bytes.len())),
            None => Ok(bytes),
        }
    }

    /// What comes out up to the first error, and that error. One byte more than `size` tells that there are too many.
    pub(super) fn decompress_beginning(self, stored: Vec<u8>, size: u64) -> (Vec<u8>, Option<io::Error>) {
        let input = stored.as_slice();
        match self {
            Self::None => (stored, None),
            Self::Bz2 => drain(BzDecoder::new(input), size),
            Self::Lz4 => drain(FrameDecoder::new(input), size),
            Self::Zstd => match zstd::stream::read::Decoder::with_buffer(input) {
                Ok(decoder) => drain(decoder, size),
                Err(error) => (Vec::new(), Some(error)),
            },
        }
    }
}

/// A message of ROS 2 as its recorder got it: some recorders compress each one. No message of theirs begins as what
/// zstd wrote does. The error says what is wrong.
pub(super) fn message(stored: Vec<u8>) -> Result<Vec<u8>, (String, String)> {
    if !stored.starts_with(&ZSTD_MAGIC) {
        return Ok(stored);
    }
    let (bytes, failed) = Compression::Zstd.decompress_beginning(stored, CHUNK_BYTES);
    match failed {
        None if bytes.len() as u64 <= CHUNK_BYTES => Ok(bytes),
        failed => {
            let found = failed.map_or_else(|| "a larger one".to_owned(), |error| error.to_string());
            Err((format!("a message of at most {CHUNK_BYTES} bytes, compressed by zstd"), found))
        }
    }
}

fn drain(decoder: impl Read, size: u64) -> (Vec<u8>, Option<io::Error>) {
    let mut bytes = Vec::new();
    let failed = decoder.take(size.saturating_add(1)).read_to_end(&mut bytes).err();
    (bytes, failed)
}
