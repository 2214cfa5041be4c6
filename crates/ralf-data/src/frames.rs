//! The one engine that yields frames: of chosen scans, in stretches of time, several at a time, with results in the
//! scans' order.
//!
//! Labelling and tuning go through it. Scans that follow each other in time are one worker's, whose window reads their
//! neighbours but once; no more than the windows of all workers are in memory, beside what the work itself returns.
//! Stretches may be of several sequences, and the last ones are short, so that all workers end at nearly the same time.

use crate::read::SequenceReader;
use ralf::config::Config;
use ralf::scene::FrameWindow;
use ralf::sensors::{Rig, Timelines};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// How many scans that follow each other in time are worked on with one window: the least of the last stretches, and
/// the most. A window begins with some ten scans of each radar.
const STRETCH: [usize; 2] = [16, 64];
/// The same where evidence is asked for: each window then begins with seconds of LiDAR scans.
const LONG_STRETCH: [usize; 2] = [64, 512];

/// A scan of a radar, by their places in the rig and in the radar's timeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct ScanIndex {
    pub(crate) radar: usize,
    pub(crate) scan: usize,
}

/// What frames are made of.
pub(crate) struct Frames<'a> {
    pub(crate) reader: &'a dyn SequenceReader,
    /// With the settings' overrides.
    pub(crate) rig: &'a Rig,
    pub(crate) config: &'a Config,
    /// Whether frames carry what evidence looks at.
    pub(crate) evidence: bool,
    /// Threads.
    pub(crate) jobs: usize,
}

/// Scans of a sequence that one worker works on with one window.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Stretch {
    /// The sequence's number.
    pub(crate) sequence: usize,
    /// Which of its scans, in the order of time; none of a sequence that has none.
    pub(crate) scans: Range<usize>,
}

/// Cuts sequences of so many scans into stretches, each sequence into one at least. They get shorter as less is left,
/// so that no worker waits long for the last one.
pub(crate) fn stretches(scans: &[usize], evidence: bool, jobs: usize) -> Vec<Stretch> {
    let [least, most] = if evidence { LONG_STRETCH } else { STRETCH };
    let mut left: usize = scans.iter().sum();
    let mut stretches = Vec::new();
    for (sequence, count) in scans.iter().copied().enumerate() {
        let mut begin = 0;
        loop {
            let wanted = if jobs > 1 { left.div_ceil(2 * jobs).clamp(least, most) } else { most };
            // What is left of it is cut evenly: a window for two scans would cost more than they do.
            let end = begin + (count - begin).div_ceil((count - begin).div_ceil(wanted).max(1));
            stretches.push(Stretch { sequence, scans: begin..end });
            left -= end - begin;
            begin = end;
            if begin == count {
                break;
            }
        }
    }
    stretches
}

impl Frames<'_> {
    /// Works on each of these scans with a window from which its frame can be asked; `work` is told the scan's place in
    /// the list. Results are in the list's order. An error ends the work.
    pub(crate) fn each<R: Send, E: Send>(
        &self,
        scans: &[ScanIndex],
        work: impl Fn(&mut FrameWindow, usize) -> Result<R, E> + Sync,
    ) -> Result<Vec<R>, E> {
        let order = in_time(&self.reader.sequence().times, scans);
        let stop = AtomicBool::new(false);
        let stretches = stretches(&[scans.len()], self.evidence, self.jobs);
        let worked = side_by_side(&stretches, self.jobs, |Stretch { scans, .. }| {
            let places = order[scans.clone()].iter().copied();
            self.one_by_one(places, &stop, |window, place| Ok((place, work(window, place)?)))
        })?;
        let mut done: Vec<(usize, R)> = worked.into_iter().flatten().collect();
        done.sort_by_key(|(place, _)| *place);
        Ok(done.into_iter().map(|(_, result)| result).collect())
    }

    /// Works on what a stretch consists of, with one window, until somebody has failed: more work would be lost, too.
    pub(crate) fn one_by_one<T, R, E>(
        &self,
        stretch: impl Iterator<Item = T>,
        stop: &AtomicBool,
        work: impl Fn(&mut FrameWindow, T) -> Result<R, E>,
    ) -> Result<Vec<R>, E> {
        let mut window = self.window();
        let going = stretch.take_while(|_| !stop.load(Ordering::Relaxed));
        let done = going.map(|scan| work(&mut window, scan)).collect::<Result<Vec<_>, _>>();
        done.inspect_err(|_| stop.store(true, Ordering::Relaxed))
    }

    fn window(&self) -> FrameWindow<'_> {
        let window = FrameWindow::new(self.reader, self.rig, self.config);
        if self.evidence { window.with_evidence() } else { window }
    }
}

/// The places of these scans, in the order of time.
pub(crate) fn in_time(times: &Timelines, scans: &[ScanIndex]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..scans.len()).collect();
    order.sort_by_key(|place| {
        let ScanIndex { radar, scan } = scans[*place];
        (times.radars[radar][scan], radar, scan)
    });
    order
}

