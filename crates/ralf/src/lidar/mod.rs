//! The LiDAR's answer: is there a surface where the radar saw something? (METHOD 4 and 6)

mod blind_spot;
mod floor;
pub mod ground;
mod matching;
mod moment;

pub use blind_spot::in_blind_spot;
pub use floor::LocalGround;
pub use matching::{LidarMatch, match_detections};
pub(crate) use moment::sees_height_of;
pub use moment::{LidarMoment, LidarView};
