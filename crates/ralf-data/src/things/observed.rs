//! All evidence on the detections of a sequence that is labelled.

use super::SequenceThings;
use crate::frames::{Frames, ScanIndex};
use crate::read::SequenceReader;
use ralf::config::Config;
use ralf::evidence::{features, observe};
use ralf::learned::{Model, Rows, UseError};
use ralf::scene::FrameWindow;
use ralf::sensors::Rig;
use ralf_train::learning::direction;
use std::convert::Infallible;

/// How much of a sequence is looked at: what lies nearest in time, as far as it is no more than that.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Extent {
    /// In the middle, ns.
    pub t_ns: i64,
    /// At most so many scans: each takes a tenth of a second or so of one processor.
    pub scans: usize,
    /// At most so many detections: each takes about a kilobyte.
    pub detections: usize,
}

/// What was observed of the detections of a sequence, or of a part of it.
#[derive(Debug, Clone)]
pub struct Observed {
    /// Which detections these are, by their places in the [`SequenceThings`], in rising order.
    pub(super) of: Vec<usize>,
    /// How many scans were looked at, and how many have detections.
    scans: (usize, usize),
    /// From when to when, ns.
    span: (i64, i64),
    /// [`features`], what a model makes of them (log odds), and the plausibility that the run found.
    pub(super) rows: Rows,
    /// By column: 1 where more of it never makes a detection less plausible, -1 where never more, else 0.
    pub(super) monotone: Vec<i8>,
}

impl Observed {
    /// Gathers it from a recording, within an extent; `rig` and `config` are those with which it was labelled. Of a
    /// scan that can't be read nothing is observed. The result is the same for any `jobs`.
    ///
    /// # Errors
    /// A model that this program can't use.
    pub fn of(
        reader: &dyn SequenceReader,
        (rig, config): (&Rig, &Config),
        model: &Model,
        things: &SequenceThings,
        (extent, jobs): (Extent, usize),
    ) -> Result<Self, UseError> {
        model.check()?;
        let columns = model.places_among(features().map(|feature| feature.name))?;
        let (scans, span) = looked_at(things, &extent);
        let all = things.scans().iter().filter(|(radar, scan)| !things.rows_of(*radar, *scan).is_empty());
        let counts = (scans.len(), all.count());
        let of: Vec<usize> = scans.iter().flat_map(|at| things.rows_of(at.radar, at.scan)).collect();
        let frames = Frames { reader, rig, config, evidence: true, jobs };
        let gathered = frames.each(&scans, |window, at| {
            let ScanIndex { radar, scan } = scans[at];
            Ok::<_, Infallible>(observed(window, (radar, scan), things.rows_of(radar, scan).len(), config))
        });
        let gathered = gathered.unwrap_or_else(|never| match never {});
        let width = features().count();
        let mut evidence = Rows::absent(0, width);
        for rows in &gathered {
            evidence.append(rows);
        }
        let log_odds = model.plausible.log_odds(&evidence.pick_columns(&columns));
        let mut rows = Rows::absent(evidence.len(), width + 2);
        for (row, (log_odds, at)) in log_odds.into_iter().zip(&of).enumerate() {
            let to = rows.row_mut(row);
            to[..width].copy_from_slice(evidence.row(row));
            (to[width], to[width + 1]) = (log_odds as f32, things.sightings()[*at].w);
        }
        let monotone = features().map(|feature| direction(feature.name)).chain([1, 0]).collect();
        Ok(Self { of, scans: counts, span, rows, monotone })
    }

    /// How many scans were looked at, and how many of the sequence have detections.
    pub fn scans(&self) -> (usize, usize) {
        self.scans
    }

    /// Whether it serves at a time, too: it is of the whole sequence, or that time lies in its middle half.
    pub fn serves(&self, t_ns: i64) -> bool {
        let (first, last) = self.span;
        let edge = (last - first) / 4;
        self.scans.0 == self.scans.1 || (first + edge..=last - edge).contains(&t_ns)
    }
}

