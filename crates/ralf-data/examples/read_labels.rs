//! Reads what `ralf label` left: every detection of every sequence, with its plausibility and the label that the
//! machine gave it.
//!
//!     cargo run -p ralf-data --example read_labels -- OUT

#![allow(clippy::print_stdout, reason = "an example shows what it does")]

use ralf_data::DataError;
use ralf_data::result::LabelledRun;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let out = std::env::args_os().nth(1).ok_or("expected the folder that `ralf label` wrote")?;
    let run = LabelledRun::open(Path::new(&out))?;
    for sequence in &run.record().sequences {
        // The table is checked against run.json, and no more than a row group of it is in memory at a time.
        let table = run.table(sequence)?;
        let (mut plausible, mut all) = (0, 0);
        table.each(&["w", "label"], |_scan, detections| {
            let (w, label) = (detections.get::<f32>("w")?, detections.get::<u8>("label")?);
            all += w.len();
            plausible += label.iter().filter(|label| **label == 1).count();
            Ok::<_, DataError>(())
        })?;
        println!("{}: {plausible} of {all} detections are plausible", sequence.name);
        for column in table.schema().columns() {
            println!("  {} [{}]: {}", column.name, column.unit, column.meaning);
        }
    }
    Ok(())
}
