//! Evidence and truth of all scans with truth: what a model is fitted to (docs/learned.md).

use crate::disk::label_file::{Label, read_labels};
use crate::error::DataError;
use crate::frames::{Chosen, Frames, ScanIndex, all_scans, each_of};
use crate::not_used::NotUsed;
use crate::read::{Recording, SequenceReader};
use crate::run::{NotLabelled, Observer, Stage, rig_of};
use crate::truth::{Causes, GroundTruth, ScanId};
use ralf::config::Config;
use ralf::evidence::{features, observe};
use ralf::label::{Cause, truth_of};
use ralf::learned::Rows;
use ralf::paper::Labeler;
use ralf::scene::{Frame, FrameWindow, Unreadable};
use ralf::sensors::Rig;
use ralf_train::learning::{Known, TrainingTable, View};
use std::path::{Path, PathBuf};

/// What is gathered from a recording, and how.
pub struct TrainingGatherer<'a> {
    /// With these settings.
    pub config: &'a Config,
    /// Of what is drawn: which scans are also seen as if less could be observed.
    pub seed: u64,
    /// Whether detections of which nobody spoke are gathered, too, of scans of which somebody said something.
    pub unsaid: bool,
    /// The output folder whose labels people saw when they spoke.
    pub shown: Option<&'a Path>,
    /// One in so many scans of each radar of a simulated recording is learned from, at least one of each sequence; the
    /// others are what lies around. 0 is 1.
    pub every: usize,
    /// Threads; the result doesn't depend on it.
    pub jobs: usize,
    /// Is told how it gets on.
    pub observer: &'a dyn Observer,
}

/// Where a recording's truth is.
#[derive(Clone, Copy)]
pub enum TrainingTruth<'a> {
    /// Its readers know it: it is simulated.
    Known,
    /// In files, and in what people corrected.
    Said(&'a GroundTruth),
}

impl TrainingGatherer<'_> {
    /// A table without rows.
    pub fn table(&self) -> TrainingTable {
        TrainingTable::new(features().collect())
    }

    /// Adds all detections with truth of a recording to a table; `world` names the world of a sequence by its name.
    /// Scans that can't be read are left out, and told, sequence by sequence.
    ///
    /// # Errors
    /// Truth that doesn't fit the recording, or settings that don't. The table then holds the sequences before.
    pub fn add(
        &self,
        table: &mut TrainingTable,
        world: &(dyn Fn(&str) -> String + Sync),
        recording: &Recording,
        truth: TrainingTruth,
    ) -> Result<Vec<NotUsed>, DataError> {
        let mut tasks = Vec::new();
        for reader in &recording.sequences {
            tasks.push(Task::new(self, recording, reader.as_ref(), truth)?);
        }
        let mut not_used = Vec::new();
        self.gather(recording, &tasks, |task, gathered| {
            let name = &task.reader.sequence().name;
            let number = table.world(&world(name));
            let mut of_sequence = NotUsed::of(name);
            append(table, number, gathered, &mut of_sequence);
            not_used.extend(Some(of_sequence).filter(|found| !found.is_nothing()));
        })?;
        Ok(not_used)
    }

    /// Hands on what all scans of a sequence tell, sequence by sequence: none waits for those after it.
    fn gather(
        &self,
        recording: &Recording,
        tasks: &[Task],
        mut hand_on: impl FnMut(&Task, Vec<Gathered>) + Send,
    ) -> Result<(), DataError> {
        let Self { config, jobs, observer, .. } = *self;
        let frames: Vec<Frames> = tasks
            .iter()
            .map(|task| Frames { reader: task.reader, rig: &task.rig, config, evidence: true })
            .collect();
        let scans: Vec<Vec<ScanIndex>> = tasks.iter().map(Task::scans).collect();
        let chosen: Vec<Chosen> =
            frames.iter().zip(&scans).map(|(frames, scans)| Chosen { frames, scans }).collect();
        let name = recording.path.file_name().unwrap_or_default().to_string_lossy();
        observer.begin(Stage::Gathering(&name), scans.iter().map(Vec::len).sum::<usize>() as u64);
        let gathered = each_of(
            &chosen,
            jobs,
            |window, sequence, place| tasks[sequence].gather_scan(window, scans[sequence][place]),
            |sequence, gathered| hand_on(&tasks[sequence], gathered),
        );
        observer.end();
        gathered
    }
}

