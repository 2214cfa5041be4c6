//! What the writers write is read back; what is cut short is read up to the cut and the loss is said; what is damaged
//! is refused, or told.

use ralf_ros::container::{Container, ContainerError};
use ralf_ros::message::{Header, Message, RadarReturn, RadarScan, TfMessage};
use ralf_ros::writer::{Compression, Delivery, MessageWriter, WriteError};
use std::collections::BTreeMap;
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

/// Every message that can be read, by topic and log time.
type Found = BTreeMap<(String, i64), Vec<u8>>;

fn found(container: &Container) -> Found {
    let read = |message| {
        let bytes = container.read(message).ok()?;
        Some(((container.topics()[message.topic()].name.clone(), message.log_ns), bytes))
    };
    container.messages().iter().filter_map(read).collect()
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
        let scans = container.messages().iter().filter(|message| message.topic() == 0);
        for (k, message) in (0..).zip(scans) {
            assert_eq!(message.log_ns, k * 1000 + 5);
            let read = RadarScan::from_bytes(encoding, &container.read(message).unwrap()).unwrap();
            assert_eq!(read.returns, scan(k).returns);
        }
    }
}

#[test]
fn the_same_messages_give_the_same_bytes() {
    assert_eq!(own_files(50), own_files(50));
}

/// How many messages are found in the file, cut to each of these lengths. Whatever the cut, nothing is invented, a
/// longer file tells no less, and the loss is said.
fn check_cuts(place: &Place, bytes: &[u8], lengths: impl DoubleEndedIterator<Item = usize>) -> Vec<usize> {
    let whole = found(&place.open(bytes).unwrap());
    let file = std::fs::File::options().write(true).open(&place.file).unwrap();
    let mut counts = Vec::new();
    for length in lengths.rev() {
        file.set_len(length as u64).unwrap();
        let Ok(container) = Container::open(&place.file) else {
            counts.push(0);
            continue;
        };
        assert!(!container.losses().is_empty(), "cut to {length} of {} bytes", bytes.len());
        let found = found(&container);
        for (key, bytes) in &found {
            assert_eq!(whole.get(key), Some(bytes), "cut to {length}: {key:?}");
        }
        counts.push(found.len());
    }
    assert!(counts.windows(2).all(|pair| pair[0] >= pair[1]), "{counts:?}");
    assert_eq!(counts.first(), Some(&whole.len()), "what follows the last message is the index");
    counts
}

#[test]
fn files_cut_at_every_byte_are_read_up_to_the_cut() {
    let place = Place::new();
    for bytes in own_files(3) {
        check_cuts(&place, &bytes, 0..bytes.len());
    }
}

#[test]
fn files_of_others_that_are_cut_are_read_up_to_the_cut() {
    let place = Place::new();
    for name in FIXTURES {
        let bytes = fixture(name);
        let counts = check_cuts(&place, &bytes, (0..bytes.len()).step_by(37));
        // A block of bz2 or lz4 comes out as a whole or not at all, and in these bags it is the only chunk.
        let partly = counts.iter().any(|count| (1..11).contains(count));
        assert_eq!(partly, !["bz2.bag", "lz4.bag"].contains(&name), "{name}: {counts:?}");
    }
}

/// A type is described once: where the second of its topics begins, many chunks later, only its number stands.
#[test]
fn types_are_known_in_files_without_their_end() {
    let mut writer = MessageWriter::mcap(Cursor::new(Vec::new()), Compression::None).unwrap();
    let first = writer.topic::<RadarScan>("/first", Delivery::Live).unwrap();
    (0..20_000).for_each(|k| writer.write(&first, k, &scan(k)).unwrap());
    let second = writer.topic::<RadarScan>("/second", Delivery::Live).unwrap();
    (0..5_000).for_each(|k| writer.write(&second, k, &scan(k)).unwrap());
    let bytes = writer.finish().unwrap().into_inner();
    // The last chunk begins in what is left; the second topic begins in the one before it.
    let container = Place::new().open(&bytes[..bytes.len() * 9 / 10]).unwrap();
    let topics: Vec<_> =
        container.topics().iter().map(|topic| (topic.name.as_str(), topic.type_name.as_str())).collect();
    assert_eq!(topics, [("/first", "radar_msgs/msg/RadarScan"), ("/second", "radar_msgs/msg/RadarScan")]);
    assert_eq!(container.topics()[0].count, 20_000);
    assert!(container.topics()[1].count > 0);
}

