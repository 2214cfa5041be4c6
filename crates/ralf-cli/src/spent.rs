//! Where the time of a run goes, for `ralf label --timings`.

use crate::text::aligned;
use ralf_data::run::Part;
use std::sync::Mutex;
use std::time::Duration;

/// What is told apart, in the order in which it is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Work {
    /// `ralf check`, and opening the recording.
    Opening,
    /// Hashing the inputs.
    Hashing,
    /// Part of what workers do for each scan, and at the end of a sequence.
    Worker(Part),
}

const ALL: [(Work, &str); 7] = [
    (Work::Opening, "opening and check"),
    (Work::Hashing, "hashing inputs"),
    (Work::Worker(Part::Gathering), "scans: reading, ground, images"),
    (Work::Worker(Part::Evidence), "scans: evidence"),
    (Work::Worker(Part::Labelling), "scans: labels"),
    (Work::Worker(Part::Keeping), "scans: keeping"),
    (Work::Worker(Part::Writing), "writing results"),
];

/// Times of several threads, summed up, and how often each was told.
#[derive(Debug, Default)]
pub(crate) struct Spent(Mutex<[(Duration, usize); ALL.len()]>);

impl Spent {
    pub(crate) fn add(&self, work: Work, time: Duration) {
        if let (Ok(mut all), Some(place)) = (self.0.lock(), ALL.iter().position(|(known, _)| *known == work))
        {
            all[place].0 += time;
            all[place].1 += 1;
        }
    }

    /// A table of all work: of a scan's parts, how long each took on average, too.
    pub(crate) fn table(&self) -> String {
        let all = self.0.lock().map(|all| *all).unwrap_or_default();
        let mut rows = vec![["work", "s", "ms per scan"].map(str::to_owned).to_vec()];
        for ((work, name), (time, count)) in ALL.iter().zip(all) {
            let seconds = time.as_secs_f64();
            let is_of_scans = matches!(work, Work::Worker(part) if *part != Part::Writing) && count > 0;
            let each =
                if is_of_scans { format!("{:.3}", 1e3 * seconds / count as f64) } else { String::new() };
            rows.push(vec![(*name).to_owned(), format!("{seconds:.3}"), each]);
        }
        aligned(&rows)
    }
}
