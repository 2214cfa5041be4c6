//! The one engine that yields frames: of chosen scans, in stretches of time, several at a time, with results in the
//! scans' order.
//!
//! Labelling and tuning go through it. Scans that follow each other in time are one worker's, whose window reads their
//! neighbours but once; no more than the windows of all workers are in memory, beside what the work itself returns.
//! Stretches may be of several sequences, and the last ones are short, so that all workers end at nearly the same time.

use crate::read::SequenceReader;
use crate::stretches::{Stretch, shared, stretches};
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

impl Frames<'_> {
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

    /// Works on what a stretch consists of, with one window, as long as it is wanted.
    pub(crate) fn one_by_one<T, R, E>(
        &self,
        stretch: impl Iterator<Item = T>,
        wanted: &Wanted,
        work: impl Fn(&mut FrameWindow, T) -> Result<R, E>,
    ) -> Result<Vec<R>, E> {
        let mut window = self.window();
        stretch.take_while(|_| wanted.still()).map(|scan| work(&mut window, scan)).collect()
    }

    fn window(&self) -> FrameWindow<'_> {
        let window = FrameWindow::new(self.reader, self.rig, self.config);
        if self.evidence { window.with_evidence() } else { window }
    }
}

/// Scans of one sequence.
pub(crate) struct Chosen<'a> {
    /// What their frames are made of.
    pub(crate) frames: &'a Frames<'a>,
    pub(crate) scans: &'a [ScanIndex],
}

/// Works on chosen scans of several sequences as [`Frames::each`] does, which may be short: workers take stretches of
/// all of them. `work` is told the sequence's place and the scan's in its list; results are in the same order.
pub(crate) fn each_of<R: Send, E: Send>(
    sequences: &[Chosen],
    jobs: usize,
    work: impl Fn(&mut FrameWindow, usize, usize) -> Result<R, E> + Sync,
) -> Result<Vec<Vec<R>>, E> {
    let (mut orders, mut all_shared, mut evidence) = (Vec::new(), Vec::new(), false);
    for Chosen { frames, scans } in sequences {
        let times = &frames.reader.sequence().times;
        let order = in_time(times, scans);
        let in_turn = order.iter().map(|place| time_of(times, scans[*place]));
        all_shared.push(shared(times, frames.config, in_turn));
        orders.push(order);
        evidence |= frames.evidence;
    }
    let stretches = stretches(&all_shared, evidence, jobs);
    let worked = side_by_side_while(&stretches, jobs, |Stretch { sequence, scans }, wanted| {
        let places = orders[*sequence][scans.clone()].iter().copied();
        let with = |window: &mut FrameWindow, place| Ok((*sequence, place, work(window, *sequence, place)?));
        sequences[*sequence].frames.one_by_one(places, wanted, with)
    })?;
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

/// What one worker did: a result for each item it took, or the item that failed and why.
type Worked<R, E> = Result<Vec<(usize, R)>, (usize, E)>;

/// Tells whoever works on an item whether that is of use.
pub(crate) struct Wanted<'a> {
    place: usize,
    /// The first item that has failed.
    failed: &'a AtomicUsize,
}

impl Wanted<'_> {
    /// Whether no item before it has failed.
    pub(crate) fn still(&self) -> bool {
        self.place < self.failed.load(Ordering::Relaxed)
    }
}

/// Works on all items, several at a time. Results are in the items' order. An error ends the work; of several it is
/// that of the first item, whatever the number of jobs.
pub(crate) fn side_by_side<T: Sync, R: Send, E: Send>(
    items: &[T],
    jobs: usize,
    work: impl Fn(&T) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    side_by_side_while(items, jobs, |item, _| work(item))
}

/// The same, where work on an item may end early once it isn't wanted any more: what it returns then is lost.
///
/// Items before one that failed are wanted still, for one of them may fail, too: so the error is the same each time.
pub(crate) fn side_by_side_while<T: Sync, R: Send, E: Send>(
    items: &[T],
    jobs: usize,
    work: impl Fn(&T, &Wanted) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    let (next, failed) = (AtomicUsize::new(0), AtomicUsize::new(usize::MAX));
    let work_off = || {
        let mut done = Vec::new();
        loop {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let wanted = Wanted { place, failed: &failed };
            let Some(item) = items.get(place).filter(|_| wanted.still()) else { return Ok(done) };
            match work(item, &wanted) {
                Ok(result) => done.push((place, result)),
                Err(error) => {
                    // The others find no more items; those before this one are somebody's already.
                    failed.fetch_min(place, Ordering::Relaxed);
                    return Err((place, error));
                }
            }
        }
    };
    let results: Vec<Worked<R, E>> = std::thread::scope(|scope| {
        // The thread that asks is one of the workers: memory that it has freed serves it again.
        let others: Vec<_> = (1..jobs.min(items.len())).map(|_| scope.spawn(work_off)).collect();
        let own = work_off();
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

    /// The second item fails at once; the first one, which then is still wanted, and the third, which isn't, only when
    /// it has.
    #[test]
    fn of_several_errors_the_first_items_is_told() {
        let failed = AtomicUsize::new(usize::MAX);
        let [first, second, third] = [0, 1, 2].map(|place| Wanted { place, failed: &failed });
        assert!(first.still() && second.still() && third.still());
        failed.store(1, Ordering::SeqCst);
        assert!(first.still() && !second.still() && !third.still());
        let second_failed = AtomicUsize::new(0);
        let found = side_by_side_while(&[0, 1], 2, |item, wanted| {
            second_failed.fetch_add(*item, Ordering::SeqCst);
            while second_failed.load(Ordering::SeqCst) == 0 {
                std::thread::yield_now();
            }
            if wanted.still() { Err(*item) } else { Ok(()) }
        });
        assert_eq!(found, Err(0));
    }
}
