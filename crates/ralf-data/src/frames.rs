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
use ralf_train::{Wanted, side_by_side_while};
use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};

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
}

impl Frames<'_> {
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
/// all of them. `work` is told the sequence's place and the scan's in its list. `hand_on` gets the results of one
/// sequence after the other, in the same order, each as soon as it and all before it are done; after an error no more.
pub(crate) fn each_of<R: Send, E: Send>(
    sequences: &[Chosen],
    jobs: usize,
    work: impl Fn(&mut FrameWindow, usize, usize) -> Result<R, E> + Sync,
    hand_on: impl FnMut(usize, Vec<R>) + Send,
) -> Result<(), E> {
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
    let queue = Mutex::new(InTurn::new(sequences.len(), &stretches, hand_on));
    side_by_side_while(&stretches, jobs, |Stretch { sequence, scans }, wanted| {
        let places = orders[*sequence][scans.clone()].iter().copied();
        let with = |window: &mut FrameWindow, place| Ok((place, work(window, *sequence, place)?));
        let results = sequences[*sequence].frames.one_by_one(places, wanted, with)?;
        // A panic ends all of the work, so that nobody is handed what it left.
        queue.lock().unwrap_or_else(PoisonError::into_inner).add(*sequence, results);
        Ok(())
    })
    .map(drop)
}

/// Results of sequences on their way to who asked for them, who gets those of a sequence once he has all before it.
struct InTurn<R, H> {
    /// Of the sequences that are not handed on: stretches that are left, and results with their places.
    waiting: VecDeque<(usize, Vec<(usize, R)>)>,
    /// How many sequences are handed on.
    handed_on: usize,
    hand_on: H,
}

impl<R, H: FnMut(usize, Vec<R>)> InTurn<R, H> {
    fn new(sequences: usize, stretches: &[Stretch], hand_on: H) -> Self {
        let mut waiting: VecDeque<_> = (0..sequences).map(|_| (0, Vec::new())).collect();
        stretches.iter().for_each(|stretch| waiting[stretch.sequence].0 += 1);
        Self { waiting, handed_on: 0, hand_on }
    }

    /// Takes what a stretch of a sequence told, and hands on what is complete.
    fn add(&mut self, sequence: usize, results: Vec<(usize, R)>) {
        let (left, waiting) = &mut self.waiting[sequence - self.handed_on];
        *left -= 1;
        waiting.extend(results);
        while let Some((_, mut results)) = self.waiting.pop_front_if(|(left, _)| *left == 0) {
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
        let stretch = |sequence| Stretch { sequence, scans: 0..1 };
        let mut handed_on = Vec::new();
        let stretches = [0, 0, 1, 2].map(stretch);
        let mut queue = InTurn::new(3, &stretches, |sequence, results| handed_on.push((sequence, results)));
        let mut seen = Vec::new();
        for (sequence, results) in
            [(1, vec![(0, "c")]), (0, vec![(1, "b")]), (0, vec![(0, "a")]), (2, vec![])]
        {
            queue.add(sequence, results);
            seen.push(queue.handed_on);
        }
        assert_eq!(seen, [0, 0, 2, 3]);
        assert_eq!(handed_on, [(0, vec!["a", "b"]), (1, vec!["c"]), (2, vec![])]);
    }
}
