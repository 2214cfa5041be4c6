//! Dividing the scans of sequences among workers.
//!
//! A stretch begins with a window to be filled: some ten scans of each radar, the LiDAR scan and the images around. So
//! workers take few and long ones, and whoever has none left takes the later half of what another has still to do:
//! all end at nearly the same time. Stretches begin where measurements change anyway.

use ralf::config::{Config, nanoseconds};
use ralf::sensors::Timelines;
use ralf::space::sync;
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What it takes to fill a window with radar scans, in scans that are labelled.
const FILLING: usize = 5;
/// The same where evidence is asked for: each window then begins with seconds of LiDAR scans.
const FILLING_WITH_EVIDENCE: usize = 12;
/// What a LiDAR scan or an image takes, in scans that are labelled.
const MEASUREMENT: usize = 2;
/// How many scans a stretch has at most where there are several workers: so that these are at work on few sequences,
/// one after the other.
const MOST: usize = 1024;

/// How many LiDAR scans and images a radar scan needs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Needs {
    /// Those that the scan before it doesn't need.
    pub(crate) new: usize,
    /// Those that it shares with that one: after a cut between the two, two workers need them.
    pub(crate) shared: usize,
}

/// What radar scans at these times, ns, need, which ascend.
pub(crate) fn needs(times: &Timelines, config: &Config, scans: impl IntoIterator<Item = i64>) -> Vec<Needs> {
    let tolerances = [config.sync.lidar_tolerance_ms, config.sync.camera_tolerance_ms].map(nanoseconds);
    let sensors: Vec<(&Vec<i64>, i64)> = [&times.lidars, &times.cameras]
        .into_iter()
        .zip(tolerances)
        .flat_map(|(sensors, tolerance)| sensors.iter().map(move |times| (times, tolerance)))
        .collect();
    let mut before = vec![None; sensors.len()];
    let needs = |t_ns: i64| {
        let mut needs = Needs::default();
        for ((sensor, tolerance), before) in sensors.iter().zip(&mut before) {
            let nearest = sync::nearest(sensor, t_ns, *tolerance);
            needs.shared += usize::from(nearest.is_some() && nearest == *before);
            needs.new += usize::from(nearest.is_some() && nearest != *before);
            *before = nearest;
        }
        needs
    };
    scans.into_iter().map(needs).collect()
}

/// Places of work, of which each worker takes one after the other: first what is done alone, then the scans of
/// sequences, each in the order of time.
pub(crate) struct Stretches {
    /// The first place of each sequence.
    begins: Vec<usize>,
    /// What all places before a place take, in scans.
    before: Vec<usize>,
    /// What is done twice if a stretch is cut before a place, in scans; nothing where a sequence begins.
    twice: Vec<usize>,
    left: Mutex<Left>,
}

/// What nobody has taken.
struct Left {
    /// Stretches that nobody has begun, in their order.
    whole: VecDeque<Range<usize>>,
    /// What is left of each worker's own.
    begun: Vec<Range<usize>>,
}

impl Stretches {
    /// So many places that stand alone, and the scans of sequences, of each of which is told what it needs. One worker
    /// takes everything as it is.
    pub(crate) fn new(alone: usize, sequences: &[Vec<Needs>], evidence: bool, jobs: usize) -> Self {
        let filling = if evidence { FILLING_WITH_EVIDENCE } else { FILLING };
        let (mut begins, mut twice) = (Vec::new(), vec![0; alone]);
        let mut before: Vec<usize> = (0..=alone).collect();
        for sequence in sequences {
            begins.push(twice.len());
            for (scan, Needs { new, shared }) in sequence.iter().enumerate() {
                twice.push(if scan == 0 { 0 } else { filling + MEASUREMENT * shared });
                let begin = if scan == 0 { filling } else { 0 };
                before.push(before.last().unwrap_or(&0) + begin + 1 + MEASUREMENT * new);
            }
        }
        let mut whole: VecDeque<_> = (0..alone).map(|place| place..place + 1).collect();
        whole.extend(parts(&twice, alone, jobs));
        let left = Left { whole, begun: vec![0..0; jobs.max(1)] };
        Self { begins, before, twice, left: Mutex::new(left) }
    }

