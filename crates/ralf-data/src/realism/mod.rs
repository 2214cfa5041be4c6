//! What the measurements of a recording are like, and how far two recordings are apart in that: how a simulated one is
//! measured against a real one.
//!
//! [`Distributions::gather`] looks at scans spread evenly over a recording, a bounded number of them, and takes the
//! values of every [`Quantity`]: of its detections, radar scans, LiDAR points and LiDAR scans. [`Realism`] sets two
//! recordings side by side, with the [`Distance`] of each pair of distributions.

mod distance;
mod distributions;
mod free_space;
mod lidar;
mod quantity;
mod radar;
mod side_by_side;
mod values;

pub use distance::Distance;
pub use distributions::Distributions;
pub use quantity::{Description, Quantity};
pub use side_by_side::{Compared, Realism, Summary};
