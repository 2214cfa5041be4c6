//! How far the work has got, in a line: for logs, in which nobody sees a bar.

use std::sync::LazyLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// A line so often, s: a night's log stays short.
const EVERY_SECONDS: u64 = 60;

/// Whether it is time for the next line, of whatever work is under way. Who is told so says it.
pub(super) fn is_due() -> bool {
    static BEGUN: LazyLock<Instant> = LazyLock::new(Instant::now);
    static TOLD: AtomicU64 = AtomicU64::new(0);
    let now = BEGUN.elapsed().as_secs() / EVERY_SECONDS;
    TOLD.fetch_max(now, Ordering::Relaxed) < now
}

/// How far something is.
pub(super) struct Reached<'a> {
    pub(super) name: &'a str,
    pub(super) done: u64,
    /// Of how many steps, where that is known.
    pub(super) all: Option<u64>,
    pub(super) seconds: f64,
}

impl Reached<'_> {
    /// Such as `fitting: 3 of 17 (18 %), some 19 min left`.
    pub(super) fn line(&self) -> String {
        let Self { name, done, all, seconds } = *self;
        let Some(all) = all.filter(|all| *all > 0) else { return format!("{name}: {done}") };
        let share = 100.0 * done as f64 / all as f64;
        let left = seconds * all.saturating_sub(done) as f64 / done.max(1) as f64;
        let told = if done == 0 { String::new() } else { format!(", some {} left", in_words(left)) };
        format!("{name}: {done} of {all} ({share:.0} %){told}")
    }
}

fn in_words(seconds: f64) -> String {
    match seconds {
        ..90.0 => format!("{seconds:.0} s"),
        90.0..5400.0 => format!("{:.0} min", seconds / 60.0),
        _ => format!("{:.1} h", seconds / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_tells_how_far_it_is_and_what_is_left() {
        let line = |done, all, seconds| Reached { name: "fitting", done, all, seconds }.line();
        assert_eq!(line(3, Some(17), 240.0), "fitting: 3 of 17 (18 %), some 19 min left");
        assert_eq!(line(16, Some(17), 160.0), "fitting: 16 of 17 (94 %), some 10 s left");
        assert_eq!(line(1, Some(100), 120.0), "fitting: 1 of 100 (1 %), some 3.3 h left");
        assert_eq!(line(0, Some(17), 60.0), "fitting: 0 of 17 (0 %)");
        assert_eq!((line(5, None, 60.0), line(5, Some(0), 60.0)), ("fitting: 5".into(), "fitting: 5".into()));
    }
}
