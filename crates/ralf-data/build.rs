//! Tells the program which sources its labels come from: a hash that changes when one of them does.
//!
//! In the workspace these are the sources of the method, of the readers and of labelling; in a package from a registry,
//! where the other crates lie elsewhere, its own, for published versions never change.
//!
//! Crates are found by the dependencies in `Cargo.toml`: a new one counts unless [`NOT_DECIDING`] names it.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Folders and files of this crate that labels depend on, relative to it, and the lock of all dependencies. Those that
/// aren't there are passed over.
const SOURCES: [&str; 8] = [
    "src/disk",
    "src/read",
    "src/result",
    "src/run",
    "src/frames",
    "src/frames.rs",
    "src/settings.rs",
    "../../Cargo.lock",
];

/// Crates of the workspace that no label depends on: what people say, the simulator and the tuner.
const NOT_DECIDING: [&str; 3] = ["ralf-corrections", "ralf-sim", "ralf-train"];

fn main() -> io::Result<()> {
    println!("cargo:rerun-if-changed=build.rs");
    let mut crates = BTreeSet::new();
    find_crates(Path::new("."), &mut crates)?;
    let mut sources: Vec<PathBuf> = SOURCES.map(PathBuf::from).to_vec();
    sources.extend(crates.iter().map(|name| Path::new("..").join(name).join("src")));
    let mut files = Vec::new();
    for source in sources {
        if source.exists() {
            println!("cargo:rerun-if-changed={}", source.display());
            gather(&source, &mut files)?;
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
    println!("cargo:rustc-env=RALF_SOURCE_CRATES={}", Vec::from_iter(crates).join(" "));
    Ok(())
}

/// Adds the workspace's crates that the one in `folder` depends on and that may decide labels, and theirs.
fn find_crates(folder: &Path, found: &mut BTreeSet<String>) -> io::Result<()> {
    let manifest = folder.join("Cargo.toml");
    println!("cargo:rerun-if-changed={}", manifest.display());
    let text = fs::read_to_string(manifest)?;
    let after_head = text.split_once("\n[dependencies]\n").map_or("", |(_, after)| after);
    for line in after_head.lines().take_while(|line| !line.starts_with('[')) {
        let name = line.split(['.', ' ', '=']).next().unwrap_or_default();
        let next = Path::new("..").join(name);
        let counts = name.starts_with("ralf") && !NOT_DECIDING.contains(&name) && next.is_dir();
        if counts && found.insert(name.to_owned()) {
            find_crates(&next, found)?;
        }
    }
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
