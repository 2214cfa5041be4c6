//! How soon the review's queue leads to wrong labels, as text.

use crate::text::{aligned, decimal, grouped};
use ralf_data::judge::QueueCurve;

/// The share of the wrong labels in the first scans of the queue, by tenths in whole scans, beside the best and none.
pub(super) fn table(curve: &QueueCurve) -> String {
    let share = |share: f64| format!("{:.1} %", 100.0 * share);
    let mut rows =
        vec![["Scans", "wrong labels found", "at best", "in no order"].map(str::to_owned).to_vec()];
    for ((found, ideal), part) in curve.found.iter().zip(&curve.ideal).zip(curve.looked_at()) {
        rows.push(vec![share(part), share(*found), share(*ideal), share(part)]);
    }
    let (errors, scans) = (grouped(curve.errors), grouped(curve.scans as u64));
    let correlation = decimal(curve.correlation);
    let note = format!(
        "{errors} wrong labels in {scans} scans; correlation with the expected errors {correlation}\n"
    );
    aligned(&rows) + &note
}
