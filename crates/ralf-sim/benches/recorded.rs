//! What labelling costs on scans cut from simulated recordings, which stand for several loads: radars with elevation
//! and without, many and few detections, near ones and far ones, LiDARs of few and many beams. One thread, measurements
//! in memory. Run with `cargo bench -p ralf-sim --bench recorded`.
//!
//! Each number is what sixteen scans of every radar of a recording cost, one after the other, with all that is made for
//! them: ground, index, windows. That is what `ralf label --timings` counts, too, but for reading and writing.

#![allow(clippy::expect_used, reason = "a bench that can't be set up should say so")]

use divan::{Bencher, black_box};
use ralf::config::Config;
use ralf::evidence::observe;
use ralf::paper::Labeler;
use ralf::scene::FrameWindow;
use ralf::sensors::{MemorySource, Source};
use ralf_sim::world::{Family, Recording};
use ralf_sim::{SimulatedSequence, presets};
use std::sync::LazyLock;

/// Scans of each radar that are simulated, and those of them that are labelled.
const SCANS: usize = 36;
const LABELLED: std::ops::Range<usize> = 10..26;

/// One sequence each: the first of the families' worlds of seed 1, the third of the preset `paper`.
const LOADS: [&str; 5] = ["street", "city", "motorway", "imaging", "country"];

static CONFIG: LazyLock<Config> = LazyLock::new(Config::default);
static RECORDINGS: [LazyLock<MemorySource>; LOADS.len()] = [
    LazyLock::new(|| in_memory(&street())),
    LazyLock::new(|| in_memory(&first_of("city"))),
    LazyLock::new(|| in_memory(&first_of("motorway"))),
    LazyLock::new(|| in_memory(&first_of("imaging"))),
    LazyLock::new(|| in_memory(&first_of("country"))),
];

fn main() {
    divan::main();
}

fn street() -> SimulatedSequence {
    let preset = presets::find("paper").expect("a preset");
    preset.sequences[2].simulate(1, SCANS).expect("a scenario")
}

fn first_of(family: &str) -> SimulatedSequence {
    let family = Family::find(family).expect("a family");
    Recording::new(family, 1).sequence(0, SCANS).expect("a world")
}

/// All measurements but the cameras'.
fn in_memory(simulated: &SimulatedSequence) -> MemorySource {
    let sequence = simulated.sequence();
    let mut held = MemorySource::new(&sequence.name, sequence.motion.clone()).expect("a motion");
    for (radar, sensor) in sequence.rig.radars.iter().enumerate() {
        let scan = |scan| simulated.radar_scan(radar, scan).expect("a scan");
        let scans = (0..sequence.times.radars[radar].len()).map(scan).map(|scan| (scan.t_ns, scan.columns));
        held = held.with_radar(sensor.clone(), scans.collect()).expect("scans in order");
    }
    for (lidar, sensor) in sequence.rig.lidars.iter().enumerate() {
        let scans = 0..sequence.times.lidars[lidar].len();
        let scans = scans.map(|scan| simulated.lidar_scan(lidar, scan).expect("a scan")).collect();
        held = held.with_lidar(sensor.clone(), scans).expect("scans in order");
    }
    held
}

fn recording(load: &str) -> &'static MemorySource {
    let place = LOADS.iter().position(|name| *name == load).expect("a load");
    &RECORDINGS[place]
}

/// The paper's method.
#[divan::bench(args = LOADS, sample_count = 10)]
fn paper(bencher: Bencher, load: &str) {
    let source = recording(load);
    bencher.bench_local(|| {
        let mut window = FrameWindow::new(source, &source.sequence().rig, &CONFIG);
        for scan in LABELLED {
            for radar in 0..source.sequence().rig.radars.len() {
                let frame = window.frame(radar, scan).expect("a scan");
                black_box(Labeler::new(&CONFIG).expect("settings in range").label(&frame));
            }
        }
    });
}

/// All evidence.
#[divan::bench(args = LOADS, sample_count = 10)]
fn evidence(bencher: Bencher, load: &str) {
    let source = recording(load);
    bencher.bench_local(|| {
        let mut window = FrameWindow::new(source, &source.sequence().rig, &CONFIG).with_evidence();
        for scan in LABELLED {
            for radar in 0..source.sequence().rig.radars.len() {
                let frame = window.frame(radar, scan).expect("a scan");
                black_box(observe(&frame, &CONFIG));
            }
        }
    });
}
