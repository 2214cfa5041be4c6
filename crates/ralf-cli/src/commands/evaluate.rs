//! `ralf evaluate`: the labels of a run against corrected ones, or what they say by themselves.

mod agreement;
mod balance;
mod progress;
mod queue;
mod table;

use crate::arguments::{ChangedArgs, open_and_tell};
use crate::corrections::{merged_truth, say_partly_corrected};
use crate::outcome::Outcome;
use crate::progress::say;
use crate::run_summary::{say_not_labelled, say_without};
use crate::text::print;
use ralf_data::judge::{Missing, QueueCurve};
use ralf_data::result::{LabelledRun, labelled_recording};
use ralf_data::{Balances, Comparison, Recording};
use std::path::{Path, PathBuf};

/// What `ralf evaluate` takes.
#[derive(Debug, Clone, clap::Args)]
#[command(mut_arg("changed_recording", |changed| changed.requires("truth")))]
#[command(after_help = "\
Corrections of a review in OUT/corrections.sqlite count above the dataset's corrected labels; both or one of them may \
be there. Without --truth it tells how far apart the two classes are (mean plausibility of one minus that of the \
other), and how balanced.

Examples:
  ralf evaluate out --truth recordings/city
  ralf evaluate out --truth recordings/city --json
  ralf evaluate other --truth recordings/city --corrections out
  ralf evaluate out --truth recordings/city --queue
  ralf evaluate out --truth recordings/city --agreement other    two people's corrections, made without each other
  ralf evaluate out --truth recordings/city --agreement out/second/bob.sqlite
  ralf evaluate out --progress                                   who has done how much
  ralf evaluate out")]
pub(crate) struct EvaluateArgs {
    /// What `ralf label` wrote
    out: PathBuf,
    /// The dataset that holds the corrected labels
    #[arg(long, value_name = "DATASET")]
    truth: Option<PathBuf>,
    /// Take the corrections of a review from this folder in place of OUT
    #[arg(long, value_name = "OUT", requires = "truth")]
    corrections: Option<PathBuf>,
    #[command(flatten)]
    changed: ChangedArgs,
    /// Print one JSON object in place of tables
    #[arg(long)]
    json: bool,
    /// Add a row for every scan to the tables
    #[arg(long, conflicts_with = "json", requires = "truth")]
    scans: bool,
    /// Print how soon the review's queue leads to wrong labels, in place of tables
    #[arg(long, conflicts_with_all = ["json", "scans"], requires = "truth")]
    queue: bool,
    /// Print how far the corrections in OUT and those in this folder or file agree: Cohen's kappa, and where they
    /// don't; of second labels those of scans that `ralf assign` dealt
    #[arg(long, value_name = "OTHER", conflicts_with_all = ["queue", "scans", "corrections"], requires = "truth")]
    agreement: Option<PathBuf>,
    /// Print what people have corrected and reviewed, day by day, and how fast
    #[arg(long, conflicts_with_all = ["truth", "queue", "scans"])]
    progress: bool,
}

/// Prints how good the labels are.
pub(crate) fn run(args: &EvaluateArgs) -> anyhow::Result<Outcome> {
    if args.progress {
        return progress::run(&args.out, args.json);
    }
    match (&args.truth, &args.agreement) {
        (Some(dataset), Some(other)) => {
            let recording = recording_of(args, dataset)?.map_or_else(|| open_and_tell(dataset), Ok)?;
            agreement::run(&recording, [&args.out, other], args.json)
        }
        (Some(dataset), None) => compare(args, dataset),
        (None, _) => balance(args),
    }
}

/// Against the truth. Scans without labels are named on standard error and left out.
fn compare(args: &EvaluateArgs, dataset: &Path) -> anyhow::Result<Outcome> {
    let corrections = args.corrections.as_deref();
    let recording = recording_of(args, dataset)?;
    let out = corrections.or(Some(&args.out));
    let (truth, outcome) = merged_truth(dataset, recording.as_ref(), out, corrections.is_some())?;
    say_partly_corrected(&truth);
    let comparison = Comparison::new(&args.out, &truth)?;
    name_what_is_left_out(&comparison, args);
    let evaluation = || comparison.evaluation_of(&args.out, &truth);
    let text = if args.queue {
        queue::table(&QueueCurve::of_run(&args.out, &comparison)?)
    } else if args.json {
        serde_json::to_string_pretty(&evaluation()?)?
    } else {
        let scans = if args.scans { table::of_scans(&comparison) + "\n" } else { String::new() };
        scans + &table::table(&evaluation()?)
    };
    print(&text)?;
    Ok(outcome.and(Outcome::done_if(comparison.missing.is_empty())))
}

/// The recording that the truth lies in, once it is found to be what was labelled. Label files are enough, so that
/// there need not be one.
fn recording_of(args: &EvaluateArgs, dataset: &Path) -> anyhow::Result<Option<Recording>> {
    let Some((run, recording)) = labelled_recording(&args.out, dataset)? else { return Ok(None) };
    // Sequences without truth are named later on, whatever the recording has, and so are those without labels: what
    // people said of them is truth all the same.
    args.changed.check_sequences(args.corrections.as_deref().unwrap_or(&args.out), None, &recording)?;
    args.changed.check(&run, &recording)?;
    Ok(Some(recording))
}

/// Without the truth.
fn balance(args: &EvaluateArgs) -> anyhow::Result<Outcome> {
    let balances = Balances::of_run(&args.out)?;
    print(&if args.json { serde_json::to_string_pretty(&balances)? } else { balance::table(&balances) })?;
    Ok(say_not_labelled(LabelledRun::open(&args.out)?.record()))
}

fn name_what_is_left_out(comparison: &Comparison, args: &EvaluateArgs) {
    say_without("truth", &comparison.without_truth);
    let Missing { sequences, radars, scans } = comparison.missing_parts();
    say_without("labels", sequences.iter().copied());
    for (sequence, radar) in radars {
        say(&format!("sequence {sequence} has no labels of {radar}: left out"));
    }
    for scan in scans {
        let file = scan.label_file(&args.out);
        say(&format!("{}: no such file: left out, though it has truth", file.display()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf_data::{Label, write_labels};

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
        let truth = Some(dataset.clone());
        let changed = ChangedArgs::default();
        let mut args = EvaluateArgs {
            out,
            truth,
            corrections: None,
            changed,
            json: true,
            scans: false,
            queue: false,
            agreement: None,
            progress: false,
        };
        assert_eq!(run(&args).unwrap(), Outcome::Done);
        put(&dataset, "sequences/00/ground_truth/front/000001.label", &[1]);
        assert_eq!(run(&args).unwrap(), Outcome::Partial);
        args.truth = None;
        assert!(run(&args).unwrap_err().to_string().contains("run.json"));
        args.truth = Some(folder.path().join("elsewhere"));
        assert!(run(&args).unwrap_err().to_string().contains("elsewhere"));
    }
}
