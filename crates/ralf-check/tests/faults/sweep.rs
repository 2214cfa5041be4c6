//! Good recordings: the sequences of the simulator's preset `paper`, whole and in short, with three seeds.

use crate::cut::Cut;
use crate::recording::{Planted, Recording};
use crate::{is_asked_for, told};
use ralf::config::Config;
use ralf::paper::Labeler;
use ralf::scene::FrameWindow;
use ralf::sensors::Source;
use ralf_check::check;
use ralf_sim::presets::{self, PresetSequence};
use std::ops::Range;
use std::time::Instant;

const SEEDS: [u64; 3] = [1, 2, 3];
/// Scans of each radar in short ones: 3 s and 1 s.
const SHORT: [usize; 2] = [60, 20];

/// The sequences of the preset `paper`, or those that `RALF_SEQUENCES` names: `RALF_SEQUENCES=03,07`.
pub fn sequences() -> Vec<&'static PresetSequence> {
    let sequences = presets::find("paper").unwrap().sequences.iter();
    sequences.filter(|sequence| is_asked_for("RALF_SEQUENCES", sequence.name)).collect()
}

/// What it is called, and which of so many scans it holds.
type Stretch = (&'static str, fn(usize) -> Range<usize>);

/// Of a sequence's scans: all, and short stretches at the begin and in the middle.
const STRETCHES: [Stretch; 5] = [
    ("whole", |scans| 0..scans),
    ("first 3 s", |_| 0..SHORT[0]),
    ("first 1 s", |_| 0..SHORT[1]),
    ("middle 3 s", |scans| scans / 2..scans / 2 + SHORT[0]),
    ("middle 1 s", |scans| scans / 2..scans / 2 + SHORT[1]),
];

#[test]
#[ignore = "takes half an hour: cargo test -p ralf-check --test faults -- --ignored --nocapture raise_nothing"]
fn the_sequences_of_the_paper_raise_nothing() {
    let (mut alarms, mut count) = (Vec::new(), 0);
    println!("{:<10}  {:<8} {:>4}  doubts and facts", "stretch", "sequence", "seed");
    for (sequence, seed) in sequences().iter().flat_map(|one| SEEDS.map(|seed| (one, seed))) {
        let simulated = sequence.simulate(seed, sequence.scans).unwrap();
        for (title, stretch) in STRETCHES {
            let says = told(&check(&Cut::of(&simulated, stretch(sequence.scans))));
            let words = if says.is_empty() { "-" } else { &says };
            println!("{title:<10}  {:<8} {seed:>4}  {words}", sequence.name);
            count += 1;
            if !says.is_empty() {
                alarms.push(format!("{title} of {}, seed {seed}: {says}", sequence.name));
            }
        }
    }
    println!("{} alarms in {count} recordings", alarms.len());
    assert!(alarms.is_empty(), "{alarms:#?}");
}

/// Seconds that a check takes beside those that labelling every scan takes, both reading anew. Nothing is asserted of a
/// time.
#[test]
#[ignore = "measures: cargo test --release -p ralf-check --test faults -- --ignored --nocapture costs"]
fn what_a_check_costs_beside_labelling() {
    for sequence in presets::find("paper").unwrap().sequences.iter().take(2) {
        let recording = Recording::simulated(sequence.simulate(1, sequence.scans).unwrap());
        let planted = Planted::new(&recording);
        let sequence = planted.sequence();
        // What is simulated is kept: the first round pays for it.
        for round in ["with reading", "read before"] {
            let begun = Instant::now();
            check(&planted);
            let checked = begun.elapsed().as_secs_f64();
            let begun = Instant::now();
            let config = Config::default();
            let mut window = FrameWindow::new(&planted, &sequence.rig, &config);
            for (radar, times) in sequence.times.radars.iter().enumerate() {
                for scan in 0..times.len() {
                    Labeler::new(&config).unwrap().label(&window.frame(radar, scan).unwrap());
                }
            }
            let labelled = begun.elapsed().as_secs_f64();
            println!("{} {round}: check {checked:.2} s, labels {labelled:.2} s", sequence.name);
        }
    }
}
