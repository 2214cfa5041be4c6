//! The faults: what is planted, whose it is, and which remedy is right.

use crate::recording::Planted;
use ralf::sensors::Elevation;
use ralf_check::Remedy;

/// A fault.
pub struct Fault {
    pub name: &'static str,
    pub plant: fn(&mut Planted),
    /// Whose it is: one of these is named in the verdict that notices it.
    pub subjects: &'static [&'static str],
    /// Whether a remedy is the right one; none is asked for where none exists.
    pub remedy: Option<fn(&Remedy) -> bool>,
    /// Whether it can be seen on a straight road, too.
    pub straight: bool,
}

macro_rules! fault {
    ($name:literal, $subjects:expr, $straight:literal, $plant:expr) => {
        Fault { name: $name, plant: $plant, subjects: &$subjects, remedy: None, straight: $straight }
    };
    ($name:literal, $subjects:expr, $straight:literal, $plant:expr, $remedy:expr) => {
        Fault { name: $name, plant: $plant, subjects: &$subjects, remedy: Some($remedy), straight: $straight }
    };
}

mod clocks;
mod mountings;
mod planting;
mod right;
mod signs;
mod structure;
mod units;

pub use planting::plant;

const FRONT: usize = 0;
const LEFT: usize = 1;
const MS: i64 = 1_000_000;
const ALL_RADARS: [&str; 4] = ["radar_front", "radar_left", "radar_right", "radar_rear"];

/// All of them, numbered from 1 in this order.
pub fn faults() -> Vec<Fault> {
    [
        mountings::radars(),
        mountings::lidars(),
        mountings::cameras(),
        clocks::faults(),
        units::faults(),
        signs::faults(),
        structure::faults(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Whether radars of the simulator measure elevation: faults of elevation rely on it.
pub fn measures_elevation(p: &Planted) -> bool {
    p.sequence.rig.radars.iter().all(|radar| radar.elevation == Elevation::Measured)
}
