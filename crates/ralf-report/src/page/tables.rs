//! Labels against corrected ones: the paper's tables 3 (metrics) and 4 (confusion matrix).

use super::NO_TRUTH;
use super::long::{folded, is_long};
use crate::content::Content;
use crate::number::{decimal, grouped, percent};
use maud::{Markup, html};
use ralf::metrics::{Confusion, Evaluation, Rates, Scores, SequenceScores};
use ralf_data::Comparison;

const COLUMNS: [&str; 7] =
    ["Accuracy", "Precision", "Recall", "F1 plausible", "Mean IoU", "IoU plausible", "IoU artifact"];
/// The first row of the paper's table 3: the mean of 2,704 scans.
const PAPER: [f64; 7] = [0.873, 0.826, 0.779, 0.675, 0.682, 0.510, 0.854];
const PAPER_SCANS: u64 = 2704;
/// Of very many sequences those are shown at once that are labelled worst.
const WORST: usize = 10;

pub(super) fn agreement(content: &Content) -> Markup {
    html! {
        section #agreement {
            h2 { "Agreement with corrected labels" }
            @match &content.comparison {
                None => p.absent { (NO_TRUTH) }
                Some(comparison) => (compared(comparison, &content.without_truth()))
            }
        }
    }
}

fn compared(comparison: &Comparison, without_truth: &[String]) -> Markup {
    let evaluation = comparison.evaluation();
    let Scores { scan_mean, pooled } = &evaluation.overall;
    html! {
        p {
            "Precision, recall and mean IoU are means over the two classes. The paper's row is the mean over its own "
            "test data, recorded with other sensors in other places: a yardstick, not a contest."
        }
        (table(&evaluation, "Mean over scans", true, |scores| scores.scan_mean.rates))
        (table(&evaluation, "All detections together", false, |scores| scores.pooled.rates))
        h3 { "Confusion matrix" }
        (confusion(&pooled.counts))
        p.note { "Matthews’ correlation: " (decimal(pooled.rates.mcc)) " over all detections together, "
            (decimal(scan_mean.rates.mcc)) " as the mean over scans." }
        @if !without_truth.is_empty() {
            p.note { "Left out for want of corrected labels: sequences " (without_truth.join(", ")) "." }
        }
        @if !comparison.missing.is_empty() {
            p.note { "Left out for want of labels: " (comparison.missing.len()) " scans that have corrected ones." }
        }
    }
}

fn table(evaluation: &Evaluation, title: &str, with_paper: bool, rates: fn(&Scores) -> Rates) -> Markup {
    let worst = worst(evaluation, rates);
    html! {
        div.scroll { table.metrics {
            caption { (title) @if !worst.is_empty() { ", and the " (WORST) " sequences with the least F1" } }
            (head())
            tbody {
                tr.total {
                    th scope="row" { "Overall" } td { (grouped(evaluation.scans() as u64)) }
                    (cells(rates(&evaluation.overall)))
                }
                @if with_paper {
                    tr.paper {
                        th scope="row" { "Paper, on other data" } td { (grouped(PAPER_SCANS)) }
                        @for value in PAPER { td { (decimal(Some(value))) } }
                    }
                }
                @if worst.is_empty() { (rows(evaluation.sequences.iter(), rates)) }
                @else { (rows(worst.into_iter(), rates)) }
            }
        } }
        @if is_long(evaluation.sequences.len()) { (all_sequences(evaluation, rates)) }
    }
}

fn all_sequences(evaluation: &Evaluation, rates: fn(&Scores) -> Rates) -> Markup {
    let sequences = &evaluation.sequences;
    let table = html! {
        div.scroll { table.metrics { (head()) tbody { (rows(sequences.iter(), rates)) } } }
    };
    folded(sequences.len(), "sequences", &table)
}

fn head() -> Markup {
    html! {
        thead { tr {
            th scope="col" { "Sequence" } th scope="col" { "Scans" }
            @for name in COLUMNS { th scope="col" { (name) } }
        } }
    }
}

fn rows<'a>(
    sequences: impl Iterator<Item = (&'a String, &'a SequenceScores)>,
    rates: fn(&Scores) -> Rates,
) -> Markup {
    html! {
        @for (name, sequence) in sequences {
            tr {
                th scope="row" { (name) } td { (grouped(sequence.scans as u64)) }
                (cells(rates(&sequence.scores)))
            }
        }
    }
}

/// The sequences with the least F1 of very many; none where all are shown.
fn worst(evaluation: &Evaluation, rates: fn(&Scores) -> Rates) -> Vec<(&String, &SequenceScores)> {
    if !is_long(evaluation.sequences.len()) {
        return Vec::new();
    }
    let mut all: Vec<_> = evaluation.sequences.iter().collect();
    let f1 = |sequence: &SequenceScores| rates(&sequence.scores).f1_plausible.unwrap_or(1.0);
    all.sort_by(|(_, a), (_, b)| f1(a).total_cmp(&f1(b)));
    all.truncate(WORST);
    all
}

fn cells(rates: Rates) -> Markup {
    let Rates { accuracy, precision, recall, f1_plausible, mean_iou, iou_plausible, iou_artifact, .. } =
        rates;
    html! {
        @for value in [accuracy, precision, recall, f1_plausible, mean_iou, iou_plausible, iou_artifact] {
            td { (decimal(value)) }
        }
    }
}

fn confusion(counts: &Confusion) -> Markup {
    let cell = |count: u64, class: &str| {
        html! { td class=(class) { strong { (grouped(count)) } span { (percent(count, counts.total())) } } }
    };
    html! {
        div.scroll { table.confusion {
            thead { tr { td {} th scope="col" { "truly plausible" } th scope="col" { "truly artifact" } } }
            tbody {
                tr { th scope="row" { "labelled plausible" } (cell(counts.tp, "right")) (cell(counts.fp, "wrong")) }
                tr { th scope="row" { "labelled artifact" } (cell(counts.r#fn, "wrong")) (cell(counts.tn, "right")) }
            }
        } }
    }
}
