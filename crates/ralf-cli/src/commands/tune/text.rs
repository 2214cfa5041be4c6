//! What tuning has found, as people read it: the printed page, and the comment in the settings file.

use super::report::{Part, Report};
use crate::text::{aligned, counted, decimal};
use ralf::metrics::{Rates, Scores};
use ralf_train::Fold;

/// Columns of all tables of scores, after the row's name. Precision and recall are those of plausible detections.
const COLUMNS: [&str; 6] =
    ["Accuracy", "F1 plausible", "Mean IoU", "Precision plausible", "Recall plausible", "MCC"];

/// The values of [`COLUMNS`].
fn values(rates: &Rates) -> [Option<f64>; COLUMNS.len()] {
    [
        rates.accuracy,
        rates.f1_plausible,
        rates.mean_iou,
        rates.precision_plausible,
        rates.recall_plausible,
        rates.mcc,
    ]
}

/// Settings and scores before and after.
pub(super) fn page(report: &Report) -> String {
    let Report { objective, trials, seed, .. } = report;
    let head = format!("Tuned for {objective}: {trials} trials, seed {seed}\n");
    let mut parts = vec![head, settings(report), part("Training sequences", &report.train)];
    parts.extend(report.test.as_ref().map(|test| part("Sequences that the search did not see", test)));
    if !report.folds.is_empty() {
        parts.push(cross_validation(&report.folds));
    }
    parts.join("\n")
}

/// How the file of tuned settings begins.
pub(super) const BEGIN: &str = "# Written by: ralf tune ";

/// What the settings were tuned on and what they reach; `command` repeats it. The same for the same command.
pub(super) fn comment(report: &Report, command: &str) -> String {
    let about = |what: &str, part: &Part| {
        let names = part.sequences.join(", ");
        let (before, after) = (sentence(&part.base), sentence(&part.tuned));
        format!("{what} {names} ({}):\n  before: {before}\n  after:  {after}\n", counted(part.scans, "scan"))
    };
    let mut text = format!("Written by: {command}\n\n{}", about("Tuned on", &report.train));
    if let Some(test) = &report.test {
        text += &about("Reached on sequences that the search did not see,", test);
    }
    if !report.folds.is_empty() {
        text += "Each training sequence judged by settings tuned on the others, mean ± deviation:\n";
        text += &format!("  before: {}\n", named(&spread(&report.folds, |fold| &fold.base)));
        text += &format!("  after:  {}\n", named(&spread(&report.folds, |fold| &fold.tuned)));
    }
    text + "All figures are of all detections together.\n"
}

fn settings(report: &Report) -> String {
    let mut rows = vec![["Setting", "before", "after"].map(str::to_owned).to_vec()];
    let before_and_after = report.base.entries().into_iter().zip(report.found.settings.entries());
    rows.extend(
        before_and_after
            .map(|((key, before), (_, after))| vec![key.to_owned(), before.to_string(), after.to_string()]),
    );
    aligned(&rows)
}

fn part(title: &str, part: &Part) -> String {
    let title = format!("{title}: {} ({})", part.sequences.join(", "), counted(part.scans, "scan"));
    let mut rows = vec![heading("")];
    for (name, rates) in [
        ("mean over scans, before", &part.base.scan_mean.rates),
        ("mean over scans, after", &part.tuned.scan_mean.rates),
        ("all detections together, before", &part.base.pooled.rates),
        ("all detections together, after", &part.tuned.pooled.rates),
    ] {
        rows.push(row(name.to_owned(), values(rates).map(decimal)));
    }
    format!("{title}\n{}", aligned(&rows))
}

fn cross_validation(folds: &[Fold]) -> String {
    let mut rows = vec![heading("Left out")];
    for Fold { left_out, base, tuned, .. } in folds {
        rows.push(row(format!("{left_out}, before"), values(&base.pooled.rates).map(decimal)));
        rows.push(row(format!("{left_out}, after"), values(&tuned.pooled.rates).map(decimal)));
    }
    rows.push(row("mean ± deviation, before".to_owned(), spread(folds, |fold| &fold.base)));
    rows.push(row("mean ± deviation, after".to_owned(), spread(folds, |fold| &fold.tuned)));
    let title = "Cross-validation: each training sequence judged by settings tuned on the others, all its \
                 detections together";
    format!("{title}\n{}", aligned(&rows))
}

fn heading(name: &str) -> Vec<String> {
    row(name.to_owned(), COLUMNS.map(str::to_owned))
}

fn row(name: String, cells: [String; COLUMNS.len()]) -> Vec<String> {
    [name].into_iter().chain(cells).collect()
}

fn sentence(scores: &Scores) -> String {
    named(&values(&scores.pooled.rates).map(decimal))
}

fn named(cells: &[String]) -> String {
    let named = COLUMNS.iter().zip(cells).map(|(name, cell)| format!("{} {cell}", name.to_lowercase()));
    named.collect::<Vec<_>>().join(", ")
}

/// Mean and sample standard deviation over the folds that have the value.
fn spread(folds: &[Fold], scores: fn(&Fold) -> &Scores) -> [String; COLUMNS.len()] {
    let of_folds: Vec<_> = folds.iter().map(|fold| values(&scores(fold).pooled.rates)).collect();
    std::array::from_fn(|column| {
        let present: Vec<f64> = of_folds.iter().filter_map(|values| values[column]).collect();
        mean_and_deviation(&present)
    })
}

fn mean_and_deviation(values: &[f64]) -> String {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    match values.len() {
        0 => decimal(None),
        1 => decimal(Some(mean)),
        _ => format!("{mean:.3} ± {:.3}", (squares / (count - 1.0)).sqrt()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_needs_values_and_a_deviation_two() {
        assert_eq!(mean_and_deviation(&[]), "-");
        assert_eq!(mean_and_deviation(&[0.5]), "0.500");
        // Deviations of -0.1, 0 and 0.1: (0.01 + 0 + 0.01) / 2 = 0.1^2.
        assert_eq!(mean_and_deviation(&[0.4, 0.5, 0.6]), "0.500 ± 0.100");
    }
}
