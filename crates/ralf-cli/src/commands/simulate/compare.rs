//! `ralf simulate --compare`: how far a simulated recording is from a real one.

use crate::progress::{Progress, say};
use crate::text::{aligned, print};
use ralf_data::realism::{Compared, Distributions, Summary};
use ralf_data::{Recording, SequenceReader};
use ralf_report::RealismPage;
use serde_json::json;
use std::path::Path;

/// A recording with the name that people know it by.
pub(super) struct Named<'a> {
    pub(super) name: String,
    pub(super) sequences: Vec<&'a dyn SequenceReader>,
}

impl<'a> Named<'a> {
    /// A recording by its folder's or file's name.
    pub(super) fn opened(recording: &'a Recording) -> Self {
        let name = recording.path.file_name().map_or("recording".into(), |name| name.to_string_lossy());
        Self {
            name: name.into_owned(),
            sequences: recording.sequences.iter().map(|reader| reader.as_ref()).collect(),
        }
    }
}

/// What is made of the comparison.
pub(super) struct Told<'a> {
    /// The page, where one is asked for.
    pub(super) page: Option<&'a Path>,
    pub(super) json: bool,
}

/// Compares, prints the distances and writes the page.
pub(super) fn compare(real: &Named, simulated: &Named, jobs: usize, told: &Told) -> anyhow::Result<()> {
    let gathered = |recording: &Named| (recording.name.clone(), gather(recording, jobs));
    let page = RealismPage::new(gathered(real), gathered(simulated));
    for reason in page.real.unreadable.iter().chain(&page.simulated.unreadable) {
        say(&format!("left out: {reason}"));
    }
    let printed = print(&if told.json {
        serde_json::to_string_pretty(&json!({
            "real": page.real_name,
            "simulated": page.simulated_name,
            "realism": page.realism,
        }))?
    } else {
        table(&page)
    });
    if let Some(file) = told.page {
        ralf_data::write_named(file, page.html()?.as_bytes())?;
        say(&format!("wrote {}", file.display()));
    }
    printed
}

fn gather(recording: &Named, jobs: usize) -> Distributions {
    let progress = Progress::spinner();
    Distributions::gather(&recording.sequences, jobs, &|done, all| {
        progress.tell(format!("{}: {done} of {all} scans", recording.name));
    })
}

/// A line per quantity, and what is lacking.
fn table(page: &RealismPage) -> String {
    let head = [
        "",
        "real 5 %",
        "50 %",
        "95 %",
        "simulated 5 %",
        "50 %",
        "95 %",
        "moved/spread",
        "KS",
        "KS of halves",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let measured = page.realism.quantities.iter().filter(|c| c.real.is_some() || c.simulated.is_some());
    rows.extend(measured.map(row));
    let mean = |value: Option<f64>| value.map_or("none".to_owned(), |value| format!("{value:.3}"));
    format!(
        "{} beside {} (real)\n\n{}\n{}mean KS {}, of the halves of the real recording {}\n",
        page.simulated_name,
        page.real_name,
        aligned(&rows),
        lacking(page),
        mean(page.realism.mean_ks),
        mean(page.realism.mean_ks_within_real),
    )
}

fn row(compared: &Compared) -> Vec<String> {
    let Compared { name, unit, real, simulated, distance, within_real, .. } = compared;
    let two = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.2}"));
    let mut row = vec![with_unit(name, unit)];
    row.extend(figures(real.as_ref()));
    row.extend(figures(simulated.as_ref()));
    row.extend([two(distance.and_then(|d| d.normalised)), two(distance.map(|d| d.ks))]);
    row.push(two(within_real.map(|d| d.ks)));
    row
}

/// Which recording lacks what, a line each.
fn lacking(page: &RealismPage) -> String {
    let mut text = String::new();
    for Compared { quantity, name, real, simulated, .. } in &page.realism.quantities {
        for (recording, summary) in [(&page.real_name, real), (&page.simulated_name, simulated)] {
            if summary.is_none() {
                text += &format!("{name}: {recording} lacks some of: {}\n", quantity.description().needs);
            }
        }
    }
    text
}

/// A quantity's name for people.
pub(in crate::commands) fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name}, {unit}") }
}

/// Three quantiles.
fn figures(summary: Option<&Summary>) -> [String; 3] {
    let Some(summary) = summary else { return std::array::from_fn(|_| "-".to_owned()) };
    [0, 2, 4].map(|place| figure(summary.quantiles[place]))
}

/// A value with two decimals, a large one with none.
pub(in crate::commands) fn figure(value: f32) -> String {
    if value.abs() >= 1000.0 { format!("{value:.0}") } else { format!("{value:.2}") }
}
