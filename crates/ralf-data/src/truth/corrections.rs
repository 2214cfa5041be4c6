//! What people corrected in the review, beside a run's labels: `OUT/corrections.sqlite`.

use crate::disk::files;
use crate::disk::label_file::Label;
use crate::error::DataError;
use crate::read::Recording;
use crate::tree::SECOND;
use crate::truth::content::HeldContent;
use crate::truth::effective::{correct, effective_labels, say};
use crate::truth::scan_id::ScanId;
use ralf::label::UNLABELED;
use ralf_corrections::{FILE, Reader, ScanKey, ScanLayer, read_layer};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The corrections of one output folder, as they were at one moment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Corrections {
    file: PathBuf,
    /// What is said of each scan, once per content that it had when something was said of it.
    scans: BTreeMap<ScanId, Vec<ScanLayer>>,
    /// The scans of which something was said while they held something else.
    orphaned: Vec<ScanId>,
    /// Those among them that can't be read now, and why.
    unread: BTreeMap<ScanId, String>,
}

/// A scan as it was before anybody settled what others said of it.
pub(crate) struct Unsettled {
    /// A label per detection, 0 (unlabeled) where nobody said anything.
    pub(crate) labels: Vec<Label>,
    /// Detections that were settled.
    pub(crate) settled: BTreeSet<u32>,
    /// Why detections that were not settled are artifacts, of those of which somebody said it.
    pub(crate) causes: BTreeMap<u32, String>,
}

impl From<&ScanId> for ScanKey {
    fn from(id: &ScanId) -> Self {
        Self { sequence: id.sequence.clone(), radar: id.radar.clone(), scan: id.scan }
    }
}

impl From<ScanKey> for ScanId {
    fn from(key: ScanKey) -> Self {
        Self { sequence: key.sequence, radar: key.radar, scan: key.scan }
    }
}

impl Corrections {
    /// Reads what is said below an output folder, or in a store's file itself; nothing where there is no such file.
    ///
    /// # Errors
    /// A file that is no store of corrections, or one of another version of the program.
    pub fn open(out: &Path) -> Result<Self, DataError> {
        let file = Self::file_of(out);
        let there = files::exists(&file)?;
        let scans = if there { read_layer(&file)? } else { BTreeMap::new() };
        let scans: BTreeMap<ScanId, Vec<ScanLayer>> =
            scans.into_iter().map(|(key, said)| (key.into(), said)).collect();
        Ok(Self { file, scans, orphaned: Vec::new(), unread: BTreeMap::new() })
    }

    /// A name that no other store has, and each of its copies; `None` where there is no store.
    ///
    /// # Errors
    /// A file that is no store of corrections, or one of another version of the program.
    pub fn id(&self) -> Result<Option<String>, DataError> {
        let there = files::exists(&self.file)?;
        Ok(if there { Some(Reader::open(&self.file)?.id()?) } else { None })
    }

    /// Refuses a place that was named for its corrections, a folder or a file, where there are none.
    ///
    /// # Errors
    /// What isn't there: the folder or file, or the store in the folder.
    pub fn check_there(out: &Path) -> Result<(), DataError> {
        let (there, file) = (files::exists(out)?, Self::file_of(out));
        if there && files::exists(&file)? {
            return Ok(());
        }
        let missing = if there { &file } else { out };
        Err(DataError::content(missing, "file", "corrections", "no such file or folder"))
    }

    /// The folder of the labels that people saw who corrected them there: of a store's file the one that it lies in.
    pub fn labels_of(out: &Path) -> &Path {
        if !out.is_file() {
            return out;
        }
        // OUT/corrections.sqlite or OUT/second/NAME.sqlite.
        let folder = out.parent().unwrap_or(out);
        let second = folder.file_name().is_some_and(|name| name == SECOND);
        folder.parent().filter(|_| second).unwrap_or(folder)
    }

    fn file_of(out: &Path) -> PathBuf {
        if out.is_file() { out.to_owned() } else { out.join(FILE) }
    }

