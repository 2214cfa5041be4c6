//! ROS 1 bags. Connections and the index are read where they stand, so that a bag that was cut short needs no other
//! way.

use super::Schema;
use super::bag_format::{MAGIC, ParsedFields, op, time_ns};
use super::catalogue::{Catalogue, Channel, Place};
use super::chunked::Format;
use super::chunks::ChunkPlace;
use super::decompress::{CHUNK_BYTES, Compression};
use super::error::Stop;
use super::records::RecordFile;
use crate::encoding::{Decoder, Encoding, EncodingError};

/// Bytes of an entry of an index: a time and an offset.
const ENTRY_BYTES: usize = 12;

#[derive(Debug)]
pub(super) struct Bag;

impl Format for Bag {
    fn name(&self) -> &'static str {
        "ROS 1 bag"
    }

    fn begins(&self, bytes: &[u8]) -> bool {
        bytes.starts_with(MAGIC)
    }

    fn index(&self, file: &mut RecordFile) -> Result<Option<u64>, Stop> {
        let size = file.left();
        let header = bag_header(file)?;
        let index_position = ParsedFields::parse(&header)?.u64("index_pos")?;
        Ok(Some(index_position).filter(|position| (1..size).contains(position)))
    }

    fn walk(&self, file: &mut RecordFile, catalogue: &mut Catalogue) -> Result<(), Stop> {
        let header = bag_header(file)?;
        let header = ParsedFields::parse(&header)?;
        if header.op()? != op::BAG_HEADER {
            return Err(Stop::Damaged(file.error("the record of the bag", "another one")));
        }
        if let Some(encryptor) = header.get("encryptor").filter(|name| !name.is_empty()) {
            let found = String::from_utf8_lossy(encryptor);
            return Err(Stop::Refused(file.error("a bag that isn't encrypted", found)));
        }
        let (index_position, connections) = (header.u64("index_pos")?, header.u32("conn_count")?);
        let chunks = header.u32("chunk_count")?;
        skip_data(file)?;
        let mut described = 0;
        while !file.is_at_end() {
            described += usize::from(record(file, index_position == 0, catalogue)? == op::CHUNK_INFO);
        }
        let found = [catalogue.channels.len(), described];
        if index_position == 0 {
            return Err(Stop::Damaged(file.error("a bag that was closed", "no index at its end")));
        }
        if found != [connections as usize, chunks as usize] {
            let expected = format!("{connections} connections and {chunks} chunks");
            return Err(Stop::Damaged(file.error(expected, format!("{} and {}", found[0], found[1]))));
        }
        Ok(())
    }

    fn scan(
        &self,
        chunk: &[u8],
        number: u32,
        messages: bool,
        catalogue: &mut Catalogue,
    ) -> Result<(), EncodingError> {
        let mut decoder = Decoder::new(Encoding::Ros1, chunk)?;
        while !decoder.is_at_end() {
            let offset = decoder.position();
            let (header, data) = (ParsedFields::parse(decoder.bytes()?)?, decoder.bytes()?);
            match header.op()? {
                op::CONNECTION => add_connection(&header, data, catalogue)?,
                op::MESSAGE if messages => {
                    let place = Place::Chunk(number, offset as u32);
                    catalogue.add_message(header.u32("conn")?, header.time("time")?, place);
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn message<'a>(&self, bytes: &'a [u8]) -> Result<&'a [u8], EncodingError> {
        let mut decoder = Decoder::new(Encoding::Ros1, bytes)?;
        let (header, data) = (ParsedFields::parse(decoder.bytes()?)?, decoder.bytes()?);
        match header.op()? {
            op::MESSAGE => Ok(data),
            other => Err(EncodingError::new(0, "a message", format!("a record of the kind {other}"))),
        }
    }
}

/// Looks at the next record, and tells its kind; of a bag that is open, for it was never closed.
fn record(file: &mut RecordFile, is_open: bool, catalogue: &mut Catalogue) -> Result<u8, Stop> {
    let header = record_header(file)?;
    let header = ParsedFields::parse(&header).map_err(|error| moved(error, file))?;
    let kind = header.op().map_err(|error| moved(error, file))?;
    match kind {
        op::CHUNK => chunk(file, &header, is_open, catalogue)?,
        op::INDEX => index(file, &header, catalogue)?,
        op::CONNECTION => {
            let length = data_length(file)?;
            let data = file.bytes(length)?;
            add_connection(&header, &data, catalogue).map_err(|error| moved(error, file))?;
        }
        op::CHUNK_INFO => skip_data(file)?,
        other => {
            let found = format!("a record of the kind {other}");
            return Err(Stop::Damaged(file.error("a chunk, its index or a connection", found)));
        }
    }
    Ok(kind)
}

fn chunk(
    file: &mut RecordFile,
    header: &ParsedFields<'_>,
    is_open: bool,
    catalogue: &mut Catalogue,
) -> Result<(), Stop> {
    let name = header.text("compression")?;
    let compression = Compression::named(name).ok_or_else(|| {
        Stop::Refused(file.error("a chunk compressed by none, bz2 or lz4", format!("`{name}`")))
    })?;
    let (mut size, mut stored) = (u64::from(header.u32("size")?), data_length(file)?);
    // Recorders tell how long a chunk is when they have written it: that which they were killed in is all the rest.
    let is_unfinished = is_open && size == 0 && stored == 0;
    if is_unfinished {
        (size, stored) = (CHUNK_BYTES, file.left());
    }
    let place = ChunkPlace {
        position: file.position(),
        stored: stored.min(file.left()),
        size,
        compression,
        crc: 0,
        cut: is_unfinished || stored > file.left(),
    };
    catalogue.add_chunk(place);
    file.skip(stored)
}

fn index(file: &mut RecordFile, header: &ParsedFields<'_>, catalogue: &mut Catalogue) -> Result<(), Stop> {
    let (version, channel) = (header.u32("ver")?, header.u32("conn")?);
    if version != 1 {
        return Err(Stop::Damaged(file.error("an index of version 1", version.to_string())));
    }
    let length = data_length(file)?;
    let entries = file.bytes(length)?;
    let Some(chunk) = catalogue.last_chunk().filter(|_| entries.len() % ENTRY_BYTES == 0) else {
        return Err(Stop::Damaged(file.error("the index of a chunk", format!("{length} bytes"))));
    };
    for entry in entries.as_chunks::<ENTRY_BYTES>().0 {
        let [t0, t1, t2, t3, t4, t5, t6, t7, offset @ ..] = *entry;
        let place = Place::Chunk(chunk, u32::from_le_bytes(offset));
        catalogue.add_message(channel, time_ns([t0, t1, t2, t3, t4, t5, t6, t7]), place);
    }
    Ok(())
}

fn add_connection(
    header: &ParsedFields<'_>,
    data: &[u8],
    catalogue: &mut Catalogue,
) -> Result<(), EncodingError> {
    let connection = ParsedFields::parse(data)?;
    let latched = connection.text("latching").is_ok_and(|latching| latching == "1");
    let publisher = connection.text("callerid").ok().filter(|_| latched).unwrap_or_default();
    let channel = Channel {
        topic: header.text("topic")?.to_owned(),
        type_name: connection.text("type")?.to_owned(),
        encoding: "ros1".to_owned(),
        schema: Schema {
            encoding: "ros1msg".to_owned(),
            text: connection.text("message_definition").unwrap_or_default().into(),
            md5: connection.text("md5sum").unwrap_or_default().to_owned(),
        },
        latched,
        publisher: publisher.to_owned(),
    };
    catalogue.channels.insert(header.u32("conn")?, channel);
    Ok(())
}

/// The fields of the record that describes the whole bag.
fn bag_header(file: &mut RecordFile) -> Result<Vec<u8>, Stop> {
    file.skip(MAGIC.len() as u64)?;
    record_header(file)
}

fn record_header(file: &mut RecordFile) -> Result<Vec<u8>, Stop> {
    let length = data_length(file)?;
    file.bytes(length)
}

fn skip_data(file: &mut RecordFile) -> Result<(), Stop> {
    let length = data_length(file)?;
    file.skip(length)
}

fn data_length(file: &mut RecordFile) -> Result<u64, Stop> {
    Ok(u64::from(u32::from_le_bytes(file.array()?)))
}

/// An error inside a record, as one at the place in the file after it.
fn moved(error: EncodingError, file: &RecordFile) -> EncodingError {
    file.error(error.expected, error.found)
}

#[cfg(test)]
mod tests {
    use crate::container::Container;
    use crate::container::bag_format::{Fields, MAGIC, op};

    /// As `rosbag record` leaves `drive.bag.active`: it tells a chunk's length, and where the index is, at its end.
    #[test]
    fn a_recorder_that_was_killed_leaves_its_last_chunk_to_be_read() {
        let header = Fields::default()
            .with("op", &[op::BAG_HEADER])
            .with("index_pos", &0u64.to_le_bytes())
            .with("conn_count", &0u32.to_le_bytes())
            .with("chunk_count", &0u32.to_le_bytes());
        let conn = 0u32.to_le_bytes();
        let connection = Fields::default().with("op", &[op::CONNECTION]).with("conn", &conn);
        let told = Fields::default().with("topic", b"/a").with("type", b"std_msgs/Int8").with("md5sum", b"1");
        let message = |second: u8| {
            let fields = Fields::default().with("op", &[op::MESSAGE]).with("conn", &conn);
            fields.with("time", &[second, 0, 0, 0, 0, 0, 0, 0]).record(&[second])
        };
        let data = [
            connection.with("topic", b"/a").record(told.bytes()),
            message(1),
            message(2),
            message(3)[..20].to_vec(),
        ]
        .concat();
        let compressed = lz4(&data);
        let folder = tempfile::tempdir().unwrap();
        for (name, data) in [("none", &data), ("lz4", &compressed)] {
            let chunk = Fields::default()
                .with("op", &[op::CHUNK])
                .with("compression", name.as_bytes())
                .with("size", &0u32.to_le_bytes());
            let file = folder.path().join(name);
            std::fs::write(&file, [MAGIC, &header.record(&[b' '; 64]), &chunk.record(&[]), data].concat())
                .unwrap();
            let container = Container::open(&file).unwrap();
            let seconds = container.messages().iter().map(|message| container.read(message).unwrap());
            assert_eq!(seconds.collect::<Vec<_>>(), [[1], [2]], "{name}: {:?}", container.losses());
            assert!(container.losses().iter().all(|loss| !loss.hides_messages), "{:?}", container.losses());
        }
    }

    fn lz4(bytes: &[u8]) -> Vec<u8> {
        use std::io::Write;
        let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }
}
