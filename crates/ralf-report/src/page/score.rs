//! What the plausibility is worth beyond the label, and how the settings matter.

use super::{NO_TRUTH, figure, swatch};
use crate::content::Content;
use crate::curves::thinned;
use crate::findings::Findings;
use crate::number::decimal;
use crate::{ReportError, chart};
use maud::{Markup, html};
use ralf::config::Method;
use ralf::metrics::{RankedPoint, Rates, average_precision};

/// Points that a curve is drawn with.
const CURVE_POINTS: usize = 500;

pub(super) fn score(content: &Content) -> Result<Markup, ReportError> {
    let figures = match content.findings.has_truth() {
        false => html! { p.absent { (NO_TRUTH) } },
        true => html! {
            div.figures { (curve(&content.findings)?) (reliability(content)?) }
            div.beside { (settings(content)?) }
        },
    };
    Ok(html! { section #score { h2 { "The plausibility as a score" } (figures) } })
}

fn curve(findings: &Findings) -> Result<Markup, ReportError> {
    let points = findings.ranked.precision_recall();
    let counts = &findings.confusion;
    let rates = Rates::new(counts);
    let used = rates.recall_plausible.zip(rates.precision_plausible);
    let used = used.map(|(recall, precision)| RankedPoint { recall, precision });
    let positives = counts.tp + counts.r#fn;
    let base_rate = positives as f64 / counts.total().max(1) as f64;
    let svg = chart::precision_recall(&thinned(&points, CURVE_POINTS), used, base_rate)?;
    let caption = html! {
        "Precision and recall of plausible detections as the threshold w" sub { "0" } " goes from 1 to 0. "
        (swatch("artifact round"))
        "the threshold of this run; dashed: everything labelled plausible. Average precision "
        (decimal((positives > 0).then(|| average_precision(&points))))
        ". What is an artifact at any w, such as a floor detection of the paper's method, never passes."
    };
    Ok(figure("Precision and recall", svg, caption))
}

fn reliability(content: &Content) -> Result<Markup, ReportError> {
    let svg = chart::reliability(&content.findings.truly, content.record.settings.method.fusion.threshold)?;
    let caption = html! {
        "How many detections of a plausibility w are truly plausible; on the dashed diagonal w would be a probability. "
        "Dotted: the threshold of this run. Below: how many detections there are."
    };
    Ok(figure("Reliability", svg, caption))
}

fn settings(content: &Content) -> Result<Markup, ReportError> {
    let heading = "F1 over α and w₀";
    if content.record.settings.method.method == Method::Learned {
        return Ok(html! { p.absent { "A model answers without α, so that there is nothing to choose." } });
    }
    let Some(map) = content.findings.passed.map() else {
        return Ok(html! { p.absent { "Nothing is truly plausible, so that F1 has no value." } });
    };
    let fusion = &content.record.settings.method.fusion;
    let svg = chart::settings_map(&map, (fusion.alpha, fusion.threshold))?;
    let (alpha, threshold, f1) = map.best();
    let caption = html! {
        "F1 of plausible detections, all together, for other branch weights α and thresholds w" sub { "0" } ". "
        "At α = 1 LiDAR and cameras decide alone, at α = 0 tracking does. Ring: this run (α = " (fusion.alpha)
        ", w" sub { "0" } " = " (fusion.threshold)
        "). Cross: the best of this grid, α = " (format!("{alpha:.2}")) ", w" sub { "0" } " = "
        (format!("{threshold:.2}")) ", with F1 = " (decimal(Some(f1)))
        ". A best setting found on the data it is judged by flatters itself."
    };
    Ok(figure(heading, svg, caption))
}
