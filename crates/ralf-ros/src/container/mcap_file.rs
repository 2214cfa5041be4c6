//! MCAP: <https://mcap.dev/spec>. Channels and the index are read where they stand, so that a file that was cut short
//! needs no other way.

use super::Schema;
use super::catalogue::{Catalogue, Channel, Place};
use super::chunked::Format;
use super::chunks::ChunkPlace;
use super::decompress::Compression;
use super::error::Stop;
use super::quality::{OFFERED, is_latched};
use super::records::RecordFile;
use crate::encoding::{Decoder, Encoding, EncodingError};
use mcap::MAGIC;
use mcap::records::op;
use std::collections::BTreeMap;

/// The kind that no record has: zeros are no record.
const NO_OP: u8 = 0;

/// The kind of a record and its length.
const PREFIX_BYTES: usize = 9;

/// What the last record holds: where the summary begins, where a part of it begins, its checksum.
const FOOTER_BYTES: u64 = 20;

#[derive(Debug, Default)]
pub(super) struct Mcap;

impl Format for Mcap {
    fn name(&self) -> &'static str {
        "MCAP file"
    }

    fn begins(&self, bytes: &[u8]) -> bool {
        bytes.starts_with(MAGIC)
    }

    fn index(&self, file: &mut RecordFile) -> Result<Option<u64>, Stop> {
        let size = file.left();
        file.skip(size.saturating_sub(FOOTER_BYTES + MAGIC.len() as u64))?;
        let summary = u64::from_le_bytes(file.array()?);
        file.skip(FOOTER_BYTES - 8)?;
        let end: [u8; MAGIC.len()] = file.array()?;
        // 0 is no summary.
        Ok((end == MAGIC).then_some(if summary == 0 { size } else { summary }))
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
                    file.skip(length.saturating_sub(MESSAGE_HEAD_BYTES))?;
                    catalogue.add_message(channel, log_ns, Place::File(start));
                }
                op::ATTACHMENT | op::METADATA => {
                    catalogue.attached += 1;
                    file.skip(length)?;
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
                NO_OP => return Err(Stop::Damaged(file.error("the kind of a record", "0"))),
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

/// No later than half of what the type holds, so that the difference of two times is a time as well.
fn time_ns(time: u64) -> Result<i64, EncodingError> {
    let known = i64::try_from(time).ok().filter(|time| *time <= i64::MAX / 2);
    known.ok_or_else(|| EncodingError::new(0, "a time before the year 2116", format!("{time} ns")))
}

/// What a schema, a channel or an index says. Lengths are checked here: a library that takes them at their word asks
/// for as much memory.
fn record(op: u8, body: &[u8], catalogue: &mut Catalogue) -> Result<(), EncodingError> {
    // Numbers and texts of MCAP lie as those of ROS 1.
    let mut decoder = Decoder::new(Encoding::Ros1, body)?;
    match op {
        op::SCHEMA => schema(&mut decoder, catalogue),
        op::CHANNEL => channel(&mut decoder, catalogue),
        _ => message_index(&mut decoder, catalogue),
    }
}

fn schema(decoder: &mut Decoder<'_>, catalogue: &mut Catalogue) -> Result<(), EncodingError> {
    let (id, name, encoding) = (decoder.u16()?, decoder.string()?, decoder.string()?);
    let schema = Schema { encoding, text: decoder.bytes()?.to_vec(), ..Schema::default() };
    catalogue.schemas.insert(id, (name, schema));
    Ok(())
}

fn channel(decoder: &mut Decoder<'_>, catalogue: &mut Catalogue) -> Result<(), EncodingError> {
    let (id, schema_id) = (decoder.u16()?, decoder.u16()?);
    let (topic, encoding) = (decoder.string()?, decoder.string()?);
    let told = Told::of(decoder.bytes()?, &topic)?;
    // 0 is no schema. Of any other one that isn't known yet an earlier chunk tells, and this channel is met again.
    let known = catalogue.schemas.get(&schema_id).cloned();
    if let Some((type_name, mut schema)) = known.or_else(|| (schema_id == 0).then(Default::default)) {
        let Told { latched, publisher, md5 } = told;
        schema.md5 = md5;
        let channel = Channel { topic, type_name, encoding, schema, latched, publisher };
        catalogue.channels.insert(u32::from(id), channel);
    }
    Ok(())
}

/// What a channel's metadata tell, pairs of texts. Those of ROS 1 have what a bag's connections have.
struct Told {
    latched: bool,
    publisher: String,
    md5: String,
}

impl Told {
    fn of(metadata: &[u8], topic: &str) -> Result<Self, EncodingError> {
        let mut decoder = Decoder::new(Encoding::Ros1, metadata)?;
        let mut told = BTreeMap::new();
        while !decoder.is_at_end() {
            told.insert(decoder.string()?, decoder.string()?);
        }
        let mut text = |key| told.remove(key).unwrap_or_default();
        let (offered, latching) = (text(OFFERED), text("latching"));
        let latched = if latching.is_empty() { is_latched(topic, &offered) } else { latching == "1" };
        let publisher = Some(text("callerid")).filter(|_| latched).unwrap_or_default();
        Ok(Self { latched, publisher, md5: text("md5sum") })
    }
}

fn message_index(decoder: &mut Decoder<'_>, catalogue: &mut Catalogue) -> Result<(), EncodingError> {
    let channel = u32::from(decoder.u16()?);
    let mut entries = Decoder::new(Encoding::Ros1, decoder.bytes()?)?;
    let chunk = catalogue
        .last_chunk()
        .ok_or_else(|| EncodingError::new(0, "an index after its chunk", "one before any"))?;
    while !entries.is_at_end() {
        let (log_time, offset) = (entries.u64()?, entries.u64()?);
        let offset = u32::try_from(offset)
            .map_err(|_| EncodingError::new(0, "an offset in a chunk", offset.to_string()))?;
        catalogue.add_message(channel, time_ns(log_time)?, Place::Chunk(chunk, offset));
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

#[cfg(test)]
mod tests {
    use crate::container::Container;
    use mcap::MAGIC;
    use mcap::records::op;

    #[test]
    fn a_length_beyond_its_record_is_a_loss_before_memory_is_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        for (kind, before) in [(op::SCHEMA, 2), (op::CHANNEL, 4), (op::MESSAGE_INDEX, 2)] {
            // Numbers, and then a text or list of 4 GB in a record of a few bytes.
            let body = [vec![0; before], vec![0xff; 4], vec![0; 8]].concat();
            let length = (body.len() as u64).to_le_bytes();
            let file = folder.path().join("drive.mcap");
            std::fs::write(&file, [MAGIC, &[kind], &length, &body].concat()).unwrap();
            let container = Container::open(&file).unwrap();
            assert!(container.topics().is_empty());
            let told = &container.losses()[0].sentence;
            assert!(
                told.contains("a list that fits into the 8 bytes left, found 4294967295 entries"),
                "{told}"
            );
        }
    }
}
