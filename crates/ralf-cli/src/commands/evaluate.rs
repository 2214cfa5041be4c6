//! `ralf evaluate`: the labels of a run against corrected ones.

mod table;

use crate::Outcome;
use crate::progress::say;
use crate::text::print;
use anyhow::Context;
use ralf_data::{Comparison, GroundTruth};
use std::path::PathBuf;

/// What `ralf evaluate` takes.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct EvaluateArgs {
    /// What `ralf label` wrote.
    out: PathBuf,
    /// The dataset that holds the corrected labels.
    #[arg(long, value_name = "DATASET")]
    truth: Option<PathBuf>,
    /// Print one JSON object in place of tables.
    #[arg(long)]
    json: bool,
    /// Add a row for every scan to the tables.
    #[arg(long, conflicts_with = "json")]
    scans: bool,
}

/// Prints how good the labels are. Scans without labels are named on standard error and left out.
pub(crate) fn run(args: &EvaluateArgs) -> anyhow::Result<Outcome> {
    let dataset =
        args.truth.as_ref().context("expected --truth DATASET, the folder with corrected labels")?;
    let comparison = Comparison::new(&args.out, &GroundTruth::open(dataset)?)?;
    name_what_is_left_out(&comparison, args);
    let text = if args.json {
        serde_json::to_string_pretty(&comparison.evaluation())?
    } else {
        let scans = if args.scans { table::of_scans(&comparison) + "\n" } else { String::new() };
        scans + &table::table(&comparison.evaluation())
    };
    print(&text)?;
    Ok(if comparison.missing.is_empty() { Outcome::Done } else { Outcome::Partial })
}

fn name_what_is_left_out(comparison: &Comparison, args: &EvaluateArgs) {
    for sequence in &comparison.without_truth {
        say(&format!("sequence {sequence} has no truth: left out"));
    }
    for scan in &comparison.missing {
        let file = scan.label_file(&args.out);
        say(&format!("{}: no such file: left out, though it has truth", file.display()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf_data::{Label, write_labels};
    use std::path::Path;

    fn put(folder: &Path, name: &str, ids: &[u16]) {
        let labels: Vec<Label> = ids.iter().copied().map(Label::of_class).collect();
        write_labels(&folder.join(name), &labels).unwrap();
    }

    #[test]
    fn the_outcome_tells_whether_scans_are_missing() {
        let folder = tempfile::tempdir().unwrap();
        let [out, dataset] = ["out", "dataset"].map(|name| folder.path().join(name));
        put(&out, "sequences/00/front/000000.label", &[1, 99]);
        put(&dataset, "sequences/00/ground_truth/front/000000.label", &[1, 10]);
        let mut args = EvaluateArgs { out, truth: Some(dataset.clone()), json: true, scans: false };
        assert_eq!(run(&args).unwrap(), Outcome::Done);
        put(&dataset, "sequences/00/ground_truth/front/000001.label", &[1]);
        assert_eq!(run(&args).unwrap(), Outcome::Partial);
        args.truth = None;
        assert!(run(&args).unwrap_err().to_string().contains("expected --truth DATASET"));
        args.truth = Some(folder.path().join("elsewhere"));
        assert!(run(&args).unwrap_err().to_string().contains("elsewhere"));
    }
}
