//! Damaged bytes give errors and never a panic: files and messages of others, changed at random.
//!
//! The same seed gives the same changes. `RALF_FUZZ_SECONDS` says how long each test goes on; 1 s without it.

use ralf_ros::container::Container;
use ralf_ros::encoding::Encoding;
use ralf_ros::message::*;
use ralf_ros::point_cloud::PointTable;
use ralf_ros::tf::{Kind, TfTree};
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const FILES: [&str; 8] =
    ["plain.bag", "bz2.bag", "lz4.bag", "plain.mcap", "lz4.mcap", "zstd.mcap", "ros1.mcap", "db3/db3.db3"];

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/ros").join(name)
}

/// Calls `check` with a generator until the time is over.
fn fuzz(mut check: impl FnMut(&mut Pcg64Mcg)) {
    let seconds = std::env::var("RALF_FUZZ_SECONDS").ok().and_then(|text| text.parse().ok()).unwrap_or(1);
    let end = Instant::now() + Duration::from_secs(seconds);
    let mut random = Pcg64Mcg::seed_from_u64(7);
    while Instant::now() < end {
        check(&mut random);
    }
}

/// Some bytes changed, put in, taken away or cut off; lengths are what readers trust, so some become huge.
fn damage(bytes: &mut Vec<u8>, random: &mut impl Rng) {
    for _ in 0..random.random_range(1..6) {
        let at = random.random_range(0..bytes.len().max(1)).min(bytes.len().saturating_sub(1));
        match random.random_range(0..7) {
            _ if bytes.is_empty() => return,
            0 => bytes[at] ^= 1 << random.random_range(0..8),
            1 => bytes[at] = random.random(),
            2 => bytes.truncate(at),
            3 => bytes.insert(at, random.random()),
            4 => drop(bytes.remove(at)),
            5 => bytes.iter_mut().skip(at).take(4).for_each(|byte| *byte = 0xff),
            _ => bytes.iter_mut().skip(at).take(8).for_each(|byte| *byte = 0),
        }
    }
}

fn decode(encoding: Encoding, bytes: &[u8]) {
    // What is checked is that these return.
    let _ = CameraInfo::from_bytes(encoding, bytes);
    let _ = CompressedImage::from_bytes(encoding, bytes);
    let _ = Image::from_bytes(encoding, bytes);
    let _ = Imu::from_bytes(encoding, bytes);
    let _ = Odometry::from_bytes(encoding, bytes);
    let _ = RadarScan::from_bytes(encoding, bytes);
    let _ = TwistStamped::from_bytes(encoding, bytes);
    if let Ok(cloud) = PointCloud2::from_bytes(encoding, bytes)
        && let Ok(table) = PointTable::new(&cloud)
    {
        table
            .names()
            .for_each(|name| assert_eq!(table.column(name).map(|column| column.len()), Some(table.len())));
    }
    if let Ok(message) = TfMessage::from_bytes(encoding, bytes) {
        let mut tree = TfTree::default();
        message.transforms.iter().for_each(|transform| drop(tree.add(transform, Kind::Moving)));
        let frames = tree.frames();
        for pair in frames.windows(2) {
            let _ = tree.lookup(pair[0], pair[1], 0);
        }
    }
}

#[test]
fn damaged_messages() {
    let mut corpus = Vec::new();
    for name in ["plain.bag", "plain.mcap"] {
        let container = Container::open(&fixture(name)).unwrap();
        corpus.extend(container.messages().iter().map(|message| container.read(message).unwrap()));
    }
    fuzz(|random| {
        let mut bytes = corpus[random.random_range(0..corpus.len())].clone();
        damage(&mut bytes, random);
        [Encoding::Ros1, Encoding::Cdr].into_iter().for_each(|encoding| decode(encoding, &bytes));
    });
}

#[test]
fn damaged_files() {
    let corpus = FILES.map(|name| std::fs::read(fixture(name)).unwrap());
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("recording");
    fuzz(|random| {
        let mut bytes = corpus[random.random_range(0..corpus.len())].clone();
        damage(&mut bytes, random);
        std::fs::write(&file, bytes).unwrap();
        if let Ok(container) = Container::open(&file) {
            container.messages().iter().for_each(|message| drop(container.read(message)));
        }
    });
}
