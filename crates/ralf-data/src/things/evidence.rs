//! All evidence on the detections of a sequence that is labelled.

use super::SequenceThings;
use crate::frames::{Frames, ScanIndex};
use crate::read::SequenceReader;
use ralf::config::Config;
use ralf::evidence::{features, observe};
use ralf::learned::{Model, Rows, UseError, Weighing};
use ralf::scene::FrameWindow;
use ralf::sensors::Rig;
use ralf_train::learning::direction;
use std::convert::Infallible;
use std::ops::RangeInclusive;

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
pub struct SequenceEvidence {
    /// Which detections these are, by their places in the [`SequenceThings`], in rising order.
    pub(super) of: Vec<usize>,
    /// How many scans were looked at.
    pub scans_looked_at: usize,
    /// How many scans of the sequence have detections.
    pub scans_with_detections: usize,
    /// The times at which it serves, ns.
    serves: RangeInclusive<i64>,
    /// [`features`], what a model makes of them (log odds), and the plausibility that the run found.
    pub(super) rows: Rows,
    /// What the model's answer makes of each row: how probably it is plausible, as a run of the learned method has it.
    pub(super) probability: Vec<f64>,
    /// By column: 1 where more of it never makes a detection less plausible, -1 where never more, else 0.
    pub(super) monotone: Vec<i8>,
}

/// No model is believed to be surer than this.
const SUREST: f64 = 1e-3;

impl SequenceEvidence {
    /// Gathers it from a recording, within an extent; `rig` and `config` are those with which it was labelled. Of a
    /// scan that can't be read nothing is observed. The result is the same for any `jobs`.
    ///
    /// # Errors
    /// A model that this program can't use, and settings out of their ranges.
    pub fn of(
        reader: &dyn SequenceReader,
        rig: &Rig,
        config: &Config,
        model: &Model,
        things: &SequenceThings,
        extent: Extent,
        jobs: usize,
    ) -> Result<Self, UseError> {
        config.check()?;
        let columns = model.places()?;
        let (scans, serves) = looked_at(things, &extent);
        let of: Vec<usize> = scans.iter().flat_map(|at| things.rows_of(*at)).collect();
        let frames = Frames { reader, rig, config, evidence: true };
        let gathered = frames.each(&scans, jobs, |window, at| {
            let detections = things.rows_of(scans[at]).len();
            Ok::<_, Infallible>(observed(window, scans[at], detections, config))
        });
        let gathered = gathered.unwrap_or_else(|never| match never {});
        let width = features().count();
        let names = model.inputs.iter().map(|input| input.name.as_str());
        let weighing = Weighing::new(model, names, &config.learned);
        let mut rows = Rows::absent(of.len(), width + 2);
        let mut probability = Vec::with_capacity(of.len());
        for Observed { rows: observed, places } in &gathered {
            let read = observed.pick_columns(&columns);
            let log_odds = log_odds(model, &read, places);
            for (row, log_odds) in log_odds.iter().enumerate() {
                let at = probability.len() + row;
                let to = rows.row_mut(at);
                to[..width].copy_from_slice(observed.row(row));
                (to[width], to[width + 1]) = (*log_odds as f32, things.sightings()[of[at]].w);
            }
            probability.extend(weighing.plausibilities(&read, &log_odds));
        }
        let monotone = features().map(|feature| direction(feature.name)).chain([1, 0]).collect();
        let with_detections = things.scans().iter().filter(|scan| !things.rows_of(**scan).is_empty());
        Ok(Self {
            of,
            scans_looked_at: scans.len(),
            scans_with_detections: with_detections.count(),
            serves,
            rows,
            probability,
            monotone,
        })
    }

    /// The model's log odds that the detection of a row is plausible; never so sure that no answer could turn it.
    pub(super) fn log_odds(&self, row: usize) -> f64 {
        let p = self.probability[row].clamp(SUREST, 1.0 - SUREST);
        (p / (1.0 - p)).ln()
    }

    /// The column of a feature.
    pub(super) fn place_of(&self, name: &str) -> Option<usize> {
        features().position(|feature| feature.name == name)
    }

