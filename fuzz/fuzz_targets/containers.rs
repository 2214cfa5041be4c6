//! Bags, MCAP files and SQLite files.

#![no_main]

use libfuzzer_sys::fuzz_target;
use ralf_ros::container::Container;
use std::sync::LazyLock;
use tempfile::TempDir;

static FOLDER: LazyLock<TempDir> = LazyLock::new(|| tempfile::tempdir().unwrap());

fuzz_target!(|data: &[u8]| {
    let file = FOLDER.path().join("recording");
    std::fs::write(&file, data).unwrap();
    if let Ok(container) = Container::open(&file) {
        container.messages().iter().for_each(|message| drop(container.read(message)));
    }
});
