//! What the plausibility is worth beyond the label, and how the settings matter.

use super::number::decimal;
use super::{NO_TRUTH, figure, swatch};
use crate::content::Content;
use crate::curves::{Point, average_precision, by_plausibility, precision_recall, thinned};
use crate::scored::Scored;
use crate::settings_map::SettingsMap;
use crate::{ReportError, chart};
use maud::{Markup, html};
use ralf::metrics::{Confusion, Rates};

/// Points that a curve is drawn with.
const CURVE_POINTS: usize = 500;

pub(super) fn score(content: &Content, with_truth: &[(&Scored, bool)]) -> Result<Markup, ReportError> {
    let figures = match with_truth {
        [] => html! { p.absent { (NO_TRUTH) } },
        _ => html! {
            div.figures { (curve(with_truth)?) (reliability(content, with_truth)?) }
            div.beside { (settings(content, with_truth)?) }
        },
    };
    Ok(html! { section #score { h2 { "The plausibility as a score" } (figures) } })
}

fn curve(with_truth: &[(&Scored, bool)]) -> Result<Markup, ReportError> {
    let points = precision_recall(with_truth);
    let mut counts = Confusion::default();
    with_truth.iter().for_each(|(scored, truth)| counts.add(*truth, scored.plausible));
    let rates = Rates::new(&counts);
    let used = rates.recall_plausible.zip(rates.precision_plausible);
    let used = used.map(|(recall, precision)| Point { recall, precision });
    let base_rate = (counts.tp + counts.r#fn) as f64 / counts.total().max(1) as f64;
    let svg = chart::precision_recall(&thinned(&points, CURVE_POINTS), used, base_rate)?;
    let caption = html! {
        "Precision and recall of plausible detections as the threshold w" sub { "0" } " goes from 1 to 0. "
        (swatch("artifact round")) "the threshold of this run; dashed: everything labelled plausible. Average precision "
        (decimal(Some(average_precision(&points)))) "."
    };
    Ok(figure("Precision and recall", svg, caption))
}

fn reliability(content: &Content, with_truth: &[(&Scored, bool)]) -> Result<Markup, ReportError> {
    let bins = by_plausibility(with_truth.iter().map(|(scored, truth)| (scored.w, *truth)));
    let svg = chart::reliability(&bins, content.record.settings.method.fusion.threshold)?;
    let caption = html! {
        "How many detections of a plausibility w are truly plausible; on the dashed diagonal w would be a probability. "
        "Dotted: the threshold of this run. Below: how many detections there are."
    };
    Ok(figure("Reliability", svg, caption))
}

fn settings(content: &Content, with_truth: &[(&Scored, bool)]) -> Result<Markup, ReportError> {
    let heading = "F1 over α and w₀";
    let Some(map) = SettingsMap::of(with_truth) else {
        return Ok(html! { p.absent { "Nothing is truly plausible, so that F1 has no value." } });
    };
    let fusion = &content.record.settings.method.fusion;
    let svg = chart::settings_map(&map, (fusion.alpha, fusion.threshold))?;
    let (alpha, threshold, f1) = map.best();
    let caption = html! {
        "F1 of plausible detections, all together, for other branch weights α and thresholds w" sub { "0" } ". "
        "At α = 1 LiDAR and cameras decide alone, at α = 0 tracking does. Ring: this run (α = " (fusion.alpha) ", w" sub { "0" }
        " = " (fusion.threshold) "). Cross: the best, α = " (format!("{alpha:.2}")) ", w" sub { "0" } " = "
        (format!("{threshold:.2}")) ", with F1 = " (decimal(Some(f1))) ". A best setting found on the data it is judged by flatters itself."
    };
    Ok(figure(heading, svg, caption))
}
