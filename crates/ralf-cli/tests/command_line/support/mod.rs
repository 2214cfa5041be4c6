//! What all tests share: recordings, the program, and what it leaves on disk.

mod dataset;
mod foreign;
#[path = "../../../../ralf-data/src/disk/hdf5/writing.rs"]
#[allow(dead_code, reason = "the tests of the reader use all of it")]
mod hdf5;
#[cfg(feature = "depth")]
#[allow(dead_code, reason = "the tests of its crate use all of it")]
#[path = "../../../../ralf-depth/src/testing.rs"]
pub(crate) mod network;
#[cfg(unix)]
mod nobody;
mod program;
mod python;
#[path = "../../../../ralf-data/src/read/radar_ghost/tests/recording.rs"]
#[allow(dead_code, reason = "the tests of the reader use all of it")]
pub(crate) mod radar_ghost;
#[path = "../../../../ralf-data/src/read/radar_scenes/tests/recording.rs"]
#[allow(dead_code, reason = "the tests of the reader use all of it")]
pub(crate) mod radar_scenes;
mod ros_topics;
mod table;
mod tree;
mod world;

pub(crate) use dataset::{Dataset, Shape};
pub(crate) use foreign::{nuscenes, nuscenes_named, view_of_delft};
#[cfg(unix)]
pub(crate) use nobody::as_nobody;
pub(crate) use program::{Ran, program, ralf};
pub(crate) use python::read_export;
pub(crate) use ros_topics::ROS_TOPICS;
pub(crate) use table::{Row, rows, schema};
pub(crate) use tree::{Tree, put, tree, without_timings};
pub(crate) use world::{ARTIFACT, CAR, WALL};
