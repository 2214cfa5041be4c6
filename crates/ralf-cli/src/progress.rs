//! How far a run has got: a bar with rate and remaining time where standard error is a terminal.

use indicatif::{ProgressBar, ProgressStyle};
use ralf_data::run::{Observer, Stage};
use std::io::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// Says something to people, on standard error. Nobody has to listen.
pub(crate) fn say(message: &str) {
    let _ = writeln!(std::io::stderr(), "{message}");
}

/// Shows a run's stages as bars.
#[derive(Default)]
pub(crate) struct Bars {
    quiet: bool,
    current: Mutex<Option<ProgressBar>>,
    detections: AtomicU64,
}

impl Bars {
    /// Shows nothing where `quiet`.
    pub(crate) fn new(quiet: bool) -> Self {
        Self { quiet, ..Self::default() }
    }

    fn with_current(&self, act: impl FnOnce(&ProgressBar)) {
        if let Ok(current) = self.current.lock()
            && let Some(bar) = current.as_ref()
        {
            act(bar);
        }
    }
}

/// A bar of so many steps; hidden where standard error is no terminal.
pub(crate) fn bar(steps: u64, template: &str, name: String) -> ProgressBar {
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(steps).with_style(style.progress_chars("=> ")).with_prefix(name)
}

const BYTES: &str = "{prefix} [{bar:30}] {bytes}/{total_bytes}  {binary_bytes_per_sec}  {eta} left";
/// With a message at its end.
pub(crate) const STEPS: &str = "{prefix} [{bar:30}] {human_pos}/{human_len}  {per_sec}  {eta} left  {msg}";

impl Observer for Bars {
    fn begin(&self, stage: Stage, steps: u64) {
        if self.quiet {
            return;
        }
        let bar = match stage {
            Stage::Inputs => bar(steps, BYTES, "hashing inputs".into()),
            Stage::Matching(sequence) => bar(steps, STEPS, format!("matching {sequence}")),
            Stage::Labelling(sequence) => bar(steps, STEPS, format!("labelling {sequence}")),
            Stage::Writing(sequence) => bar(steps, STEPS, format!("writing {sequence}")),
        };
        self.detections.store(0, Ordering::Relaxed);
        if let Ok(mut current) = self.current.lock() {
            *current = Some(bar);
        }
    }

    fn advance(&self, steps: u64, detections: u64) {
        let detections = self.detections.fetch_add(detections, Ordering::Relaxed) + detections;
        self.with_current(|bar| {
            bar.inc(steps);
            let seconds = bar.elapsed().as_secs_f64();
            if detections > 0 && seconds > 0.0 {
                bar.set_message(format!("{:.0}k detections/s", detections as f64 / seconds / 1e3));
            }
        });
    }

    fn end(&self) {
        self.with_current(ProgressBar::finish_and_clear);
    }
}
