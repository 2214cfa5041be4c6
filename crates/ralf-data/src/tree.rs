//! Where things lie in the project's own tree, which recordings and results share: the one place that names them.
//!
//! Nothing here looks at what is joined. Who writes takes names that lead nowhere else ([`crate::result::Component`]).

use std::path::{Path, PathBuf};

/// The folder of a recording, of results and of a store that holds sequences.
pub const SEQUENCES: &str = "sequences";
/// What lies beside the sequences in an output folder, and in no recording.
pub const RECORD: &str = "run.json";
/// The folder beside the sequences that holds what a run keeps until the record tells of it.
pub(crate) const UNFINISHED: &str = ".ralf-run";
/// What tells who labels what, in an output folder.
pub(crate) const TEAM: &str = "team.toml";
/// The folder of second labels in an output folder.
pub(crate) const SECOND: &str = "second";
/// What tells of an output folder's run on many machines.
pub(crate) const PLAN: &str = "plan.json";
/// What labels have beside their sequences, and no recording has.
pub(crate) const MARKS_OF_LABELS: [&str; 3] = [RECORD, UNFINISHED, ralf_corrections::FILE];
/// The file in a sequence's folder that tells its sensors.
pub const SENSORS: &str = "sequence.toml";
/// The file in a sequence's folder that tells speeds and yaw rates.
pub(crate) const ODOMETRY: &str = "odometry.csv";
/// The file in a sequence's folder that tells poses.
pub(crate) const POSES: &str = "poses.csv";
/// The file in a sensor's folder that tells when it measured.
pub(crate) const TIMES: &str = "timestamps.txt";
/// The folder of a camera that holds the depth of its images.
pub(crate) const DEPTH: &str = "depth";
/// The folder of a camera that holds the classes that its images show.
pub(crate) const SEGMENTATION: &str = "segmentation";
/// The folder of a sequence that holds corrected labels.
pub(crate) const GROUND_TRUTH: &str = "ground_truth";
/// The file in it that names the causes of artifacts.
pub(crate) const CAUSE_NAMES: &str = "causes.txt";
/// The file in a labelled sequence's folder that holds its table.
pub(crate) const TABLE: &str = "plausibility.parquet";
/// The ending of files of labels.
pub(crate) const LABELS: &str = "label";

/// The folder of a sequence.
pub fn sequence_folder(root: &Path, sequence: &str) -> PathBuf {
    root.join(SEQUENCES).join(sequence)
}

/// The file that tells the sensors of a sequence of a recording.
pub fn sensors_file(root: &Path, sequence: &str) -> PathBuf {
    sequence_folder(root, sequence).join(SENSORS)
}

/// The folder of a sequence's corrected labels.
pub(crate) fn truth_folder(root: &Path, sequence: &str) -> PathBuf {
    sequence_folder(root, sequence).join(GROUND_TRUTH)
}

/// The labels that a run gave a scan of a radar.
pub(crate) fn label_file(root: &Path, sequence: &str, radar: &str, scan: usize) -> PathBuf {
    sequence_folder(root, sequence).join(radar).join(label_name(scan))
}

/// The corrected labels of a scan of a radar.
pub(crate) fn truth_file(root: &Path, sequence: &str, radar: &str, scan: usize) -> PathBuf {
    truth_folder(root, sequence).join(radar).join(label_name(scan))
}

/// The name of a scan's file of labels.
pub(crate) fn label_name(scan: usize) -> String {
    numbered(scan, LABELS)
}

/// The name of a measurement's file: `000017.bin`.
pub(crate) fn numbered(number: usize, ending: &str) -> String {
    format!("{number:06}.{ending}")
}
