//! `geometry_msgs`: the parts that other messages are made of.

use crate::encoding::{Decoder, Encoder, EncodingError};

/// `geometry_msgs/Pose`, and `geometry_msgs/Transform`, whose values lie the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// x, y, z, m.
    pub position: [f64; 3],
    /// x, y, z, w.
    pub orientation: [f64; 4],
}

impl Default for Pose {
    fn default() -> Self {
        Self { position: [0.0; 3], orientation: [0.0, 0.0, 0.0, 1.0] }
    }
}

impl Pose {
    pub(super) fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        Ok(Self { position: decoder.f64_array()?, orientation: decoder.f64_array()? })
    }

    pub(super) fn encode(&self, encoder: &mut Encoder) {
        encoder.f64_array(&self.position);
        encoder.f64_array(&self.orientation);
    }
}

/// `geometry_msgs/Twist`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Twist {
    /// m/s.
    pub linear: [f64; 3],
    /// rad/s.
    pub angular: [f64; 3],
}

impl Twist {
    pub(super) fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        Ok(Self { linear: decoder.f64_array()?, angular: decoder.f64_array()? })
    }

    pub(super) fn encode(&self, encoder: &mut Encoder) {
        encoder.f64_array(&self.linear);
        encoder.f64_array(&self.angular);
    }
}
