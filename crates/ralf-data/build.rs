//! Tells the program which sources its labels come from: a hash that changes when one of them does.
//!
//! In the workspace these are the sources of the method, of the readers and of labelling; in a package from a registry,
//! where the other crates lie elsewhere, its own, for published versions never change.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Folders and files that labels depend on, relative to this crate. Those that aren't there are passed over.
const SOURCES: [&str; 10] = [
    "src/disk",
    "src/read",
    "src/result",
    "src/run",
    "src/frames",
    "src/frames.rs",
    "src/settings.rs",
    "../ralf/src",
    "../ralf-ros/src",
    "../../Cargo.lock",
];

fn main() -> io::Result<()> {
    println!("cargo:rerun-if-changed=build.rs");
    let mut files = Vec::new();
    for source in SOURCES.map(Path::new) {
        if source.exists() {
            println!("cargo:rerun-if-changed={}", source.display());
            gather(source, &mut files)?;
        }
    }
    files.sort();
    let mut hash = Fnv::default();
    for file in files {
        let content = fs::read(&file)?;
        hash.add(file.to_string_lossy().replace('\\', "/").as_bytes());
        hash.add(&(content.len() as u64).to_le_bytes());
        hash.add(&content);
    }
    println!("cargo:rustc-env=RALF_SOURCES={:032x}", hash.0);
    Ok(())
}

fn gather(source: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    if !source.is_dir() {
        files.push(source.to_owned());
        return Ok(());
    }
    for entry in fs::read_dir(source)? {
        gather(&entry?.path(), files)?;
    }
    Ok(())
}

/// Fowler, Noll and Vo's hash (1a, 128 bits): it tells sources apart, and needs no crate.
struct Fnv(u128);

impl Default for Fnv {
    fn default() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }
}

impl Fnv {
    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u128::from(*byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
        }
    }
}
