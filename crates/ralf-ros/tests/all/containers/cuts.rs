//! Files that end too soon.

use super::{FIXTURES, Place, fixture, own_files, scan};
use ralf_ros::container::Container;
use ralf_ros::message::RadarScan;
use ralf_ros::writer::{Compression, Delivery, MessageWriter};
use std::collections::BTreeMap;
use std::io::Cursor;

/// Every message that can be read, by topic and log time.
type Found = BTreeMap<(String, i64), Vec<u8>>;

fn found(container: &Container) -> Found {
    let read = |message| {
        let bytes = container.read(message).ok()?;
        Some(((container.topics()[container.topic_of(message)].name.clone(), message.log_ns), bytes))
    };
    container.messages().iter().filter_map(read).collect()
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