    /// The sequence and the number of the scan at a place; `None` of one that stands alone.
    pub(crate) fn scan(&self, place: usize) -> Option<(usize, usize)> {
        let sequence = self.begins.partition_point(|begin| *begin <= place).checked_sub(1)?;
        Some((sequence, place - self.begins[sequence]))
    }

    /// The place that a worker works on next; `None` where nothing is left that it should take.
    ///
    /// What another has begun it takes from the end alone, so that whatever comes before a place that somebody works on
    /// is done, under way or still to be done by somebody else.
    pub(crate) fn next(&self, worker: usize) -> Option<usize> {
        let mut left = self.left();
        if left.begun[worker].is_empty() {
            left.begun[worker] = left.whole.pop_front().or_else(|| self.part_of(&mut left.begun))?;
        }
        left.begun[worker].next()
    }

    /// The end of the stretch of which most is left, which its worker then hasn't any more: so that both are done
    /// soonest. `None` where it is done soonest by one.
    fn part_of(&self, begun: &mut [Range<usize>]) -> Option<Range<usize>> {
        let some_left = begun.iter_mut().filter(|stretch| stretch.start < stretch.end);
        let longest = some_left.max_by_key(|stretch| self.work(&with_current(stretch)))?;
        let both = |at: usize| {
            let second = self.work(&(at..longest.end)) + self.twice[at];
            self.work(&with_current(&(longest.start..at))).max(second)
        };
        // What is done twice is lost, while those of whom one has less to do than the other share again.
        let at = longest.clone().min_by_key(|at| both(*at) + self.twice[*at]);
        let at = at.filter(|at| both(*at) < self.work(&with_current(longest)))?;
        let part = at..longest.end;
        longest.end = at;
        Some(part)
    }

    /// What a stretch takes, in scans.
    fn work(&self, stretch: &Range<usize>) -> usize {
        self.before[stretch.end] - self.before[stretch.start]
    }

