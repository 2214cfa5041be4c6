//! The bytes of ROS 1 bags, version 2.0: records of a header and data, both with their length before them.

use crate::encoding::{Decoder, Encoding, EncodingError};

/// What a bag begins with.
pub(crate) const MAGIC: &[u8] = b"#ROSBAG V2.0\n";

/// Kinds of records.
pub(crate) mod op {
    pub(crate) const MESSAGE: u8 = 2;
    pub(crate) const BAG_HEADER: u8 = 3;
    pub(crate) const INDEX: u8 = 4;
    pub(crate) const CHUNK: u8 = 5;
    pub(crate) const CHUNK_INFO: u8 = 6;
    pub(crate) const CONNECTION: u8 = 7;
}

/// Names with values, as headers and connections hold them: `length name=value` each.
#[derive(Debug, Clone, Default)]
pub(crate) struct Fields(Vec<u8>);

impl Fields {
    /// With one more.
    pub(crate) fn with(mut self, name: &str, value: &[u8]) -> Self {
        // Texts of definitions are the longest of them, of a few kB.
        let length = (name.len() + 1 + value.len()) as u32;
        self.0.extend(length.to_le_bytes());
        self.0.extend_from_slice(name.as_bytes());
        self.0.push(b'=');
        self.0.extend_from_slice(value);
        self
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        &self.0
    }

    /// A record with these fields as its header.
    pub(crate) fn record(&self, data: &[u8]) -> Vec<u8> {
        let mut record = Vec::with_capacity(8 + self.0.len() + data.len());
        record.extend((self.0.len() as u32).to_le_bytes());
        record.extend_from_slice(&self.0);
        record.extend((data.len() as u32).to_le_bytes());
        record.extend_from_slice(data);
        record
    }
}

/// Names with values, as read.
#[derive(Debug)]
pub(crate) struct ParsedFields<'a>(Vec<(&'a [u8], &'a [u8])>);

impl<'a> ParsedFields<'a> {
    pub(crate) fn parse(bytes: &'a [u8]) -> Result<Self, EncodingError> {
        let mut decoder = Decoder::new(Encoding::Ros1, bytes)?;
        let mut fields = Vec::new();
        while !decoder.is_at_end() {
            let position = decoder.position();
            let field = decoder.bytes()?;
            let equals = field
                .iter()
                .position(|byte| *byte == b'=')
                .ok_or_else(|| EncodingError::new(position, "a field `name=value`", "one without `=`"))?;
            fields.push((&field[..equals], &field[equals + 1..]));
        }
        Ok(Self(fields))
    }

    pub(crate) fn get(&self, name: &str) -> Option<&'a [u8]> {
        self.0.iter().find(|(known, _)| *known == name.as_bytes()).map(|(_, value)| *value)
    }

    pub(crate) fn text(&self, name: &str) -> Result<&'a str, EncodingError> {
        let value = self.get(name).ok_or_else(|| missing(name))?;
        std::str::from_utf8(value)
            .map_err(|_| EncodingError::new(0, format!("UTF-8 text in the field `{name}`"), "other bytes"))
    }

    pub(crate) fn op(&self) -> Result<u8, EncodingError> {
        self.array("op").map(|[op]| op)
    }

    pub(crate) fn u32(&self, name: &str) -> Result<u32, EncodingError> {
        self.array(name).map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&self, name: &str) -> Result<u64, EncodingError> {
        self.array(name).map(u64::from_le_bytes)
    }

    /// Nanoseconds.
    pub(crate) fn time(&self, name: &str) -> Result<i64, EncodingError> {
        self.array(name).map(time_ns)
    }

    fn array<const N: usize>(&self, name: &str) -> Result<[u8; N], EncodingError> {
        let value = self.get(name).ok_or_else(|| missing(name))?;
        value.try_into().map_err(|_| {
            let expected = format!("{N} bytes in the field `{name}`");
            EncodingError::new(0, expected, value.len().to_string())
        })
    }
}

/// From seconds and nanoseconds of 4 bytes each.
pub(crate) fn time_ns(bytes: [u8; 8]) -> i64 {
    let both = u64::from_le_bytes(bytes);
    let [seconds, nanoseconds] = [both & u64::from(u32::MAX), both >> 32].map(u64::cast_signed);
    seconds * 1_000_000_000 + nanoseconds
}

fn missing(name: &str) -> EncodingError {
    EncodingError::new(0, format!("a field `{name}`"), "none")
}