    /// Whether what was observed at one time serves at another, `t_ns`, as well: at least half as much was looked at
    /// before and after that one as on either side of the own time, or all that there is.
    pub fn serves(&self, t_ns: i64) -> bool {
        self.serves.contains(&t_ns)
    }
}

/// The scans of a sequence within an extent that have detections, in their order, and when they [serve](served).
fn looked_at(things: &SequenceThings, extent: &Extent) -> (Vec<ScanIndex>, RangeInclusive<i64>) {
    let measured = things.scans().iter().filter_map(|scan| {
        let rows = things.rows_of(*scan);
        let t_ns = things.sightings()[rows.clone().next()?].t_ns;
        Some((*scan, t_ns, rows.len()))
    });
    let all: Vec<(ScanIndex, i64, usize)> = measured.collect();
    let sizes: Vec<(i64, usize)> = all.iter().map(|(_, t_ns, detections)| (*t_ns, *detections)).collect();
    let near = nearest(&sizes, extent);
    let serves = served(&sizes, &near, extent.t_ns);
    (near.into_iter().map(|at| all[at].0).collect(), serves)
}

/// The times, ns, at which those of all scans serve that were looked at for one time: as far from it as half the way
/// to the farthest of them. On a side on which none is left out there is no such end.
fn served(all: &[(i64, usize)], near: &[usize], t_ns: i64) -> RangeInclusive<i64> {
    let times = || near.iter().map(|at| all[*at].0);
    let half = times().map(|time| time.abs_diff(t_ns)).max().unwrap_or(0) / 2;
    let is_first = times().min() == all.iter().map(|(time, _)| *time).min();
    let is_last = times().max() == all.iter().map(|(time, _)| *time).max();
    let from = if is_first { i64::MIN } else { t_ns.saturating_sub_unsigned(half) };
    let to = if is_last { i64::MAX } else { t_ns.saturating_add_unsigned(half) };
    from..=to
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

/// What is known of the detections of a scan.
struct Observed {
    /// [`features`], a row for each; nothing of any where they can't be gathered.
    rows: Rows,
    /// Where each that has a place lies, with its row, in the vehicle frame, m.
    places: Vec<(usize, [f32; 3])>,
}

/// What a model makes of the detections of a scan, log odds; of those without a place its trees alone.
fn log_odds(model: &Model, rows: &Rows, places: &[(usize, [f32; 3])]) -> Vec<f64> {
    let mut log_odds = model.plausible.log_odds(rows);
    let (of, places): (Vec<usize>, Vec<[f32; 3]>) = places.iter().copied().unzip();
    let mut placed: Vec<f64> = of.iter().map(|row| log_odds[*row]).collect();
    model.add_to_trees(&mut placed, &rows.pick(of.iter().copied()), &places);
    of.into_iter().zip(placed).for_each(|(row, placed)| log_odds[row] = placed);
    log_odds
}

/// The evidence on one scan.
fn observed(
    window: &mut FrameWindow,
    ScanIndex { radar, scan }: ScanIndex,
    detections: usize,
    config: &Config,
) -> Observed {
    let mut found = Observed { rows: Rows::absent(detections, features().count()), places: Vec::new() };
    if let Ok(frame) = window.frame(radar, scan) {
        for (place, column) in observe(&frame, config).iter().enumerate() {
            found.rows.set_column(place, &column.values);
        }
        let detections = frame.scan.detections.iter().enumerate();
        found.places = detections.filter_map(|(row, known)| Some((row, known.as_ref()?.place()))).collect();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::Certainty;
    use crate::result::{LabelledRun, LabelledSequence};
    use crate::run::{LabelRun, Unwatched};
    use crate::{Recording, Settings};
    use proptest::prelude::*;
    use std::path::Path;

    #[test]
    fn a_probability_is_the_plausibility_of_a_run_with_the_model() {
        let sequence = ralf_sim::presets::find("tiny").unwrap().sequences[0].simulate(3, 4).unwrap();
        let recording = Recording::new(Path::new("simulated"), "simulated", vec![Box::new(sequence)]);
        let reader = recording.sequences[0].as_ref();
        // So that the model answers for all.
        let settings = Settings::from_toml("", &["method=learned", "learned.max_novelty=1"]).unwrap();
        let (model, out) = (Model::shipped().unwrap(), tempfile::tempdir().unwrap());
        let (recording, settings, out) = (&recording, &settings, out.path());
        LabelRun { recording, settings, out, jobs: 2, evidence: false, checks: &[], model: Some(&model) }
            .execute(&Unwatched)
            .unwrap();
        let LabelledSequence { rig, tables, settings, .. } =
            LabelledRun::open(out).unwrap().sequence(reader).unwrap();
        let things = SequenceThings::of(reader, &rig, &Certainty::of(&settings), &tables).unwrap();
        let whole = Extent { t_ns: 0, scans: usize::MAX, detections: usize::MAX };
        let found = SequenceEvidence::of(reader, &rig, &settings, &model, &things, whole, 2).unwrap();
        for (at, probability) in found.of.iter().zip(&found.probability) {
            let w = f64::from(things.sightings()[*at].w);
            assert!((w - probability).abs() < 1e-6, "{w} and {probability}");
        }
        assert!(found.of.len() > 100, "{}", found.of.len());
    }

    #[test]
    fn a_short_sequence_is_looked_at_as_a_whole_and_of_a_long_one_what_is_near() {
        let scans = [(0, 10), (100, 10), (200, 10), (300, 10)];
        let extent = |t_ns, scans, detections| Extent { t_ns, scans, detections };
        assert_eq!(nearest(&scans, &extent(-7, 4, 40)), [0, 1, 2, 3]);
        assert_eq!(nearest(&scans, &extent(210, 2, 40)), [2, 3]);
        assert_eq!(nearest(&scans, &extent(90, 4, 25)), [0, 1]);
        assert!(nearest(&scans, &extent(i64::MAX, 1, 9)).is_empty());
    }

    /// Some of a hundred scans, one in each nanosecond.
    #[test]
    fn what_was_looked_at_serves_to_the_ends_of_the_sequence_and_half_way_to_its_own() {
        let all: Vec<(i64, usize)> = (0..100).map(|t_ns| (t_ns, 1)).collect();
        let of =
            |t_ns, scans| served(&all, &nearest(&all, &Extent { t_ns, scans, detections: usize::MAX }), t_ns);
        assert_eq!(of(0, 5), i64::MIN..=2);
        assert_eq!(of(50, 9), 48..=52);
        assert_eq!(of(99, 5), 97..=i64::MAX);
        assert_eq!(of(50, 100), i64::MIN..=i64::MAX);
        assert_eq!(of(50, 0), 50..=50);
        assert_eq!(served(&[], &[], 50), i64::MIN..=i64::MAX);
    }

    proptest! {
        /// Asked again for the same time, nothing is gathered anew; where much is left out, it is for a far one.
        #[test]
        fn what_was_looked_at_serves_at_the_time_that_it_is_of(
            scans in proptest::collection::vec((0..60i64, 1..9usize), 0..20),
            (t_ns, most, detections) in (-10..70i64, 0..12usize, 0..60usize),
        ) {
            let near = nearest(&scans, &Extent { t_ns, scans: most, detections });
            let serves = served(&scans, &near, t_ns);
            prop_assert!(serves.contains(&t_ns));
            // A scan that was left out is asked for anew, but where others of the very end were looked at.
            let ends = |time: i64| near.iter().any(|at| scans[*at].0 == time);
            let nearest_out = (0..scans.len()).filter(|at| !near.contains(at));
            for (time, _) in nearest_out.map(|at| scans[at]) {
                let half = near.iter().map(|at| scans[*at].0.abs_diff(t_ns)).max().unwrap_or(0) / 2;
                let is_far = time.abs_diff(t_ns) > half;
                prop_assert!(!is_far || ends(time) || !serves.contains(&time));
            }
        }

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
