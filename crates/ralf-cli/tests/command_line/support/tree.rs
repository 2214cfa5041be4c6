//! All that lies in a folder, to be compared.

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Names relative to the folder, with the content of files; folders have none.
pub(crate) type Tree = BTreeMap<String, Option<Vec<u8>>>;

/// All that lies in a folder.
pub(crate) fn tree(folder: impl AsRef<Path>) -> Tree {
    let mut found = Tree::new();
    add(folder.as_ref(), "", &mut found);
    found
}

/// The results of a run without the one part that differs from run to run: the timings in `run.json`.
pub(crate) fn without_timings(out: impl AsRef<Path>) -> Tree {
    let mut found = tree(out);
    let mut record: Value = serde_json::from_slice(found["run.json"].as_ref().unwrap()).unwrap();
    assert!(record.as_object_mut().unwrap().remove("timings").is_some());
    found.insert("run.json".to_owned(), Some(record.to_string().into_bytes()));
    found
}

/// Writes all of it into a folder.
pub(crate) fn put(files: &Tree, folder: impl AsRef<Path>) {
    for (name, content) in files {
        let path = folder.as_ref().join(name);
        match content {
            Some(bytes) => {
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(path, bytes).unwrap();
            }
            None => fs::create_dir_all(path).unwrap(),
        }
    }
}

fn add(folder: &Path, prefix: &str, found: &mut Tree) {
    for entry in fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = format!("{prefix}{}", entry.file_name().to_str().unwrap());
        if entry.path().is_dir() {
            add(&entry.path(), &format!("{name}/"), found);
            found.insert(name, None);
        } else {
            found.insert(name, Some(fs::read(entry.path()).unwrap()));
        }
    }
}
