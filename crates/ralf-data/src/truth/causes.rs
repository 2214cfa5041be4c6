//! What is behind each artifact, where a dataset knows it: a simulator does, people seldom.
//!
//! `sequences/NAME/ground_truth/causes.txt` names the causes, one per line: line n (from 0) is code n, and line 0 is
//! `none`. `sequences/NAME/ground_truth/RADAR/NNNNNN.cause` beside a `.label` file holds one uint8 per detection, the
//! code. Formats that tell causes have [numbers of their own](ralf::label::Cause) for them.

use super::known::KnownTruth;
use crate::disk::files;
use crate::error::DataError;
use crate::tree::{CAUSE_NAMES, truth_folder};
use crate::truth::scan_id::ScanId;
use ralf_files::Kind;
use std::path::{Path, PathBuf};

/// The name of code 0.
const NONE: &str = "none";

/// The names in a file that lists them.
///
/// # Errors
/// An empty list or name, more names than codes, a first name other than `none`, or a file that can't be read.
pub(crate) fn cause_names(file: &Path) -> Result<Vec<String>, DataError> {
    names_of_causes(file, &files::read_text(file, Kind::Settings)?)
}

/// The names in a file that lists them, whose text this is.
///
/// # Errors
/// Those of [`cause_names`], but for reading.
pub(crate) fn names_of_causes(file: &Path, text: &str) -> Result<Vec<String>, DataError> {
    let names: Vec<String> = text.lines().map(|name| name.trim().to_owned()).collect();
    let refuse = |line: usize, expected: &str, found: &str| {
        Err(DataError::content(file, format!("line {line}"), expected, format!("`{found}`")))
    };
    match names.first() {
        Some(first) if first == NONE => {}
        first => return refuse(1, "`none`, the name of code 0", first.map_or("", String::as_str)),
    }
    if let Some(empty) = names.iter().position(String::is_empty) {
        return refuse(empty + 1, "the name of a cause", "");
    }
    if let Some(name) = names.get(usize::from(u8::MAX) + 1) {
        return refuse(257, "at most 256 names", name);
    }
    Ok(names)
}

/// The causes of one sequence's artifacts.
#[derive(Debug, Clone)]
pub struct Causes {
    told: Told,
    names: Vec<String>,
}

/// Who tells the codes.
#[derive(Debug, Clone)]
enum Told {
    /// Files below this dataset.
    Files(PathBuf),
    /// The recording's format.
    Format(KnownTruth),
}

impl Causes {
    /// Reads the names of a sequence's causes; `None` where it has none.
    ///
    /// # Errors
    /// An empty list or name, more names than codes, a first name other than `none`, or a file that can't be read.
    pub fn find(dataset: &Path, sequence: &str) -> Result<Option<Self>, DataError> {
        let file = truth_folder(dataset, sequence).join(CAUSE_NAMES);
        if !files::exists(&file)? {
            return Ok(None);
        }
        let names = cause_names(&file)?;
        Ok(Some(Self { told: Told::Files(dataset.to_owned()), names }))
    }

    /// The causes that a format tells; `None` of a sequence in which it tells none apart.
    pub(super) fn known(known: &KnownTruth, sequence: &str) -> Option<Self> {
        let names = known.causes(sequence);
        (!names.is_empty()).then(|| Self { told: Told::Format(known.clone()), names })
    }

    /// The name of each code; that of code 0 is `none`.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The codes of a scan with so many detections; `None` where the scan has no such file.
    ///
    /// # Errors
    /// Another number of codes, or a code without a name.
    pub fn of_scan(&self, scan: &ScanId, detections: usize) -> Result<Option<Vec<u8>>, DataError> {
        let (file, codes) = match &self.told {
            Told::Files(dataset) => {
                let file = scan.truth_file(dataset).with_extension("cause");
                if !files::exists(&file)? {
                    return Ok(None);
                }
                let codes = files::read(&file)?;
                (file, codes)
            }
            Told::Format(known) => {
                let Some(truth) = known.of_scan(scan)? else { return Ok(None) };
                (known.file(&scan.sequence), truth.causes)
            }
        };
        check_codes(&file, &codes, detections, self.names.len())?;
        Ok(Some(codes))
    }
}

/// Refuses another number of codes than there are detections, and a code without one of so many names.
pub(crate) fn check_codes(
    file: &Path,
    codes: &[u8],
    detections: usize,
    names: usize,
) -> Result<(), DataError> {
    if codes.len() != detections {
        let expected = format!("{detections}, one for each detection of its scan");
        return Err(DataError::content(file, "number of codes", expected, codes.len().to_string()));
    }
    let Some(row) = codes.iter().position(|code| usize::from(*code) >= names) else { return Ok(()) };
    let expected = format!("a code below {names}, as in {CAUSE_NAMES}");
    Err(DataError::content(file, format!("byte {row}"), expected, codes[row].to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::write;

    fn find(names: &str) -> Result<Option<Causes>, DataError> {
        let folder = tempfile::tempdir().unwrap();
        write(&folder.path().join("sequences/00/ground_truth/causes.txt"), names.as_bytes());
        Causes::find(folder.path(), "00")
    }

    #[test]
    fn codes_have_names() {
        let folder = tempfile::tempdir().unwrap();
        assert!(Causes::find(folder.path(), "00").unwrap().is_none());
        let truth = folder.path().join("sequences/00/ground_truth");
        write(&truth.join("causes.txt"), b"none\nclutter\nmultipath\n");
        write(&truth.join("front/000003.cause"), &[0, 2, 1]);
        let causes = Causes::find(folder.path(), "00").unwrap().unwrap();
        assert_eq!(causes.names(), ["none", "clutter", "multipath"]);
        let scan = |scan| ScanId { sequence: "00".into(), radar: "front".into(), scan };
        assert_eq!(causes.of_scan(&scan(3), 3).unwrap(), Some(vec![0, 2, 1]));
        assert_eq!(causes.of_scan(&scan(4), 3).unwrap(), None);
        let error = causes.of_scan(&scan(3), 4).unwrap_err().to_string();
        assert!(
            error.ends_with("number of codes: expected 4, one for each detection of its scan, found 3"),
            "{error}"
        );
        write(&truth.join("front/000003.cause"), &[0, 3, 1]);
        let error = causes.of_scan(&scan(3), 3).unwrap_err().to_string();
        assert!(error.ends_with("byte 1: expected a code below 3, as in causes.txt, found 3"), "{error}");
    }

    #[test]
    fn lists_of_names_that_do_not_fit_are_refused() {
        for names in ["", "clutter\n", "none\n\nclutter\n", &format!("none\n{}", "more\n".repeat(256))] {
            assert!(find(names).is_err(), "{names}");
        }
        assert!(find(&format!("none\n{}", "more\n".repeat(255))).is_ok());
    }
}
