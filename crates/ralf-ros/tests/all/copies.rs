//! Messages of one recording in another, as they are.

use ralf_ros::container::{Container, Schema, Topic};
use ralf_ros::message::{Header, Imu, TfMessage};
use ralf_ros::writer::{Compression, Delivery, MessageWriter};
use std::fs::File;
use std::path::{Path, PathBuf};

type FileWriter = MessageWriter<File>;

fn bag(file: &Path) -> FileWriter {
    MessageWriter::bag(File::create(file).unwrap()).unwrap()
}

fn mcap(file: &Path) -> FileWriter {
    MessageWriter::mcap(File::create(file).unwrap(), Compression::Zstd).unwrap()
}

const KINDS: [fn(&Path) -> FileWriter; 2] = [bag, mcap];

/// Three messages of two topics, one of them latched.
fn recording(file: &Path, begin: fn(&Path) -> FileWriter) -> Container {
    let mut writer = begin(file);
    let frames = writer.topic::<TfMessage>("/tf_static", Delivery::Latched).unwrap();
    let imu = writer.topic::<Imu>("/imu", Delivery::Live).unwrap();
    writer.write(&frames, 1_000, &TfMessage::default()).unwrap();
    for t_ns in [2_000, 3_000] {
        let header = Header { stamp_ns: t_ns, frame_id: "imu".to_owned(), ..Header::default() };
        writer.write(&imu, t_ns + 7, &Imu { header, ..Imu::default() }).unwrap();
    }
    writer.finish().unwrap();
    Container::open(file).unwrap()
}

/// Topic, log time and bytes of each message.
fn messages(recording: &Container) -> Vec<(usize, i64, Vec<u8>)> {
    let bytes = |message| recording.read(message).unwrap();
    recording.messages().iter().map(|message| (message.topic(), message.log_ns, bytes(message))).collect()
}

fn copy(from: &Container, file: PathBuf, begin: fn(&Path) -> FileWriter) -> Container {
    let mut writer = begin(&file);
    let topics: Vec<_> = from.topics().iter().map(|topic| writer.raw_topic(topic).unwrap()).collect();
    for (topic, log_ns, bytes) in messages(from) {
        writer.write_raw(&topics[topic], log_ns, &bytes).unwrap();
    }
    writer.finish().unwrap();
    Container::open(&file).unwrap()
}

#[test]
fn a_copy_has_the_same_topics_types_and_bytes() {
    let folder = tempfile::tempdir().unwrap();
    for begin in KINDS {
        let first = recording(&folder.path().join("first"), begin);
        let second = copy(&first, folder.path().join("second"), begin);
        assert_eq!(second.topics(), first.topics());
        assert_eq!(messages(&second), messages(&first));
        let latched: Vec<bool> = second.topics().iter().map(|topic| topic.schema.latched).collect();
        assert_eq!(latched, [false, true]);
    }
}

#[test]
fn an_encoding_stays_in_its_kind_of_file() {
    let folder = tempfile::tempdir().unwrap();
    for (begin, other) in [(KINDS[0], KINDS[1]), (KINDS[1], KINDS[0])] {
        let found = recording(&folder.path().join("first"), begin);
        let [same, other] = [begin, other].map(|begin| begin(&folder.path().join("second")));
        assert!(found.topics().iter().all(|topic| same.can_copy(topic) && !other.can_copy(topic)));
    }
}

#[test]
fn types_that_are_not_known_are_copied_with_what_is_told_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let thing = |encoding: &str, language: &str, md5: &str| Topic {
        name: "/thing".to_owned(),
        type_name: "my_msgs/Thing".to_owned(),
        encoding: encoding.to_owned(),
        schema: Schema {
            encoding: language.to_owned(),
            text: b"int32 a\n".to_vec(),
            md5: md5.to_owned(),
            latched: false,
        },
        count: 1,
    };
    for (begin, topic) in
        [(KINDS[0], thing("ros1", "ros1msg", "0123")), (KINDS[1], thing("json", "jsonschema", ""))]
    {
        let file = folder.path().join("things");
        let mut writer = begin(&file);
        assert!(writer.can_copy(&topic));
        let copy = writer.raw_topic(&topic).unwrap();
        writer.write_raw(&copy, 5, b"anything").unwrap();
        writer.finish().unwrap();
        let found = Container::open(&file).unwrap();
        assert_eq!(found.topics(), [topic]);
        assert_eq!(messages(&found), [(0, 5, b"anything".to_vec())]);
    }
    assert!(!bag(&folder.path().join("none")).can_copy(&thing("ros1", "ros1msg", "")), "no checksum");
}
