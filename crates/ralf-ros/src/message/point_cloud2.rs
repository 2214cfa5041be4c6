//! `sensor_msgs/PointCloud2`: points as records of bytes, and what lies where in a record.

use super::definition::{Definition, HEADER};
use super::{Header, Message};
use crate::encoding::{Decoder, Encoder, EncodingError};

/// A cloud of points, as published; [`crate::point_cloud::PointTable`] reads its values.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PointCloud2 {
    /// When and in which frame.
    pub header: Header,
    /// Rows; 1 of a cloud without order.
    pub height: u32,
    /// Points of a row.
    pub width: u32,
    /// What lies where in a record.
    pub fields: Vec<PointField>,
    /// Byte order of the values.
    pub is_bigendian: bool,
    /// Bytes of a record.
    pub point_step: u32,
    /// Bytes of a row.
    pub row_step: u32,
    /// The records.
    pub data: Vec<u8>,
    /// Whether no point is invalid.
    pub is_dense: bool,
}

/// `sensor_msgs/PointField`: where a value lies in a record.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PointField {
    /// Unique in the cloud.
    pub name: String,
    /// Bytes from the record's beginning.
    pub offset: u32,
    /// A number that [`Datatype::from_code`] knows.
    pub datatype: u8,
    /// How many values; 0 and 1 are one.
    pub count: u32,
}

/// The type of a value of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Datatype {
    /// 1 byte with sign.
    Int8 = 1,
    /// 1 byte.
    Uint8 = 2,
    /// 2 bytes with sign.
    Int16 = 3,
    /// 2 bytes.
    Uint16 = 4,
    /// 4 bytes with sign.
    Int32 = 5,
    /// 4 bytes.
    Uint32 = 6,
    /// A float of 4 bytes.
    Float32 = 7,
    /// A float of 8 bytes.
    Float64 = 8,
}

impl Datatype {
    /// The type of this number.
    pub fn from_code(datatype: u8) -> Option<Self> {
        use Datatype::{Float32, Float64, Int8, Int16, Int32, Uint8, Uint16, Uint32};
        let all = [Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64];
        all.into_iter().find(|known| *known as u8 == datatype)
    }

    /// Bytes of a value.
    pub fn size(self) -> usize {
        match self {
            Self::Int8 | Self::Uint8 => 1,
            Self::Int16 | Self::Uint16 => 2,
            Self::Int32 | Self::Uint32 | Self::Float32 => 4,
            Self::Float64 => 8,
        }
    }
}

impl PointField {
    /// A single value.
    pub fn new(name: &str, offset: u32, datatype: Datatype) -> Self {
        Self { name: name.to_owned(), offset, datatype: datatype as u8, count: 1 }
    }

    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        Ok(Self {
            name: decoder.string()?,
            offset: decoder.u32()?,
            datatype: decoder.u8()?,
            count: decoder.u32()?,
        })
    }

    fn encode(&self, encoder: &mut Encoder) -> Result<(), EncodingError> {
        encoder.string(&self.name)?;
        encoder.u32(self.offset);
        encoder.u8(self.datatype);
        encoder.u32(self.count);
        Ok(())
    }
}

static POINT_FIELD: Definition = Definition::part(
    "sensor_msgs/PointField",
    "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n\
     uint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count",
    &[],
);

static POINT_CLOUD2: Definition = Definition::new(
    "sensor_msgs/PointCloud2",
    "1158d486dd51d683ce2f1be655c3c181",
    "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\n\
     uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense",
    &[&HEADER, &POINT_FIELD],
);

impl Message for PointCloud2 {
    const DEFINITION: &'static Definition = &POINT_CLOUD2;

    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        // The least that a field takes: a length, an offset, a datatype, a count.
        const FIELD_BYTES: usize = 13;
        Ok(Self {
            header: Header::decode(decoder)?,
            height: decoder.u32()?,
            width: decoder.u32()?,
            fields: decoder.list(FIELD_BYTES, PointField::decode)?,
            is_bigendian: decoder.bool()?,
            point_step: decoder.u32()?,
            row_step: decoder.u32()?,
            data: decoder.bytes()?.to_owned(),
            is_dense: decoder.bool()?,
        })
    }

    fn encode(&self, encoder: &mut Encoder) -> Result<(), EncodingError> {
        self.header.encode(encoder)?;
        encoder.u32(self.height);
        encoder.u32(self.width);
        encoder.list(&self.fields, |encoder, field| field.encode(encoder))?;
        encoder.bool(self.is_bigendian);
        encoder.u32(self.point_step);
        encoder.u32(self.row_step);
        encoder.bytes(&self.data)?;
        encoder.bool(self.is_dense);
        Ok(())
    }
}
