//! Recordings in and labels out: readers and writers of the formats that RALF knows.
//!
//! [`open`] recognises what a folder holds and gives a [`Recording`]: its sequences, each a [`SequenceReader`], which
//! is a [`ralf::sensors::Source`] that also knows its files. Opening checks all metadata; measurements are read when
//! they are asked for. [`write_sequence`] writes any of them in the project's own layout, without loss.
//!
//! Whatever is wrong with a file is a [`DataError`] that names the file, the place in it, what was expected and what
//! was found. Keys of no meaning and files that belong to nothing are [warnings](SequenceReader::warnings).
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
//! let recording = ralf_data::open("recordings/town".as_ref(), None)?;
//! for sequence in &recording.sequences {
//!     let scan = sequence.radar_scan(0, 0)?;
//!     assert_eq!(scan.t_ns, sequence.sequence().times.radars[0][0]);
//! }
//! # Ok(())
//! # }
//! ```

mod disk;
mod error;
mod frames;
pub mod judge;
pub mod many;
mod mismatches;
mod not_used;
pub mod read;
pub mod realism;
pub mod result;
pub mod run;
mod settings;
mod stretches;
pub mod team;
#[cfg(test)]
mod testing;
pub mod things;
mod training;
mod tree;
pub mod truth;
pub mod views;
pub mod words;
pub mod write;

pub use disk::edited::{refuse_edited, write_editable};
pub use disk::files::{check_writable, write_named, write_whole};
pub use disk::images::png;
pub use disk::label_file::{Label, read_labels, write_labels};
pub use disk::real_path::real_path;
pub use error::DataError;
pub use frames::ScanIndex;
pub use judge::{Balance, Balances, Comparison};
pub use mismatches::{SequenceMismatches, gather_mismatches};
pub use not_used::NotUsed;
pub use ralf_corrections::ContentHash;
pub use read::{
    LayoutSequence, MotionSettings, Recording, SensorCorrection, SequenceReader, TruthLabels, formats, open,
    open_selected, open_with,
};
pub use result::program;
pub use settings::Settings;
pub use training::{TrainingGatherer, TrainingTruth};
pub use tree::{RECORD, SENSORS, SEQUENCES, sensors_file, sequence_folder};
pub use truth::{
    Causes, Corrections, GroundTruth, HeldContent, ScanId, lost_sequences, partly_corrected, scan_content,
    told_partly_corrected,
};
pub use write::{has_sequence, has_whole_sequence, write_sequence, write_sequence_with};
