//! Writing the values of a message, one after the other.

use super::{ENCAPSULATION, Encoding, EncodingError};

/// A message in the making; CDR is written in little endian, as ROS does on the machines of today.
#[derive(Debug, Clone)]
pub struct Encoder {
    bytes: Vec<u8>,
    encoding: Encoding,
}

impl Encoder {
    /// A message without values yet.
    pub fn new(encoding: Encoding) -> Self {
        let bytes = match encoding {
            Encoding::Ros1 => Vec::new(),
            Encoding::Cdr => vec![0, 1, 0, 0],
        };
        Self { bytes, encoding }
    }

    /// How the message is written.
    pub fn encoding(&self) -> Encoding {
        self.encoding
    }

    /// The message.
    pub fn finish(self) -> Vec<u8> {
        self.bytes
    }

    /// A byte.
    pub fn u8(&mut self, value: u8) {
        self.number(value.to_le_bytes());
    }

    /// 0 or 1.
    pub fn bool(&mut self, value: bool) {
        self.u8(u8::from(value));
    }

    /// A number of 2 bytes.
    pub fn u16(&mut self, value: u16) {
        self.number(value.to_le_bytes());
    }

    /// A number of 4 bytes.
    pub fn u32(&mut self, value: u32) {
        self.number(value.to_le_bytes());
    }

    /// A number of 4 bytes with a sign.
    pub fn i32(&mut self, value: i32) {
        self.number(value.to_le_bytes());
    }

    /// A float of 4 bytes.
    pub fn f32(&mut self, value: f32) {
        self.number(value.to_le_bytes());
    }

    /// A float of 8 bytes.
    pub fn f64(&mut self, value: f64) {
        self.number(value.to_le_bytes());
    }

    /// Floats of 8 bytes without their number before them.
    pub fn f64_array(&mut self, values: &[f64]) {
        values.iter().for_each(|value| self.f64(*value));
    }

    /// UTF-8 text.
    pub fn string(&mut self, text: &str) -> Result<(), EncodingError> {
        let final_zero: &[u8] = if self.encoding == Encoding::Cdr { &[0] } else { &[] };
        self.length(text.len() + final_zero.len())?;
        self.bytes.extend_from_slice(text.as_bytes());
        self.bytes.extend_from_slice(final_zero);
        Ok(())
    }

    /// A list of bytes.
    pub fn bytes(&mut self, bytes: &[u8]) -> Result<(), EncodingError> {
        self.length(bytes.len())?;
        self.bytes.extend_from_slice(bytes);
        Ok(())
    }

    /// A list.
    pub fn list<T>(
        &mut self,
        entries: &[T],
        mut entry: impl FnMut(&mut Self, &T) -> Result<(), EncodingError>,
    ) -> Result<(), EncodingError> {
        self.length(entries.len())?;
        entries.iter().try_for_each(|value| entry(self, value))
    }

    fn length(&mut self, length: usize) -> Result<(), EncodingError> {
        let length = u32::try_from(length).map_err(|_| {
            EncodingError::new(self.bytes.len(), "at most 2^32 - 1 entries", length.to_string())
        })?;
        self.u32(length);
        Ok(())
    }

    fn number<const N: usize>(&mut self, bytes: [u8; N]) {
        if self.encoding == Encoding::Cdr {
            let aligned = (self.bytes.len() - ENCAPSULATION).next_multiple_of(N) + ENCAPSULATION;
            self.bytes.resize(aligned, 0);
        }
        self.bytes.extend(bytes);
    }
}
