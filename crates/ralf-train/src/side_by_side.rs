//! Work on several items at a time.

use std::sync::atomic::{AtomicUsize, Ordering};

/// What one worker did: a result for each item it took, or the item that failed and why.
type Worked<R, E> = Result<Vec<(usize, R)>, (usize, E)>;

/// Tells whoever works on an item whether that is of use.
#[derive(Debug)]
pub struct Wanted<'a> {
    place: usize,
    /// The first item that has failed.
    failed: &'a AtomicUsize,
}

impl Wanted<'_> {
    /// Whether no item before it has failed.
    pub fn still(&self) -> bool {
        self.place < self.failed.load(Ordering::Relaxed)
    }
}

/// Works on all items, several at a time. Results are in the items' order.
///
/// # Errors
/// An error ends the work; of several it is that of the first item, whatever the number of jobs.
pub fn side_by_side<T: Sync, R: Send, E: Send>(
    items: &[T],
    jobs: usize,
    work: impl Fn(&T) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    side_by_side_while(items, jobs, |item, _| work(item))
}

/// The same, where work on an item may end early once it isn't wanted any more: what it returns then is lost.
///
/// # Errors
/// As [`side_by_side`]. Items before one that failed are wanted still, for one of them may fail, too: so the error is
/// the same each time.
pub fn side_by_side_while<T: Sync, R: Send, E: Send>(
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
