//! How far two people agree, as text.

use crate::corrections::say_orphaned;
use crate::outcome::Outcome;
use crate::progress::say;
use crate::text::{aligned, counted, decimal, grouped, print};
use anyhow::{bail, ensure};
use ralf::metrics::Confusion;
use ralf_data::judge::{Agreement, disagreements, kappa, kappa_of_names, label_name};
use ralf_data::result::read_record;
use ralf_data::team::{Assignment, second_labellers};
use ralf_data::{Corrections, Recording};
use std::path::{Path, PathBuf};

/// The scans that are named, those with the most disagreements.
const NAMED: usize = 20;

/// Prints what two people's corrections of one recording have in common. Both must be there.
pub(super) fn run(recording: &Recording, [out, other]: [&Path; 2], as_json: bool) -> anyhow::Result<Outcome> {
    [out, other].into_iter().try_for_each(Corrections::check_there)?;
    refuse_one_store(out, other)?;
    let [first, second] = [out, other].map(|out| Corrections::of_recording(out, recording));
    let (first, second) = (first?, of_dealt(out, other, second?)?);
    let outcome = say_orphaned(&first.told_orphaned()).and(say_orphaned(&second.told_orphaned()));
    let agreement = Agreement::of(&first, &second)?;
    if agreement.scans.is_empty() {
        let (first, second) = (first.file().display(), second.file().display());
        bail!("{first}, {second}: expected detections of which both say something, found none");
    }
    print(&if as_json { serde_json::to_string_pretty(&agreement.json())? } else { table(&agreement) })?;
    Ok(outcome)
}

/// Refuses one store that was named twice, or a copy of it: people agree with themselves.
fn refuse_one_store(out: &Path, other: &Path) -> anyhow::Result<()> {
    let [first, second] = [out, other].map(Corrections::open);
    let (first, second) = (first?, second?);
    let place = |said: &Corrections| said.file().canonicalize().ok();
    ensure!(
        first.id()? != second.id()? && place(&first) != place(&second),
        "--agreement: expected what two people said without each other, found one store of corrections twice, or a \
         copy of it: {}, {}",
        first.file().display(),
        second.file().display()
    );
    Ok(())
}

/// Second labels of the scans alone that were dealt to whoever gave them: others are of no random sample.
fn of_dealt(out: &Path, other: &Path, second: Corrections) -> anyhow::Result<Corrections> {
    let place = |file: &Path| file.canonicalize().ok();
    let is_other = |(_, file): &(String, PathBuf)| place(file).is_some_and(|file| place(other) == Some(file));
    let Some((name, _)) = second_labellers(out)?.into_iter().find(is_other) else { return Ok(second) };
    let labelled = read_record(out)?.sequences;
    let dealt = Assignment::open(out, &labelled)?;
    if let Some(sentence) = dealt.as_ref().and_then(|dealt| dealt.told_waiting(out, &labelled)) {
        say(&sentence);
    }
    let Some(twice) = dealt.as_ref().and_then(|dealt| dealt.twice_of(&name)) else { return Ok(second) };
    let (second, left_out) = twice.among(second);
    if left_out > 0 {
        let file = second.file().display();
        say(&format!("{file}: {} not dealt to {name}: left out", counted(left_out, "scan")));
    }
    Ok(second)
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
    rows.extend(agreement.radars().into_iter().map(|(name, counts)| row(name, &counts)));
    let named = agreement.disagreements();
    let mut text = aligned(&rows) + "\n" + &classes(agreement) + &causes(agreement);
    if !named.is_empty() {
        text += &format!("\nThey disagree in {}, most in:\n", counted(named.len(), "scan"));
    }
    for (scan, counts) in named.into_iter().take(NAMED) {
        text += &format!("  {scan}: {} of {}\n", grouped(disagreements(counts)), grouped(counts.total()));
    }
    text
}

/// Each label against all others.
fn classes(agreement: &Agreement) -> String {
    let mut rows = vec![heads("")];
    rows.extend(agreement.classes().iter().map(|(id, counts)| against(&label_name(*id), counts)));
    aligned(&rows)
}

/// Each cause against all others, where both said one; nothing where nobody did.
fn causes(agreement: &Agreement) -> String {
    if agreement.causes.is_empty() {
        return String::new();
    }
    let mut rows = vec![heads("cause")];
    rows.extend(agreement.each_cause().iter().map(|(cause, counts)| against(cause, counts)));
    let (said, all) = (agreement.causes.values().sum(), decimal(kappa_of_names(&agreement.causes)));
    format!("\n{}Both said a cause of {}: kappa {all}\n", aligned(&rows), grouped(said))
}

fn heads(first: &str) -> Vec<String> {
    [first, "both", "first alone", "second alone", "kappa"].map(str::to_owned).to_vec()
}

fn against(name: &str, counts: &Confusion) -> Vec<String> {
    let numbers = [counts.tp, counts.r#fn, counts.fp].map(grouped);
    [vec![name.to_owned()], numbers.to_vec(), vec![decimal(kappa(counts))]].concat()
}

fn row(name: &str, counts: &Confusion) -> Vec<String> {
    let numbers = [counts.total(), counts.tp, counts.tn, disagreements(counts)].map(grouped);
    [vec![name.to_owned()], numbers.to_vec(), vec![decimal(kappa(counts))]].concat()
}
