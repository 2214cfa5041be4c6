//! Messages of one recording in another, as they are.

use ralf_ros::container::{Channel, Container, Schema};
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
    recording.messages().iter().map(|message| (message.channel(), message.log_ns, bytes(message))).collect()
}

fn copy(from: &Container, file: PathBuf, begin: fn(&Path) -> FileWriter) -> Container {
    let mut writer = begin(&file);
    let channels: Vec<_> = from.channels().iter().map(|channel| writer.raw_topic(channel).unwrap()).collect();
    for (channel, log_ns, bytes) in messages(from) {
        writer.write_raw(&channels[channel], log_ns, &bytes).unwrap();
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
        assert_eq!((second.topics(), second.channels()), (first.topics(), first.channels()));
        assert_eq!(messages(&second), messages(&first));
        let latched: Vec<bool> = second.channels().iter().map(|channel| channel.latched).collect();
        assert_eq!(latched, [false, true]);
    }
}

#[test]
fn an_encoding_stays_in_its_kind_of_file() {
    let folder = tempfile::tempdir().unwrap();
    for (begin, other) in [(KINDS[0], KINDS[1]), (KINDS[1], KINDS[0])] {
        let found = recording(&folder.path().join("first"), begin);
        let [same, other] = [begin, other].map(|begin| begin(&folder.path().join("second")));
        assert!(found.channels().iter().all(|channel| same.can_copy(channel) && !other.can_copy(channel)));
    }
}

#[test]
fn types_that_are_not_known_are_copied_with_what_is_told_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let thing = |encoding: &str, language: &str, md5: &str| Channel {
        topic: "/thing".to_owned(),
        type_name: "my_msgs/Thing".to_owned(),
        encoding: encoding.to_owned(),
        schema: Schema { encoding: language.to_owned(), text: b"int32 a\n".to_vec(), md5: md5.to_owned() },
        latched: false,
        publisher: String::new(),
    };
    for (begin, channel) in
        [(KINDS[0], thing("ros1", "ros1msg", "0123")), (KINDS[1], thing("json", "jsonschema", ""))]
    {
        let file = folder.path().join("things");
        let mut writer = begin(&file);
        assert!(writer.can_copy(&channel));
        let copy = writer.raw_topic(&channel).unwrap();
        writer.write_raw(&copy, 5, b"anything").unwrap();
        writer.finish().unwrap();
        let found = Container::open(&file).unwrap();
        assert_eq!(found.channels(), [channel]);
        assert_eq!(messages(&found), [(0, 5, b"anything".to_vec())]);
    }
    assert!(!bag(&folder.path().join("none")).can_copy(&thing("ros1", "ros1msg", "")), "no checksum");
}

/// As where a driver was updated between two sessions, and where every sensor's mounting has a publisher of its own.
#[test]
fn channels_of_one_topic_stay_apart() {
    let folder = tempfile::tempdir().unwrap();
    let channel = |text: &str, publisher: &str| Channel {
        topic: "/thing".to_owned(),
        type_name: "my_msgs/Thing".to_owned(),
        encoding: "ros1".to_owned(),
        schema: Schema {
            encoding: "ros1msg".to_owned(),
            text: text.as_bytes().to_vec(),
            md5: text.to_owned(),
        },
        latched: !publisher.is_empty(),
        publisher: publisher.to_owned(),
    };
    let channels =
        [channel("int32 a", ""), channel("int64 a", ""), channel("int64 a", "/b"), channel("int64 a", "/c")];
    let file = folder.path().join("things");
    let mut writer = bag(&file);
    let copies: Vec<_> = channels.iter().map(|channel| writer.raw_topic(channel).unwrap()).collect();
    copies.iter().for_each(|copy| writer.write_raw(copy, 5, b"anything").unwrap());
    writer.finish().unwrap();
    let found = Container::open(&file).unwrap();
    assert_eq!(found.channels(), channels);
    assert_eq!((found.topics().len(), found.topics()[0].count), (1, 4));
    assert_eq!(messages(&found).iter().map(|(channel, ..)| *channel).collect::<Vec<_>>(), [0, 1, 2, 3]);
    let again = copy(&found, folder.path().join("again"), bag);
    assert_eq!((again.channels(), messages(&again)), (found.channels(), messages(&found)));
}

/// JSON without a schema: readers refuse one in no language.
#[test]
fn what_has_no_schema_gets_none() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("json.mcap");
    let plain = Channel {
        topic: "/state".to_owned(),
        type_name: String::new(),
        encoding: "json".to_owned(),
        schema: Schema::default(),
        latched: false,
        publisher: String::new(),
    };
    let mut writer = mcap(&file);
    let copy = writer.raw_topic(&plain).unwrap();
    writer.write_raw(&copy, 5, b"{}").unwrap();
    writer.finish().unwrap();
    assert_eq!(Container::open(&file).unwrap().channels(), [plain]);
    let summary = mcap::Summary::read(&std::fs::read(&file).unwrap()).unwrap().unwrap();
    assert!(summary.schemas.is_empty() && summary.channels.values().all(|channel| channel.schema.is_none()));
}

/// As a tool makes MCAP files of bags: what a bag's connections tell stands in the metadata.
#[test]
fn channels_of_a_converted_bag_keep_checksum_and_latching() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bag.mcap");
    let mut writer = mcap::WriteOptions::new().profile("ros1").create(File::create(&file).unwrap()).unwrap();
    let schema = writer.add_schema("my_msgs/Gear", "ros1msg", b"int8 gear").unwrap();
    let told = [("md5sum", "0123"), ("latching", "1"), ("callerid", "/gearbox")];
    let metadata = told.map(|(key, value)| (key.to_owned(), value.to_owned())).into();
    let id = writer.add_channel(schema, "/gear", "ros1", &metadata).unwrap();
    let header = mcap::records::MessageHeader { channel_id: id, sequence: 0, log_time: 5, publish_time: 5 };
    writer.write_to_known_channel(&header, b"1").unwrap();
    writer.finish().unwrap();
    drop(writer);
    let found = Container::open(&file).unwrap();
    let channel = &found.channels()[0];
    assert_eq!((channel.schema.md5.as_str(), channel.latched), ("0123", true));
    assert!(bag(&folder.path().join("none")).can_copy(channel));
    let copied = copy(&found, folder.path().join("copy.bag"), bag);
    assert_eq!(copied.channels(), found.channels());
}

/// `rosbag play` begins at 1 ns: what is logged at 0 would never be played.
#[test]
fn nothing_new_in_a_bag_is_logged_at_0() {
    let folder = tempfile::tempdir().unwrap();
    for (begin, logged) in [(KINDS[0], 1), (KINDS[1], 0)] {
        let file = folder.path().join("zero");
        let mut writer = begin(&file);
        let frames = writer.topic::<TfMessage>("/tf_static", Delivery::Latched).unwrap();
        writer.write(&frames, 0, &TfMessage::default()).unwrap();
        writer.finish().unwrap();
        assert_eq!(Container::open(&file).unwrap().messages()[0].log_ns, logged);
    }
}
