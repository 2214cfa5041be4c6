//! How much people have done, as text.

use crate::outcome::Outcome;
use crate::text::{aligned, grouped, print};
use anyhow::bail;
use ralf_data::Corrections;
use ralf_data::result::{LabelledRun, is_under_way};
use ralf_data::team::Worked;
use serde_json::Value;
use std::path::Path;

/// What was done in less says nothing of an hour, h.
const LEAST_HOURS: f64 = 0.05;

/// Prints what everybody has done, day by day, and how fast.
pub(super) fn run(out: &Path, as_json: bool) -> anyhow::Result<Outcome> {
    let worked = Worked::below(out)?;
    if worked.is_empty() && !out.is_dir() {
        bail!("{}: expected corrections, found none", out.display());
    }
    // That nobody has done anything yet is an answer of labels, begun or finished, and of corrections that were begun.
    if worked.is_empty() && Corrections::check_there(out).is_err() && !is_under_way(out)? {
        LabelledRun::open(out)?;
    }
    let page: Value = worked.iter().map(Worked::json).collect();
    print(&match (as_json, worked.is_empty()) {
        (true, _) => serde_json::to_string_pretty(&page)?,
        (false, true) => format!("{}: nobody has corrected anything yet", out.display()),
        (false, false) => table(&worked),
    })?;
    Ok(Outcome::Done)
}

fn table(worked: &[Worked]) -> String {
    let head = ["", "day (UTC)", "edits", "detections", "scans", "hours", "detections/h", "scans/h"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(worked.iter().map(row));
    aligned(&rows)
}

fn row(Worked { second, on }: &Worked) -> Vec<String> {
    let hours = on.worked_s / 3600.0;
    let rate = |count: u64| {
        if hours >= LEAST_HOURS { format!("{:.0}", count as f64 / hours) } else { "-".to_owned() }
    };
    let name = if *second { format!("{} (second)", on.author) } else { on.author.clone() };
    let mut row = vec![name, on.day.clone()];
    row.extend([on.edits, on.detections, on.scans].map(grouped));
    row.extend([format!("{hours:.2}"), rate(on.detections), rate(on.scans)]);
    row
}
