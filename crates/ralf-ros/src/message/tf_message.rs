//! `tf2_msgs/TFMessage`: how frames lie to each other.

use super::definition::{Definition, HEADER, QUATERNION, VECTOR3};
use super::{Header, Message, Pose};
use crate::encoding::{Decoder, Encoder, EncodingError};

/// Transforms that were published together.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TfMessage {
    /// In no particular order.
    pub transforms: Vec<TransformStamped>,
}

/// `geometry_msgs/TransformStamped`: a child frame in its parent's.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TransformStamped {
    /// When, and the parent frame.
    pub header: Header,
    /// The child frame.
    pub child_frame_id: String,
    /// `parent_from_child`: the child's origin and orientation in the parent frame.
    pub transform: Pose,
}

static TRANSFORM: Definition = Definition::part(
    "geometry_msgs/Transform",
    "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation",
    &[&VECTOR3, &QUATERNION],
);

static TRANSFORM_STAMPED: Definition = Definition::part(
    "geometry_msgs/TransformStamped",
    "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform",
    &[&HEADER, &TRANSFORM],
);

static TF_MESSAGE: Definition = Definition::new(
    "tf2_msgs/TFMessage",
    "94810edda583a504dfda3829e70d7eec",
    "geometry_msgs/TransformStamped[] transforms",
    &[&TRANSFORM_STAMPED],
)
.earlier_called("tf/tfMessage");

impl TransformStamped {
    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        Ok(Self {
            header: Header::decode(decoder)?,
            child_frame_id: decoder.string()?,
            transform: Pose::decode(decoder)?,
        })
    }

    fn encode(&self, encoder: &mut Encoder) -> Result<(), EncodingError> {
        self.header.encode(encoder)?;
        encoder.string(&self.child_frame_id)?;
        self.transform.encode(encoder);
        Ok(())
    }
}

impl Message for TfMessage {
    const DEFINITION: &'static Definition = &TF_MESSAGE;

    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        // The least that a transform takes: a time, the lengths of two names, seven numbers.
        const TRANSFORM_BYTES: usize = 72;
        Ok(Self { transforms: decoder.list(TRANSFORM_BYTES, TransformStamped::decode)? })
    }

    fn encode(&self, encoder: &mut Encoder) -> Result<(), EncodingError> {
        encoder.list(&self.transforms, |encoder, transform| transform.encode(encoder))
    }
}
