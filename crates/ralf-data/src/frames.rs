//! The one engine that yields frames: of chosen scans, in stretches of time, several at a time, with results in the
//! scans' order.
//!
//! Labelling and tuning go through it. Scans that follow each other in time are one worker's, whose window reads their
//! neighbours but once; no more than the windows of all workers are in memory, beside what the work itself returns.

use crate::read::SequenceReader;
use ralf::config::Config;
use ralf::scene::FrameWindow;
use ralf::sensors::{Rig, Timelines};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Scans that follow each other in time and are worked on with one window.
const STRETCH: usize = 64;
/// At most so many where evidence is asked for: each window then begins with seconds of LiDAR scans.
const LONG_STRETCH: usize = 512;

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

impl Frames<'_> {
    /// Works on each of these scans with a window from which its frame can be asked; `work` is told the scan's place in
    /// the list. Results are in the list's order. An error ends the work.
    pub(crate) fn each<R: Send, E: Send>(
        &self,
        scans: &[ScanIndex],
        work: impl Fn(&mut FrameWindow, usize) -> Result<R, E> + Sync,
    ) -> Result<Vec<R>, E> {
        let times = &self.reader.sequence().times;
        let order = in_time(times, scans);
        let stretches: Vec<&[usize]> = order.chunks(self.stretch(scans.len())).collect();
        let stop = AtomicBool::new(false);
        let worked = side_by_side(&stretches, self.jobs, |stretch| {
            let mut window = self.window();
            let mut done = Vec::with_capacity(stretch.len());
            for place in stretch.iter().copied() {
                // Another worker has failed, so that more work would be lost, too.
                if stop.load(Ordering::Relaxed) {
                    break;
                }
                let result = work(&mut window, place);
                done.push((place, result.inspect_err(|_| stop.store(true, Ordering::Relaxed))?));
            }
            Ok(done)
        })?;
        let mut done: Vec<(usize, R)> = worked.into_iter().flatten().collect();
        done.sort_by_key(|(place, _)| *place);
        Ok(done.into_iter().map(|(_, result)| result).collect())
    }

    fn stretch(&self, scans: usize) -> usize {
        if self.evidence { (scans / self.jobs.max(1)).clamp(STRETCH, LONG_STRETCH) } else { STRETCH }
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
