//! Recordings in and labels out: readers and writers of the formats that RALF knows.
//!
//! [`open`] recognises what a folder holds and gives a [`Recording`]: its sequences, each a [`SequenceReader`], which is a
//! [`ralf::sensors::Source`] that also knows its files. Opening checks all metadata; measurements are read when they are
//! asked for. [`write_sequence`] writes any of them in the project's own layout, without loss.
//!
//! Whatever is wrong with a file is a [`DataError`] that names the file, the place in it, what was expected and what was
//! found. Keys of no meaning and files that belong to nothing are [warnings](SequenceReader::warnings).
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

mod balance;
mod causes;
mod corrections;
pub mod depth;
mod error;
mod evaluation;
mod evidence;
pub mod export;
mod files;
mod ground_truth;
mod images;
pub mod inspection;
mod label_file;
mod layout;
mod measured_files;
mod models;
mod npy;
mod nuscenes;
mod open;
pub mod output;
mod radial;
mod recording;
pub mod ros;
pub mod run;
mod settings;
mod simulated;
#[cfg(test)]
mod testing;
mod view_of_delft;

pub use balance::{Balance, Balances};
pub use causes::Causes;
pub use corrections::Corrections;
pub use error::DataError;
pub use evaluation::Comparison;
pub use evidence::{SequenceEvidence, gather_evidence};
pub use files::write_whole;
pub use ground_truth::{GroundTruth, ScanId};
pub use images::png;
pub use label_file::{Label, read_labels, write_labels};
pub use layout::{LayoutSequence, write_sequence};
pub use open::{formats, open, open_with};
pub use recording::{NuScenesKey, Recording, RosSource, SequenceReader, TruthLabels};
pub use settings::Settings;
