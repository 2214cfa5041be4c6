//! How values lie in a message: one after the other in ROS 1, aligned in CDR.
//!
//! | | ROS 1 | CDR (ROS 2) |
//! | --- | --- | --- |
//! | before the first value | nothing | 4 bytes: 0, the representation, 2 options |
//! | byte order | little | as the representation says: 0 big, 1 little |
//! | alignment | none | each number to its own size, counted from the fifth byte |
//! | strings | length, bytes | length with the final 0, bytes, 0 |
//! | lists | length, values | length, values |
//!
//! Source: ROS 1 `roscpp` serialization; OMG DDSI-RTPS 2.3, 10 (`PLAIN_CDR`, version 1).

mod decoder;
mod encoder;

pub use decoder::Decoder;
pub use encoder::Encoder;
use thiserror::Error;

/// How the messages of a topic are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// As ROS 1 serializes.
    Ros1,
    /// As ROS 2 serializes.
    Cdr,
}

/// Why a message has no meaning, or can't be written.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("byte {position}: expected {expected}, found {found}")]
pub struct EncodingError {
    /// Bytes from the beginning of the message.
    pub position: usize,
    /// What the type asks for.
    pub expected: String,
    /// What is there.
    pub found: String,
}

impl Encoding {
    /// By the name that recordings have for it; `None` of what this program can't read.
    pub(crate) fn named(name: &str) -> Option<Self> {
        match name {
            "ros1" => Some(Self::Ros1),
            "cdr" => Some(Self::Cdr),
            _ => None,
        }
    }
}

impl EncodingError {
    pub(crate) fn new(position: usize, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self { position, expected: expected.into(), found: found.into() }
    }
}

/// Bytes before the first value of a CDR message.
const ENCAPSULATION: usize = 4;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cdr_aligns_each_number_counted_from_the_fifth_byte() {
        let mut encoder = Encoder::new(Encoding::Cdr);
        encoder.u8(7);
        encoder.f64(1.0);
        encoder.string("ab").unwrap();
        encoder.u16(5);
        let bytes = encoder.finish();
        let mut expected = vec![0, 1, 0, 0, 7, 0, 0, 0, 0, 0, 0, 0];
        expected.extend(1.0f64.to_le_bytes());
        expected.extend([3, 0, 0, 0, b'a', b'b', 0, 0, 5, 0]);
        assert_eq!(bytes, expected);
        let mut decoder = Decoder::new(Encoding::Cdr, &bytes).unwrap();
        assert_eq!((decoder.u8(), decoder.f64()), (Ok(7), Ok(1.0)));
        assert_eq!((decoder.string(), decoder.u16()), (Ok("ab".to_owned()), Ok(5)));
        assert_eq!(decoder.finish(), Ok(()));
    }

    #[test]
    fn ros1_packs_and_has_no_final_zero() {
        let mut encoder = Encoder::new(Encoding::Ros1);
        encoder.u8(7);
        encoder.string("ab").unwrap();
        encoder.u32(9);
        assert_eq!(encoder.finish(), [7, 2, 0, 0, 0, b'a', b'b', 9, 0, 0, 0]);
    }

    #[test]
    fn big_endian_is_read_as_the_first_bytes_say() {
        let bytes = [0, 0, 0, 0, 1, 0, 0, 0, 0x3f, 0x80, 0, 0, 0, 2];
        let mut decoder = Decoder::new(Encoding::Cdr, &bytes).unwrap();
        assert_eq!((decoder.u8(), decoder.f32(), decoder.u16()), (Ok(1), Ok(1.0), Ok(2)));
    }

    #[test]
    fn lengths_beyond_the_message_are_refused_before_anything_is_allocated() {
        let bytes = [0xff, 0xff, 0xff, 0xff, 1, 2];
        let decoder = || Decoder::new(Encoding::Ros1, &bytes).unwrap();
        assert!(decoder().string().is_err() && decoder().bytes().is_err());
        let error = decoder().list(1, Decoder::u8).unwrap_err();
        assert_eq!(
            error.to_string(),
            "byte 0: expected a list that fits into the 2 bytes left, found 4294967295 entries"
        );
    }

    #[test]
    fn what_is_no_message_is_told() {
        let error = |bytes: &[u8]| Decoder::new(Encoding::Cdr, bytes).unwrap_err().to_string();
        assert_eq!(error(&[0, 7, 0, 0]), "byte 0: expected plain CDR (0 or 1), found representation 7");
        assert!(error(&[0, 1]).contains("4 more bytes"));
        let mut decoder = Decoder::new(Encoding::Ros1, &[1, 0, 0, 0, 0xff, 9]).unwrap();
        assert_eq!(
            decoder.string().unwrap_err().to_string(),
            "byte 4: expected UTF-8 text, found other bytes"
        );
        assert_eq!(
            decoder.finish().unwrap_err().to_string(),
            "byte 5: expected the end of the message, found 1 more bytes"
        );
    }
}
