//! A small data set in the genuine layout, made here.

mod reading;
#[allow(dead_code, reason = "whoever labels it wants more of it")]
mod recording;
mod refusals;

use super::*;
use crate::read::SequenceReader;
use crate::read::scene_tables::testing::{Tables, check_empty_scene, check_filenames, check_versions};
use crate::testing;
use recording::{SCENE, TINY, VERSION, write_data_set};
use serde_json::{Value, json};
use std::fs;
use tempfile::TempDir;

struct DataSet(TempDir);

impl Tables for DataSet {
    const VERSION: &'static str = VERSION;
    const SCENE: &'static str = SCENE;

    fn new() -> Self {
        let set = Self(tempfile::tempdir().unwrap());
        write_data_set(set.0.path(), &TINY);
        set
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn open(&self) -> Result<Box<dyn SequenceReader>, DataError> {
        let mut recording = crate::read::open(self.path(), None)?;
        assert_eq!((recording.format, recording.sequences.len()), ("truckscenes", 1));
        Ok(recording.sequences.remove(0))
    }
}

impl DataSet {
    /// A file of a channel.
    fn file(&self, part: &str, channel: &str, n: usize) -> PathBuf {
        let folder = self.0.path().join(part).join(channel);
        let mut files: Vec<PathBuf> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        files.swap_remove(n)
    }
}
