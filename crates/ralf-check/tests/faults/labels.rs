//! What labels of a recording are worth, by the paper's method.

use crate::recording::{Planted, Recording};
use ralf::config::Config;
use ralf::metrics::{Confusion, Rates};
use ralf::paper::Labeler;
use ralf::scene::FrameWindow;
use ralf::sensors::Source;
use ralf_check::doppler;
use std::sync::Arc;

/// Every so many scans is labelled.
const STEP: usize = 4;
/// Labels without recorded motion agree with those from it in this share.
const ALIKE: f64 = 0.97;

/// Of each labelled detection: whether it truly is plausible, and whether it is called so.
pub fn labels(recording: &Planted, base: &Recording) -> Vec<(bool, bool)> {
    let config = Config::default();
    let mut window = FrameWindow::new(recording, &recording.sequence().rig, &config);
    let mut found = Vec::new();
    for (radar, times) in recording.sequence().times.radars.iter().enumerate() {
        for scan in (0..times.len()).step_by(STEP) {
            let labels = Labeler::new(&config).unwrap().label(&window.frame(radar, scan).unwrap());
            let called = labels.iter().map(|label| label.plausible);
            found.extend(base.plausible(radar, scan).into_iter().zip(called));
        }
    }
    found
}

/// Plausible F1 over all radars.
pub fn f1(recording: &Planted, base: &Recording) -> f64 {
    let mut counts = Confusion::default();
    labels(recording, base).into_iter().for_each(|(is_plausible, called)| counts.add(is_plausible, called));
    Rates::new(&counts).f1_plausible.unwrap()
}

#[test]
#[ignore = "takes minutes: cargo test -p ralf-check --test faults -- --ignored --nocapture labels_without_recorded"]
fn labels_without_recorded_motion_are_those_with_it() {
    let mut worst = (1.0_f64, "");
    for sequence in crate::sweep::sequences() {
        let simulated = sequence.simulate(1, sequence.scans.min(240)).unwrap().without_cameras();
        let base: Arc<Recording> = Recording::simulated(simulated);
        let mut without = Planted::new(&base);
        let with = labels(&without, &base);
        without.sequence.motion = doppler::from_doppler(&without).unwrap();
        let alike = labels(&without, &base).iter().zip(&with).filter(|(one, other)| one == other).count();
        let share = alike as f64 / with.len() as f64;
        println!("{}: {:.2} % of {} labels agree", sequence.name, share * 100.0, with.len());
        worst = if share < worst.0 { (share, sequence.name) } else { worst };
    }
    assert!(worst.0 >= ALIKE, "{worst:?}");
}
