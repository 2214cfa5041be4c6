//! `sensor_msgs/CameraInfo`: a camera's calibration.

use super::definition::{Definition, HEADER};
use super::{Header, Message};
use crate::encoding::{Decoder, Encoder, EncodingError};

/// How a camera maps space onto its image.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CameraInfo {
    /// When and in which frame.
    pub header: Header,
    /// Height of the calibrated image, px.
    pub height: u32,
    /// Width of the calibrated image, px.
    pub width: u32,
    /// Such as `plumb_bob`.
    pub distortion_model: String,
    /// Distortion coefficients, as the model orders them.
    pub d: Vec<f64>,
    /// The camera matrix of the raw image, row by row: fx, 0, cx; 0, fy, cy; 0, 0, 1.
    pub k: [f64; 9],
    /// Rectification, row by row.
    pub r: [f64; 9],
    /// The projection of the rectified image, row by row.
    pub p: [f64; 12],
    /// Pixels that are one in the image, along x; 0 is 1.
    pub binning_x: u32,
    /// The same along y.
    pub binning_y: u32,
    /// Which part of the calibrated image was kept.
    pub roi: RegionOfInterest,
}

/// `sensor_msgs/RegionOfInterest`; all 0 is the whole image.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct RegionOfInterest {
    /// px from the left.
    pub x_offset: u32,
    /// px from above.
    pub y_offset: u32,
    /// px.
    pub height: u32,
    /// px.
    pub width: u32,
    /// Whether it is to be rectified.
    pub do_rectify: bool,
}

static REGION_OF_INTEREST: Definition = Definition::part(
    "sensor_msgs/RegionOfInterest",
    "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify",
    &[],
);

static CAMERA_INFO: Definition = Definition::new(
    "sensor_msgs/CameraInfo",
    "c9a58c1b0b154e0e6da7578cb991d214",
    "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] D\nfloat64[9] K\n\
     float64[9] R\nfloat64[12] P\nuint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi",
    &[&HEADER, &REGION_OF_INTEREST],
)
.with_ros2_fields(
    "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\nfloat64[9] k\n\
     float64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi",
);

impl RegionOfInterest {
    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        Ok(Self {
            x_offset: decoder.u32()?,
            y_offset: decoder.u32()?,
            height: decoder.u32()?,
            width: decoder.u32()?,
            do_rectify: decoder.bool()?,
        })
    }

    fn encode(&self, encoder: &mut Encoder) {
        [self.x_offset, self.y_offset, self.height, self.width]
            .into_iter()
            .for_each(|value| encoder.u32(value));
        encoder.bool(self.do_rectify);
    }
}

impl Message for CameraInfo {
    const DEFINITION: &'static Definition = &CAMERA_INFO;

    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        Ok(Self {
            header: Header::decode(decoder)?,
            height: decoder.u32()?,
            width: decoder.u32()?,
            distortion_model: decoder.string()?,
            d: decoder.list(size_of::<f64>(), Decoder::f64)?,
            k: decoder.f64_array()?,
            r: decoder.f64_array()?,
            p: decoder.f64_array()?,
            binning_x: decoder.u32()?,
            binning_y: decoder.u32()?,
            roi: RegionOfInterest::decode(decoder)?,
        })
    }

    fn encode(&self, encoder: &mut Encoder) -> Result<(), EncodingError> {
        self.header.encode(encoder)?;
        encoder.u32(self.height);
        encoder.u32(self.width);
        encoder.string(&self.distortion_model)?;
        encoder.list(&self.d, |encoder, value| {
            encoder.f64(*value);
            Ok(())
        })?;
        encoder.f64_array(&self.k);
        encoder.f64_array(&self.r);
        encoder.f64_array(&self.p);
        encoder.u32(self.binning_x);
        encoder.u32(self.binning_y);
        self.roi.encode(encoder);
        Ok(())
    }
}
