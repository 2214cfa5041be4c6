//! `ralf inspect --distributions`: what a recording's measurements are like.

use crate::commands::simulate::compare::{figure, with_unit};
use crate::outcome::Outcome;
use crate::progress::{Progress, say};
use crate::text::{aligned, grouped, print};
use ralf_data::Recording;
use ralf_data::realism::{Description, Distributions, Quantity, Summary};
use serde_json::{Value, json};

/// Gathers them and prints them.
pub(super) fn show(recording: &Recording, jobs: usize, as_json: bool) -> anyhow::Result<Outcome> {
    let sequences: Vec<_> = recording.sequences.iter().map(|reader| reader.as_ref()).collect();
    let progress = Progress::spinner();
    let found = Distributions::gather(&sequences, jobs, &|done, all| {
        progress.tell(format!("{done} of {all} scans"));
    });
    drop(progress);
    for reason in &found.unreadable {
        say(&format!("left out: {reason}"));
    }
    print(&if as_json { serde_json::to_string_pretty(&values(&found)?)? } else { table(&found) })?;
    Ok(Outcome::Done)
}

fn table(found: &Distributions) -> String {
    let head = ["", "values", "mean", "5 %", "25 %", "50 %", "75 %", "95 %"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let mut lacking = String::new();
    for quantity in Quantity::ALL {
        let description = quantity.description();
        let Some(summary) = Summary::of(&found.values(quantity)) else {
            lacking += &format!("{}: needs {}\n", description.name, description.needs);
            continue;
        };
        let mut row = vec![with_unit(description.name, description.unit), grouped(summary.values as u64)];
        row.push(figure(summary.mean as f32));
        row.extend(summary.quantiles.map(figure));
        rows.push(row);
    }
    let scans = [found.radar_scans, found.lidar_scans].map(|scans| grouped(scans as u64));
    format!("{} radar scans, {} LiDAR scans\n\n{}\n{lacking}", scans[0], scans[1], aligned(&rows))
}

fn values(found: &Distributions) -> anyhow::Result<Value> {
    let mut quantities = Vec::new();
    for quantity in Quantity::ALL {
        let Description { name, unit, .. } = quantity.description();
        let summary = Summary::of(&found.values(quantity));
        quantities.push(json!({ "name": name, "unit": unit, "summary": summary }));
    }
    Ok(json!({
        "radar_scans": found.radar_scans,
        "lidar_scans": found.lidar_scans,
        "unreadable": found.unreadable,
        "quantities": quantities,
    }))
}