#[test]
fn a_database_that_is_cut_is_refused_or_told() {
    let bytes = fixture("db3/db3.db3");
    let place = Place::new();
    let whole = found(&place.open(&bytes).unwrap());
    assert_eq!(whole.len(), 11);
    for length in (0..bytes.len()).step_by(1024) {
        if let Ok(container) = place.open(&bytes[..length]) {
            let found = found(&container);
            assert!(
                found.len() == 11
                    || !container.losses().is_empty()
                    || found.len() < container.messages().len()
            );
            assert!(found.iter().all(|(key, bytes)| whole.get(key) == Some(bytes)), "cut to {length}");
        }
    }
}

/// What its recorder left where it was killed: the database, the log of changes and that log's index.
fn killed_recorder(folder: &Path) -> PathBuf {
    let [written, left] = ["written.db3", "left.db3"].map(|name| folder.join(name));
    std::fs::write(&written, fixture("db3/db3.db3")).unwrap();
    let on = rusqlite::Connection::open(&written).unwrap();
    on.pragma_update(None, "journal_mode", "WAL").unwrap();
    on.execute_batch(
        "INSERT INTO messages (topic_id, timestamp, data) SELECT topic_id, 5, data FROM messages LIMIT 3",
    )
    .unwrap();
    for ending in ["", "-wal", "-shm"] {
        let [from, to] = [&written, &left].map(|file| format!("{}{ending}", file.display()));
        std::fs::copy(from, to).unwrap();
    }
    drop(on);
    std::fs::remove_file(written).unwrap();
    left
}

/// The files of a folder, and what is in them.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let all = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    all.map(|file| (file.clone(), std::fs::read(file).unwrap())).collect()
}

#[test]
fn what_a_killed_recorder_left_is_read_with_its_log_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let file = killed_recorder(folder.path());
    let before = files(folder.path());
    assert_eq!(before.len(), 3);
    assert_eq!(Container::open(&file).unwrap().messages().len(), 14);
    assert!(files(folder.path()) == before);
    let [log, index] = ["-wal", "-shm"].map(|ending| format!("{}{ending}", file.display()));
    std::fs::remove_file(index).unwrap();
    let before = files(folder.path());
    let error = Container::open(&file).unwrap_err().to_string();
    assert!(
        error.contains("-wal") && error.contains("sqlite3 '") && error.contains("FROM messages'"),
        "{error}"
    );
    assert!(files(folder.path()) == before);
    // Written back, and in the same mode.
    let on = rusqlite::Connection::open(&file).unwrap();
    assert_eq!(on.query_row("SELECT count(*) FROM messages", [], |row| row.get(0)), Ok(14));
    drop(on);
    assert!(!Path::new(&log).exists());
    let before = files(folder.path());
    assert_eq!(Container::open(&file).unwrap().messages().len(), 14);
    assert!(files(folder.path()) == before && before.len() == 1);
}

#[test]
fn a_change_that_was_never_ended_is_not_taken_for_a_recording() {
    let folder = tempfile::tempdir().unwrap();
    let [written, left] = ["written.db3", "left.db3"].map(|name| folder.path().join(name));
    std::fs::write(&written, fixture("db3/db3.db3")).unwrap();
    let on = rusqlite::Connection::open(&written).unwrap();
    on.execute_batch("PRAGMA cache_size = 1; BEGIN; UPDATE messages SET data = zeroblob(100000)").unwrap();
    for ending in ["", "-journal"] {
        let [from, to] = [&written, &left].map(|file| format!("{}{ending}", file.display()));
        std::fs::copy(from, to).unwrap();
    }
    let error = Container::open(&left).unwrap_err().to_string();
    assert!(error.contains("-journal") && error.contains("sqlite3 '"), "{error}");
}

