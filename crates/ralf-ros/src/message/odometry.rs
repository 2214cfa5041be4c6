//! `nav_msgs/Odometry`: where a vehicle is and how it moves.

use super::definition::{Definition, HEADER, QUATERNION, TWIST};
use super::{Header, Message, Pose, Twist};
use crate::encoding::{Decoder, Encoder, EncodingError};

/// A pose in the header's frame and a twist in the child frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Odometry {
    /// When, and the frame of the pose.
    pub header: Header,
    /// The frame whose pose and twist these are.
    pub child_frame_id: String,
    /// The child frame in the header's.
    pub pose: Pose,
    /// Row by row; all 0 is not known.
    pub pose_covariance: [f64; 36],
    /// In the child frame.
    pub twist: Twist,
    /// Row by row; all 0 is not known.
    pub twist_covariance: [f64; 36],
}

impl Default for Odometry {
    fn default() -> Self {
        Self {
            header: Header::default(),
            child_frame_id: String::new(),
            pose: Pose::default(),
            pose_covariance: [0.0; 36],
            twist: Twist::default(),
            twist_covariance: [0.0; 36],
        }
    }
}

static POINT: Definition = Definition::part("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z", &[]);

static POSE: Definition = Definition::part(
    "geometry_msgs/Pose",
    "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation",
    &[&POINT, &QUATERNION],
);

static POSE_WITH_COVARIANCE: Definition = Definition::part(
    "geometry_msgs/PoseWithCovariance",
    "geometry_msgs/Pose pose\nfloat64[36] covariance",
    &[&POSE],
);

static TWIST_WITH_COVARIANCE: Definition = Definition::part(
    "geometry_msgs/TwistWithCovariance",
    "geometry_msgs/Twist twist\nfloat64[36] covariance",
    &[&TWIST],
);

static ODOMETRY: Definition = Definition::new(
    "nav_msgs/Odometry",
    "cd5e73d190d741a2f92e81eda573aca7",
    "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n\
     geometry_msgs/TwistWithCovariance twist",
    &[&HEADER, &POSE_WITH_COVARIANCE, &TWIST_WITH_COVARIANCE],
);

impl Message for Odometry {
    const DEFINITION: &'static Definition = &ODOMETRY;

    fn decode(decoder: &mut Decoder<'_>) -> Result<Self, EncodingError> {
        Ok(Self {
            header: Header::decode(decoder)?,
            child_frame_id: decoder.string()?,
            pose: Pose::decode(decoder)?,
            pose_covariance: decoder.f64_array()?,
            twist: Twist::decode(decoder)?,
            twist_covariance: decoder.f64_array()?,
        })
    }

    fn encode(&self, encoder: &mut Encoder) -> Result<(), EncodingError> {
        self.header.encode(encoder)?;
        encoder.string(&self.child_frame_id)?;
        self.pose.encode(encoder);
        encoder.f64_array(&self.pose_covariance);
        self.twist.encode(encoder);
        encoder.f64_array(&self.twist_covariance);
        Ok(())
    }
}
