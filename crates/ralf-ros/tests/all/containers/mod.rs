//! What the writers write is read back; what is cut short is read up to the cut and the loss is said; what is damaged
//! is refused, or told.

mod cuts;
mod damage;
mod databases;

use damage::mcap_with_chunk;
use ralf_ros::container::{Container, ContainerError};
use ralf_ros::message::{Header, Message, RadarReturn, RadarScan, TfMessage};
use ralf_ros::writer::{Compression, Delivery, MessageWriter, WriteError};
use std::io::{Cursor, Seek, Write};
use std::path::{Path, PathBuf};

const FIXTURES: [&str; 7] =
    ["plain.bag", "bz2.bag", "lz4.bag", "plain.mcap", "lz4.mcap", "zstd.mcap", "ros1.mcap"];

fn fixture(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/ros").join(name)).unwrap()
}

fn scan(k: i64) -> RadarScan {
    let header = Header { stamp_ns: k * 1000, frame_id: "radar".to_owned(), ..Header::default() };
    RadarScan { header, returns: vec![RadarReturn { range: k as f32, ..RadarReturn::default() }; 3] }
}

/// Two topics, `count` messages of the one, one of the other.
fn write<W: Write + Seek>(mut writer: MessageWriter<W>, count: i64) -> Result<W, WriteError> {
    let scans = writer.topic::<RadarScan>("/radar", Delivery::Live)?;
    let frames = writer.topic::<TfMessage>("/tf_static", Delivery::Latched)?;
    writer.write(&frames, 1, &TfMessage::default())?;
    (0..count).try_for_each(|k| writer.write(&scans, k * 1000 + 5, &scan(k)))?;
    writer.finish()
}

fn own_files(count: i64) -> [Vec<u8>; 3] {
    let file = || Cursor::new(Vec::new());
    [
        write(MessageWriter::bag(file()).unwrap(), count),
        write(MessageWriter::mcap(file(), Compression::None).unwrap(), count),
        write(MessageWriter::mcap(file(), Compression::Zstd).unwrap(), count),
    ]
    .map(|written| written.unwrap().into_inner())
}

/// A place for one file at a time.
struct Place {
    file: PathBuf,
    /// Removed with it.
    _folder: tempfile::TempDir,
}

impl Place {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("recording");
        Self { file, _folder: folder }
    }

    fn open(&self, bytes: &[u8]) -> Result<Container, ContainerError> {
        std::fs::write(&self.file, bytes).unwrap();
        Container::open(&self.file)
    }
}

#[test]
fn what_is_written_is_read_back() {
    let place = Place::new();
    // Enough for several chunks.
    for bytes in own_files(20_000) {
        let container = place.open(&bytes).unwrap();
        assert_eq!(container.losses(), []);
        let topics: Vec<_> =
            container.topics().iter().map(|topic| (topic.name.as_str(), topic.count)).collect();
        assert_eq!(topics, [("/radar", 20_000), ("/tf_static", 1)]);
        let encoding = container.topics()[0].known_encoding().unwrap();
        let scans = container.messages().iter().filter(|message| container.topic_of(message) == 0);
        for (k, message) in (0..).zip(scans) {
            assert_eq!(message.log_ns, k * 1000 + 5);
            let read = RadarScan::from_bytes(encoding, &container.read(message).unwrap()).unwrap();
            assert_eq!(read.returns, scan(k).returns);
        }
    }
}

/// As `ros2 bag record --compression-mode message` writes them.
#[test]
fn messages_that_are_compressed_one_by_one_are_read() {
    let place = Place::new();
    let [_, plain, _] = own_files(3);
    let original = place.open(&plain).unwrap();
    let written = |stored: &dyn Fn(Vec<u8>) -> Vec<u8>| {
        let mut to = MessageWriter::mcap(Cursor::new(Vec::new()), Compression::None).unwrap();
        let topic = to.raw_topic(&original.channels()[0]).unwrap();
        for message in original.messages().iter().filter(|message| original.topic_of(message) == 0) {
            to.write_raw(&topic, message.log_ns, &stored(original.read(message).unwrap())).unwrap();
        }
        to.finish().unwrap().into_inner()
    };
    let zipped = |bytes: Vec<u8>| zstd::bulk::compress(&bytes, 1).unwrap();
    let place = Place::new();
    let container = place.open(&written(&zipped)).unwrap();
    for (k, message) in (0..).zip(container.messages()) {
        let bytes = container.read(message).unwrap();
        let encoding = container.topics()[0].known_encoding().unwrap();
        assert_eq!(RadarScan::from_bytes(encoding, &bytes).unwrap().returns, scan(k).returns);
    }
    assert_eq!(container.messages().len(), 3);
    let cut = |bytes: Vec<u8>| {
        let mut zipped = zipped(bytes);
        zipped.truncate(zipped.len() - 4);
        zipped
    };
    let container = place.open(&written(&cut)).unwrap();
    let error = container.read(&container.messages()[0]).unwrap_err().to_string();
    assert!(error.contains("message of /radar at 5 ns: expected a message of at most"), "{error}");
}

#[test]
fn the_same_messages_give_the_same_bytes() {
    assert_eq!(own_files(50), own_files(50));
}

#[test]
fn what_cannot_be_read_is_refused_with_its_name() {
    let place = Place::new();
    let error = |bytes: &[u8]| place.open(bytes).unwrap_err().to_string();
    assert!(error(b"RIFF").contains("expected a ROS 1 bag 2.0, an MCAP file or an SQLite file"));
    assert!(error(&mcap_with_chunk(1, "snappy", &[0])).contains("none, lz4 or zstd, found `snappy`"));
    let bag = fixture("plain.bag");
    let at = bag.windows(16).position(|window| window == b"compression=none").unwrap();
    let mut other = bag.clone();
    other[at + 12..at + 16].copy_from_slice(b"zlib");
    assert!(error(&other).contains("none, bz2 or lz4, found `zlib`"));
    assert!(matches!(Container::open(Path::new("nowhere")).unwrap_err(), ContainerError::Io { .. }));
}

#[test]
fn names_that_are_not_utf8_are_told() {
    let place = Place::new();
    for (bytes, name) in [(fixture("plain.bag"), "topic=/odom"), (fixture("plain.mcap"), "/odom")] {
        let mut bytes = bytes;
        let mut from = 0;
        while let Some(at) = bytes[from..].windows(name.len()).position(|window| window == name.as_bytes()) {
            from += at + name.len();
            bytes[from - 1] = 0xff;
        }
        match place.open(&bytes) {
            Ok(container) => assert!(!container.losses().is_empty() || container.topics().len() < 9),
            Err(error) => assert!(error.to_string().contains("UTF-8"), "{error}"),
        }
    }
}
