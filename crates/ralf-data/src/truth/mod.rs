//! What people and simulators say of detections: label files, corrections, causes, and the label that counts.

mod bound;
mod causes;
mod content;
mod corrections;
mod effective;
mod ground_truth;
mod known;
mod partly;
mod scan_id;

pub use bound::lost_sequences;
pub use causes::Causes;
pub(crate) use causes::{cause_names, check_codes, names_of_causes};
pub use content::{HeldContent, scan_content};
pub use corrections::Corrections;
pub use effective::effective_labels;
pub use ground_truth::GroundTruth;
pub use partly::{partly_corrected, told_partly_corrected};
pub use scan_id::ScanId;
