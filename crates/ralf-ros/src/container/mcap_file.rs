//! MCAP: <https://mcap.dev/spec>. Channels and the index are read where they stand, so that a file that was cut short
//! needs no other way.

use super::Schema;
use super::catalogue::{Catalogue, Channel, Place};
use super::chunked::Format;
use super::chunks::ChunkPlace;
use super::decompress::Compression;
use super::error::Stop;
use super::records::RecordFile;
use crate::encoding::{Decoder, Encoding, EncodingError};
use mcap::MAGIC;
use mcap::records::{Record, op};

/// The kind of a record and its length.
const PREFIX_BYTES: usize = 9;

/// What the quality of service says of topics that are also for those who come later: as ROS 2 writes it, and wrote it.
const LATCHED: [&str; 2] = ["durability: transient_local\n", "durability: 1\n"];

#[derive(Debug, Default)]
pub(super) struct Mcap;

impl Format for Mcap {
    fn name(&self) -> &'static str {
        "MCAP file"
    }

    fn begins(&self, bytes: &[u8]) -> bool {
        bytes.starts_with(MAGIC)
    }

    fn walk(&self, file: &mut RecordFile, catalogue: &mut Catalogue) -> Result<(), Stop> {
        file.skip(MAGIC.len() as u64)?;
        loop {
            let start = file.position();
            let [op] = file.array()?;
            let length = u64::from_le_bytes(file.array()?);
            match op {
                op::CHUNK => chunk(file, length, catalogue)?,
                op::SCHEMA | op::CHANNEL | op::MESSAGE_INDEX => {
                    let body = file.bytes(length)?;
                    record(op, &body, catalogue).map_err(|error| file.error(error.expected, error.found))?;
                }
                op::MESSAGE => {
                    let head = file.bytes(length.min(MESSAGE_HEAD_BYTES))?;
                    let (channel, log_ns) = message_head(&head)?;
                    catalogue.add_message(channel, log_ns, Place::File(start));
                    file.skip(length.saturating_sub(MESSAGE_HEAD_BYTES))?;
                }
                op::FOOTER => {
                    file.skip(length)?;
                    let end: [u8; MAGIC.len()] = file.array()?;
                    let whole = end == MAGIC;
                    return if whole {
                        Ok(())
                    } else {
                        Err(Stop::Damaged(file.error("the end of an MCAP file", "other bytes")))
                    };
                }
                _ => file.skip(length)?,
            }
        }
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
            let (op, body) = next_record(&mut decoder)?;
            match op {
                op::SCHEMA | op::CHANNEL => record(op, body, catalogue)?,
                op::MESSAGE if messages => {
                    let (channel, log_ns) = message_head(body)?;
                    catalogue.add_message(channel, log_ns, Place::Chunk(number, offset as u32));
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn message<'a>(&self, bytes: &'a [u8]) -> Result<&'a [u8], EncodingError> {
        match next_record(&mut Decoder::new(Encoding::Ros1, bytes)?)? {
            (op::MESSAGE, body) if body.len() as u64 >= MESSAGE_HEAD_BYTES => {
                Ok(&body[MESSAGE_HEAD_BYTES as usize..])
            }
            (other, _) => Err(EncodingError::new(0, "a message", format!("a record of the kind {other}"))),
        }
    }
}

/// Channel, sequence, log time, publish time.
const MESSAGE_HEAD_BYTES: u64 = 22;

fn next_record<'a>(decoder: &mut Decoder<'a>) -> Result<(u8, &'a [u8]), EncodingError> {
    let op = decoder.u8()?;
    let length = decoder.u64()?;
    let length = usize::try_from(length).map_err(|_| {
        EncodingError::new(decoder.position() - PREFIX_BYTES, "a record", format!("one of {length} bytes"))
    })?;
    Ok((op, decoder.slice(length)?))
}

/// Channel and log time of a message.
fn message_head(head: &[u8]) -> Result<(u32, i64), EncodingError> {
    let mut decoder = Decoder::new(Encoding::Ros1, head)?;
    let (channel, _sequence) = (decoder.u16()?, decoder.u32()?);
    Ok((u32::from(channel), time_ns(decoder.u64()?)?))
}

fn time_ns(time: u64) -> Result<i64, EncodingError> {
    i64::try_from(time)
        .map_err(|_| EncodingError::new(0, "a time before the year 2262", format!("{time} ns")))
}

/// What a schema, a channel or an index says.
fn record(op: u8, body: &[u8], catalogue: &mut Catalogue) -> Result<(), EncodingError> {
    let record = mcap::parse_record(op, body)
        .map_err(|error| EncodingError::new(0, "a record of MCAP", error.to_string()))?;
    match record {
        Record::Schema { header, data } => {
            let schema = Schema { encoding: header.encoding, text: data.into_owned(), ..Schema::default() };
            catalogue.schemas.insert(header.id, (header.name, schema));
        }
        Record::Channel(channel) => {
            // 0 is no schema. Of any other one that isn't known yet an earlier chunk tells, and this channel is met
            // again.
            let schema = catalogue.schemas.get(&channel.schema_id).cloned();
            if let Some((type_name, mut schema)) =
                schema.or_else(|| (channel.schema_id == 0).then(Default::default))
            {
                let quality_of_service = channel.metadata.get("offered_qos_profiles");
                schema.latched = quality_of_service
                    .is_some_and(|text| LATCHED.iter().any(|latched| text.contains(latched)));
                let (topic, encoding) = (channel.topic, channel.message_encoding);
                catalogue
                    .channels
                    .insert(u32::from(channel.id), Channel { topic, type_name, encoding, schema });
            }
        }
        Record::MessageIndex(index) => {
            let chunk = catalogue
                .last_chunk()
                .ok_or_else(|| EncodingError::new(0, "an index after its chunk", "one before any"))?;
            for entry in index.records {
                let offset = u32::try_from(entry.offset)
                    .map_err(|_| EncodingError::new(0, "an offset in a chunk", entry.offset.to_string()))?;
                let place = Place::Chunk(chunk, offset);
                catalogue.add_message(u32::from(index.channel_id), time_ns(entry.log_time)?, place);
            }
        }
        _ => {}
    }
    Ok(())
}

fn chunk(file: &mut RecordFile, length: u64, catalogue: &mut Catalogue) -> Result<(), Stop> {
    let (_start, _end) = (file.array::<8>()?, file.array::<8>()?);
    let size = u64::from_le_bytes(file.array()?);
    let crc = u32::from_le_bytes(file.array()?);
    let name_length = u64::from(u32::from_le_bytes(file.array()?));
    let name = file.bytes(name_length)?;
    let stored = u64::from_le_bytes(file.array()?);
    // Times, size, checksum, the name with its length, the length of what is stored.
    let expected = 40 + name_length;
    if length.checked_sub(stored) != Some(expected) {
        let found = format!("{stored} in a record of {length}");
        return Err(Stop::Damaged(
            file.error(format!("{} stored bytes", length.saturating_sub(expected)), found),
        ));
    }
    let name = String::from_utf8_lossy(&name);
    let compression = Compression::named(&name).ok_or_else(|| {
        Stop::Refused(file.error("a chunk compressed by none, lz4 or zstd", format!("`{name}`")))
    })?;
    let place = ChunkPlace {
        position: file.position(),
        stored: stored.min(file.left()),
        size,
        compression,
        crc,
        cut: stored > file.left(),
    };
    catalogue.add_chunk(place);
    file.skip(stored)
}
