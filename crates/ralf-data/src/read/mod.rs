//! Recordings in: what a folder or file holds, as sequences whose measurements are read on demand. A folder per format.

mod aimotive;
mod corrected;
mod corrections;
mod file_sequence;
mod incomplete;
pub mod inspection;
mod instances;
mod last_read;
pub(crate) mod layout;
mod meanings;
mod measured_files;
mod memory;
pub(crate) mod models;
mod nuscenes;
mod nvidia;
pub(crate) mod open;
mod outside;
mod point_times;
mod radar_ghost;
mod radar_scenes;
mod radial;
pub(crate) mod recording;
pub mod ros;
mod rotation;
pub(crate) mod scene_tables;
mod truckscenes;
mod view_of_delft;
mod zod;

pub(crate) use corrected::corrected;
pub use corrections::{MotionSettings, MotionSource, SensorCorrection};
pub use incomplete::Incomplete;
pub use layout::{LayoutSequence, rig_from_json};
pub use meanings::{Meanings, meanings};
pub use open::{formats, open, open_with};
pub use outside::refuse_to_write_into;
pub use recording::{Recording, SequenceReader, TruthLabels};
