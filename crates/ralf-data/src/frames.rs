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
use ralf_jobs::work_off;
use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};

/// A scan of a radar, by their places in the rig and in the radar's timeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ScanIndex {
    /// The radar's place in the rig.
    pub radar: usize,
    /// The scan's number.
    pub scan: usize,
}

/// What frames are made of.
pub(crate) struct Frames<'a> {
    pub(crate) reader: &'a dyn SequenceReader,
    /// With the settings' overrides.
    pub(crate) rig: &'a Rig,
    pub(crate) config: &'a Config,
    /// Whether frames carry what evidence looks at.
    pub(crate) evidence: bool,
}

impl<'a> Frames<'a> {
    /// Works on each of these scans with a window from which its frame can be asked; `work` is told the scan's place in
    /// the list. Results are in the list's order. An error ends the work.
    pub(crate) fn each<R: Send, E: Send>(
        &self,
        scans: &[ScanIndex],
        jobs: usize,
        work: impl Fn(&mut FrameWindow, usize) -> Result<R, E> + Sync,
    ) -> Result<Vec<R>, E> {
        let chosen = Chosen { frames: self, scans };
        let mut results = Vec::new();
        each_of(&[chosen], jobs, |window, _, place| work(window, place), |_, of_scans| results = of_scans)?;
        Ok(results)
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
/// all of them. `work` is told the sequence's place and the scan's in its list. `hand_on` gets the results of one
/// sequence after the other, in the same order, each as soon as it and all before it are done; after an error no more.
pub(crate) fn each_of<'a, R: Send, E: Send>(
    sequences: &[Chosen<'a, '_>],
    jobs: usize,
    work: impl Fn(&mut FrameWindow, usize, usize) -> Result<R, E> + Sync,
    hand_on: impl FnMut(usize, Vec<R>) + Send,
) -> Result<(), E> {
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
    let queue = Mutex::new(InTurn::new(orders.iter().map(Vec::len), hand_on));
    let worked = work_off(
        jobs,
        OwnWindow::default,
        |worker| stretches.next(worker),
        |window, place| {
            let Some((sequence, scan)) = stretches.scan(place) else { return Ok(None) };
            let window = window.over(sequence, sequences[sequence].frames);
            let place = orders[sequence][scan];
            let result = work(window, sequence, place)?;
            // A panic ends all of the work, so that nobody is handed what it left.
            queue.lock().unwrap_or_else(PoisonError::into_inner).add(sequence, place, result);
            Ok(None)
        },
    );
    worked.map(|_: Vec<()>| ())
}

/// Results of sequences on their way to who asked for them, who gets those of a sequence once he has all before it.
struct InTurn<R, H> {
    /// Of the sequences that are not handed on: how many results are missing, and the others with their places.
    waiting: VecDeque<(usize, Vec<(usize, R)>)>,
    /// How many sequences are handed on.
    handed_on: usize,
    hand_on: H,
}

impl<R, H: FnMut(usize, Vec<R>)> InTurn<R, H> {
    /// Sequences of so many results.
    fn new(counts: impl Iterator<Item = usize>, hand_on: H) -> Self {
        let waiting = counts.map(|count| (count, Vec::new())).collect();
        let mut queue = Self { waiting, handed_on: 0, hand_on };
        queue.hand_on_complete();
        queue
    }

    /// Takes one of a sequence's results, and hands on what is complete.
    fn add(&mut self, sequence: usize, place: usize, result: R) {
        let (missing, there) = &mut self.waiting[sequence - self.handed_on];
        *missing -= 1;
        there.push((place, result));
        self.hand_on_complete();
    }

    fn hand_on_complete(&mut self) {
        while let Some((_, mut results)) = self.waiting.pop_front_if(|(missing, _)| *missing == 0) {
            results.sort_by_key(|(place, _)| *place);
            (self.hand_on)(self.handed_on, results.into_iter().map(|(_, result)| result).collect());
            self.handed_on += 1;
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sequence_is_handed_on_once_all_before_it_are() {
        let mut handed_on = Vec::new();
        let counts = [0, 2, 1, 0].into_iter();
        let mut queue = InTurn::new(counts, |sequence, results| handed_on.push((sequence, results)));
        let mut seen = vec![queue.handed_on];
        for (sequence, place, result) in [(2, 0, "c"), (1, 1, "b"), (1, 0, "a")] {
            queue.add(sequence, place, result);
            seen.push(queue.handed_on);
        }
        assert_eq!(seen, [1, 1, 1, 4]);
        assert_eq!(handed_on, [(0, vec![]), (1, vec!["a", "b"]), (2, vec!["c"]), (3, vec![])]);
    }
}
