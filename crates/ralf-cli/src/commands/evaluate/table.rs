//! An evaluation as text: the paper's tables 3 (metrics) and 4 (confusion matrix).

use crate::text::{aligned, decimal};
use ralf::metrics::{Confusion, Evaluation, Rates, ScoreWorth, Scores};
use ralf_data::Comparison;

/// The paper's columns, after the row's name and its number of scans or detections.
const COLUMNS: [&str; 7] =
    ["Acc", "Precision", "Recall", "F1 plausible", "mean IoU", "IoU plausible", "IoU artifact"];

/// The paper's table, as the mean over scans and pooled, and the confusion matrix.
pub(super) fn table(evaluation: &Evaluation) -> String {
    let by_scan = of_sequences(evaluation, "Mean over scans", |scores| scores.scan_mean.rates);
    let together = of_sequences(evaluation, "All detections together", |scores| scores.pooled.rates);
    let Scores { scan_mean: means, pooled: sums } = &evaluation.overall;
    let mcc = format!(
        "MCC: {} over all detections together, {} as the mean over scans\n",
        decimal(sums.rates.mcc),
        decimal(means.rates.mcc)
    );
    let note = "Precision, recall and mean IoU are means over the two classes.\n";
    let worth = evaluation.plausibility.as_ref().map(worth).unwrap_or_default();
    [by_scan, together, confusion(&sums.counts), mcc + note + &worth].join("\n")
}

/// What plausibilities are worth.
fn worth(worth: &ScoreWorth) -> String {
    format!(
        "Plausibility w: average precision {}, calibration error (ECE, 15 cells) {}; what is labelled artifact at any \
         threshold, such as floor detections of the paper's method, is never found\n",
        decimal(worth.average_precision),
        decimal(worth.calibration_error)
    )
}

/// One row for every scan.
pub(super) fn of_scans(comparison: &Comparison) -> String {
    let mut rows = vec![heading("Scan", "Detections")];
    rows.extend(
        comparison
            .scans
            .iter()
            .map(|(scan, counts)| row(scan.to_string(), counts.total().to_string(), &Rates::new(counts))),
    );
    aligned(&rows)
}

fn of_sequences(evaluation: &Evaluation, title: &str, rates: fn(&Scores) -> Rates) -> String {
    let mut rows = vec![heading("Sequence", "Scans")];
    rows.push(row("overall".into(), evaluation.scans().to_string(), &rates(&evaluation.overall)));
    rows.extend(
        evaluation
            .sequences
            .iter()
            .map(|(name, sequence)| row(name.clone(), sequence.scans.to_string(), &rates(&sequence.scores))),
    );
    format!("{title}\n{}", aligned(&rows))
}

fn heading(name: &str, count: &str) -> Vec<String> {
    [name, count].into_iter().chain(COLUMNS).map(str::to_owned).collect()
}

fn row(name: String, count: String, rates: &Rates) -> Vec<String> {
    let values = [
        rates.accuracy,
        rates.precision,
        rates.recall,
        rates.f1_plausible,
        rates.mean_iou,
        rates.iou_plausible,
        rates.iou_artifact,
    ];
    [name, count].into_iter().chain(values.map(decimal)).collect()
}

fn confusion(counts: &Confusion) -> String {
    let cell = |count: u64| {
        let share = (counts.total() > 0).then(|| 100.0 * count as f64 / counts.total() as f64);
        format!("{count} ({:>5} %)", share.map_or("-".to_owned(), |share| format!("{share:.2}")))
    };
    let of_label = |name: &str, plausible, artifact| vec![name.to_owned(), cell(plausible), cell(artifact)];
    let heading = ["Detections", "truly plausible", "truly artifact"].map(str::to_owned).to_vec();
    aligned(&[
        heading,
        of_label("labelled plausible", counts.tp, counts.fp),
        of_label("labelled artifact", counts.r#fn, counts.tn),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf_data::ScanId;

    fn counts([tp, fp, tn, missed]: [u64; 4]) -> Confusion {
        Confusion { tp, fp, tn, r#fn: missed }
    }

    /// Worked out by hand: 00 is perfect, 01 holds no artifacts.
    #[test]
    fn the_whole_text() {
        let mut evaluation =
            Evaluation::from_scans([("00", counts([1, 0, 1, 0])), ("01", counts([3, 0, 0, 1]))]);
        let expected = "\
Mean over scans
Sequence  Scans    Acc  Precision  Recall  F1 plausible  mean IoU  IoU plausible  IoU artifact
overall       2  0.875      1.000   0.875         0.929     0.875          0.875         1.000
00            1  1.000      1.000   1.000         1.000     1.000          1.000         1.000
01            1  0.750      1.000   0.750         0.857     0.750          0.750             -

All detections together
Sequence  Scans    Acc  Precision  Recall  F1 plausible  mean IoU  IoU plausible  IoU artifact
overall       2  0.833      0.750   0.900         0.889     0.650          0.800         0.500
00            1  1.000      1.000   1.000         1.000     1.000          1.000         1.000
01            1  0.750      1.000   0.750         0.857     0.750          0.750             -

Detections          truly plausible  truly artifact
labelled plausible      4 (66.67 %)     0 ( 0.00 %)
labelled artifact       1 (16.67 %)     1 (16.67 %)

MCC: 0.632 over all detections together, 1.000 as the mean over scans
Precision, recall and mean IoU are means over the two classes.
";
        assert_eq!(table(&evaluation), expected, "\n{}", table(&evaluation));
        evaluation.plausibility = Some(ScoreWorth { average_precision: Some(0.75), calibration_error: None });
        let text = table(&evaluation);
        let (before, worth) = text.split_at(expected.len());
        let told = "Plausibility w: average precision 0.750, calibration error (ECE, 15 cells) -; ";
        assert!(before == expected && worth.starts_with(told), "{worth}");
    }

    #[test]
    fn every_scan_has_its_row() {
        let scan = ScanId { sequence: "00".into(), radar: "front".into(), scan: 12 };
        let scans = vec![(scan, counts([3, 0, 0, 1]))];
        let comparison = Comparison { scans, missing: vec![], without_truth: vec![] };
        let expected = "\
Scan             Detections    Acc  Precision  Recall  F1 plausible  mean IoU  IoU plausible  IoU artifact
00/front/000012           4  0.750      1.000   0.750         0.857     0.750          0.750             -
";
        assert_eq!(of_scans(&comparison), expected);
    }

    #[test]
    fn nothing_compared_shows_dashes() {
        let text = table(&Evaluation::from_scans([("00", counts([0; 4]))]));
        assert!(text.contains("labelled plausible      0 (    - %)     0 (    - %)\n"), "{text}");
        assert!(text.contains("MCC: - over all detections together, - as the mean over scans"), "{text}");
    }
}
