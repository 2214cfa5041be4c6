//! A LiDAR by physics: patterns of rays, glass that lets them through, leaves, dark and shiny surfaces, rain, and a
//! revolution during which the world moves.

mod optics;
mod pattern;
mod scan;

pub(super) use optics::Optics;
pub(super) use pattern::{
    CORNER, FORWARD, HDL_32, HDL_64, OS0_128, OS1_64, PANDAR_40, Pattern, VLP_16, VLS_128,
};
pub(super) use scan::{Sweep, scan};

use ralf::space::Transform;

/// A LiDAR.
#[derive(Debug, Clone)]
pub(crate) struct LidarModel {
    pub(crate) name: String,
    /// Where it really sits.
    pub(crate) vehicle_from_lidar: Transform,
    pub(crate) pattern: Pattern,
    /// Between scans, ns.
    pub(crate) period_ns: i64,
    /// Whether its points are measured one after the other during the revolution.
    pub(crate) rolling: bool,
    /// Whether it says when.
    pub(crate) timed: bool,
    pub(crate) optics: Optics,
}
