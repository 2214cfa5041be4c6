//! The corrected labels of a dataset: `sequences/NAME/ground_truth/RADAR/NNNNNN.label` (FORMATS 1).

use crate::label_file::{Label, read_labels};
use crate::{DataError, files};
use std::fmt;
use std::path::{Path, PathBuf};

const EXTENSION: &str = "label";

/// Which scan of which radar of which sequence. Ordered by these.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct ScanId {
    /// The sequence's folder.
    pub sequence: String,
    /// The radar's folder.
    pub radar: String,
    /// The number in the file's name.
    pub scan: u32,
}

impl ScanId {
    /// Where the labels that a run gave this scan lie below its folder.
    pub fn label_file(&self, out: &Path) -> PathBuf {
        out.join("sequences").join(&self.sequence).join(&self.radar).join(label_name(self.scan))
    }

    /// Where its corrected labels lie below the dataset's folder.
    pub fn truth_file(&self, dataset: &Path) -> PathBuf {
        let sequence = dataset.join("sequences").join(&self.sequence);
        sequence.join("ground_truth").join(&self.radar).join(label_name(self.scan))
    }
}

impl fmt::Display for ScanId {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}/{}/{:06}", self.sequence, self.radar, self.scan)
    }
}

fn label_name(scan: u32) -> String {
    format!("{scan:06}.{EXTENSION}")
}

/// What people say of a dataset's detections. The one place to ask: further layers of corrections are to be merged here.
#[derive(Debug, Clone)]
pub struct GroundTruth {
    dataset: PathBuf,
    scans: Vec<ScanId>,
}

impl GroundTruth {
    /// Finds all scans with truth below a dataset's folder; none at all is an error. Only label files are needed.
    pub fn open(dataset: &Path) -> Result<Self, DataError> {
        let sequences = dataset.join("sequences");
        let mut scans = Vec::new();
        for sequence in files::folders(&sequences)? {
            let truth = sequences.join(&sequence).join("ground_truth");
            for radar in files::folders(&truth)? {
                let numbers = scan_numbers(&truth.join(&radar))?;
                let id = |scan| ScanId { sequence: sequence.clone(), radar: radar.clone(), scan };
                scans.extend(numbers.into_iter().map(id));
            }
        }
        if scans.is_empty() {
            let place = format!("*/ground_truth/*/NNNNNN.{EXTENSION}");
            return Err(DataError::content(&sequences, place, "files of corrected labels", "none"));
        }
        scans.sort_unstable();
        Ok(Self { dataset: dataset.to_owned(), scans })
    }

    /// The scans with truth, in order.
    pub fn scans(&self) -> &[ScanId] {
        &self.scans
    }

    /// The corrected labels of a scan, one per detection.
    pub fn labels(&self, scan: &ScanId) -> Result<Vec<Label>, DataError> {
        read_labels(&self.file(scan))
    }

    /// Where they are read from.
    pub(crate) fn file(&self, scan: &ScanId) -> PathBuf {
        scan.truth_file(&self.dataset)
    }
}

/// The numbers of a folder's label files, which must be named as the format says.
fn scan_numbers(folder: &Path) -> Result<Vec<u32>, DataError> {
    let names = files::names(folder)?;
    let labels =
        names.iter().filter(|name| Path::new(name).extension().is_some_and(|found| found == EXTENSION));
    labels
        .map(|name| {
            let number = Path::new(name).file_stem().and_then(|stem| stem.to_str()?.parse().ok());
            number.filter(|number| label_name(*number) == *name).ok_or_else(|| {
                DataError::content(folder, "file names", format!("NNNNNN.{EXTENSION}"), format!("`{name}`"))
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::label_file::write_labels;
    use std::fs;

    fn put(dataset: &Path, name: &str) {
        write_labels(&dataset.join("sequences").join(name), &[Label::of_class(99)]).unwrap();
    }

    #[test]
    fn scans_are_found_in_order_and_other_files_let_be() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["01/ground_truth/b/000000", "00/ground_truth/b/1000000", "00/ground_truth/b/000010"] {
            put(folder.path(), &format!("{name}.label"));
        }
        put(folder.path(), "00/ground_truth/a/000007.label");
        put(folder.path(), "00/lidar_top/000000.label");
        fs::write(folder.path().join("sequences/00/ground_truth/a/notes.txt"), "mine").unwrap();
        fs::write(folder.path().join("sequences/00/ground_truth/a/.000008.label"), "hidden").unwrap();
        fs::write(folder.path().join("sequences/README"), "mine").unwrap();
        let truth = GroundTruth::open(folder.path()).unwrap();
        let names: Vec<String> = truth.scans().iter().map(ScanId::to_string).collect();
        assert_eq!(names, ["00/a/000007", "00/b/000010", "00/b/1000000", "01/b/000000"]);
        assert_eq!(truth.labels(&truth.scans()[0]).unwrap(), [Label::of_class(99)]);
    }

    #[test]
    fn no_truth_names_the_folder_looked_in() {
        let folder = tempfile::tempdir().unwrap();
        let refusal = || GroundTruth::open(folder.path()).unwrap_err().to_string();
        let expected =
            "sequences: */ground_truth/*/NNNNNN.label: expected files of corrected labels, found none";
        assert!(refusal().ends_with(expected), "{}", refusal());
        fs::create_dir_all(folder.path().join("sequences/00/ground_truth/radar_front")).unwrap();
        assert!(refusal().ends_with(expected), "{}", refusal());
    }

    #[test]
    fn a_file_with_another_name_is_named() {
        for name in ["7.label", "0000007.label", "+00007.label", "first.label"] {
            let folder = tempfile::tempdir().unwrap();
            put(folder.path(), &format!("00/ground_truth/radar_front/{name}"));
            let error = GroundTruth::open(folder.path()).unwrap_err().to_string();
            assert!(error.ends_with(&format!("expected NNNNNN.label, found `{name}`")), "{error}");
        }
    }
}
