//! A small data set in the genuine layout, made here.

mod reading;
#[allow(dead_code, reason = "whoever labels it wants more of it")]
mod recording;
mod refusals;

use super::*;
use crate::read::SequenceReader;
use crate::testing;
use recording::{SCENE, TINY, VERSION, write_data_set};
use serde_json::{Value, json};
use std::fs;
use tempfile::TempDir;

struct DataSet(TempDir);

impl DataSet {
    fn new() -> Self {
        let set = Self(tempfile::tempdir().unwrap());
        write_data_set(set.0.path(), &TINY);
        set
    }

    fn edit(&self, table: &str, change: impl FnOnce(&mut Vec<Value>)) {
        let file = self.0.path().join(VERSION).join(table).with_extension("json");
        let mut rows: Vec<Value> = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
        change(&mut rows);
        testing::write(&file, Value::Array(rows).to_string().as_bytes());
    }

    fn open(&self) -> Result<Box<dyn SequenceReader>, DataError> {
        let mut recording = crate::read::open(self.0.path(), None)?;
        assert_eq!((recording.format, recording.sequences.len()), ("truckscenes", 1));
        Ok(recording.sequences.remove(0))
    }

    /// The error of opening, which must hold all of the words.
    fn refused(&self, words: &[&str]) {
        let error = self.open().map(drop).unwrap_err().to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }

    /// A file of a channel.
    fn file(&self, part: &str, channel: &str, n: usize) -> PathBuf {
        let folder = self.0.path().join(part).join(channel);
        let mut files: Vec<PathBuf> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        files.swap_remove(n)
    }
}
