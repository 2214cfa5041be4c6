//! The message types that a radar recording is made of, each written down once for ROS 1 and ROS 2.
//!
//! Where the two differ, the type itself asks [`Decoder::encoding`]: only the header does, by its `seq`.

mod camera_info;
mod compressed_image;
mod definition;
mod geometry;
mod header;
mod image;
mod imu;
mod odometry;
mod point_cloud2;
mod radar_scan;
mod tf_message;
mod twist_stamped;

use crate::encoding::{Decoder, Encoder, Encoding, EncodingError};
pub use camera_info::{CameraInfo, RegionOfInterest};
pub use compressed_image::CompressedImage;
pub use definition::Definition;
pub use geometry::{Pose, Twist};
pub use header::Header;
pub use image::Image;
pub use imu::Imu;
pub use odometry::Odometry;
pub use point_cloud2::{Datatype, PointCloud2, PointField};
pub use radar_scan::{RadarReturn, RadarScan};
pub use tf_message::{TfMessage, TransformStamped};
pub use twist_stamped::TwistStamped;

/// A message type.
pub trait Message: Sized {
    /// Its name, fields and checksum.
    const DEFINITION: &'static Definition;

    /// Reads the values from the decoder's place on.
    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError>;

    /// Writes the values; refused where they don't fit, such as a time before 1970 in ROS 1.
    fn encode(&self, encoder: &mut Encoder) -> Result<(), EncodingError>;

    /// A whole message; bytes that are left over are refused.
    fn from_bytes(encoding: Encoding, bytes: &[u8]) -> Result<Self, EncodingError> {
        let mut decoder = Decoder::new(encoding, bytes)?;
        let message = Self::decode(&mut decoder)?;
        decoder.finish()?;
        Ok(message)
    }

    /// A whole message.
    fn to_bytes(&self, encoding: Encoding) -> Result<Vec<u8>, EncodingError> {
        let mut encoder = Encoder::new(encoding);
        self.encode(&mut encoder)?;
        Ok(encoder.finish())
    }
}

/// All types of this module.
pub const DEFINITIONS: [&Definition; 9] = [
    CameraInfo::DEFINITION,
    CompressedImage::DEFINITION,
    Image::DEFINITION,
    Imu::DEFINITION,
    Odometry::DEFINITION,
    PointCloud2::DEFINITION,
    RadarScan::DEFINITION,
    TfMessage::DEFINITION,
    TwistStamped::DEFINITION,
];

/// The header of a message of any type that begins with one, without reading the rest.
pub fn peek_header(encoding: Encoding, bytes: &[u8]) -> Result<Header, EncodingError> {
    Header::decode(&mut Decoder::new(encoding, bytes)?)
}
