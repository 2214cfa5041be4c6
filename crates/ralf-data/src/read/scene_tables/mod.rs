//! Tables of scenes as nuScenes brought them up and others took them over: JSON arrays whose rows name each other by
//! tokens. Here is what formats of this kind share; what is theirs alone stands in their own folders.

mod join;
mod measurements;
mod raw;
mod rig;
#[cfg(test)]
pub(crate) mod testing;
mod version;

pub(crate) use join::{SceneRecord, Scenes, lookup, read_scenes};
pub(crate) use measurements::{Measurements, TableOrigin};
pub(crate) use raw::{EgoPoseRow, Token, for_each_row, nanoseconds};
pub(crate) use rig::Models;
pub(crate) use version::{Place, is_one, place};

/// The tables that all of these formats have.
pub(crate) const TABLES: [&str; 6] = [
    "calibrated_sensor.json",
    "ego_pose.json",
    "sample.json",
    "sample_data.json",
    "scene.json",
    "sensor.json",
];
