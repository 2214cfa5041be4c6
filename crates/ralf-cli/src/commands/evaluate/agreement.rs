//! How far two people agree, as text.

use crate::corrections::orphaned;
use crate::outcome::Outcome;
use crate::progress::say;
use crate::text::{aligned, decimal, grouped, print};
use anyhow::bail;
use ralf::metrics::Confusion;
use ralf_data::Corrections;
use ralf_data::judge::{Agreement, disagreements, kappa};
use serde_json::{Value, json};
use std::path::Path;

/// The scans that are named, those with the most disagreements.
const NAMED: usize = 20;

/// Prints what the corrections in two output folders of one dataset have in common.
pub(super) fn run(out: &Path, other: &Path, dataset: &Path, as_json: bool) -> anyhow::Result<Outcome> {
    let recording = ralf_data::open(dataset, None)?;
    let [first, second] = [out, other].map(|out| Corrections::of_recording(out, &recording));
    let (first, second) = (first?, second?);
    for said in [&first, &second] {
        said.orphaned().iter().for_each(|scan| say(&orphaned(scan)));
    }
    let agreement = Agreement::of(&first, &second)?;
    if agreement.scans.is_empty() {
        let (first, second) = (first.file().display(), second.file().display());
        bail!("{first}, {second}: expected detections of which both say something, found none");
    }
    print(&if as_json { serde_json::to_string_pretty(&page(&agreement))? } else { table(&agreement) })?;
    Ok(Outcome::Done)
}

fn table(agreement: &Agreement) -> String {
    let mut rows = vec![
        ["", "labelled by both", "both plausible", "both artifact", "disagree", "kappa"]
            .map(str::to_owned)
            .to_vec(),
    ];
    let overall = agreement.overall();
    let all = agreement.sequences().into_iter().chain([("all", overall)]);
    rows.extend(all.map(|(name, counts)| row(name, &counts)));
    let named = agreement.disagreements();
    let mut text = aligned(&rows);
    if !named.is_empty() {
        text += &format!("\nThey disagree in {} scans, most in:\n", grouped(named.len() as u64));
    }
    for (scan, counts) in named.into_iter().take(NAMED) {
        text += &format!("  {scan}: {} of {}\n", grouped(disagreements(counts)), grouped(counts.total()));
    }
    text
}

fn row(name: &str, counts: &Confusion) -> Vec<String> {
    let numbers = [counts.total(), counts.tp, counts.tn, disagreements(counts)].map(grouped);
    [vec![name.to_owned()], numbers.to_vec(), vec![decimal(kappa(counts))]].concat()
}

fn page(agreement: &Agreement) -> Value {
    let sequences = agreement.sequences().into_iter().map(|(name, counts)| (name.to_owned(), told(&counts)));
    let scans = agreement.disagreements().into_iter().map(|(scan, counts)| {
        json!({ "sequence": scan.sequence, "radar": scan.radar, "scan": scan.scan,
            "labelled_by_both": counts.total(), "disagree": disagreements(counts) })
    });
    json!({
        "overall": told(&agreement.overall()),
        "sequences": sequences.collect::<serde_json::Map<_, _>>(),
        "disagreements": scans.collect::<Vec<_>>(),
    })
}

fn told(counts: &Confusion) -> Value {
    json!({
        "labelled_by_both": counts.total(),
        "both_plausible": counts.tp,
        "both_artifact": counts.tn,
        "disagree": disagreements(counts),
        "kappa": kappa(counts),
    })
}
