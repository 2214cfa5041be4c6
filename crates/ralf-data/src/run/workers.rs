//! Labelling scans, several at a time.

use super::any_labeler::AnyLabeler;
use super::workspace::Workspace;
use super::{Observer, Part, Stage, Task, not_read};
use crate::error::DataError;
use crate::frames::{Frames, ScanIndex};
use crate::result::{NotLabelled, ScanNotes, ScanParts, Table, told_within};
use ralf::config::Config;
use ralf::evidence;
use ralf::learned::LearnedScan;
use ralf::scene::{Frame, FrameWindow};
use std::time::Instant;

/// What all workers on a sequence share.
pub(super) struct Labelling<'a> {
    pub(super) task: &'a Task<'a>,
    pub(super) config: &'a Config,
    pub(super) observer: &'a dyn Observer,
}

impl<'a> Labelling<'a> {
    /// Labels these scans of a sequence, as far as an earlier run has not. Returns those that could not be labelled.
    pub(super) fn label_scans(
        &self,
        scans: &[ScanIndex],
        workspace: &Workspace,
        jobs: usize,
    ) -> Result<Vec<NotLabelled>, DataError> {
        let failed = self.each(scans, jobs, |window, scan| self.label_next(workspace, window, scan))?;
        let mut failed: Vec<NotLabelled> = failed.into_iter().flatten().collect();
        failed.sort();
        Ok(failed)
    }

    /// Works on these scans with windows, until somebody wants it to end. Results are in the scans' order.
    pub(super) fn each<R: Send>(
        &self,
        scans: &[ScanIndex],
        jobs: usize,
        work: impl Fn(&mut FrameWindow, ScanIndex) -> Result<R, DataError> + Sync,
    ) -> Result<Vec<R>, DataError> {
        self.observer.begin(Stage::Labelling(&self.task.reader.sequence().name), scans.len() as u64);
        let worked =
            self.frames().each(scans, jobs, |window, place| self.while_wanted(|| work(window, scans[place])));
        self.observer.end();
        worked
    }

    pub(super) fn frames(&self) -> Frames<'a> {
        let Task { reader, rig, .. } = self.task;
        Frames { reader: *reader, rig, config: self.config, evidence: self.task.gathers_evidence() }
    }

    /// Does the work unless somebody wants all of it to end.
    pub(super) fn while_wanted<R>(
        &self,
        work: impl FnOnce() -> Result<R, DataError>,
    ) -> Result<R, DataError> {
        if self.observer.stopped() { Err(DataError::Stopped) } else { work() }
    }

    /// Labels one scan and tells of it. Returns it where it can't be labelled.
    pub(super) fn label_next(
        &self,
        workspace: &Workspace,
        window: &mut FrameWindow,
        scan: ScanIndex,
    ) -> Result<Option<NotLabelled>, DataError> {
        let labelled = self.label_scan(workspace, window, scan)?;
        self.observer.advance(1, labelled.as_ref().map_or(0, |detections| *detections));
        Ok(labelled.err())
    }

    /// Labels one scan, unless that was done before. Returns how many detections are new, or why it can't be labelled.
    fn label_scan(
        &self,
        workspace: &Workspace,
        window: &mut FrameWindow,
        ScanIndex { radar, scan }: ScanIndex,
    ) -> Result<Result<u64, NotLabelled>, DataError> {
        let Task { root, reader, schema, .. } = self.task;
        let kept = workspace.kept(radar, scan, schema);
        if kept.is_some_and(|notes| not_read::changed(&notes.not_read, *reader, root).is_none()) {
            return Ok(Ok(0));
        }
        let frame = match timed(self.observer, Part::Gathering, || window.frame(radar, scan)) {
            Ok(frame) => frame,
            Err(error) => {
                let name = self.task.rig.radars[radar].name.clone();
                workspace.forget(radar, scan)?;
                let reason = told_within(&error.to_string(), root);
                return Ok(Err(NotLabelled { radar: name, scan, reason }));
            }
        };
        let table = self.table(radar, &frame)?;
        let notes = ScanNotes::new(&frame, root);
        timed(self.observer, Part::Keeping, || workspace.keep(radar, scan, &notes, &table))?;
        Ok(Ok(table.len() as u64))
    }

    /// What is said of the detections of a radar's frame.
    pub(super) fn table(&self, radar: usize, frame: &Frame) -> Result<Table, DataError> {
        let Task { rig, schema, labeler, .. } = self.task;
        let gathers = self.task.gathers_evidence();
        let observe = || if gathers { evidence::observe(frame, self.config) } else { Vec::new() };
        let evidence = timed(self.observer, Part::Evidence, observe);
        let (LearnedScan { labels, answers }, seen) = timed(self.observer, Part::Labelling, || {
            let said = match labeler {
                AnyLabeler::Learned(labeler) => labeler.label(frame, &evidence),
                AnyLabeler::Paper(labeler) => {
                    LearnedScan { labels: labeler.label(frame), answers: Vec::new() }
                }
            };
            let without_class = |i: usize| said.labels[i].plausible && said.labels[i].semantic.is_none();
            let seen = evidence::seen_classes(frame, self.config.camera.stride, without_class);
            (said, seen)
        });
        let parts = ScanParts {
            radar: &rig.radars[radar],
            scan: &frame.scan,
            labels: Some(&labels),
            evidence: &evidence,
            answers: &answers,
            seen: &seen,
        };
        Table::of_scan(schema, &parts)
    }
}

/// Does a part of the work, and tells the observer how long it took.
pub(super) fn timed<R>(observer: &dyn Observer, part: Part, work: impl FnOnce() -> R) -> R {
    let begun = Instant::now();
    let done = work();
    observer.spent(part, begun.elapsed());
    done
}
