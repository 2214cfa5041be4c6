//! ROS 1 bags, version 2.0: <http://wiki.ros.org/Bags/Format/2.0>.

use super::{Delivery, Described, WriteError};
use crate::container::bag_format::{Fields, MAGIC, op};
use std::collections::BTreeMap;
use std::io::{Seek, SeekFrom, Write};

/// Bytes of messages before a chunk is written; rosbag's own.
const CHUNK_BYTES: usize = 768 * 1024;

/// What the first record is filled up to, so that it can be written again when the index is known.
const BAG_HEADER_BYTES: usize = 4096;

pub(super) struct BagWriter<W: Write + Seek> {
    file: W,
    /// Bytes written.
    position: u64,
    /// The data of each topic's connection record, and whether a chunk holds it already.
    connections: Vec<Connection>,
    chunk: Chunk,
    /// A chunk info record of each chunk.
    chunk_infos: Vec<Vec<u8>>,
}

struct Connection {
    record: Vec<u8>,
    written: bool,
}

/// The chunk in the making.
#[derive(Default)]
struct Chunk {
    data: Vec<u8>,
    /// Time and offset of each message, by topic.
    messages: BTreeMap<u32, Vec<([u8; 8], u32)>>,
    /// First and last time, ns.
    span: Option<[i64; 2]>,
}

impl<W: Write + Seek> BagWriter<W> {
    pub(super) fn new(file: W) -> Result<Self, WriteError> {
        let (connections, chunk_infos) = (Vec::new(), Vec::new());
        let mut bag = Self { file, position: 0, connections, chunk: Chunk::default(), chunk_infos };
        bag.put(MAGIC)?;
        bag.put(&bag_header(0, 0, 0))?;
        Ok(bag)
    }

    pub(super) fn add_topic(&mut self, name: &str, described: &Described) -> u32 {
        let id = self.connections.len() as u32;
        let header = Fields::default().with("op", &[op::CONNECTION]).with("conn", &id.to_le_bytes());
        let mut data = Fields::default()
            .with("topic", name.as_bytes())
            .with("type", described.type_name.as_bytes())
            .with("md5sum", described.schema.md5.as_bytes())
            .with("message_definition", &described.schema.text);
        if described.delivery == Delivery::Latched {
            data = data.with("latching", b"1");
        }
        if !described.publisher.is_empty() {
            data = data.with("callerid", described.publisher.as_bytes());
        }
        let record = header.with("topic", name.as_bytes()).record(data.bytes());
        self.connections.push(Connection { record, written: false });
        id
    }

    pub(super) fn write(&mut self, topic: u32, log_ns: i64, message: &[u8]) -> Result<(), WriteError> {
        let time = bag_time(log_ns)?;
        let connection = &mut self.connections[topic as usize];
        if !std::mem::replace(&mut connection.written, true) {
            self.chunk.data.extend_from_slice(&connection.record);
        }
        let offset = self.chunk.data.len() as u32;
        self.chunk.messages.entry(topic).or_default().push((time, offset));
        let [first, last] = self.chunk.span.unwrap_or([log_ns; 2]);
        self.chunk.span = Some([first.min(log_ns), last.max(log_ns)]);
        let header = Fields::default().with("op", &[op::MESSAGE]).with("conn", &topic.to_le_bytes());
        length(message.len())?;
        self.chunk.data.extend(header.with("time", &time).record(message));
        if self.chunk.data.len() >= CHUNK_BYTES { self.write_chunk() } else { Ok(()) }
    }

    pub(super) fn finish(mut self) -> Result<W, WriteError> {
        self.write_chunk()?;
        let index_position = self.position;
        let (connections, chunks) = (self.connections.len() as u32, self.chunk_infos.len() as u32);
        for connection in std::mem::take(&mut self.connections) {
            self.put(&connection.record)?;
        }
        for info in std::mem::take(&mut self.chunk_infos) {
            self.put(&info)?;
        }
        self.file.seek(SeekFrom::Start(MAGIC.len() as u64))?;
        self.file.write_all(&bag_header(index_position, connections, chunks))?;
        self.file.seek(SeekFrom::End(0))?;
        self.file.flush()?;
        Ok(self.file)
    }

    fn write_chunk(&mut self) -> Result<(), WriteError> {
        let chunk = std::mem::take(&mut self.chunk);
        let Some([first, last]) = chunk.span else { return Ok(()) };
        let info = Fields::default()
            .with("op", &[op::CHUNK_INFO])
            .with("ver", &1u32.to_le_bytes())
            .with("chunk_pos", &self.position.to_le_bytes())
            .with("start_time", &bag_time(first)?)
            .with("end_time", &bag_time(last)?)
            .with("count", &(chunk.messages.len() as u32).to_le_bytes());
        let header = Fields::default()
            .with("op", &[op::CHUNK])
            .with("compression", b"none")
            .with("size", &length(chunk.data.len())?.to_le_bytes());
        self.put(&header.record(&chunk.data))?;
        let mut counts = Vec::new();
        for (topic, messages) in &chunk.messages {
            let count = messages.len() as u32;
            counts.extend(topic.to_le_bytes().into_iter().chain(count.to_le_bytes()));
            let entries: Vec<u8> = messages
                .iter()
                .flat_map(|(time, offset)| time.iter().copied().chain(offset.to_le_bytes()))
                .collect();
            let header = Fields::default()
                .with("op", &[op::INDEX])
                .with("ver", &1u32.to_le_bytes())
                .with("conn", &topic.to_le_bytes())
                .with("count", &count.to_le_bytes());
            self.put(&header.record(&entries))?;
        }
        self.chunk_infos.push(info.record(&counts));
        Ok(())
    }

    fn put(&mut self, bytes: &[u8]) -> Result<(), WriteError> {
        self.file.write_all(bytes)?;
        self.position += bytes.len() as u64;
        Ok(())
    }
}

fn bag_header(index_position: u64, connections: u32, chunks: u32) -> Vec<u8> {
    let header = Fields::default()
        .with("op", &[op::BAG_HEADER])
        .with("index_pos", &index_position.to_le_bytes())
        .with("conn_count", &connections.to_le_bytes())
        .with("chunk_count", &chunks.to_le_bytes());
    let padding = vec![b' '; BAG_HEADER_BYTES - header.bytes().len()];
    header.record(&padding)
}

/// Seconds and nanoseconds of 4 bytes each.
fn bag_time(t_ns: i64) -> Result<[u8; 8], WriteError> {
    let seconds = u32::try_from(t_ns.div_euclid(1_000_000_000)).map_err(|_| WriteError::Content {
        expected: "a log time from 1970 to 2106",
        found: format!("{t_ns} ns"),
    })?;
    // Below 10^9, and so within 32 bits.
    let nanoseconds = t_ns.rem_euclid(1_000_000_000) as u32;
    Ok((u64::from(seconds) | (u64::from(nanoseconds) << 32)).to_le_bytes())
}

fn length(bytes: usize) -> Result<u32, WriteError> {
    u32::try_from(bytes)
        .map_err(|_| WriteError::Content { expected: "at most 2^32 - 1 bytes", found: bytes.to_string() })
}
