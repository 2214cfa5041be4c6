//! MCAP as ROS 2 records it: messages in CDR, definitions as `ros2msg`, quality of service in the metadata.

use super::{Compression, Delivery, Described, WriteError};
use mcap::records::MessageHeader;
use mcap::{WriteOptions, Writer};
use std::collections::BTreeMap;
use std::io::{Seek, Write};

pub(super) struct McapWriter<W: Write + Seek> {
    writer: Writer<W>,
    /// How many messages each topic has, by the number of its channel.
    counts: BTreeMap<u16, u32>,
}

impl<W: Write + Seek> McapWriter<W> {
    pub(super) fn new(file: W, compression: Compression) -> Result<Self, WriteError> {
        let options = WriteOptions::new()
            .profile("ros2")
            .library(concat!("ralf ", env!("CARGO_PKG_VERSION")))
            .compression((compression == Compression::Zstd).then_some(mcap::Compression::Zstd))
            .compression_threads(0);
        Ok(Self { writer: options.create(file)?, counts: BTreeMap::new() })
    }

    pub(super) fn add_topic(&mut self, name: &str, described: &Described) -> Result<u32, WriteError> {
        let Described { type_name, encoding, schema, delivery, .. } = described;
        // What has no schema has none in a copy: readers of JSON refuse one in no language.
        let has_schema = !(type_name.is_empty() && schema.encoding.is_empty() && schema.text.is_empty());
        let schema =
            if has_schema { self.writer.add_schema(type_name, &schema.encoding, &schema.text)? } else { 0 };
        let metadata = BTreeMap::from([("offered_qos_profiles".to_owned(), quality_of_service(*delivery))]);
        Ok(u32::from(self.writer.add_channel(schema, name, encoding, &metadata)?))
    }

    pub(super) fn write(&mut self, topic: u32, log_ns: i64, message: &[u8]) -> Result<(), WriteError> {
        let time = u64::try_from(log_ns).map_err(|_| WriteError::Content {
            expected: "a log time from 1970 on",
            found: format!("{log_ns} ns"),
        })?;
        // It was a u16 when `add_topic` gave it.
        let channel_id = topic as u16;
        let count = self.counts.entry(channel_id).or_default();
        let header = MessageHeader { channel_id, sequence: *count, log_time: time, publish_time: time };
        *count = count.wrapping_add(1);
        Ok(self.writer.write_to_known_channel(&header, message)?)
    }

    pub(super) fn finish(mut self) -> Result<W, WriteError> {
        self.writer.finish()?;
        Ok(self.writer.into_inner())
    }
}

/// As rosbag2 of ROS 2 Humble writes it: reliable; durability 1 is transient local, 2 is volatile.
fn quality_of_service(delivery: Delivery) -> String {
    let (history, depth, durability) = match delivery {
        Delivery::Live => (3, 0, 2),
        Delivery::Latched => (1, 1, 1),
    };
    let forever = "\n    sec: 9223372036\n    nsec: 854775807\n";
    format!(
        "- history: {history}\n  depth: {depth}\n  reliability: 1\n  durability: {durability}\n  \
         deadline:{forever}  lifespan:{forever}  liveliness: 1\n  liveliness_lease_duration:{forever}  \
         avoid_ros_namespace_conventions: false"
    )
}
