//! `sensor_msgs/CompressedImage`: an image file in a message.

use super::definition::{Definition, HEADER};
use super::{Header, Message};
use crate::encoding::{Decoder, Encoder, EncodingError};

/// An image as JPEG, PNG or another kind of file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CompressedImage {
    /// When and in which frame.
    pub header: Header,
    /// The kind of file, such as `jpeg` or `bgr8; jpeg compressed bgr8`.
    pub format: String,
    /// The file.
    pub data: Vec<u8>,
}

static COMPRESSED_IMAGE: Definition = Definition::new(
    "sensor_msgs/CompressedImage",
    "8f7a12909da2c9d3332d540a0977563f",
    "std_msgs/Header header\nstring format\nuint8[] data",
    &[&HEADER],
);

impl Message for CompressedImage {
    const DEFINITION: &'static Definition = &COMPRESSED_IMAGE;

    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        let header = Header::decode(decoder)?;
        Ok(Self { header, format: decoder.string()?, data: decoder.bytes()?.to_owned() })
    }

    fn encode(&self, encoder: &mut Encoder) -> Result<(), EncodingError> {
        self.header.encode(encoder)?;
        encoder.string(&self.format)?;
        encoder.bytes(&self.data)
    }
}
