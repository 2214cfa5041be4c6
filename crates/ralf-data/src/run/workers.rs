//! Labelling scans, several at a time.

use super::workspace::Workspace;
use super::{Observer, Stage, Task};
use crate::error::DataError;
use crate::frames::{Frames, ScanIndex, all_scans};
use crate::result::{NotLabelled, ScanNotes, ScanParts, Table};
use ralf::config::Config;
use ralf::evidence;
use ralf::learned::LearnedScan;
use ralf::paper::Labeler;
use ralf::scene::FrameWindow;

/// Labels all scans of a sequence that an earlier run has not. Returns those that could not be labelled.
pub(super) fn label_scans(
    task: &Task,
    config: &Config,
    workspace: &Workspace,
    jobs: usize,
    observer: &dyn Observer,
) -> Result<Vec<NotLabelled>, DataError> {
    let scans = all_scans(&task.reader.sequence().times);
    observer.begin(Stage::Labelling(&task.reader.sequence().name), scans.len() as u64);
    let labelling = Labelling { task, config, workspace };
    let frames =
        Frames { reader: task.reader, rig: &task.rig, config, evidence: task.gathers_evidence(), jobs };
    let labelled = frames.each(&scans, |window, place| {
        let ScanIndex { radar, scan } = scans[place];
        let labelled = labelling.label_scan(window, radar, scan)?;
        observer.advance(1, labelled.as_ref().map_or(0, |detections| *detections));
        Ok::<_, DataError>(labelled.err())
    });
    observer.end();
    let mut failed: Vec<NotLabelled> = labelled?.into_iter().flatten().collect();
    failed.sort();
    Ok(failed)
}

/// What all workers share.
struct Labelling<'a> {
    task: &'a Task<'a>,
    config: &'a Config,
    workspace: &'a Workspace<'a>,
}

impl Labelling<'_> {
    /// Labels one scan, unless that was done before. Returns how many detections are new, or why it can't be labelled.
    fn label_scan(
        &self,
        window: &mut FrameWindow,
        radar: usize,
        scan: usize,
    ) -> Result<Result<u64, NotLabelled>, DataError> {
        let Task { rig, schema, .. } = self.task;
        let name = &rig.radars[radar].name;
        if self.workspace.has_kept(radar, scan, schema) {
            return Ok(Ok(0));
        }
        let frame = match window.frame(radar, scan) {
            Ok(frame) => frame,
            Err(error) => {
                let failed = NotLabelled { radar: name.clone(), scan, reason: error.to_string() };
                self.workspace.forget(radar, scan)?;
                return Ok(Err(failed));
            }
        };
        let gathers = self.task.gathers_evidence();
        let evidence = if gathers { evidence::observe(&frame, self.config) } else { Vec::new() };
        let LearnedScan { labels, answers } = match self.task.labeler {
            Some(labeler) => labeler.label(&frame, &evidence),
            None => LearnedScan { labels: Labeler::new(self.config).label(&frame), answers: Vec::new() },
        };
        let parts = ScanParts {
            radar: &rig.radars[radar],
            scan: &frame.scan,
            labels: Some(&labels),
            evidence: &evidence,
            answers: &answers,
        };
        let table = Table::of_scan(schema, &parts)?;
        self.workspace.keep(radar, scan, &ScanNotes::new(&frame), &table)?;
        Ok(Ok(labels.len() as u64))
    }
}
