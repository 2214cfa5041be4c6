//! Work that takes a while: without Python's lock, with progress, and stopped by Ctrl-C.

use crate::errors;
use pyo3::prelude::*;
use ralf_data::DataError;
use ralf_data::run::{Observer, Stage};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// How often signals are looked for and progress is told.
const EVERY: Duration = Duration::from_millis(50);

/// How far the work is.
#[derive(Debug, Clone, Default)]
struct Progress {
    stage: &'static str,
    name: String,
    done: u64,
    steps: u64,
    detections: u64,
}

/// Sees the work's progress, and ends it when it is asked to.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    stop: AtomicBool,
    progress: Mutex<Option<Progress>>,
}

impl Watch {
    fn set(&self, change: impl FnOnce(&mut Option<Progress>)) {
        change(&mut self.progress.lock().unwrap_or_else(PoisonError::into_inner));
    }

    /// Calls `progress(stage, name, done, steps, detections)`.
    fn tell(&self, py: Python<'_>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
        let at = self.progress.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let (Some(progress), Some(at)) = (progress, at) else { return Ok(()) };
        progress.call1(py, (at.stage, at.name, at.done, at.steps, at.detections)).map(drop)
    }
}

impl Observer for Watch {
    fn begin(&self, stage: Stage, steps: u64) {
        let (stage, name) = match stage {
            Stage::Inputs => ("hashing", "inputs"),
            Stage::Matching(name) => ("matching", name),
            Stage::Gathering(name) => ("gathering", name),
            Stage::Labelling(name) => ("labelling", name),
            Stage::Writing(name) => ("writing", name),
        };
        self.set(|progress| {
            *progress = Some(Progress { stage, name: name.to_owned(), steps, ..Progress::default() });
        });
    }

    fn advance(&self, steps: u64, detections: u64) {
        self.set(|progress| {
            if let Some(progress) = progress {
                progress.done += steps;
                progress.detections += detections;
            }
        });
    }

    fn end(&self) {
        self.set(|progress| *progress = None);
    }

    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// Does the work on a thread of its own, while this one listens to signals and tells of progress. What Python raises
/// meanwhile, Ctrl-C above all, stops it.
pub(crate) fn watched<T: Send>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Watch) -> Result<T, DataError> + Send,
) -> PyResult<T> {
    let watch = Watch::default();
    let mut raised = None;
    let done = py.detach(|| {
        thread::scope(|scope| {
            // Nothing is ever sent: the channel breaks when the work is over, however it ends.
            let (tell, hear) = channel::<()>();
            let watch = &watch;
            let worker = scope.spawn(move || {
                let done = work(watch);
                drop(tell);
                done
            });
            while let Err(RecvTimeoutError::Timeout) = hear.recv_timeout(EVERY) {
                let seen = Python::attach(|py| py.check_signals().and_then(|()| watch.tell(py, progress)));
                if let Err(error) = seen {
                    raised.get_or_insert(error);
                    watch.stop.store(true, Ordering::Relaxed);
                }
            }
            worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        })
    });
    match raised {
        Some(error) => Err(error),
        None => done.map_err(errors::data),
    }
}