    /// Keeps what was said of what the scans hold now: what was said of another content is [orphaned](Self::orphaned),
    /// and counts no more. `content_of` tells what a scan holds (see [`HeldContent`]), and `None` of one that isn't
    /// there.
    ///
    /// # Errors
    /// Those of `content_of`.
    pub fn bound<E, C: Into<HeldContent>>(
        mut self,
        mut content_of: impl FnMut(&ScanId) -> Result<Option<C>, E>,
    ) -> Result<Self, E> {
        let mut bound = BTreeMap::new();
        for (scan, said) in self.scans {
            let contents = || Ok(said.iter().map(|layer| layer.content).collect());
            let content = content_of(&scan)?.map(|held| held.into().among(contents)).transpose()?;
            let held = content.and_then(|content| ScanLayer::find_in(&said, &content)).cloned();
            if said.len() > usize::from(held.is_some()) {
                self.orphaned.push(scan.clone());
            }
            bound.extend(held.map(|layer| (scan, vec![layer])));
        }
        self.scans = bound;
        Ok(self)
    }

    /// Those of a recording's sequences alone.
    pub(super) fn of_sequences(mut self, recording: &Recording) -> Self {
        let names: Vec<&str> =
            recording.sequences.iter().map(|reader| reader.sequence().name.as_str()).collect();
        self.scans.retain(|scan, _| names.contains(&scan.sequence.as_str()));
        self
    }

    /// Keeps the corrections of scans that are marked as reviewed: whoever labels them is through with these. Of a scan
    /// with several contents that of what was marked is left.
    pub fn of_reviewed_scans(mut self) -> Self {
        self.scans.retain(|_, said| {
            said.retain(|layer| layer.accepted.is_some());
            !said.is_empty()
        });
        self
    }

    /// Those of these scans alone.
    pub fn of_scans(mut self, wanted: impl Fn(&ScanId) -> bool) -> Self {
        self.scans.retain(|scan, _| wanted(scan));
        self
    }

    /// The scans of which something was said while they held something else: it is kept in the file, and never applied.
    pub fn orphaned(&self) -> &[ScanId] {
        &self.orphaned
    }

    /// A sentence for each of these.
    pub fn told_orphaned(&self) -> Vec<String> {
        let told = |scan: &ScanId| {
            let why = self.unread.get(scan).map(|error| format!("the scan can't be read: {error}"));
            let why = why.unwrap_or_else(|| "they were made when it held other detections".into());
            format!("corrections of {scan} are kept and not applied: {why}")
        };
        self.orphaned.iter().map(told).collect()
    }

    /// That these scans can't be read, and why.
    pub(super) fn with_unread(self, unread: BTreeMap<ScanId, String>) -> Self {
        Self { unread, ..self }
    }

    /// Where they lie.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Whether nobody said anything.
    pub fn is_empty(&self) -> bool {
        self.scans().next().is_none()
    }

    /// The scans with corrections or a reviewed mark, in order.
    pub fn scans(&self) -> impl Iterator<Item = &ScanId> {
        let spoken = self.scans.iter().filter(|(_, said)| !said.iter().all(ScanLayer::says_nothing));
        spoken.map(|(scan, _)| scan)
    }

    /// These, and those that were settled so that nothing is said of them any more.
    pub(crate) fn scans_ever(&self) -> impl Iterator<Item = &ScanId> {
        self.scans.keys()
    }

    /// How many detections a person has labelled.
    pub fn corrected_detections(&self) -> usize {
        self.layers().map(|layer| layer.corrections.len()).sum()
    }

    /// How many scans are marked as reviewed.
    pub fn reviewed_scans(&self) -> usize {
        self.layers().filter(|layer| layer.accepted.is_some()).count()
    }

    /// Whether people corrected some of a scan's detections, but not all, and nobody has marked it as reviewed.
    pub(super) fn is_partial(&self, scan: &ScanId) -> bool {
        let is_partial = |layer: &ScanLayer| {
            layer.accepted.is_none() && layer.corrections.len() < layer.content.detections as usize
        };
        self.scans.get(scan).is_some_and(|said| said.iter().all(is_partial))
    }

    /// Why detections of a scan are artifacts, as far as people said it: the causes by their places in the scan,
    /// ascending.
    ///
    /// # Errors
    /// Several contents of the scan, of which nothing says which is meant.
    pub fn causes(&self, scan: &ScanId) -> Result<&[(u32, String)], DataError> {
        Ok(self.layer(scan)?.map_or(&[], |layer| layer.causes.as_slice()))
    }

