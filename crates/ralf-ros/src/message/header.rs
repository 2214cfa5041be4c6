//! `std_msgs/Header`: when and in which frame.

use super::Message;
use super::definition::{Definition, HEADER};
use crate::encoding::{Decoder, Encoder, Encoding, EncodingError};

const SECOND_NS: i64 = 1_000_000_000;

/// When and in which frame something was measured.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Header {
    /// A running number; ROS 2 has none, and it is 0 there.
    pub seq: u32,
    /// The sensor's own time, ns.
    pub stamp_ns: i64,
    /// The frame of the values.
    pub frame_id: String,
}

impl Message for Header {
    const DEFINITION: &'static Definition = &HEADER;

    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        let seq = if decoder.encoding() == Encoding::Ros1 { decoder.u32()? } else { 0 };
        Ok(Self { seq, stamp_ns: decode_time(decoder)?, frame_id: decoder.string()? })
    }

    fn encode(&self, encoder: &mut Encoder) -> Result<(), EncodingError> {
        if encoder.encoding() == Encoding::Ros1 {
            encoder.u32(self.seq);
        }
        encode_time(self.stamp_ns, encoder)?;
        encoder.string(&self.frame_id)
    }
}

/// Seconds, which have a sign in ROS 2 only, and nanoseconds.
fn decode_time(decoder: &mut Decoder<'_>) -> Result<i64, EncodingError> {
    let seconds = match decoder.encoding() {
        Encoding::Ros1 => i64::from(decoder.u32()?),
        Encoding::Cdr => i64::from(decoder.i32()?),
    };
    Ok(seconds * SECOND_NS + i64::from(decoder.u32()?))
}

fn encode_time(t_ns: i64, encoder: &mut Encoder) -> Result<(), EncodingError> {
    let seconds = t_ns.div_euclid(SECOND_NS);
    let outside = |range: &str| EncodingError::new(0, format!("a time of {range}"), format!("{seconds} s"));
    match encoder.encoding() {
        Encoding::Ros1 => encoder.u32(u32::try_from(seconds).map_err(|_| outside("0 to 2^32 - 1 s"))?),
        Encoding::Cdr => encoder.i32(i32::try_from(seconds).map_err(|_| outside("-2^31 to 2^31 - 1 s"))?),
    }
    // Below 10^9, and so within 32 bits.
    encoder.u32(t_ns.rem_euclid(SECOND_NS) as u32);
    Ok(())
}
