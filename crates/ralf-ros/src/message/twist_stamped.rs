//! `geometry_msgs/TwistStamped`: how a vehicle moves.

use super::definition::{Definition, HEADER, TWIST};
use super::{Header, Message, Twist};
use crate::encoding::{Decoder, Encoder, EncodingError};

/// A twist in the header's frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TwistStamped {
    /// When and in which frame.
    pub header: Header,
    /// Velocity and turn rate.
    pub twist: Twist,
}

static TWIST_STAMPED: Definition = Definition::new(
    "geometry_msgs/TwistStamped",
    "98d34b0043a2093cf9d9345ab6eef12e",
    "std_msgs/Header header\ngeometry_msgs/Twist twist",
    &[&HEADER, &TWIST],
);

impl Message for TwistStamped {
    const DEFINITION: &'static Definition = &TWIST_STAMPED;

    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        Ok(Self { header: Header::decode(decoder)?, twist: Twist::decode(decoder)? })
    }

    fn encode(&self, encoder: &mut Encoder) -> Result<(), EncodingError> {
        self.header.encode(encoder)?;
        self.twist.encode(encoder);
        Ok(())
    }
}