/// The scans of a sequence within an extent that have detections, in their order, and from when to when they are, ns.
fn looked_at(things: &SequenceThings, extent: &Extent) -> (Vec<ScanIndex>, (i64, i64)) {
    let measured = things.scans().iter().filter_map(|(radar, scan)| {
        let rows = things.rows_of(*radar, *scan);
        let t_ns = things.sightings()[rows.clone().next()?].t_ns;
        Some((ScanIndex { radar: *radar, scan: *scan }, t_ns, rows.len()))
    });
    let all: Vec<(ScanIndex, i64, usize)> = measured.collect();
    let sizes: Vec<(i64, usize)> = all.iter().map(|(_, t_ns, detections)| (*t_ns, *detections)).collect();
    let near: Vec<&(ScanIndex, i64, usize)> =
        nearest(&sizes, extent).into_iter().map(|at| &all[at]).collect();
    let times = || near.iter().map(|(_, t_ns, _)| *t_ns);
    let span = (times().min().unwrap_or(extent.t_ns), times().max().unwrap_or(extent.t_ns));
    (near.iter().map(|(scan, ..)| *scan).collect(), span)
}

/// Which scans, each with its time and its number of detections, are within an extent, in rising order.
fn nearest(scans: &[(i64, usize)], extent: &Extent) -> Vec<usize> {
    let mut by_time: Vec<usize> = (0..scans.len()).collect();
    by_time.sort_by_key(|at| (scans[*at].0.abs_diff(extent.t_ns), *at));
    let mut detections = 0;
    let fits = |at: &usize| {
        detections += scans[*at].1;
        detections <= extent.detections
    };
    let mut near: Vec<usize> = by_time.into_iter().take(extent.scans).take_while(fits).collect();
    near.sort_unstable();
    near
}

/// The evidence on one scan; nothing where it can't be gathered.
fn observed(
    window: &mut FrameWindow,
    (radar, scan): (usize, usize),
    detections: usize,
    config: &Config,
) -> Rows {
    let mut rows = Rows::absent(detections, features().count());
    if let Ok(frame) = window.frame(radar, scan) {
        for (place, column) in observe(&frame, config).iter().enumerate() {
            rows.set_column(place, &column.values);
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_short_sequence_is_looked_at_as_a_whole_and_of_a_long_one_what_is_near() {
        let scans = [(0, 10), (100, 10), (200, 10), (300, 10)];
        let extent = |t_ns, scans, detections| Extent { t_ns, scans, detections };
        assert_eq!(nearest(&scans, &extent(-7, 4, 40)), [0, 1, 2, 3]);
        assert_eq!(nearest(&scans, &extent(210, 2, 40)), [2, 3]);
        assert_eq!(nearest(&scans, &extent(90, 4, 25)), [0, 1]);
        assert!(nearest(&scans, &extent(i64::MAX, 1, 9)).is_empty());
    }

    proptest! {
        /// Nothing left out is nearer than what is looked at, and one scan more would be too much.
        #[test]
        fn what_is_looked_at_is_the_nearest_and_as_much_as_fits(
            scans in proptest::collection::vec((0..60i64, 1..9usize), 0..20),
            (t_ns, most, detections) in (-10..70i64, 0..12usize, 0..60usize),
        ) {
            let near = nearest(&scans, &Extent { t_ns, scans: most, detections });
            let used: usize = near.iter().map(|at| scans[*at].1).sum();
            prop_assert!(near.is_sorted() && near.len() <= most && used <= detections);
            let far = |at: &usize| (scans[*at].0.abs_diff(t_ns), *at);
            let next = (0..scans.len()).filter(|at| !near.contains(at)).min_by_key(far);
            if let Some(next) = next {
                prop_assert!(near.iter().all(|at| far(at) < far(&next)));
                prop_assert!(near.len() == most || used + scans[next].1 > detections);
            }
        }
    }
}