#[test]
fn a_view_in_the_place_of_a_table_is_refused() {
    let place = Place::new();
    for (table, columns) in [
        ("topics", "1 id, 2 name, 3 type, 4 serialization_format"),
        ("messages", "1 id, 1 topic_id, 2 timestamp"),
    ] {
        std::fs::write(&place.file, fixture("db3/db3.db3")).unwrap();
        let on = rusqlite::Connection::open(&place.file).unwrap();
        let view = format!("DROP TABLE {table}; CREATE VIEW {table} AS SELECT {columns} FROM sqlite_master");
        on.execute_batch(&view).unwrap();
        drop(on);
        let error = Container::open(&place.file).unwrap_err().to_string();
        assert!(error.contains(&format!("table `{table}`")) && error.contains("view"), "{error}");
    }
}

#[cfg(unix)]
#[test]
fn a_pipe_in_the_place_of_a_log_is_named() {
    let place = Place::new();
    let log = format!("{}-wal", place.file.display());
    assert!(std::process::Command::new("mkfifo").arg(&log).status().unwrap().success());
    let error = place.open(&fixture("db3/db3.db3")).unwrap_err().to_string();
    assert!(error.contains("recording-wal, found a named pipe"), "{error}");
}

#[test]
fn a_wrong_checksum_is_told() {
    let place = Place::new();
    let [_, mut bytes, _] = own_files(3);
    let needle = 2.0f32.to_le_bytes();
    let at = bytes.windows(4).position(|window| window == needle).unwrap();
    bytes[at] ^= 1;
    let container = place.open(&bytes).unwrap();
    let error = container.read(&container.messages()[0]).unwrap_err().to_string();
    assert!(error.contains("chunk 0 (at byte") && error.contains("expected the checksum 0x"), "{error}");
}

/// A chunk of an MCAP file that says what it likes of itself.
fn mcap_with_chunk(size: u64, compression: &str, stored: &[u8]) -> Vec<u8> {
    let mut chunk = [0u8; 16].to_vec();
    chunk.extend(size.to_le_bytes());
    chunk.extend(0u32.to_le_bytes());
    chunk.extend((compression.len() as u32).to_le_bytes());
    chunk.extend(compression.as_bytes());
    chunk.extend((stored.len() as u64).to_le_bytes());
    chunk.extend(stored);
    let mut file = b"\x89MCAP0\r\n\x06".to_vec();
    file.extend((chunk.len() as u64).to_le_bytes());
    file.extend(chunk);
    file
}

/// How many messages are there and can't be read.
fn unreadable(container: &Container) -> usize {
    container.messages().iter().filter(|message| container.read(message).is_err()).count()
}

#[test]
fn nothing_lies_behind_a_cut() {
    let place = Place::new();
    let [bag, mcap, _] = own_files(3);
    for bytes in [bag, mcap] {
        let at = bytes.windows(4).position(|window| window == 2.0f32.to_le_bytes()).unwrap();
        let container = place.open(&bytes[..at]).unwrap();
        assert_eq!((container.messages().len(), unreadable(&container)), (3, 0));
        assert!(container.losses().iter().all(|loss| !loss.hides_messages), "{:?}", container.losses());
    }
}

/// A recorder that was killed wrote no index: damage before that is damage still.
#[test]
fn damage_in_a_file_without_its_end_may_hide_messages() {
    let [mut bag, ..] = own_files(20_000);
    let at = bag.windows(9).position(|window| window == b"index_pos").unwrap();
    bag[at + 10..at + 18].fill(0);
    let at = index_in_the_midst(&bag);
    bag[at..at + 400].fill(0);
    let container = Place::new().open(&bag).unwrap();
    assert!(container.losses().iter().any(|loss| loss.hides_messages), "{:?}", container.losses());
}

