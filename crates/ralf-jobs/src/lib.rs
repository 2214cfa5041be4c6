//! Work on several items at a time, whose results and errors don't depend on how many threads do it.
//!
//! ```
//! let squares = ralf_jobs::side_by_side(&[1, 2, 3], 2, |item| Ok::<_, String>(item * item));
//! assert_eq!(squares, Ok(vec![1, 4, 9]));
//! ```

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Works on all items, several at a time. Results are in the items' order.
///
/// # Errors
/// An error ends the work; of several it is that of the first item, whatever the number of jobs.
pub fn side_by_side<T: Sync, R: Send, E: Send>(
    items: &[T],
    jobs: usize,
    work: impl Fn(&T) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    let next = AtomicUsize::new(0);
    let take = |_| Some(next.fetch_add(1, Ordering::Relaxed)).filter(|place| *place < items.len());
    work_off(jobs.min(items.len()), || (), take, |(), place| work(&items[place]).map(Some))
}

/// What one worker did: results of the places it took, or the place that failed and why.
type Worked<R, E> = Result<Vec<(usize, R)>, (usize, E)>;

/// Lets workers, one at least and no more than the system gives threads, take places of the work until there are none.
/// `begin` makes the state that a worker keeps, `next` tells the place that the worker of this number takes, or none,
/// and `work` does it. Results are in the order of the places, of those that have one.
///
/// # Errors
/// An error ends the work. Of several it is that of the first place, where each worker's places ascend: what comes
/// before a failure is still worked on.
pub fn work_off<S, R: Send, E: Send>(
    workers: usize,
    begin: impl Fn() -> S + Sync,
    next: impl Fn(usize) -> Option<usize> + Sync,
    work: impl Fn(&mut S, usize) -> Result<Option<R>, E> + Sync,
) -> Result<Vec<R>, E> {
    let failed = AtomicUsize::new(usize::MAX);
    let work_off = |worker| {
        let (mut state, mut done) = (begin(), Vec::new());
        while let Some(place) = next(worker) {
            if place > failed.load(Ordering::Relaxed) {
                continue;
            }
            match work(&mut state, place) {
                Ok(result) => done.extend(result.map(|result| (place, result))),
                Err(error) => {
                    failed.fetch_min(place, Ordering::Relaxed);
                    return Err((place, error));
                }
            }
        }
        Ok(done)
    };
    let (work_off, at_most) = (&work_off, &OnceLock::new());
    let results: Vec<Worked<R, E>> = std::thread::scope(|scope| {
        // The thread that asks is one of the workers: memory that it has freed serves it again.
        let at_work = move |worker| if worker < *at_most.wait() { work_off(worker) } else { Ok(Vec::new()) };
        let spawn = |worker| std::thread::Builder::new().spawn_scoped(scope, move || at_work(worker)).ok();
        let others: Vec<_> = (1..workers).map_while(spawn).collect();
        // Where the system gives no more threads it has little left for their work, too: half of them do all of it.
        let started = others.len() + 1;
        let _ = at_most.set(if started < workers { started.div_ceil(2) } else { workers });
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
