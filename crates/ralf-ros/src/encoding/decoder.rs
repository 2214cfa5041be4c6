//! Reading the values of a message, one after the other.

use super::{ENCAPSULATION, Encoding, EncodingError};

/// A place in a message. Nothing beyond its end is ever read or allocated for.
#[derive(Debug, Clone)]
pub struct Decoder<'a> {
    bytes: &'a [u8],
    position: usize,
    encoding: Encoding,
    big_endian: bool,
}

impl<'a> Decoder<'a> {
    /// At the first value of a message; refused where CDR is of a kind that ROS doesn't write.
    pub fn new(encoding: Encoding, bytes: &'a [u8]) -> Result<Self, EncodingError> {
        let mut decoder = Self { bytes, position: 0, encoding, big_endian: false };
        if encoding == Encoding::Cdr {
            let [zero, representation, ..] = decoder.take::<ENCAPSULATION>()?;
            if zero != 0 || representation > 1 {
                let found = format!("representation {}", u16::from_be_bytes([zero, representation]));
                return Err(EncodingError::new(0, "plain CDR (0 or 1)", found));
            }
            decoder.big_endian = representation == 0;
        }
        Ok(decoder)
    }

    /// How the message is written.
    pub fn encoding(&self) -> Encoding {
        self.encoding
    }

    /// Bytes from the beginning of the message.
    pub fn position(&self) -> usize {
        self.position
    }

    /// Whether nothing is left.
    pub(crate) fn is_at_end(&self) -> bool {
        self.position >= self.bytes.len()
    }

    /// Refuses what follows the last value: the message is of another type. CDR may be filled up to a multiple of 4.
    pub fn finish(&self) -> Result<(), EncodingError> {
        let left = self.bytes.len().saturating_sub(self.position);
        let padding = if self.encoding == Encoding::Cdr { ENCAPSULATION - 1 } else { 0 };
        if left <= padding {
            return Ok(());
        }
        Err(EncodingError::new(self.position, "the end of the message", format!("{left} more bytes")))
    }

    /// A byte.
    pub fn u8(&mut self) -> Result<u8, EncodingError> {
        self.number().map(u8::from_le_bytes)
    }

    /// A byte that is not 0: ROS 1 and 2 read it so, and some drivers leave it to chance which one it is.
    pub fn bool(&mut self) -> Result<bool, EncodingError> {
        Ok(self.u8()? != 0)
    }

    /// A number of 2 bytes.
    pub fn u16(&mut self) -> Result<u16, EncodingError> {
        self.number().map(u16::from_le_bytes)
    }

    /// A number of 4 bytes.
    pub fn u32(&mut self) -> Result<u32, EncodingError> {
        self.number().map(u32::from_le_bytes)
    }

    /// A number of 4 bytes with a sign.
    pub fn i32(&mut self) -> Result<i32, EncodingError> {
        self.number().map(i32::from_le_bytes)
    }

    /// A number of 8 bytes.
    pub fn u64(&mut self) -> Result<u64, EncodingError> {
        self.number().map(u64::from_le_bytes)
    }

    /// A float of 4 bytes.
    pub fn f32(&mut self) -> Result<f32, EncodingError> {
        self.number().map(f32::from_le_bytes)
    }

    /// A float of 8 bytes.
    pub fn f64(&mut self) -> Result<f64, EncodingError> {
        self.number().map(f64::from_le_bytes)
    }

    /// As many floats of 8 bytes as the type says; no length stands before them.
    pub fn f64_array<const N: usize>(&mut self) -> Result<[f64; N], EncodingError> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.f64()?;
        }
        Ok(values)
    }

    /// UTF-8 text.
    pub fn string(&mut self) -> Result<String, EncodingError> {
        let mut text = self.bytes()?;
        let start = self.position - text.len();
        if self.encoding == Encoding::Cdr {
            // Some writers give an empty string no final 0.
            text = text.strip_suffix(&[0]).unwrap_or(text);
        }
        let text = std::str::from_utf8(text)
            .map_err(|error| EncodingError::new(start + error.valid_up_to(), "UTF-8 text", "other bytes"))?;
        Ok(text.to_owned())
    }

    /// A list of bytes, not copied.
    pub fn bytes(&mut self) -> Result<&'a [u8], EncodingError> {
        let length = self.length(1)?;
        self.slice(length)
    }

    /// A list; an entry takes at least `entry_bytes`, which is what bounds the memory that a wrong length can ask for.
    pub fn list<T>(
        &mut self,
        entry_bytes: usize,
        mut entry: impl FnMut(&mut Self) -> Result<T, EncodingError>,
    ) -> Result<Vec<T>, EncodingError> {
        let length = self.length(entry_bytes)?;
        (0..length).map(|_| entry(self)).collect()
    }

    fn length(&mut self, entry_bytes: usize) -> Result<usize, EncodingError> {
        let length = self.u32()? as usize;
        let left = self.bytes.len() - self.position;
        if length.checked_mul(entry_bytes).is_some_and(|bytes| bytes <= left) {
            return Ok(length);
        }
        let expected = format!("a list that fits into the {left} bytes left");
        Err(EncodingError::new(self.position - size_of::<u32>(), expected, format!("{length} entries")))
    }

    /// A number's bytes from the least to the most significant one, after the padding before it.
    fn number<const N: usize>(&mut self) -> Result<[u8; N], EncodingError> {
        if self.encoding == Encoding::Cdr {
            self.position = (self.position - ENCAPSULATION).next_multiple_of(N) + ENCAPSULATION;
        }
        let mut bytes = self.take::<N>()?;
        if self.big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], EncodingError> {
        let mut array = [0; N];
        array.copy_from_slice(self.slice(N)?);
        Ok(array)
    }

    /// As many bytes, not copied.
    pub(crate) fn slice(&mut self, length: usize) -> Result<&'a [u8], EncodingError> {
        let left = self.bytes.get(self.position..).unwrap_or_default();
        let slice = left.get(..length).ok_or_else(|| {
            EncodingError::new(self.position, format!("{length} more bytes"), format!("{}", left.len()))
        })?;
        self.position += length;
        Ok(slice)
    }
}
