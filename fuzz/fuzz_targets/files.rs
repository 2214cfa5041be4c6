//! Any file of any place, with any content: the first byte says which verb, the second which file.

#![no_main]

use libfuzzer_sys::fuzz_target;
use ralf_fuzz::{Case, make_places};
use std::sync::LazyLock;
use tempfile::TempDir;

static FOLDER: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    make_places(&folder.path().join("places"));
    folder
});

fuzz_target!(|data: &[u8]| {
    let [verb, file, content @ ..] = data else { return };
    let case = Case::chosen(*verb, *file, &FOLDER.path().join("places"), &FOLDER.path().join("scratch"));
    assert!(case.run_with(content), "it panicked");
});