/// Adds what the scans of a sequence tell to a table, as those of this world.
fn append(table: &mut TrainingTable, world: u16, gathered: Vec<Gathered>, not_used: &mut NotUsed) {
    let first_scan = table.known.last().map_or(0, |known| known.scan + 1);
    for (scan, gathered) in (first_scan..).zip(gathered) {
        for Part { rows, known } in not_used.sort(gathered).into_iter().flatten() {
            table.append(&rows, known.into_iter().map(|known| Known { world, scan, ..known }));
        }
    }
}

/// What a scan tells, with what belongs to it and can't be read; or why it tells nothing.
type Gathered = Result<(Vec<Part>, Vec<Unreadable>), NotLabelled>;

/// One sequence.
struct Task<'a> {
    gatherer: &'a TrainingGatherer<'a>,
    reader: &'a dyn SequenceReader,
    rig: Rig,
    truth: TrainingTruth<'a>,
    causes: Option<Causes>,
    labeler: Labeler<'a>,
}

/// The detections with truth of one scan, seen in one way.
struct Part {
    rows: Rows,
    known: Vec<Known>,
}

/// Whether a scan is one in so many of its radar: the middle one of each, so that there is something around it; the
/// middle one of a sequence that is shorter.
fn is_chosen(scan: usize, scans: usize, every: usize) -> bool {
    let middle = every / 2;
    if scans <= middle { scan == scans / 2 } else { scan % every == middle }
}

/// What is true of a detection.
#[derive(Debug, Clone, Copy)]
struct True {
    plausible: Option<bool>,
    /// How people saw it labelled.
    shown: Option<bool>,
    cause: u8,
    /// Somebody took its label away: nothing is known of it, and it wasn't left alone.
    unlabeled: bool,
}

impl<'a> Task<'a> {
    fn new(
        gatherer: &'a TrainingGatherer<'a>,
        recording: &Recording,
        reader: &'a dyn SequenceReader,
        truth: TrainingTruth<'a>,
    ) -> Result<Self, DataError> {
        let rig = rig_of(recording, reader, gatherer.config)?;
        let causes = match truth {
            TrainingTruth::Known => None,
            TrainingTruth::Said(truth) => truth.causes(&reader.sequence().name)?,
        };
        let labeler = Labeler::new(gatherer.config);
        let labeler = labeler.map_err(|error| DataError::settings(&recording.path, &error))?;
        Ok(Self { gatherer, reader, rig, truth, causes, labeler })
    }

    /// Those that are learned from, and may have truth.
    fn scans(&self) -> Vec<ScanIndex> {
        let times = &self.reader.sequence().times;
        let mut scans = all_scans(times);
        match self.truth {
            TrainingTruth::Known => scans.retain(|place| {
                is_chosen(place.scan, times.radars[place.radar].len(), self.gatherer.every.max(1))
            }),
            TrainingTruth::Said(truth) => {
                scans.retain(|scan| truth.scans().binary_search(&self.id(*scan)).is_ok())
            }
        }
        scans
    }

    fn gather_scan(&self, window: &mut FrameWindow, place: ScanIndex) -> Result<Gathered, DataError> {
        let frame = match window.frame(place.radar, place.scan) {
            Ok(frame) => frame,
            Err(error) => return Ok(Err(self.left_out(place, error.to_string()))),
        };
        let truth = match self.true_of(place, frame.scan.len())? {
            Ok(truth) => truth,
            Err(reason) => return Ok(Err(self.left_out(place, reason))),
        };
        let mut parts = vec![self.part(&frame, View::Whole, &truth)];
        let t_ns = frame.scan.t_ns().cast_unsigned();
        let number = t_ns.wrapping_mul(31).wrapping_add(place.radar as u64);
        if let Some(view) = View::drawn(self.gatherer.seed, number) {
            parts.push(self.part(&view.of(&frame), view, &truth));
        }
        self.gatherer.observer.advance(1, frame.scan.len() as u64);
        Ok(Ok((parts, frame.unreadable)))
    }