#[test]
fn damage_that_an_index_tells_of_hides_no_message() {
    let place = Place::new();
    let [_, mcap, _] = own_files(3);
    let needle = 2.0f32.to_le_bytes();
    let at = mcap.windows(4).position(|window| window == needle).unwrap();
    let mut damaged = mcap;
    damaged[at] ^= 1;
    let container = place.open(&damaged).unwrap();
    assert_eq!((container.losses(), container.messages().len(), unreadable(&container)), (&[][..], 4, 4));
}

#[test]
fn damage_that_nothing_tells_of_may_hide_messages() {
    let place = Place::new();
    let hides = |bytes: &[u8], place_of: &str| {
        let container = place.open(bytes).unwrap();
        let hidden: Vec<_> = container.losses().iter().filter(|loss| loss.hides_messages).collect();
        assert!(hidden.len() == 1 && hidden[0].sentence.contains(place_of), "{:?}", container.losses());
    };
    // A chunk without an index whose bytes have another checksum than the chunk tells.
    let mut chunk = mcap_with_chunk(4, "", &[0; 4]);
    chunk[41] = 1;
    hides(&chunk, "chunk 0 (at byte 57): expected the checksum 0x00000001");
    // Zeros in the place of an index, in a file that goes on after them.
    let [bag, mcap, _] = own_files(20_000);
    for mut bytes in [bag, mcap] {
        let at = index_in_the_midst(&bytes);
        bytes[at..at + 400].fill(0);
        hides(&bytes, " bytes from there on are not read: byte ");
    }
}

/// Where an index of a chunk begins, behind the middle of a file.
fn index_in_the_midst(file: &[u8]) -> usize {
    let is_index = |at: &usize| {
        let at = *at;
        let number = |from: usize, bytes: usize| {
            file[from..from + bytes].iter().rev().fold(0, |n, b| n << 8 | u64::from(*b))
        };
        // An MCAP file: the record's kind and length, the channel, the length of the entries.
        let mcap = file[at] == 7 && number(at + 11, 4) > 0 && number(at + 1, 8) == 6 + number(at + 11, 4);
        mcap || file[at..].starts_with(b"op=\x04")
    };
    (file.len() / 2..file.len() - 15).find(is_index).unwrap()
}

#[test]
fn bombs_are_refused_before_anything_is_allocated() {
    let place = Place::new();
    let losses = |bytes: &[u8]| {
        let container = place.open(bytes).unwrap();
        container.losses().iter().map(|loss| loss.sentence.as_str()).collect::<Vec<_>>().join("\n")
    };
    // A chunk that claims a terabyte.
    let told = losses(&mcap_with_chunk(1 << 40, "zstd", &[0; 40]));
    assert!(told.contains("at most 1073741824 bytes, decompressed, found 1099511627776"), "{told}");
    // A chunk of zeros that is larger than it claims.
    let zeros = zstd::bulk::compress(&vec![0; 1 << 24], 1).unwrap();
    let told = losses(&mcap_with_chunk(100, "zstd", &zeros));
    assert!(told.contains("expected 100 bytes, decompressed, found 101"), "{told}");
    // A record of 2^63 bytes, and one of 4 GB.
    let huge = [b"\x89MCAP0\r\n\x03".as_slice(), &(1u64 << 63).to_le_bytes(), &[0; 80]].concat();
    assert!(losses(&huge).contains("found the end of the file after 80"), "{}", losses(&huge));
    let huge = [b"#ROSBAG V2.0\n".as_slice(), &u32::MAX.to_le_bytes(), &[0; 80]].concat();
    assert!(losses(&huge).contains("expected 4294967295 more bytes"), "{}", losses(&huge));
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
