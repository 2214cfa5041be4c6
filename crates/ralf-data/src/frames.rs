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
        Ok(each_of(&[chosen], jobs, |window, _, place| work(window, place))?.pop().unwrap_or_default())
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