    /// What is observed of the detections whose truth is known, and of the others where they are asked for.
    fn part(&self, frame: &Frame, view: View, truth: &[True]) -> Part {
        let config = self.gatherer.config;
        let labels = self.labeler.label(frame);
        let columns = observe(frame, config);
        let mut rows = Rows::absent(frame.scan.len(), columns.len());
        for (place, column) in columns.iter().enumerate() {
            rows.set_column(place, &column.values);
        }
        let gathers_unsaid = self.gatherer.unsaid && truth.iter().any(|truth| truth.plausible.is_some());
        let (mut kept, mut known) = (Vec::new(), Vec::new());
        for (row, (truth, label)) in truth.iter().zip(&labels).enumerate() {
            // A detection without a place has no evidence.
            let Some(detection) = &frame.scan.detections[row] else { continue };
            if truth.plausible.is_none() && (truth.unlabeled || !gathers_unsaid) {
                continue;
            }
            kept.push(row);
            known.push(Known {
                world: 0,
                scan: 0,
                t_ns: frame.scan.t_ns(),
                view,
                said: truth.plausible.is_some(),
                plausible: truth.plausible.unwrap_or(false),
                shown: truth.shown,
                cause: truth.cause,
                paper: label.w as f32,
                paper_label: label.plausible,
                place: detection.place(),
            });
        }
        Part { rows: rows.pick(kept.into_iter()), known }
    }

    /// What is true of a scan's detections, or why nobody knows.
    fn true_of(&self, place: ScanIndex, detections: usize) -> Result<Result<Vec<True>, String>, DataError> {
        let id = self.id(place);
        let (labels, causes, file, unlabeled) = match self.truth {
            TrainingTruth::Known => match self.reader.truth(place.radar, place.scan) {
                Ok(Some(truth)) => (truth.labels, Some(truth.causes), PathBuf::new(), Vec::new()),
                Ok(None) => return Ok(Err("its truth is not known".to_owned())),
                Err(error) => return Ok(Err(error.to_string())),
            },
            TrainingTruth::Said(truth) => (truth.labels(&id)?, None, truth.file(&id), truth.unlabeled(&id)?),
        };
        if labels.len() != detections {
            let (expected, found) = (format!("{detections} as in the scan"), labels.len().to_string());
            return Err(DataError::content(&file, "number of labels", expected, found));
        }
        let causes = causes.map_or_else(|| self.causes_of(&id, detections), Ok)?;
        let cause = |row: usize| causes.get(row).copied().unwrap_or(0);
        let shown = self.shown(&id, detections);
        let told = |(row, label): (usize, &Label)| True {
            plausible: truth_of(label.id),
            shown: shown.get(row).copied().flatten(),
            cause: cause(row),
            unlabeled: unlabeled.binary_search(&(row as u32)).is_ok(),
        };
        Ok(Ok(labels.iter().enumerate().map(told).collect()))
    }

    /// How people saw a scan's detections labelled; nothing where its labels are gone.
    fn shown(&self, id: &ScanId, detections: usize) -> Vec<Option<bool>> {
        let labels = self.gatherer.shown.and_then(|out| read_labels(&id.label_file(out)).ok());
        let labels = labels.filter(|labels| labels.len() == detections).unwrap_or_default();
        labels.iter().map(|label| truth_of(label.id)).collect()
    }

    /// The numbers of the causes that a file tells; none where there is no file.
    fn causes_of(&self, id: &ScanId, detections: usize) -> Result<Vec<u8>, DataError> {
        let Some(causes) = &self.causes else { return Ok(Vec::new()) };
        let codes = causes.of_scan(id, detections)?.unwrap_or_default();
        let number = |code: &u8| {
            let name = &causes.names()[usize::from(*code)];
            Cause::named(name).map_or(0, |cause| cause as u8)
        };
        Ok(codes.iter().map(number).collect())
    }

    fn id(&self, place: ScanIndex) -> ScanId {
        let radar = self.rig.radars[place.radar].name.clone();
        ScanId { sequence: self.reader.sequence().name.clone(), radar, scan: place.scan as u32 }
    }

    fn left_out(&self, place: ScanIndex, reason: String) -> NotLabelled {
        NotLabelled { radar: self.rig.radars[place.radar].name.clone(), scan: place.scan, reason }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_in_so_many_scans_is_chosen_and_at_least_one() {
        let chosen = |scans: usize, every: usize| -> Vec<usize> {
            (0..scans).filter(|scan| is_chosen(*scan, scans, every)).collect()
        };
        assert_eq!(chosen(40, 8), [4, 12, 20, 28, 36]);
        assert_eq!(chosen(5, 8), [4]);
        assert_eq!(chosen(4, 8), [2]);
        assert_eq!(chosen(1, 8), [0]);
        assert_eq!(chosen(4, 1), [0, 1, 2, 3]);
        assert_eq!(chosen(0, 8), [0; 0]);
    }
}
