//! Good recordings: the sequences of the simulator's preset `paper`, whole and in short, with three seeds.

use crate::told;
use ralf::sensors::Source;
use ralf_check::check;
use ralf_sim::presets;

const SEEDS: [u64; 3] = [1, 2, 3];
/// Scans of each radar in a short one: 3 s.
const SHORT: usize = 60;

#[test]
#[ignore = "takes a quarter of an hour: cargo test -p ralf-check --test faults -- --ignored --nocapture"]
fn the_sequences_of_the_paper_raise_nothing() {
    let mut alarms = Vec::new();
    println!("{:<9} {:>4} {:>6}  doubts and facts", "sequence", "seed", "scans");
    for sequence in presets::find("paper").unwrap().sequences {
        for (scans, seed) in
            [sequence.scans, SHORT].into_iter().flat_map(|scans| SEEDS.map(|seed| (scans, seed)))
        {
            let simulated = sequence.simulate(seed, scans).unwrap();
            let says = told(&check(&simulated));
            let words = if says.is_empty() { "-" } else { &says };
            println!("{:<9} {seed:>4} {scans:>6}  {words}", simulated.sequence().name);
            if !says.is_empty() {
                alarms.push(format!("{} seed {seed}, {scans} scans: {says}", sequence.name));
            }
        }
    }
    println!("{} alarms in {} recordings", alarms.len(), 11 * 2 * SEEDS.len());
    assert!(alarms.is_empty(), "{alarms:#?}");
}
