//! A sensor's files: their names are numbers, and line n of `timestamps.txt` belongs to the n-th of them.

use super::tables;
use crate::disk::files;
use crate::disk::numbered::number_of;
use crate::error::DataError;
use crate::tree::TIMES;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The measurements of one sensor.
#[derive(Debug)]
pub(super) struct SensorFiles {
    /// Where the times are.
    timestamps: PathBuf,
    /// When each was measured, ns.
    pub(super) times: Vec<i64>,
    /// One per time.
    pub(super) files: Vec<PathBuf>,
    /// What belongs to each file (see [`Partner`]), where it exists: a list for each kind of partner.
    partners: Vec<Vec<Option<PathBuf>>>,
}

/// Where a file of the same number as a measurement's is looked for: labels, times of points, truth, depth,
/// segmentation.
pub(super) struct Partner {
    /// It need not exist.
    pub(super) folder: PathBuf,
    /// How its file name ends, without the dot.
    pub(super) extension: &'static str,
}

impl SensorFiles {
    /// The measurements in a sensor's folder. Partners that belong to none are warnings.
    pub(super) fn list(
        folder: &Path,
        extensions: &[&str],
        partners: &[Partner],
        warnings: &mut Vec<String>,
    ) -> Result<Self, DataError> {
        let files = numbered(folder, extensions)?;
        let timestamps = folder.join(TIMES);
        let times = tables::read_timestamps(&timestamps)?;
        if times.len() != files.len() {
            let expected = format!("a line for each of the {} files beside it", files.len());
            return Err(DataError::content(&timestamps, "end", expected, format!("{} lines", times.len())));
        }
        let mut found = Vec::with_capacity(partners.len());
        for partner in partners {
            found.push(partners_of(partner, files.keys().copied(), warnings)?);
        }
        Ok(Self { timestamps, times, files: files.into_values().collect(), partners: found })
    }

    /// The partner of a measurement, of the kind that was listed at this place.
    pub(super) fn partner(&self, kind: usize, index: usize) -> Option<&PathBuf> {
        self.partners.get(kind)?.get(index)?.as_ref()
    }

    /// Whether any measurement has a partner of this kind.
    pub(super) fn has_partners(&self, kind: usize) -> bool {
        self.partners.get(kind).is_some_and(|files| files.iter().any(Option::is_some))
    }

    /// Times and measurements.
    pub(super) fn measured(&self) -> impl Iterator<Item = &PathBuf> {
        std::iter::once(&self.timestamps).chain(&self.files)
    }

    /// Times, and each measurement with its partners.
    pub(super) fn all(&self) -> impl Iterator<Item = &PathBuf> {
        let with_partners = self.files.iter().enumerate().flat_map(move |(index, file)| {
            let partners = (0..self.partners.len()).filter_map(move |kind| self.partner(kind, index));
            std::iter::once(file).chain(partners)
        });
        std::iter::once(&self.timestamps).chain(with_partners)
    }
}

/// The files of a folder with one of these extensions, by number. Hidden files are none.
fn numbered(folder: &Path, extensions: &[&str]) -> Result<BTreeMap<u64, PathBuf>, DataError> {
    let mut files = BTreeMap::new();
    for entry in files::entries(folder, "a folder of measurements")? {
        let file = entry.map_err(DataError::io(folder))?.path();
        let Some(stem) = stem(&file, extensions) else { continue };
        let Some(number) = number_of(&file) else {
            return Err(DataError::content(&file, "name", "a number such as 000000", format!("`{stem}`")));
        };
        if let Some(other) = files.insert(number, file.clone()) {
            let found = format!("another: {}", other.display());
            return Err(DataError::content(&file, "name", format!("one file of number {number}"), found));
        }
    }
    Ok(files)
}

/// For each of the numbers, its partner.
fn partners_of(
    Partner { folder, extension }: &Partner,
    numbers: impl Iterator<Item = u64>,
    warnings: &mut Vec<String>,
) -> Result<Vec<Option<PathBuf>>, DataError> {
    let mut files = if folder.is_dir() { numbered(folder, &[*extension])? } else { BTreeMap::new() };
    let partners = numbers.map(|number| files.remove(&number)).collect();
    let lone = files.values().map(|file| format!("{}: belongs to no measurement, ignored", file.display()));
    warnings.extend(lone);
    Ok(partners)
}

/// The name without its extension, if that is one of these (in capitals or not).
fn stem<'a>(file: &'a Path, extensions: &[&str]) -> Option<&'a str> {
    let found = file.extension()?.to_str()?;
    let stem = file.file_stem()?.to_str()?;
    let wanted = extensions.iter().any(|extension| extension.eq_ignore_ascii_case(found));
    (wanted && !stem.starts_with('.')).then_some(stem)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn folder(names: &[&str]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for name in names {
            fs::write(folder.path().join(name), "").unwrap();
        }
        folder
    }

    #[test]
    fn order_is_by_number_and_gaps_are_fine() {
        let folder = folder(&["10.bin", "9.bin", "000002.BIN", "timestamps.txt", "._9.bin", "3.label"]);
        let files = numbered(folder.path(), &["bin"]).unwrap();
        assert_eq!(files.keys().copied().collect::<Vec<_>>(), [2, 9, 10]);
        let mut warnings = vec![];
        let partner = Partner { folder: folder.path().to_owned(), extension: "label" };
        let labels = partners_of(&partner, [2].into_iter(), &mut warnings).unwrap();
        assert_eq!(labels, [None]);
        assert!(warnings[0].contains("3.label: belongs to no measurement"), "{warnings:?}");
    }

    #[test]
    fn names_that_are_no_number_or_the_same_are_refused() {
        for (names, part) in [(&["a.bin"][..], "found `a`"), (&["1.png", "01.jpg"], "one file of number 1")] {
            let error = numbered(folder(names).path(), &["bin", "png", "jpg"]).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
        assert!(numbered(Path::new("nowhere"), &["bin"]).unwrap_err().to_string().contains("nowhere"));
    }
}
