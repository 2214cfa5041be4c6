//! Whether things lie where other measurements have them: radar on LiDAR, LiDAR on LiDAR half a second later, and
//! sensors on others of their kind.

mod motion;
mod neighbours;
mod radar_lidar;
mod tally;

pub(crate) use motion::{changed_motion_overlap, motion_overlap, radar_motion_overlap};
pub(crate) use neighbours::{LidarPair, RadarPair, Side};
pub(crate) use radar_lidar::{Measure, Setup, TOGETHER_NS, obstacles_in_view, of_moment, overlap};
pub(crate) use tally::Tally;

use ralf::space::Point;
use std::ops::Range;

/// Whether a place in a radar's frame lies in these ranges and in its field of view, half of which is told, m and rad.
fn is_in_view(own: &Point, ranges: &Range<f64>, half_view: f64) -> bool {
    ranges.contains(&own.coords.norm()) && own.y.atan2(own.x).abs() < half_view
}
