//! The corrected labels of a dataset: `sequences/NAME/ground_truth/RADAR/NNNNNN.label` (docs/formats.md, section 1), or
//! what a format of its own says of its detections; and above them the corrections of a review.

use super::causes::Causes;
use super::corrections::Corrections;
use super::known::KnownTruth;
use super::scan_id::ScanId;
use crate::disk::files;
use crate::disk::label_file::{Label, read_labels};
use crate::disk::numbered::number_of;
use crate::error::DataError;
use crate::read::layout;
use crate::read::open::recognised;
use crate::tree::{GROUND_TRUTH, LABELS, SEQUENCES, label_name, truth_folder};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// What people say of a dataset's detections. The one place to ask: the layers of what they said are merged here.
#[derive(Debug, Clone)]
pub struct GroundTruth {
    dataset: PathBuf,
    /// With a file of their own, with corrections, or both.
    scans: Vec<ScanId>,
    /// With a file of their own, or told by their format.
    files: BTreeSet<ScanId>,
    /// The format that tells.
    known: Option<KnownTruth>,
    corrections: Option<Corrections>,
}

impl GroundTruth {
    /// Finds all scans with truth below a dataset's folder; none at all is an error. Only label files are needed.
    pub fn open(dataset: &Path) -> Result<Self, DataError> {
        Self::find(dataset)?.ok_or_else(|| none(dataset))
    }

    /// Finds all scans with truth below a dataset's folder; `None` where there are none.
    pub fn find(dataset: &Path) -> Result<Option<Self>, DataError> {
        Self::gather(dataset, None)
    }

    /// Finds all scans with truth below a dataset's folder, and puts the corrections of a review above it; the folder
    /// need hold no truth of its own. None at all is an error.
    pub fn merged(dataset: &Path, corrections: Corrections) -> Result<Self, DataError> {
        Self::find_merged(dataset, corrections)?.ok_or_else(|| none(dataset))
    }

    /// Finds the truth below a dataset's folder with the corrections of a review above it; `None` where neither says
    /// anything.
    pub fn find_merged(dataset: &Path, corrections: Corrections) -> Result<Option<Self>, DataError> {
        Self::gather(dataset, Some(corrections))
    }

    /// What people corrected and accepted in a review of a dataset, whatever else is known of it; `None` where they
    /// said nothing.
    pub fn of_corrections(dataset: &Path, corrections: Corrections) -> Option<Self> {
        let (dataset, files) = (dataset.to_owned(), BTreeSet::new());
        let scans = corrections.scans().cloned().collect();
        let found = Self { dataset, scans, files, known: None, corrections: Some(corrections) };
        (!found.scans.is_empty()).then_some(found)
    }

    fn gather(dataset: &Path, corrections: Option<Corrections>) -> Result<Option<Self>, DataError> {
        let known = KnownTruth::find(dataset)?;
        let files = match &known {
            Some(known) => known.scans().into_iter().collect(),
            None => scans_with_files(dataset)?,
        };
        let corrected = corrections.iter().flat_map(Corrections::scans);
        let scans: BTreeSet<ScanId> = files.iter().chain(corrected).cloned().collect();
        let scans: Vec<ScanId> = scans.into_iter().collect();
        let found = Self { dataset: dataset.to_owned(), scans, files, known, corrections };
        Ok((!found.scans.is_empty()).then_some(found))
    }

    /// The same truth of these sequences alone; `None` where that leaves no scan.
    pub fn of_sequences(mut self, names: &[&str]) -> Option<Self> {
        self.scans.retain(|scan| names.contains(&scan.sequence.as_str()));
        (!self.scans.is_empty()).then_some(self)
    }

    /// What people corrected, which stands above the files; `None` where nobody asked for it.
    pub fn corrections(&self) -> Option<&Corrections> {
        self.corrections.as_ref()
    }

    /// The scans with truth, in order.
    pub fn scans(&self) -> &[ScanId] {
        &self.scans
    }

    /// The names of the dataset's sequences, with truth or without, and of those with corrections.
    ///
    /// # Errors
    /// The dataset's folder can't be read.
    pub fn sequences(&self) -> Result<BTreeSet<String>, DataError> {
        let held = match &self.known {
            Some(known) => known.sequences(),
            None => files::folders(&self.dataset.join(SEQUENCES))?,
        };
        Ok(held.into_iter().chain(self.scans.iter().map(|scan| scan.sequence.clone())).collect())
    }

    /// What people say of a scan, one label per detection: its correction, else what its file says, else what was
    /// accepted when it was marked as reviewed, else 0 (unlabeled).
    pub fn labels(&self, scan: &ScanId) -> Result<Vec<Label>, DataError> {
        let on_file = || match self.known.as_ref().map(|known| known.of_scan(scan)).transpose()?.flatten() {
            Some(truth) => Ok(truth.labels),
            None => read_labels(&scan.truth_file(&self.dataset)),
        };
        let Some(corrections) = &self.corrections else { return on_file() };
        let file = if self.files.contains(scan) { Some(on_file()?) } else { None };
        corrections.truth(scan, file)?.map_or_else(on_file, Ok)
    }

