//! HDF5 files whose data sets are tables: a row is a record of named fields (HDF5 calls that a compound).

mod table;
#[cfg(test)]
pub(crate) mod writing;

use crate::disk::guarded::guarded;
use crate::disk::lzf;
use crate::error::DataError;
use hdf5_reader::error::Error;
use hdf5_reader::{FilterRegistry, OpenOptions};
use ralf_files::Kind;
use std::path::{Path, PathBuf};
pub(crate) use table::Table;

/// The number of LZF, the compression that h5py has of its own, among HDF5's registered filters.
const LZF: u16 = 32_000;
/// Nobody's tables are compressed better than this; a damaged file claims any size.
const MOST_TIMES_THE_FILE: usize = 64;
/// What a small file may hold all the same, bytes.
const ALWAYS: usize = 64 << 20;
/// The most of a data set's own description, bytes.
const LARGEST_HEADER: usize = 1 << 20;

/// A file, in memory.
pub(crate) struct Hdf5File {
    path: PathBuf,
    inner: hdf5_reader::Hdf5File,
}

impl Hdf5File {
    /// Reads a file. Nothing of its data sets is decompressed yet.
    pub(crate) fn open(path: &Path) -> Result<Self, DataError> {
        Self::of_bytes(path, ralf_files::read(path, Kind::Table).map_err(DataError::io(path))?)
    }

    /// The same of a file's bytes.
    fn of_bytes(path: &Path, bytes: Vec<u8>) -> Result<Self, DataError> {
        let most = bytes.len().saturating_mul(MOST_TIMES_THE_FILE).max(ALWAYS);
        let options = OpenOptions::default()
            .with_filter_registry(filters(most))
            .with_chunk_cache_bytes(0)
            .with_max_chunk_bytes(most)
            .with_max_read_bytes(most)
            .with_max_object_header_bytes(LARGEST_HEADER);
        let opened = guarded(path, "content", "an HDF5 file", || {
            hdf5_reader::Hdf5File::from_vec_with_options(bytes, options)
        });
        Ok(Self { path: path.to_owned(), inner: opened? })
    }

    /// A table, decompressed.
    pub(crate) fn table(&self, name: &str) -> Result<Table, DataError> {
        let dataset = guarded(&self.path, name, "a table", || self.inner.dataset(name))?;
        Table::read(&self.path, name, dataset)
    }
}

/// The library's filters and LZF, which gives at most so many bytes.
fn filters(most: usize) -> FilterRegistry {
    let mut filters = FilterRegistry::new();
    let no_lzf = || Error::InvalidData("no LZF, or too much of it".into());
    let lzf = move |_: &_, packed: &[u8], _| lzf::at_most(packed, most).ok_or_else(no_lzf);
    filters.register(LZF, Box::new(lzf));
    filters
}

#[cfg(test)]
mod tests;
