//! `ralf assign`: who labels what.

use crate::outcome::{Outcome, UsageError};
use crate::text::{aligned, grouped, print};
use clap::Args;
use ralf_data::result::{Component, SequenceRecord, read_record};
use ralf_data::team::{Assignment, Share, alike, person};
use std::path::PathBuf;

/// Where the second labels are given, by a command that not every build has.
const SECOND: &str = match cfg!(feature = "review") {
    true => "with `ralf review --second NAME`",
    false => "in the review of a build of ralf that has it",
};

/// Arguments of `ralf assign`.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Each sequence goes to one person, the largest first, to whom has the fewest detections so far; of each, a share of \
the scans to somebody else, who labels them {SECOND} without seeing the first labels. \
OUT/team.toml says who labels what, and is yours to change.

Examples:
  ralf assign out --to ada,bob,cem
  ralf assign out --to ada,bob --twice 0.1    a tenth of the scans twice: how far do they agree?"))]
pub(crate) struct AssignArgs {
    /// What `ralf label` wrote
    #[arg(value_name = "OUT")]
    out: PathBuf,
    /// The people, by what they call themselves in the review; no two names that differ by case alone
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', required = true, value_parser = name)]
    to: Vec<Component>,
    /// The share of each sequence's scans that somebody else labels, too
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share)]
    twice: f64,
    /// Which scans these are
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
}

/// Deals, and prints what everybody has.
pub(crate) fn run(arguments: &AssignArgs) -> anyhow::Result<Outcome> {
    let people = &arguments.to;
    if let Some([one, other]) = alike(people.iter().map(Component::as_str)) {
        let expected = "expected each name once, whatever the case";
        return Err(UsageError(format!("--to: {expected}, found `{one}` and `{other}`")).into());
    }
    if people.len() < 2 && arguments.twice > 0.0 {
        let found = "expected two people or more, found one: nobody else could label its scans";
        return Err(UsageError(format!("--twice: {found}")).into());
    }
    let sequences = read_record(&arguments.out)?.sequences;
    let dealt = Assignment::deal(&sequences, people, arguments.twice, arguments.seed);
    let file = dealt.write(&arguments.out)?;
    print(&format!("{}\n{}\n", table(&dealt, &sequences), file.display()))?;
    Ok(Outcome::Done)
}

fn table(dealt: &Assignment, sequences: &[SequenceRecord]) -> String {
    let mut rows = vec![["", "sequences", "detections", "scans a second time"].map(str::to_owned).to_vec()];
    rows.extend(dealt.0.iter().map(|(name, share)| row(name, share, sequences)));
    aligned(&rows)
}

fn row(name: &str, share: &Share, sequences: &[SequenceRecord]) -> Vec<String> {
    let own = sequences.iter().filter(|sequence| share.sequences.contains(&sequence.name));
    let detections = own.flat_map(|sequence| &sequence.radars).flat_map(|radar| &radar.detections);
    let numbers =
        [share.sequences.len() as u64, detections.copied().map(u64::from).sum(), share.twice.len() as u64];
    [vec![name.to_owned()], numbers.map(grouped).to_vec()].concat()
}

fn name(text: &str) -> Result<Component, String> {
    person(text).map_err(|found| format!("expected a name that a file can have, found {found}"))
}

fn share(text: &str) -> Result<f64, String> {
    let found = text.parse().ok().filter(|share| (0.0..=1.0).contains(share));
    found.ok_or_else(|| format!("expected a number from 0 to 1, found `{text}`"))
}
