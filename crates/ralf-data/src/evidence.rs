//! The evidence of all scans with truth: what tuning works on (docs/method.md, section 10).

use crate::error::DataError;
use crate::read::{Recording, SequenceReader};
use crate::run::{NotLabelled, Observer, Stage, rig_of};
use crate::truth::{GroundTruth, ScanId};
use ralf::config::Config;
use ralf::label::truth_of;
use ralf::scene::FrameWindow;
use ralf::sensors::Rig;
use ralf_train::{EvidenceTable, Gatherer, Space};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Scans that follow each other in time and are matched by one worker, which reads their neighbours but once.
const STRETCH: usize = 64;

/// What is known of one sequence's detections with truth.
#[derive(Debug, Clone)]
pub struct SequenceEvidence {
    /// The sequence's name.
    pub name: String,
    /// In the order of the truth's scans.
    pub table: EvidenceTable,
    /// Scans with truth that can't be matched; they are left out.
    pub left_out: Vec<NotLabelled>,
}

/// Matches all scans with truth of all sequences of a recording, in its order, for every `K` and `n_b` around the
/// settings' own. The result doesn't depend on the number of jobs. A sequence without truth is refused, and so is a
/// truth of another size than its scan.
pub fn gather_evidence(
    recording: &Recording,
    truth: &GroundTruth,
    config: &Config,
    jobs: usize,
    observer: &dyn Observer,
) -> Result<Vec<SequenceEvidence>, DataError> {
    let gatherer = Gatherer::new(config, Space::around(config));
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

/// One sequence.
struct Task<'a> {
    reader: &'a dyn SequenceReader,
    rig: Rig,
    truth: &'a GroundTruth,
    gatherer: &'a Gatherer,
    scans: Vec<&'a ScanId>,
    observer: &'a dyn Observer,
}

/// A scan's place in [`Task::scans`], and its evidence or why there is none.
type Matched = (usize, Result<EvidenceTable, NotLabelled>);

impl Task<'_> {
    fn gather(&self, jobs: usize) -> Result<SequenceEvidence, DataError> {
        let name = self.reader.sequence().name.clone();
        self.observer.begin(Stage::Matching(&name), self.scans.len() as u64);
        let in_time_order = self.in_time_order();
        let stretches: Vec<&[usize]> = in_time_order.chunks(STRETCH).collect();
        let matched = side_by_side(&stretches, jobs, |stretch| self.match_stretch(stretch));
        self.observer.end();
        let mut matched: Vec<Matched> = matched?.into_iter().flatten().collect();
        matched.sort_by_key(|(place, _)| *place);
        let (mut table, mut left_out) = (self.gatherer.table(), Vec::new());
        for (_, scan) in matched {
            match scan {
                Ok(scan) => table.append(scan),
                Err(reason) => left_out.push(reason),
            }
        }
        Ok(SequenceEvidence { name, table, left_out })
    }

    /// Places of the scans, by their time.
    fn in_time_order(&self) -> Vec<usize> {
        let times = &self.reader.sequence().times.radars;
        let time = |place: &usize| {
            self.place_of(self.scans[*place]).map(|(radar, scan)| (times[radar][scan], radar, scan))
        };
        let mut places: Vec<usize> = (0..self.scans.len()).collect();
        places.sort_by_key(time);
        places
    }

    /// Radar and scan, where the recording holds them.
    fn place_of(&self, id: &ScanId) -> Option<(usize, usize)> {
        let radar = self.rig.radars.iter().position(|radar| radar.name == id.radar)?;
        let scan = id.scan as usize;
        (scan < self.reader.sequence().times.radars[radar].len()).then_some((radar, scan))
    }

    fn match_stretch(&self, stretch: &[usize]) -> Result<Vec<Matched>, DataError> {
        let mut window = FrameWindow::new(self.reader, &self.rig, self.gatherer.frame_config());
        stretch.iter().map(|&place| Ok((place, self.match_scan(&mut window, self.scans[place])?))).collect()
    }

    fn match_scan(
        &self,
        window: &mut FrameWindow,
        id: &ScanId,
    ) -> Result<Result<EvidenceTable, NotLabelled>, DataError> {
        let left_out =
            |reason: String| NotLabelled { radar: id.radar.clone(), scan: id.scan as usize, reason };
        let Some((radar, scan)) = self.place_of(id) else {
            return Ok(Err(left_out("no such scan in the recording, though it has truth".into())));
        };
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
        Ok(Ok(table))
    }
}

/// Works on all items, several at a time. Results are in the items' order. An error ends the work.
fn side_by_side<T: Sync, R: Send>(
    items: &[T],
    jobs: usize,
    work: impl Fn(&T) -> Result<R, DataError> + Sync,
) -> Result<Vec<R>, DataError> {
    let next = AtomicUsize::new(0);
    let work_off = || {
        let mut done = Vec::new();
        loop {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(place) else { return Ok(done) };
            // The others find no more items.
            done.push((place, work(item).inspect_err(|_| next.store(items.len(), Ordering::Relaxed))?));
        }
    };
    let results: Vec<Result<Vec<(usize, R)>, DataError>> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..jobs.clamp(1, items.len().max(1))).map(|_| scope.spawn(work_off)).collect();
        let joined =
            workers.into_iter().map(|w| w.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        joined.collect()
    });
    let mut done: Vec<_> =
        results.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect();
    done.sort_by_key(|(place, _)| *place);
    Ok(done.into_iter().map(|(_, result)| result).collect())
}
