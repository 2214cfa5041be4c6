//! `sensor_msgs/Imu`: turn rates and accelerations.

use super::definition::{Definition, HEADER, QUATERNION, VECTOR3};
use super::{Header, Message};
use crate::encoding::{Decoder, Encoder, EncodingError};

/// What an inertial measurement unit tells. A first covariance of -1 says that the value isn't measured.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Imu {
    /// When and in which frame.
    pub header: Header,
    /// x, y, z, w.
    pub orientation: [f64; 4],
    /// Row by row.
    pub orientation_covariance: [f64; 9],
    /// rad/s.
    pub angular_velocity: [f64; 3],
    /// Row by row.
    pub angular_velocity_covariance: [f64; 9],
    /// m/s^2.
    pub linear_acceleration: [f64; 3],
    /// Row by row.
    pub linear_acceleration_covariance: [f64; 9],
}

static IMU: Definition = Definition::new(
    "sensor_msgs/Imu",
    "6a62c6daae103f4ff57a132d6f95cec2",
    "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n\
     geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n\
     geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance",
    &[&HEADER, &QUATERNION, &VECTOR3],
);

impl Message for Imu {
    const DEFINITION: &'static Definition = &IMU;

    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        Ok(Self {
            header: Header::decode(decoder)?,
            orientation: decoder.f64_array()?,
            orientation_covariance: decoder.f64_array()?,
            angular_velocity: decoder.f64_array()?,
            angular_velocity_covariance: decoder.f64_array()?,
            linear_acceleration: decoder.f64_array()?,
            linear_acceleration_covariance: decoder.f64_array()?,
        })
    }

    fn encode(&self, encoder: &mut Encoder) -> Result<(), EncodingError> {
        self.header.encode(encoder)?;
        encoder.f64_array(&self.orientation);
        encoder.f64_array(&self.orientation_covariance);
        encoder.f64_array(&self.angular_velocity);
        encoder.f64_array(&self.angular_velocity_covariance);
        encoder.f64_array(&self.linear_acceleration);
        encoder.f64_array(&self.linear_acceleration_covariance);
        Ok(())
    }
}