    /// Detections of a scan whose label somebody took away, ascending.
    ///
    /// # Errors
    /// Several contents of the scan, of which nothing says which is meant.
    pub(super) fn unlabeled(&self, scan: &ScanId) -> Result<Vec<u32>, DataError> {
        let corrections = self.layer(scan)?.map_or(&[][..], |layer| layer.corrections.as_slice());
        let unlabeled = corrections.iter().filter(|(_, label)| *label == UNLABELED);
        Ok(unlabeled.map(|(detection, _)| *detection).collect())
    }

    fn layers(&self) -> impl Iterator<Item = &ScanLayer> {
        self.scans.values().flatten()
    }

    /// The labels of a scan with people's word above the machine's: of each detection its correction, else the
    /// label that was accepted when the scan was marked as reviewed, else the machine's. A label that stays
    /// keeps its instance.
    ///
    /// # Errors
    /// Labels of another number than the scan had when it was edited.
    pub fn effective_labels(&self, scan: &ScanId, machine: Vec<Label>) -> Result<Vec<Label>, DataError> {
        let Some(layer) = self.layer(scan)? else { return Ok(machine) };
        self.check_size(scan, layer, machine.len())?;
        Ok(effective_labels(machine, layer.accepted.as_deref(), &layer.corrections))
    }

    /// What people say of a scan's detections: of each its correction, else what the ground truth's file says,
    /// else the label accepted when the scan was marked as reviewed, else 0 (unlabeled). `None` where neither
    /// file nor corrections know the scan.
    pub(crate) fn truth(
        &self,
        scan: &ScanId,
        file: Option<Vec<Label>>,
    ) -> Result<Option<Vec<Label>>, DataError> {
        let Some(layer) = self.layer(scan)?.filter(|layer| !layer.says_nothing()) else { return Ok(file) };
        if let Some(file) = &file {
            self.check_size(scan, layer, file.len())?;
        }
        Ok(Some(said(layer, file)))
    }

    /// What a scan's labels were before anybody settled what others said of it. `None` of a scan that nobody knows.
    ///
    /// # Errors
    /// Several contents of the scan, of which nothing says which is meant.
    pub(crate) fn unsettled(&self, scan: &ScanId) -> Result<Option<Unsettled>, DataError> {
        let Some(layer) = self.layer(scan)? else { return Ok(None) };
        let settled = layer.settled.iter().map(|(point, _)| *point).collect();
        let before = layer.before_settling();
        let labels = said(&before, None);
        Ok(Some(Unsettled { labels, settled, causes: before.causes.into_iter().collect() }))
    }

    /// What is said of a scan. Which of several contents is meant must have been told before.
    fn layer(&self, scan: &ScanId) -> Result<Option<&ScanLayer>, DataError> {
        match self.scans.get(scan).map(Vec::as_slice) {
            None | Some([]) => Ok(None),
            Some([layer]) => Ok(Some(layer)),
            Some(several) => {
                let found = format!(
                    "{} contents of this scan, and nothing that says which one is meant",
                    several.len()
                );
                Err(DataError::content(
                    &self.file,
                    format!("scan {scan}"),
                    "corrections of one content",
                    found,
                ))
            }
        }
    }

    fn check_size(&self, scan: &ScanId, layer: &ScanLayer, labels: usize) -> Result<(), DataError> {
        let detections = layer.content.detections as usize;
        if labels == detections {
            return Ok(());
        }
        let (expected, found) = (format!("{labels} detections"), format!("corrections of {detections}"));
        Err(DataError::content(&self.file, format!("scan {scan}"), expected, found))
    }
}

