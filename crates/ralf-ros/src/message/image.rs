//! `sensor_msgs/Image`: pixels as they are.

use super::definition::{Definition, HEADER};
use super::{Header, Message};
use crate::encoding::{Decoder, Encoder, EncodingError};

/// An image without compression.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Image {
    /// When and in which frame.
    pub header: Header,
    /// px.
    pub height: u32,
    /// px.
    pub width: u32,
    /// What a pixel is, such as `rgb8`.
    pub encoding: String,
    /// Byte order of values of more than one byte.
    pub is_bigendian: bool,
    /// Bytes of a row.
    pub step: u32,
    /// The rows, from above.
    pub data: Vec<u8>,
}

static IMAGE: Definition = Definition::new(
    "sensor_msgs/Image",
    "060021388200f6f0f447d0fcd9c64743",
    "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\n\
     uint8[] data",
    &[&HEADER],
);

impl Message for Image {
    const DEFINITION: &'static Definition = &IMAGE;

    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        Ok(Self {
            header: Header::decode(decoder)?,
            height: decoder.u32()?,
            width: decoder.u32()?,
            encoding: decoder.string()?,
            is_bigendian: decoder.bool()?,
            step: decoder.u32()?,
            data: decoder.bytes()?.to_owned(),
        })
    }

    fn encode(&self, encoder: &mut Encoder) -> Result<(), EncodingError> {
        self.header.encode(encoder)?;
        encoder.u32(self.height);
        encoder.u32(self.width);
        encoder.string(&self.encoding)?;
        encoder.bool(self.is_bigendian);
        encoder.u32(self.step);
        encoder.bytes(&self.data)
    }
}
