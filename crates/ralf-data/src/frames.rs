//! The one engine that yields frames: of chosen scans, in stretches of time, several at a time, with results in the
//! scans' order.
//!
//! Labelling and tuning go through it. Scans that follow each other in time are one worker's, whose window reads their
//! neighbours but once; no more than the windows of all workers are in memory, beside what the work itself returns.
//! Stretches may be of several sequences, and are divided anew as workers end, so that all do at nearly the same time.

use crate::read::SequenceReader;
use crate::stretches::{Stretches, needs};
use ralf::config::Config;
use ralf::scene::FrameWindow;
use ralf::sensors::{Rig, Timelines};
use std::sync::atomic::{AtomicUsize, Ordering};

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

impl<'a> Frames<'a> {
    /// Works on each of these scans with a window from which its frame can be asked; `work` is told the scan's place in
    /// the list. Results are in the list's order. An error ends the work.
    pub(crate) fn each<R: Send, E: Send>(
        &self,
        scans: &[ScanIndex],
        work: impl Fn(&mut FrameWindow, usize) -> Result<R, E> + Sync,
    ) -> Result<Vec<R>, E> {
        let chosen = Chosen { frames: self, scans };
        Ok(each_of(&[chosen], self.jobs, |window, _, place| work(window, place))?.pop().unwrap_or_default())
    }

    fn window(&self) -> FrameWindow<'a> {
        let window = FrameWindow::new(self.reader, self.rig, self.config);
        if self.evidence { window.with_evidence() } else { window }
    }
}

/// A worker's window, over the sequence whose scans it works on.
#[derive(Default)]
pub(crate) struct OwnWindow<'a>(Option<(usize, FrameWindow<'a>)>);

impl<'a> OwnWindow<'a> {
    /// Over the sequence of this number, which has such frames.
    pub(crate) fn over(&mut self, sequence: usize, frames: &Frames<'a>) -> &mut FrameWindow<'a> {
        let kept = self.0.take().filter(|(known, _)| *known == sequence);
        &mut self.0.insert(kept.unwrap_or_else(|| (sequence, frames.window()))).1
    }
}

/// Scans of one sequence.
pub(crate) struct Chosen<'a, 'b> {
    /// What their frames are made of.
    pub(crate) frames: &'b Frames<'a>,
    pub(crate) scans: &'b [ScanIndex],
}

/// Works on chosen scans of several sequences as [`Frames::each`] does, which may be short: workers take stretches of
/// all of them. `work` is told the sequence's place and the scan's in its list; results are in the same order.
pub(crate) fn each_of<'a, R: Send, E: Send>(
    sequences: &[Chosen<'a, '_>],
    jobs: usize,
    work: impl Fn(&mut FrameWindow, usize, usize) -> Result<R, E> + Sync,
) -> Result<Vec<Vec<R>>, E> {
    let (mut orders, mut all_needs, mut evidence) = (Vec::new(), Vec::new(), false);
    for Chosen { frames, scans } in sequences {
        let times = &frames.reader.sequence().times;
        let order = in_time(times, scans);
        let in_turn = order.iter().map(|place| time_of(times, scans[*place]));
        all_needs.push(needs(times, frames.config, in_turn));
        orders.push(order);
        evidence |= frames.evidence;
    }
    let stretches = Stretches::new(0, &all_needs, evidence, jobs);
    let worked = work_off(
        jobs,
        OwnWindow::default,
        |worker| stretches.next(worker),
        |window, place| {
            let Some((sequence, scan)) = stretches.scan(place) else { return Ok(None) };
            let window = window.over(sequence, sequences[sequence].frames);
            let place = orders[sequence][scan];
            Ok(Some((sequence, place, work(window, sequence, place)?)))
        },
    )?;
    let mut done: Vec<(usize, usize, R)> = worked.into_iter().flatten().collect();
    done.sort_by_key(|(sequence, place, _)| (*sequence, *place));
    let mut results: Vec<Vec<R>> = sequences.iter().map(|_| Vec::new()).collect();
    done.into_iter().for_each(|(sequence, _, result)| results[sequence].push(result));
    Ok(results)
}

/// The places of these scans, in the order of time.
pub(crate) fn in_time(times: &Timelines, scans: &[ScanIndex]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..scans.len()).collect();
    order.sort_by_key(|place| {
        let ScanIndex { radar, scan } = scans[*place];
        (time_of(times, scans[*place]), radar, scan)
    });
    order
}

/// When a scan was made, ns.
pub(crate) fn time_of(times: &Timelines, ScanIndex { radar, scan }: ScanIndex) -> i64 {
    times.radars[radar][scan]
}

/// All scans of all radars, radar by radar.
pub(crate) fn all_scans(times: &Timelines) -> Vec<ScanIndex> {
    let mut scans = Vec::new();
    for (radar, times) in times.radars.iter().enumerate() {
        scans.extend((0..times.len()).map(|scan| ScanIndex { radar, scan }));
    }
    scans
}

/// Works on all items, several at a time. Results are in the items' order. An error ends the work; of several it is
/// that of the first item, whatever the number of jobs.
pub(crate) fn side_by_side<T: Sync, R: Send, E: Send>(
    items: &[T],
    jobs: usize,
    work: impl Fn(&T) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    let next = AtomicUsize::new(0);
    let take = |_| Some(next.fetch_add(1, Ordering::Relaxed)).filter(|place| *place < items.len());
    work_off(jobs.min(items.len()), || (), take, |(), place| work(&items[place]))
}

/// What one worker did: a result for each place it took, or the place that failed and why.
type Worked<R, E> = Result<Vec<(usize, R)>, (usize, E)>;

/// So many workers, but one at least, take one place of the work after the other, as `next` tells each by its number,
/// until it tells of none; each begins with a state of its own. Results are in the order of the places. An error ends
/// the work: of several it is that of the first place, for what comes before a failure is still worked on, if `next`
/// gives each worker places that ascend as long as he takes none that was another's before.
pub(crate) fn work_off<S, R: Send, E: Send>(
    workers: usize,
    begin: impl Fn() -> S + Sync,
    next: impl Fn(usize) -> Option<usize> + Sync,
    work: impl Fn(&mut S, usize) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    let failed = AtomicUsize::new(usize::MAX);
    let work_off = |worker| {
        let (mut state, mut done) = (begin(), Vec::new());
        while let Some(place) = next(worker) {
            if place > failed.load(Ordering::Relaxed) {
                continue;
            }
            match work(&mut state, place) {
                Ok(result) => done.push((place, result)),
                Err(error) => {
                    failed.fetch_min(place, Ordering::Relaxed);
                    return Err((place, error));
                }
            }
        }
        Ok(done)
    };
    let work_off = &work_off;
    let results: Vec<Worked<R, E>> = std::thread::scope(|scope| {
        // The thread that asks is one of the workers: memory that it has freed serves it again.
        let others: Vec<_> = (1..workers).map(|worker| scope.spawn(move || work_off(worker))).collect();
        let own = work_off(0);
        let joined =
            others.into_iter().map(|w| w.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        std::iter::once(own).chain(joined).collect()
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

    /// The second item fails first; the first one, which then is still worked on, afterwards.
    #[test]
    fn of_several_errors_the_first_items_is_told() {
        let failed = AtomicUsize::new(0);
        let found = side_by_side(&[0, 1, 2], 2, |item| {
            failed.fetch_add(*item, Ordering::SeqCst);
            while failed.load(Ordering::SeqCst) == 0 {
                std::thread::yield_now();
            }
            Err::<(), _>(*item)
        });
        assert_eq!(found, Err(0));
    }
}
