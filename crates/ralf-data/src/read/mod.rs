//! Recordings in: what a folder or file holds, as sequences whose measurements are read on demand. A folder per format.

mod aimotive;
mod corrected;
mod corrections;
pub mod inspection;
mod instances;
mod last_read;
pub(crate) mod layout;
mod measured_files;
mod memory;
pub(crate) mod models;
pub(crate) mod nuscenes;
mod nvidia;
pub(crate) mod open;
mod radar_ghost;
mod radar_scenes;
mod radial;
pub(crate) mod recording;
pub mod ros;
mod rotation;
mod view_of_delft;

pub(crate) use corrected::corrected;
pub use corrections::{MotionSettings, MotionSource, SensorCorrection};
pub use layout::LayoutSequence;
pub use open::{formats, open, open_with};
pub use recording::{Recording, SequenceReader, TruthLabels};
