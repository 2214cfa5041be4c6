//! Bytes that are others than were written, and sizes that no file has.

use super::{Place, own_files};
use ralf_ros::container::Container;

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
pub(super) fn mcap_with_chunk(size: u64, compression: &str, stored: &[u8]) -> Vec<u8> {
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
