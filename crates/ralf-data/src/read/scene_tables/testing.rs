//! What the tests of every format of such tables share, and what holds of each of them.

use crate::error::DataError;
use crate::read::{self, SequenceReader};
use crate::testing;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// A small data set of one scene, made for a test.
pub(crate) trait Tables: Sized {
    /// The folder of its tables.
    const VERSION: &'static str;
    /// The scene.
    const SCENE: &'static str;

    /// Writes it.
    fn new() -> Self;

    /// Where it lies.
    fn path(&self) -> &Path;

    /// The scene, opened.
    fn open(&self) -> Result<Box<dyn SequenceReader>, DataError>;

    /// Changes the rows of a table.
    fn edit(&self, table: &str, change: impl FnOnce(&mut Vec<Value>)) {
        let file = self.path().join(Self::VERSION).join(table).with_extension("json");
        let mut rows: Vec<Value> = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
        change(&mut rows);
        testing::write(&file, Value::Array(rows).to_string().as_bytes());
    }

    /// The error of opening, which must hold all of the words.
    fn refused(&self, words: &[&str]) {
        let error = self.open().map(drop).unwrap_err().to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }
}

/// A file that lies elsewhere is never opened.
pub(crate) fn check_filenames<T: Tables>() {
    for name in ["/etc/hostname", "../a.pcd", "samples/../../a.pcd"] {
        let set = T::new();
        set.edit("sample_data", |rows| {
            (rows[0]["token"], rows[0]["filename"]) = (json!("abroad"), json!(name));
        });
        set.refused(&["sample_data.json: line", &format!("{name:?} of the token `abroad`, which leads out")]);
    }
}

/// A scene without measurements costs the others nothing, and is refused alone.
pub(crate) fn check_empty_scene<T: Tables>() {
    let set = T::new();
    set.edit("scene", |rows| {
        let mut other = rows[0].clone();
        (other["token"], other["name"]) = (json!("other"), json!("parked"));
        rows.push(other);
    });
    let words = "scene `parked`: expected at least one measurement with its ego pose, found none";
    testing::check_left_out(set.path(), [T::SCENE, "parked"], words);
    set.edit("scene", |rows| rows.retain(|row| row["token"] == "other"));
    set.edit("sample", Vec::clear);
    set.edit("sample_data", Vec::clear);
    set.refused(&[words]);
}

/// Where several versions lie beside each other, one of them is the recording.
pub(crate) fn check_versions<T: Tables>(other: &str) {
    let set = T::new();
    let text = |path: &Path| {
        let recording = read::open(path, None).unwrap();
        let reader = testing::only(&recording);
        format!("{} {:?} {:?}", recording.format, reader.sequence(), reader.radar_scan(0, 0).unwrap())
    };
    let alone = text(set.path());
    let [version, beside] = [T::VERSION, other].map(|name| set.path().join(name));
    fs::create_dir(&beside).unwrap();
    for entry in fs::read_dir(&version).unwrap() {
        let file = entry.unwrap().path();
        fs::copy(&file, beside.join(file.file_name().unwrap())).unwrap();
    }
    let one = if version < beside { &version } else { &beside };
    let named = format!("or the path of one, such as {}, found", one.display());
    set.refused(&["exactly one version folder", &named, T::VERSION, other]);
    assert_eq!(text(&version), alone);
    assert_eq!(text(&beside), alone);
}