    fn left(&self) -> MutexGuard<'_, Left> {
        // No worker leaves it in disorder, not even one that panics.
        self.left.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What is left of a stretch, and the place that its worker is at.
fn with_current(left: &Range<usize>) -> Range<usize> {
    left.start.saturating_sub(1)..left.end
}

/// Places from a first one on in parts of nearly the same length, one where there is one worker.
fn parts(twice: &[usize], first: usize, jobs: usize) -> Vec<Range<usize>> {
    let count = twice.len() - first;
    let wanted = if jobs > 1 { count.div_ceil(MOST) } else { count.min(1) };
    let (mut parts, mut begin) = (Vec::new(), first);
    for others in (0..wanted).rev() {
        let rest = &twice[begin..];
        let end = if others > 0 { begin + cut(rest, rest.len() / (others + 1)) } else { twice.len() };
        parts.push(begin..end);
        begin = end;
    }
    parts
}

/// Where to cut, near to a wanted length, so that least is done twice.
fn cut(twice: &[usize], wanted: usize) -> usize {
    let around = wanted - wanted / 4..=wanted + wanted / 4;
    around.min_by_key(|place| (twice[*place], place.abs_diff(wanted))).unwrap_or(wanted)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What each worker takes of these sequences where all are equally fast, in turns.
    fn taken(stretches: &Stretches, workers: usize) -> Vec<Vec<usize>> {
        let mut taken = vec![Vec::new(); workers];
        loop {
            let mut some = false;
            for (worker, taken) in taken.iter_mut().enumerate() {
                let next = stretches.next(worker);
                some |= next.is_some();
                taken.extend(next);
            }
            if !some {
                return taken;
            }
        }
    }

    /// How many windows had to be filled.
    fn jumps(taken: &[Vec<usize>]) -> usize {
        taken.iter().flat_map(|taken| taken.windows(2)).filter(|pair| pair[1] != pair[0] + 1).count()
    }

    /// Scans that share so many images with the one before.
    fn sharing(shared: &[usize]) -> Vec<Needs> {
        shared.iter().map(|shared| Needs { new: 4 - shared, shared: *shared }).collect()
    }

    #[test]
    fn every_place_is_taken_once_and_windows_are_few() {
        for (counts, evidence, jobs) in [
            (vec![0], false, 2),
            (vec![1, 0, 200, 40], false, 1),
            (vec![40; 30], false, 2),
            (vec![20_000, 3], true, 7),
            (vec![110], false, 2),
            (vec![2], false, 3),
            (vec![], false, 3),
        ] {
            for alone in [0, 3] {
                // Images change with every seventh scan.
                let images = |scan: usize| if scan.is_multiple_of(7) { 0 } else { 4 };
                let needs = |count: &usize| sharing(&(0..*count).map(images).collect::<Vec<_>>());
                let needs: Vec<_> = counts.iter().map(needs).collect();
                let stretches = Stretches::new(alone, &needs, evidence, jobs);
                let taken = taken(&stretches, jobs);
                let mut all = taken.concat();
                all.sort_unstable();
                let count = alone + counts.iter().sum::<usize>();
                assert!(all.into_iter().eq(0..count));
                let most = alone + count / MOST + if jobs > 1 { 3 * jobs } else { 0 };
                assert!(jumps(&taken) <= most, "{} of {counts:?}", jumps(&taken));
            }
        }
    }

    #[test]
    fn whoever_has_nothing_left_takes_the_end_of_what_another_has() {
        let stretches = Stretches::new(0, &[vec![Needs::default(); 100]], false, 2);
        assert_eq!((stretches.next(0), stretches.next(1)), (Some(0), Some(50)));
        assert!((1..40).all(|place| stretches.next(0) == Some(place)));
        assert!((51..100).all(|place| stretches.next(1) == Some(place)));
        // Of ten, for it has a window to fill first.
        assert_eq!((stretches.next(1), stretches.next(0)), (Some(47), Some(40)));
        assert_eq!((stretches.next(1), stretches.next(1), stretches.next(1)), (Some(48), Some(49), Some(46)));
        assert_eq!(stretches.next(1), None, "the other is sooner done with five");
        assert!((41..46).all(|place| stretches.next(0) == Some(place)));
        assert_eq!(stretches.next(0), None);
    }

    #[test]
    fn a_place_names_its_sequence_and_scan() {
        let of = |count| vec![Needs::default(); count];
        let stretches = Stretches::new(2, &[of(0), of(3), of(0), of(2)], false, 2);
        let names: Vec<_> = (0..7).map(|place| stretches.scan(place)).collect();
        assert_eq!(names[..2], [None; 2]);
        assert_eq!(names[2..], [(1, 0), (1, 1), (1, 2), (3, 0), (3, 1)].map(Some));
    }

    #[test]
    fn a_cut_is_where_sequences_begin_or_images_change_if_that_is_near() {
        let second = |sequences: &[Vec<Needs>]| {
            let stretches = Stretches::new(0, sequences, false, 2);
            stretches.next(0);
            stretches.next(1)
        };
        let images = |scan: usize| if scan.is_multiple_of(7) { 0 } else { 4 };
        assert_eq!(second(&[sharing(&(0..60).map(images).collect::<Vec<_>>())]), Some(28));
        assert_eq!(second(&vec![vec![Needs::default(); 57]; 2]), Some(57));
        let long = vec![vec![Needs::default(); 900], vec![Needs::default(); 1000]];
        assert_eq!(Stretches::new(0, &long, false, 2).left().whole, [0..900, 900..1900]);
    }

    #[test]
    fn what_scans_need_is_what_is_nearest() {
        let times = Timelines {
            radars: vec![],
            lidars: vec![vec![0, 24]],
            cameras: vec![vec![2, 12, 22, 32], vec![]],
        };
        let found = needs(&times, &Config::default(), [0, 10, 20, 30]);
        let expected = [(2, 0), (1, 1), (2, 0), (1, 1)].map(|(new, shared)| Needs { new, shared });
        assert_eq!(found, expected);
    }
}