    /// Detections of a scan whose label somebody took away in a review, ascending: 0 (unlabeled) was said of them.
    ///
    /// # Errors
    /// Those of [`Corrections::causes`].
    pub(crate) fn unlabeled(&self, scan: &ScanId) -> Result<Vec<u32>, DataError> {
        self.corrections.as_ref().map_or(Ok(Vec::new()), |corrections| corrections.unlabeled(scan))
    }

    /// Why the artifacts of a sequence are such, where its format or files of causes tell it.
    ///
    /// # Errors
    /// Those of [`Causes::find`].
    pub fn causes(&self, sequence: &str) -> Result<Option<Causes>, DataError> {
        match &self.known {
            Some(known) => Ok(Causes::known(known, sequence)),
            None => Causes::find(&self.dataset, sequence),
        }
    }

    /// Where most of it is read from.
    pub fn file(&self, scan: &ScanId) -> PathBuf {
        match (&self.corrections, &self.known) {
            (Some(corrections), _) if !self.files.contains(scan) => corrections.file().to_owned(),
            (_, Some(known)) => known.file(&scan.sequence),
            _ => scan.truth_file(&self.dataset),
        }
    }
}

/// What is said of a folder without truth, or of one that isn't there at all.
fn none(dataset: &Path) -> DataError {
    if let Err(error) = dataset.metadata() {
        let expected = "a folder with corrected labels, or a recording whose truth is known";
        return DataError::io(dataset)(ralf_files::absent(error, expected));
    }
    if let Some((format, _)) = recognised(dataset).filter(|(format, _)| *format != layout::NAME) {
        let expected = "corrected labels, as the own layout or a review has them";
        let found = format!("a recording of the format {format}, without truth");
        return DataError::content(dataset, "truth", expected, found);
    }
    let place = format!("*/{GROUND_TRUTH}/*/NNNNNN.{LABELS}");
    DataError::content(&dataset.join(SEQUENCES), place, "files of corrected labels", "none")
}

fn scans_with_files(dataset: &Path) -> Result<BTreeSet<ScanId>, DataError> {
    let mut scans = BTreeSet::new();
    for sequence in files::folders(&dataset.join(SEQUENCES))? {
        let truth = truth_folder(dataset, &sequence);
        for radar in files::folders(&truth)? {
            let numbers = scan_numbers(&truth.join(&radar))?;
            let id = |scan| ScanId { sequence: sequence.clone(), radar: radar.clone(), scan };
            scans.extend(numbers.into_iter().map(id));
        }
    }
    Ok(scans)
}

/// The numbers of a folder's label files, which must be named as the format says.
fn scan_numbers(folder: &Path) -> Result<Vec<u32>, DataError> {
    let names = files::names(folder)?;
    let labels = names.iter().filter(|name| Path::new(name).extension().is_some_and(|found| found == LABELS));
    labels
        .map(|name| {
            let number = number_of(Path::new(name)).and_then(|number| u32::try_from(number).ok());
            number.filter(|number| label_name(*number as usize) == *name).ok_or_else(|| {
                DataError::content(folder, "file names", format!("NNNNNN.{LABELS}"), format!("`{name}`"))
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disk::label_file::write_labels;
    use ralf_corrections::{FILE, ScanEdit, Store, Stroke, Who};
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
    fn truth_may_be_looked_for_and_narrowed() {
        let folder = tempfile::tempdir().unwrap();
        assert!(GroundTruth::find(folder.path()).unwrap().is_none());
        put(folder.path(), "00/ground_truth/a/000000.label");
        put(folder.path(), "01/ground_truth/a/000000.label");
        let truth = GroundTruth::find(folder.path()).unwrap().unwrap();
        let narrowed = truth.clone().of_sequences(&["01", "02"]).unwrap();
        assert_eq!(narrowed.scans(), &truth.scans()[1..]);
        fs::create_dir_all(folder.path().join("sequences/02")).unwrap();
        assert_eq!(narrowed.sequences().unwrap().into_iter().collect::<Vec<_>>(), ["00", "01", "02"]);
        assert!(truth.of_sequences(&["02"]).is_none());
    }

    #[test]
    fn corrections_are_merged_and_enough_by_themselves() {
        let [folder, out] = [(); 2].map(|()| tempfile::tempdir().unwrap());
        let merged = || GroundTruth::merged(folder.path(), Corrections::open(out.path()).unwrap());
        assert!(merged().unwrap_err().to_string().contains("found none"));
        let edit =
            ScanEdit { radar: "a".into(), scan: 3, detections: 2, content: None, base: 0, points: vec![1] };
        let stroke = Stroke { label: Some(1), scans: vec![edit], ..Stroke::of_sequence("01") };
        let who = Who::named("ada");
        Store::open(&out.path().join(FILE)).unwrap().apply(&stroke, &who).unwrap();
        let truth = merged().unwrap();
        assert_eq!(truth.labels(&truth.scans()[0]).unwrap(), [0, 1].map(Label::of_class));
        put(folder.path(), "00/ground_truth/a/000000.label");
        let names: Vec<String> = merged().unwrap().scans().iter().map(ScanId::to_string).collect();
        assert_eq!(names, ["00/a/000000", "01/a/000003"]);
        put(folder.path(), "01/ground_truth/a/000003.label");
        let error = merged().unwrap().labels(&truth.scans()[0]).unwrap_err().to_string();
        assert!(
            error.ends_with("scan 01/a/000003: expected 1 detections, found corrections of 2"),
            "{error}"
        );
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
