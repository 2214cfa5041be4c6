//! From evidence to verdicts: the change that explains the most is taken first, and the rest is judged with it in
//! place.
//!
//! Motion before clocks before LiDARs before radars, for a fault of one is seen in all that come after.

mod alternatives;
mod cameras;
mod case;
mod clocks;
mod compensated;
mod depth;
mod doppler;
mod ground;
mod lidar;
mod motion;
mod neighbours;
mod order;
mod places;
mod radar;
mod refine;
mod scale;
mod steady;
mod swapped;
mod unseen;
mod vertical;
mod wheels;

use crate::bounds;
use crate::remedy::{AS_TEXT, BACKWARDS, OTHER_ORDER, OTHER_WAY, Remedy};
use crate::sample::Sample;
use crate::verdict::{Question, SequenceCheck, State, Verdict};
use case::Case;
use ralf::sensors::Source;
pub use refine::Refinement;

/// Judges sequences of one vehicle, and refines what was found: the corrections of each sensor, jointly from range
/// rates and the LiDAR of all of them, with standard deviations. Nothing is applied.
pub fn check_and_refine(sources: &[&dyn Source]) -> (Vec<SequenceCheck>, Vec<Refinement>) {
    let samples: Vec<Sample> = sources.iter().map(|source| Sample::in_rows(*source)).collect();
    let judged = sources.iter().zip(&samples).map(|(source, sample)| with_figures(judge(*source, sample)));
    let (checked, mut cases): (Vec<_>, Vec<_>) = judged.unzip();
    (checked, refine::refine(&mut cases))
}

/// Judges a sequence. Some hundred scans of each radar and some thirty of each LiDAR are read, spread over the
/// sequence; those that can't be read are left out, and this is said. What pictures show is left out.
pub fn check(source: &dyn Source) -> SequenceCheck {
    let sample = Sample::of(source);
    judge(source, &sample).0
}

/// The same with what pictures show.
pub fn check_with_figures(source: &dyn Source) -> SequenceCheck {
    let sample = Sample::of(source);
    with_figures(judge(source, &sample)).0
}

fn with_figures<'a>((checked, case): (SequenceCheck, Case<'a>)) -> (SequenceCheck, Case<'a>) {
    (SequenceCheck { figures: case.figures(), ..checked }, case)
}

fn judge<'a>(source: &'a dyn Source, sample: &'a Sample) -> (SequenceCheck, Case<'a>) {
    let sequence = source.sequence();
    let mut verdicts = bounds::judge(sequence, sample);
    if let Some(first) = sample.unreadable.first() {
        let evidence = format!("{} scans can't be read, the first: {first}", sample.unreadable.len());
        let state = if sample.lacks_a_sensor(sequence) { State::Doubt } else { State::Fact };
        verdicts.push(Verdict::new(&sequence.name, Question::Bounds, state, evidence));
    }
    verdicts.extend(order::judge(source, sample, &unfit(&verdicts)));
    let mut case = Case::new(sequence, sample, unfit(&verdicts));
    verdicts.extend(motion::judge(&mut case));
    verdicts.extend(clocks::judge(&mut case));
    let of_wheels = wheels::judge(&case, &mut verdicts);
    verdicts.extend(of_wheels);
    verdicts.extend(lidar::judge(&mut case));
    verdicts.extend(radar::judge(&mut case));
    verdicts.extend(compensated::judge(&case));
    verdicts.extend(neighbours::judge(&mut case));
    verdicts.extend(ground::judge(&case));
    verdicts.extend(vertical::judge(&case, &verdicts));
    let of_pictures = [cameras::judge(&case, &verdicts), depth::judge(&case, &verdicts)];
    verdicts.extend(of_pictures.into_iter().flatten());
    let rank = |verdict: &Verdict| case.rank(&verdict.subject);
    verdicts.sort_by_key(|verdict| (rank(verdict), verdict.question));
    (SequenceCheck { name: sequence.name.clone(), verdicts, figures: Vec::new() }, case)
}

/// Words of remedies for what can't be asked anything else.
const UNFIT: [&str; 7] = ["type", "columns", "cm", OTHER_ORDER, OTHER_WAY, AS_TEXT, BACKWARDS];

/// Sensors whose numbers are no positions: nothing else can be asked of them.
fn unfit(verdicts: &[Verdict]) -> Vec<String> {
    let breaks = |verdict: &&Verdict| {
        let remedy = verdict.remedy.as_ref();
        verdict.state == State::Doubt && remedy.is_some_and(|remedy| {
            matches!(remedy, Remedy::Positions(_) | Remedy::InDegrees(_))
                || matches!(remedy, Remedy::LookInto(what) if UNFIT.iter().any(|word| what.contains(word)))
        })
    };
    verdicts.iter().filter(breaks).map(|verdict| verdict.subject.clone()).collect()
}