/// All scans of all radars, radar by radar.
pub(crate) fn all_scans(times: &Timelines) -> Vec<ScanIndex> {
    let mut scans = Vec::new();
    for (radar, times) in times.radars.iter().enumerate() {
        scans.extend((0..times.len()).map(|scan| ScanIndex { radar, scan }));
    }
    scans
}

/// What one worker did: a result for each item it took, or the item that failed and why.
type Worked<R, E> = Result<Vec<(usize, R)>, (usize, E)>;

/// Works on all items, several at a time. Results are in the items' order. An error ends the work; of several it is
/// that of the first item, whatever the number of jobs.
pub(crate) fn side_by_side<T: Sync, R: Send, E: Send>(
    items: &[T],
    jobs: usize,
    work: impl Fn(&T) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    let next = AtomicUsize::new(0);
    let work_off = || {
        let mut done = Vec::new();
        loop {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(place) else { return Ok(done) };
            match work(item) {
                Ok(result) => done.push((place, result)),
                Err(error) => {
                    // The others find no more items; those before this one are somebody's already.
                    next.store(items.len(), Ordering::Relaxed);
                    return Err((place, error));
                }
            }
        }
    };
    let results: Vec<Worked<R, E>> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..jobs.clamp(1, items.len().max(1))).map(|_| scope.spawn(work_off)).collect();
        let joined =
            workers.into_iter().map(|w| w.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        joined.collect()
    });
    let (mut done, mut failed) = (Vec::new(), Vec::new());
    for result in results {
        match result {
            Ok(of_worker) => done.extend(of_worker),
            Err(error) => failed.push(error),
        }
    }
    if let Some((_, error)) = failed.into_iter().min_by_key(|(place, _)| *place) {
        return Err(error);
    }
    done.sort_by_key(|(place, _)| *place);
    Ok(done.into_iter().map(|(_, result)| result).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_hold_every_scan_once_and_are_short_at_the_end() {
        for (counts, evidence, jobs) in [
            (vec![0], false, 2),
            (vec![1, 0, 200, 40], false, 1),
            (vec![40; 30], false, 2),
            (vec![20_000, 3], true, 7),
            (vec![110], false, 2),
            (vec![], false, 3),
        ] {
            let [least, most] = if evidence { LONG_STRETCH } else { STRETCH };
            let stretches = stretches(&counts, evidence, jobs);
            for (sequence, count) in counts.iter().enumerate() {
                let own: Vec<_> = stretches.iter().filter(|stretch| stretch.sequence == sequence).collect();
                let scans: Vec<usize> = own.iter().flat_map(|stretch| stretch.scans.clone()).collect();
                assert!(!own.is_empty() && scans.into_iter().eq(0..*count));
                let shortest = own.iter().map(|stretch| stretch.scans.len()).min();
                assert!(shortest >= Some(least.div_ceil(2).min(*count)), "{own:?}");
            }
            assert!(stretches.is_sorted_by_key(|stretch| stretch.sequence));
            assert!(stretches.iter().all(|stretch| stretch.scans.len() <= most));
        }
        // 110 scans for two: 28 of 110, 21 of the 82 left, and then short ones.
        let lengths =
            stretches(&[110], false, 2).iter().map(|stretch| stretch.scans.len()).collect::<Vec<_>>();
        assert_eq!(lengths, [28, 21, 16, 15, 15, 15]);
        assert_eq!(stretches(&[110], false, 1).len(), 2);
    }

    #[test]
    fn results_are_in_the_items_order_whatever_the_number_of_jobs() {
        let items: Vec<usize> = (0..500).collect();
        for jobs in [1, 2, 7, 1000] {
            let found = side_by_side(&items, jobs, |item| Ok::<_, ()>(item * item)).unwrap();
            assert!(found.into_iter().eq(items.iter().map(|item| item * item)));
        }
        assert_eq!(side_by_side(&[] as &[u8], 3, |_| Err::<(), _>("never asked")), Ok(vec![]));
    }

    #[test]
    fn an_error_ends_the_work() {
        let seen = AtomicUsize::new(0);
        let items: Vec<usize> = (0..10_000).collect();
        let found = side_by_side(&items, 2, |item| {
            seen.fetch_add(1, Ordering::Relaxed);
            if *item == 3 { Err("three") } else { Ok(()) }
        });
        assert_eq!(found, Err("three"));
        assert!(seen.into_inner() < items.len());
    }

    /// The second item fails at once, the first one only when it has.
    #[test]
    fn of_several_errors_the_first_items_is_told() {
        let second_failed = AtomicBool::new(false);
        let found = side_by_side(&[0, 1], 2, |item| {
            if *item == 1 {
                second_failed.store(true, Ordering::SeqCst);
            }
            while !second_failed.load(Ordering::SeqCst) {
                std::thread::yield_now();
            }
            Err::<(), _>(*item)
        });
        assert_eq!(found, Err(0));
    }
}
