//! Scans side by side: each worker takes a stretch of time and labels it with a window of its own.

use super::workspace::Workspace;
use super::{Observer, Stage, Task};
use crate::error::DataError;
use crate::result::{NotLabelled, ScanNotes, ScanTable};
use ralf::config::Config;
use ralf::paper::Labeler;
use ralf::scene::FrameWindow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Scans that follow each other in time and are labelled by one worker, which reads their neighbours but once.
const STRETCH: usize = 64;

/// Labels all scans of a sequence that an earlier run has not. Returns those that could not be labelled.
pub(super) fn label_scans(
    task: &Task,
    config: &Config,
    workspace: &Workspace,
    jobs: usize,
    observer: &dyn Observer,
) -> Result<Vec<NotLabelled>, DataError> {
    let scans = in_time_order(task);
    let name = &task.reader.sequence().name;
    observer.begin(Stage::Labelling(name), scans.len() as u64);
    let shared =
        Shared { task, config, workspace, observer, failed: Mutex::default(), stop: AtomicBool::new(false) };
    let stretches: Vec<_> = scans.chunks(STRETCH).collect();
    let next = AtomicUsize::new(0);
    let results: Vec<Result<(), DataError>> = std::thread::scope(|scope| {
        let work = || {
            while let Some(stretch) = stretches.get(next.fetch_add(1, Ordering::Relaxed)) {
                shared.label_stretch(stretch)?;
            }
            Ok(())
        };
        let workers: Vec<_> = (0..jobs.clamp(1, stretches.len().max(1))).map(|_| scope.spawn(work)).collect();
        workers
            .into_iter()
            .map(|worker| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    });
    observer.end();
    results.into_iter().collect::<Result<(), _>>()?;
    let mut failed = shared.failed.into_inner().unwrap_or_else(PoisonError::into_inner);
    failed.sort();
    Ok(failed)
}

/// All scans of all radars by their time: (radar, scan).
fn in_time_order(task: &Task) -> Vec<(usize, usize)> {
    let times = &task.reader.sequence().times.radars;
    let mut scans: Vec<_> = times
        .iter()
        .enumerate()
        .flat_map(|(radar, times)| times.iter().enumerate().map(move |(scan, t_ns)| (*t_ns, radar, scan)))
        .collect();
    scans.sort_unstable();
    scans.into_iter().map(|(_, radar, scan)| (radar, scan)).collect()
}

/// What all workers share.
struct Shared<'a> {
    task: &'a Task<'a>,
    config: &'a Config,
    workspace: &'a Workspace<'a>,
    observer: &'a dyn Observer,
    failed: Mutex<Vec<NotLabelled>>,
    /// A result could not be written, so that more work would be lost, too.
    stop: AtomicBool,
}

impl Shared<'_> {
    fn label_stretch(&self, stretch: &[(usize, usize)]) -> Result<(), DataError> {
        let mut window = FrameWindow::new(self.task.reader, &self.task.rig, self.config);
        for &(radar, scan) in stretch {
            if self.stop.load(Ordering::Relaxed) {
                return Ok(());
            }
            let detections = self.label_scan(&mut window, radar, scan).inspect_err(|_| {
                self.stop.store(true, Ordering::Relaxed);
            })?;
            self.observer.advance(1, detections);
        }
        Ok(())
    }

    /// Labels one scan, unless that was done before. Returns how many detections it has.
    fn label_scan(&self, window: &mut FrameWindow, radar: usize, scan: usize) -> Result<u64, DataError> {
        let Task { rig, columns, .. } = self.task;
        let name = &rig.radars[radar].name;
        if self.workspace.has_kept(radar, scan, columns) {
            return Ok(0);
        }
        let frame = match window.frame(radar, scan) {
            Ok(frame) => frame,
            Err(error) => {
                let failed = NotLabelled { radar: name.clone(), scan, reason: error.to_string() };
                self.failed.lock().unwrap_or_else(PoisonError::into_inner).push(failed);
                return self.workspace.forget(radar, scan).map(|()| 0);
            }
        };
        let labels = Labeler::new(self.config).label(&frame);
        let table = ScanTable::new(columns, &rig.radars[radar], &frame.scan, &labels);
        self.workspace.keep(radar, scan, &ScanNotes::new(&frame), &table)?;
        Ok(labels.len() as u64)
    }
}
