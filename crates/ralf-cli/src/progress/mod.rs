//! How far the work has got: a bar with rate and remaining time where standard error is a terminal, and a line a minute
//! where it is not.

mod lines;

use crate::spent::{Spent, Work};
use crate::text::{grouped, tamed};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lines::{Reached, is_due};
use ralf_data::run::{Earlier, Observer, Part, Stage};
use std::io::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Says something to people, on standard error. Nobody has to listen.
pub(crate) fn say(message: &str) {
    let _ = writeln!(std::io::stderr(), "{}", tamed(message));
}

/// Whether no work is shown, whoever does it.
static QUIET: AtomicBool = AtomicBool::new(false);

/// No work is shown from now on.
pub(crate) fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

const STEPS: &str = "{prefix} [{bar:30}] {human_pos}/{human_len}  {per_sec}  {eta} left  {msg}";
const BYTES: &str = "{prefix} [{bar:30}] {bytes}/{total_bytes}  {binary_bytes_per_sec}  {eta} left";

/// One piece of work on the screen, until it is dropped.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// Whether there is no terminal to draw it on, and nobody asked for quiet.
    in_lines: bool,
}

impl Progress {
    /// A bar of so many steps.
    pub(crate) fn of_steps(steps: u64, name: impl Into<String>) -> Self {
        Self::with_template(steps, STEPS, name.into())
    }

    /// Work whose length nobody knows.
    pub(crate) fn spinner() -> Self {
        Self::shown(ProgressBar::new_spinner())
    }

    fn with_template(steps: u64, template: &str, name: String) -> Self {
        let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
        Self::shown(
            ProgressBar::new(steps)
                .with_style(style.progress_chars("=> "))
                .with_prefix(tamed(&name).into_owned()),
        )
    }

    fn shown(bar: ProgressBar) -> Self {
        let quiet = QUIET.load(Ordering::Relaxed);
        let in_lines = bar.is_hidden() && !quiet;
        if quiet {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        Self { bar, in_lines }
    }

    /// Says how far it is, where nobody sees the bar and a minute went by.
    fn say_in_lines(&self) {
        if self.in_lines && is_due() {
            let (done, all) = (self.bar.position(), self.bar.length());
            say(&Reached { name: &self.bar.prefix(), done, all, seconds: self.seconds() }.line());
        }
    }

    /// So many steps are done.
    pub(crate) fn reached(&self, steps: u64) {
        self.bar.set_position(steps);
        self.say_in_lines();
    }

    /// So many steps of so many are done.
    pub(crate) fn reached_of(&self, steps: u64, all: u64) {
        self.bar.set_length(all);
        self.reached(steps);
    }

    /// So many more steps are done.
    pub(crate) fn advance(&self, steps: u64) {
        self.bar.inc(steps);
        self.say_in_lines();
    }

    /// What the work is at.
    pub(crate) fn tell(&self, message: String) {
        self.bar.set_message(tamed(&message).into_owned());
        self.bar.tick();
    }

    /// What is worked on.
    pub(crate) fn name(&self, name: String) {
        self.bar.set_prefix(tamed(&name).into_owned());
    }

    fn seconds(&self) -> f64 {
        self.bar.elapsed().as_secs_f64()
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Shows a run's stages, one after the other.
#[derive(Default)]
pub(crate) struct Stages {
    current: Mutex<Option<Progress>>,
    /// The recording that is worked on, where there are many.
    within: Mutex<String>,
    detections: AtomicU64,
    /// Work whose end is told, since when.
    under_way: Mutex<Option<(Work, Instant)>>,
    /// Where the time went.
    pub(crate) spent: Spent,
}

impl Stages {
    /// Ends what was under way.
    fn begin_work(&self, work: Option<Work>) {
        if let Ok(mut under_way) = self.under_way.lock() {
            if let Some((work, begun)) = under_way.take() {
                self.spent.add(work, begun.elapsed());
            }
            *under_way = work.map(|work| (work, Instant::now()));
        }
    }

    /// Says something while work is shown.
    pub(crate) fn say(&self, message: &str) {
        match self.current.lock().as_deref() {
            Ok(Some(progress)) => progress.bar.suspend(|| say(message)),
            _ => say(message),
        }
    }

    /// Names the recording that is worked on from now on.
    pub(crate) fn name_recording(&self, name: &str) {
        if let Ok(mut within) = self.within.lock() {
            *within = format!("{name}: ");
        }
    }

    fn show(&self, progress: Option<Progress>) {
        if let Ok(mut current) = self.current.lock() {
            *current = progress;
        }
    }
}

impl Observer for Stages {
    fn found(&self, earlier: &Earlier) {
        let within = self.within.lock().map(|within| within.clone()).unwrap_or_default();
        earlier.told(Earlier::NOW).iter().for_each(|line| self.say(&format!("{within}{line}")));
    }

    fn begin(&self, stage: Stage, steps: u64) {
        self.begin_work((stage == Stage::Inputs).then_some(Work::Hashing));
        self.detections.store(0, Ordering::Relaxed);
        let within = self.within.lock().map(|within| within.clone()).unwrap_or_default();
        let of_steps = |what: String| Progress::of_steps(steps, within + &what);
        self.show(Some(match stage {
            Stage::Inputs => Progress::with_template(steps, BYTES, "hashing inputs".into()),
            Stage::Matching(sequence) => of_steps(format!("matching {sequence}")),
            Stage::Gathering(sequence) => of_steps(format!("gathering {sequence}")),
            Stage::Labelling(sequence) => of_steps(format!("labelling {sequence}")),
            Stage::Writing(sequence) => of_steps(format!("writing {sequence}")),
        }));
    }

    fn advance(&self, steps: u64, detections: u64) {
        let detections = self.detections.fetch_add(detections, Ordering::Relaxed) + detections;
        if let Ok(current) = self.current.lock()
            && let Some(progress) = current.as_ref()
        {
            progress.advance(steps);
            let seconds = progress.seconds();
            if detections > 0 && seconds > 0.0 {
                progress.tell(format!("{} detections/s", grouped((detections as f64 / seconds) as u64)));
            }
        }
    }

    fn end(&self) {
        self.begin_work(None);
        self.show(None);
    }

    fn spent(&self, part: Part, time: Duration) {
        self.spent.add(Work::Worker(part), time);
    }
}
