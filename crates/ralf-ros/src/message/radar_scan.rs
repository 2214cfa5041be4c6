//! `radar_msgs/RadarScan`: detections in polar coordinates.

use super::definition::{Definition, HEADER};
use super::{Header, Message};
use crate::encoding::{Decoder, Encoder, EncodingError};

/// One scan of one radar.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RadarScan {
    /// When and in which frame.
    pub header: Header,
    /// The detections.
    pub returns: Vec<RadarReturn>,
}

/// `radar_msgs/RadarReturn`: a detection.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RadarReturn {
    /// m.
    pub range: f32,
    /// rad, positive to the left.
    pub azimuth: f32,
    /// rad, positive upwards.
    pub elevation: f32,
    /// m/s.
    pub doppler_velocity: f32,
    /// dB m^2 or dB.
    pub amplitude: f32,
}

impl RadarReturn {
    /// The names of [`Self::values`].
    pub const FIELDS: [&'static str; 5] = ["range", "azimuth", "elevation", "doppler_velocity", "amplitude"];

    /// In the order of the message.
    pub fn values(&self) -> [f32; 5] {
        [self.range, self.azimuth, self.elevation, self.doppler_velocity, self.amplitude]
    }

    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        Ok(Self {
            range: decoder.f32()?,
            azimuth: decoder.f32()?,
            elevation: decoder.f32()?,
            doppler_velocity: decoder.f32()?,
            amplitude: decoder.f32()?,
        })
    }
}

static RADAR_RETURN: Definition = Definition::part(
    "radar_msgs/RadarReturn",
    "float32 range\nfloat32 azimuth\nfloat32 elevation\nfloat32 doppler_velocity\nfloat32 amplitude",
    &[],
);

static RADAR_SCAN: Definition = Definition::new(
    "radar_msgs/RadarScan",
    "6dfacef1e665538dbd8e159d5ce7a97a",
    "std_msgs/Header header\nradar_msgs/RadarReturn[] returns",
    &[&HEADER, &RADAR_RETURN],
);

impl Message for RadarScan {
    const DEFINITION: &'static Definition = &RADAR_SCAN;

    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        let header = Header::decode(decoder)?;
        Ok(Self { header, returns: decoder.list(size_of::<RadarReturn>(), RadarReturn::decode)? })
    }

    fn encode(&self, encoder: &mut Encoder) -> Result<(), EncodingError> {
        self.header.encode(encoder)?;
        encoder.list(&self.returns, |encoder, detection| {
            detection.values().into_iter().for_each(|value| encoder.f32(value));
            Ok(())
        })
    }
}
