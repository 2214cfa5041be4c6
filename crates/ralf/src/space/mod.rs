//! Space and time without sensors: frames and spherical coordinates, how the vehicle moved, which times belong
//! together, and the one search for nearest points.
//!
//! | frame | axes | origin |
//! | --- | --- | --- |
//! | vehicle | x forward, y left, z up | on the ground below the rear axle's centre |
//! | radar, LiDAR | x forward (boresight), y left, z up | the sensor |
//! | camera (optical) | x right, y down, z forward | the projection centre |
//! | odom | any fixed frame in which the vehicle's poses are given | |
//!
//! Metres and radians throughout, times in whole nanoseconds. A transform carries its direction in its name:
//! `vehicle_from_radar * p_radar = p_vehicle`.

mod geometry;
mod going_on;
mod many_transforms;
mod motion;
mod neighbors;
mod recent;
pub mod sync;

pub use geometry::{Point, Spherical, Transform, Vector, check_rigid, placed, transform_from_parts};
pub use going_on::going_on;
pub(crate) use many_transforms::{LANES, ManyTransforms};
pub use motion::{EgoMotion, OdometrySample, PoseSample};
pub use neighbors::{Neighbor, NeighborIndex};
pub(crate) use recent::Recent;
