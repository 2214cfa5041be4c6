//! Whether range rates that are said to be without the vehicle's motion are: things that stand still have none then.

use super::case::{Case, is_trusted};
use super::doppler::{COMPENSATED, is_explained};
use crate::doppler::{Timed, compare};
use crate::remedy::Remedy;
use crate::verdict::{Question, Verdict};
use ralf::scene::Doppler;

/// Judges each radar that has such a field.
pub(super) fn judge(case: &Case) -> Vec<Verdict> {
    let has_field = |radar: &usize| case.sequence.rig.radars[*radar].column(Doppler::COMPENSATED).is_some();
    case.radars().filter(has_field).map(|radar| one(case, radar)).collect()
}

fn one(case: &Case, radar: usize) -> Verdict {
    let looks = case.sample.radars[radar].iter();
    let fits: Vec<Timed> =
        looks.filter_map(|look| Some(Timed { t_ns: look.t_ns, fit: look.compensated? })).collect();
    let figures = compare(&fits, &case.motion, &case.mount(radar)).filter(is_trusted);
    let (name, question) = (case.name(radar), Question::Doppler);
    let Some(figures) = figures else {
        let missing = format!(
            "{} of {} scans tell whether `{}` is without the vehicle's motion: ten at more than 1 m/s are needed in \
             which three in ten detections agree",
            fits.len(),
            case.sample.radars[radar].len(),
            Doppler::COMPENSATED
        );
        return Verdict::cannot_judge(name, question, missing);
    };
    let evidence = format!(
        "`{}` of {} scans has {:.2} of the vehicle's speed in it ({:.0} % of the detections agree)",
        Doppler::COMPENSATED,
        figures.scans,
        figures.ratio.value,
        figures.inliers * 100.0
    );
    if is_explained(&figures) {
        let remedy =
            Remedy::LookInto("`doppler_compensated` has the vehicle's motion in it: it looks like `doppler`");
        return Verdict::doubt(name, question, evidence, Some(remedy));
    }
    if figures.ratio.value < COMPENSATED {
        return Verdict::good(name, question, evidence);
    }
    Verdict::cannot_judge(name, question, format!("{evidence}: most of what agrees moves"))
}
