//! The mismatches of all scans with truth: what tuning works on (docs/method.md, section 10).

use crate::error::DataError;
use crate::frames::{Frames, ScanIndex};
use crate::not_used::NotUsed;
use crate::read::{Recording, SequenceReader};
use crate::run::{NotLabelled, Observer, Stage, rig_of};
use crate::truth::{GroundTruth, ScanId};
use ralf::config::Config;
use ralf::label::truth_of;
use ralf::scene::{FrameWindow, Unreadable};
use ralf::sensors::Rig;
use ralf_train::{Gatherer, MismatchTable, Space};

/// What is known of one sequence's detections with truth.
#[derive(Debug, Clone)]
pub struct SequenceMismatches {
    /// In the order of the truth's scans.
    pub table: MismatchTable,
    /// The sequence's name, and what it had to do without.
    pub not_used: NotUsed,
}

/// Matches all scans with truth of all sequences of a recording, in its order, for every `K` and `n_b` around the
/// settings' own. The result doesn't depend on the number of jobs. A sequence without truth is refused, and so is a
/// truth of another size than its scan.
pub fn gather_mismatches(
    recording: &Recording,
    truth: &GroundTruth,
    config: &Config,
    jobs: usize,
    observer: &dyn Observer,
) -> Result<Vec<SequenceMismatches>, DataError> {
    let gatherer = Gatherer::new(config, Space::around(config));
    let gatherer = gatherer.map_err(|error| DataError::settings(&recording.path, &error))?;
    let with_truth = recording.sequences.iter().map(|reader| {
        let name = &reader.sequence().name;
        let scans: Vec<&ScanId> = truth.scans().iter().filter(|scan| scan.sequence == *name).collect();
        if scans.is_empty() {
            let place = format!("sequence {name}");
            return Err(DataError::content(&recording.path, place, "ground truth to compare with", "none"));
        }
        let rig = rig_of(recording, reader.as_ref(), config)?;
        Ok(Task { reader: reader.as_ref(), rig, truth, gatherer: &gatherer, scans, observer })
    });
    let tasks = with_truth.collect::<Result<Vec<_>, _>>()?;
    tasks.iter().map(|task| task.gather(jobs)).collect()
}

/// What is known of a scan, with what belongs to it and can't be read; or why nothing is.
type Matched = Result<(MismatchTable, Vec<Unreadable>), NotLabelled>;

/// One sequence.
struct Task<'a> {
    reader: &'a dyn SequenceReader,
    rig: Rig,
    truth: &'a GroundTruth,
    gatherer: &'a Gatherer,
    scans: Vec<&'a ScanId>,
    observer: &'a dyn Observer,
}

impl Task<'_> {
    fn gather(&self, jobs: usize) -> Result<SequenceMismatches, DataError> {
        let name = &self.reader.sequence().name;
        self.observer.begin(Stage::Matching(name), self.scans.len() as u64);
        let places: Vec<Option<ScanIndex>> =
            self.scans.iter().map(|id| id.place_in(self.reader.sequence())).collect();
        let (mut there, mut ids) = (Vec::new(), Vec::new());
        for (place, id) in places.iter().zip(&self.scans) {
            if let Some(place) = place {
                there.push(*place);
                ids.push(*id);
            }
        }
        let config = self.gatherer.frame_config();
        let frames = Frames { reader: self.reader, rig: &self.rig, config, evidence: false };
        let matched = frames.each(&there, jobs, |window, at| self.match_scan(window, ids[at], there[at]));
        self.observer.end();
        let mut matched = matched?.into_iter();
        let (mut table, mut not_used) = (self.gatherer.table(), NotUsed::of(name));
        for (place, id) in places.iter().zip(&self.scans) {
            let found = place.and_then(|_| matched.next()).unwrap_or_else(|| {
                let reason = "no such scan in the recording, though it has truth".to_owned();
                Err(NotLabelled { radar: id.radar.clone(), scan: id.scan as usize, reason })
            });
            if let Some(scan) = not_used.sort(found) {
                table.append(scan);
            }
        }
        Ok(SequenceMismatches { table, not_used })
    }

    fn match_scan(
        &self,
        window: &mut FrameWindow,
        id: &ScanId,
        ScanIndex { radar, scan }: ScanIndex,
    ) -> Result<Matched, DataError> {
        let left_out = |reason| NotLabelled { radar: id.radar.clone(), scan, reason };
        let frame = match window.frame(radar, scan) {
            Ok(frame) => frame,
            Err(error) => return Ok(Err(left_out(error.to_string()))),
        };
        let truth: Vec<Option<bool>> =
            self.truth.labels(id)?.iter().map(|label| truth_of(label.id)).collect();
        let detections = frame.scan.len();
        if truth.len() != detections {
            let expected = format!("{detections} as in the scan");
            let file = self.truth.file(id);
            return Err(DataError::content(&file, "number of labels", expected, truth.len().to_string()));
        }
        let mut table = self.gatherer.table();
        self.gatherer.add(&mut table, &frame, &truth);
        self.observer.advance(1, detections as u64);
        Ok(Ok((table, frame.unreadable)))
    }
}