/// A correction, else what the file says, else what was accepted.
fn said(layer: &ScanLayer, file: Option<Vec<Label>>) -> Vec<Label> {
    let mut labels = file.unwrap_or_else(|| vec![Label::default(); layer.content.detections as usize]);
    for (label, accepted) in labels.iter_mut().zip(layer.accepted.iter().flatten()) {
        if label.id == Label::default().id {
            say(label, *accepted);
        }
    }
    correct(&mut labels, &layer.corrections);
    labels
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf_corrections::{ContentHash, Mark, SETTLE, ScanContent, ScanEdit, Store, Stroke, Who};

    fn scan() -> ScanId {
        ScanId { sequence: "00".into(), radar: "front".into(), scan: 3 }
    }

    fn hash(byte: u8) -> ContentHash {
        ContentHash::new([byte; 32])
    }

    fn ids(labels: &[Label]) -> Vec<u16> {
        labels.iter().map(|label| label.id).collect()
    }

    /// A scan of four detections: the machine says 99, 1, 99, 1; it is marked as reviewed, and the second is a car.
    fn store(out: &Path) -> Corrections {
        let mut store = Store::open(&out.join(FILE)).unwrap();
        let who = Who::named("ada");
        let content = Some(hash(1));
        let edit =
            ScanEdit { radar: "front".into(), scan: 3, detections: 4, content, base: 0, points: vec![1] };
        let stroke = Stroke { label: Some(10), scans: vec![edit], ..Stroke::of_sequence("00") };
        store.apply(&stroke, &who).unwrap();
        let machine = vec![99, 1, 99, 1];
        let mark = Mark { key: (&scan()).into(), content, base: 1, machine, reviewed: true };
        store.mark(&mark, &who).unwrap();
        Corrections::open(out).unwrap()
    }

    #[test]
    fn a_persons_word_stands_above_the_machines() {
        let out = tempfile::tempdir().unwrap();
        let corrections = store(out.path());
        assert_eq!((corrections.corrected_detections(), corrections.reviewed_scans()), (1, 1));
        // Labelled again with other settings: what was accepted stays.
        let machine =
            vec![Label::of_class(1), Label::of_class(1), Label { id: 99, instance: 7 }, Label::of_class(99)];
        let labels = corrections.effective_labels(&scan(), machine.clone()).unwrap();
        assert_eq!(ids(&labels), [99, 10, 99, 1]);
        assert_eq!(labels[2].instance, 7);
        let other = ScanId { scan: 4, ..scan() };
        assert_eq!(corrections.effective_labels(&other, machine.clone()).unwrap(), machine);
    }

    #[test]
    fn a_store_is_about_the_labels_of_the_folder_that_it_lies_in() {
        let out = tempfile::tempdir().unwrap();
        store(out.path());
        let second = out.path().join("second/bob.sqlite");
        std::fs::create_dir(second.parent().unwrap()).unwrap();
        std::fs::copy(out.path().join(FILE), &second).unwrap();
        for place in [out.path(), &out.path().join(FILE), &second] {
            assert_eq!(Corrections::labels_of(place), out.path());
        }
    }

    #[test]
    fn truth_takes_the_correction_then_the_file_then_what_was_accepted() {
        let out = tempfile::tempdir().unwrap();
        let corrections = store(out.path());
        let file = [0, 1, 48, 0].map(Label::of_class).to_vec();
        assert_eq!(ids(&corrections.truth(&scan(), Some(file)).unwrap().unwrap()), [99, 10, 48, 1]);
        assert_eq!(ids(&corrections.truth(&scan(), None).unwrap().unwrap()), [99, 10, 99, 1]);
        assert_eq!(corrections.truth(&ScanId { scan: 4, ..scan() }, None).unwrap(), None);
    }

    /// LiDAR points may be labelled so, and the machine's labels go by theirs.
    #[test]
    fn labels_may_be_ids_that_semantickitti_lacks() {
        let out = tempfile::tempdir().unwrap();
        let mut store = Store::open(&out.path().join(FILE)).unwrap();
        let radar = "front".to_owned();
        let edit = ScanEdit { radar, scan: 3, detections: 4, content: None, base: 0, points: vec![1] };
        let stroke = Stroke { label: Some(103), scans: vec![edit], ..Stroke::of_sequence("00") };
        store.apply(&stroke, &Who::named("ada")).unwrap();
        let machine = vec![1, 99, 7, u16::MAX];
        let mark = Mark { key: (&scan()).into(), content: None, base: 1, machine, reviewed: true };
        store.mark(&mark, &Who::named("ada")).unwrap();
        let said = Corrections::open(out.path()).unwrap().truth(&scan(), None).unwrap().unwrap();
        assert_eq!(ids(&said), [1, 103, 7, u16::MAX]);
    }

    #[test]
    fn corrections_of_another_content_are_kept_and_never_applied() {
        let out = tempfile::tempdir().unwrap();
        let content = |byte| Ok::<_, ()>(Some(ScanContent { detections: 4, hash: Some(hash(byte)) }));
        let machine = vec![Label::of_class(1); 4];
        let same = store(out.path()).bound(|_| content(1)).unwrap();
        assert_eq!(ids(&same.effective_labels(&scan(), machine.clone()).unwrap()), [99, 10, 99, 1]);
        assert!(same.orphaned().is_empty());
        let open = || Corrections::open(out.path()).unwrap();
        for other in [
            open().bound(|_| content(2)).unwrap(),
            open().bound(|_| Ok::<_, ()>(None::<ScanContent>)).unwrap(),
        ] {
            assert_eq!(other.effective_labels(&scan(), machine.clone()).unwrap(), machine);
            assert_eq!((other.orphaned(), other.corrected_detections()), (&[scan()][..], 0));
            assert_eq!(other.truth(&scan(), None).unwrap(), None);
        }
        assert_eq!(open().corrected_detections(), 1, "kept");
    }

    #[test]
    fn who_is_through_with_what_a_scan_held_before_is_not_through_with_what_it_holds_now() {
        let out = tempfile::tempdir().unwrap();
        drop(store(out.path()));
        let content = Some(hash(2));
        let edit =
            ScanEdit { radar: "front".into(), scan: 3, detections: 4, content, base: 0, points: vec![2] };
        let stroke = Stroke { label: Some(48), scans: vec![edit], ..Stroke::of_sequence("00") };
        Store::open(&out.path().join(FILE)).unwrap().apply(&stroke, &Who::named("ada")).unwrap();
        let open = || Corrections::open(out.path()).unwrap();
        let now =
            |byte| move |_: &ScanId| Ok::<_, ()>(Some(ScanContent { detections: 4, hash: Some(hash(byte)) }));
        assert_eq!(open().bound(now(2)).unwrap().corrected_detections(), 1);
        for (byte, through) in [(1, 1), (2, 0)] {
            let either = [
                open().bound(now(byte)).unwrap().of_reviewed_scans(),
                open().of_reviewed_scans().bound(now(byte)).unwrap(),
            ];
            for found in either {
                assert_eq!((found.scans().count(), found.corrected_detections()), (through, through));
            }
        }
    }

    #[test]
    fn what_was_settled_to_be_the_machines_again_is_no_word_and_was_one() {
        let out = tempfile::tempdir().unwrap();
        let mut store = Store::open(&out.path().join(FILE)).unwrap();
        for (base, tool, label) in [(0, "lasso", Some(10)), (1, SETTLE, None)] {
            let radar = "front".to_owned();
            let edit = ScanEdit { radar, scan: 3, detections: 4, content: None, base, points: vec![1] };
            let stroke = Stroke { tool: tool.into(), label, scans: vec![edit], ..Stroke::of_sequence("00") };
            store.apply(&stroke, &Who::named("ada")).unwrap();
        }
        let corrections = Corrections::open(out.path()).unwrap();
        assert!(corrections.is_empty() && corrections.truth(&scan(), None).unwrap().is_none());
        assert_eq!(corrections.scans_ever().collect::<Vec<_>>(), [&scan()]);
        assert_eq!(ids(&corrections.unsettled(&scan()).unwrap().unwrap().labels), [0, 10, 0, 0]);
    }

    #[test]
    fn another_size_is_refused_and_no_file_is_no_word() {
        let out = tempfile::tempdir().unwrap();
        assert!(Corrections::open(out.path()).unwrap().is_empty());
        let error = store(out.path()).effective_labels(&scan(), vec![Label::default(); 3]).unwrap_err();
        let expected =
            "corrections.sqlite: scan 00/front/000003: expected 3 detections, found corrections of 4";
        assert!(error.to_string().ends_with(expected), "{error}");
    }
}
