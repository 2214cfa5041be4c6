//! Worlds whose mountings and clocks are off by what a good calibration leaves: no sensor of these is in any other test.

use crate::{is_asked_for, told};
use ralf::sensors::Source;
use ralf_check::{Refinement, check_and_refine};
use ralf_sim::SimulatedSequence;
use ralf_sim::world::{FAMILIES, Family, Recording};

/// Worlds of each family, and scans of each radar.
const SEEDS: [u64; 2] = [101, 102];
const SCANS: usize = 80;
/// Sequences of a world that corrections come from.
const DRIVES: usize = 3;
/// Of the errors of corrections at least this share lies within three standard deviations.
const COVERED: f64 = 0.95;

/// All families, or those that `RALF_FAMILIES` names: `RALF_FAMILIES=city,yard`.
fn families() -> impl Iterator<Item = &'static Family> {
    FAMILIES.iter().filter(|family| is_asked_for("RALF_FAMILIES", family.name))
}

/// What should be added to yaw (degrees), place forward and to the left (m) and clock (ms) of a radar.
fn missing(world: &SimulatedSequence, radar: usize) -> [f64; 4] {
    let (truth, clock_ns) = world.true_radar(radar).unwrap();
    let said = world.sequence().rig.radars[radar].vehicle_from_radar;
    let turn = (said.rotation.inverse() * truth.rotation).euler_angles().2.to_degrees();
    let shift = truth.translation.vector - said.translation.vector;
    [turn, shift.x, shift.y, -clock_ns as f64 * 1e-6]
}

/// What corrections are worth.
#[derive(Default)]
struct Left {
    /// Errors that are left of the likeliest corrections, in standard deviations.
    sigmas: Vec<f64>,
    /// Of what is proposed: how many quantities are nearer to the truth than without, and how many are farther.
    nearer: usize,
    farther: usize,
}

impl Left {
    fn add(&mut self, other: Self) {
        self.sigmas.extend(other.sigmas);
        self.nearer += other.nearer;
        self.farther += other.farther;
    }

    fn told(&self) -> String {
        let within = self.sigmas.iter().filter(|sigma| **sigma < 3.0).count() as f64;
        format!(
            "{:.1} % of {} errors within three standard deviations; {} proposed, {} of them nearer",
            within / self.sigmas.len().max(1) as f64 * 100.0,
            self.sigmas.len(),
            self.nearer + self.farther,
            self.nearer
        )
    }
}

fn left(world: &SimulatedSequence, refined: &[Refinement]) -> Left {
    let mut left = Left::default();
    for (radar, sensor) in world.sequence().rig.radars.iter().enumerate() {
        let missing = missing(world, radar);
        let [yaw, x, y, clock] = missing;
        let own = refined.iter().find(|refinement| refinement.name == sensor.name);
        println!("  {:<14} lacks {yaw:+.2} deg, {x:+.3} m, {y:+.3} m, {clock:+.0} ms", sensor.name);
        if let Some(Refinement { change, deviations, proposed, .. }) = own {
            let of = |change: &ralf_check::SensorChange| {
                [change.turn_deg[2], change.shift_m[0], change.shift_m[1], change.clock_ms]
            };
            let found = of(change);
            println!("  {:<14} found {found:.2?} +- {deviations:.2?}, proposed {:.2?}", "", of(proposed));
            left.sigmas.extend((0..4).map(|i| (found[i] - missing[i]).abs() / deviations[i]));
            for (proposed, missing) in of(proposed).into_iter().zip(missing).filter(|(own, _)| *own != 0.0) {
                let is_nearer = (proposed - missing).abs() < missing.abs();
                left.nearer += usize::from(is_nearer);
                left.farther += usize::from(!is_nearer);
            }
        }
    }
    left
}

#[test]
#[ignore = "takes minutes: RALF_FAMILIES names some families"]
fn worlds_with_small_errors_raise_nothing_and_corrections_know_how_good_they_are() {
    let (mut of_one, mut of_all, mut alarms, mut count) = (Left::default(), Left::default(), Vec::new(), 0);
    for family in families() {
        for seed in SEEDS {
            let world = Recording::new(family, seed);
            let drives: Vec<_> = (0..DRIVES).map(|i| world.sequence(i, SCANS).unwrap()).collect();
            let drives: Vec<&dyn Source> = drives.iter().map(|drive| drive as &dyn Source).collect();
            let first = world.sequence(0, SCANS).unwrap();
            let (checked, refined) = check_and_refine(&[&first]);
            let says = told(&checked[0]);
            println!("{} {seed}, {}: {says}", family.name, first.sequence().title);
            of_one.add(left(&first, &refined));
            alarms.extend((!says.is_empty()).then(|| format!("{} {seed}: {says}", family.name)));
            println!(" of {DRIVES} drives");
            of_all.add(left(&first, &check_and_refine(&drives).1));
            count += 1;
        }
    }
    println!("{} alarms in {count} worlds", alarms.len());
    println!("of one drive: {}", of_one.told());
    println!("of {DRIVES} drives: {}", of_all.told());
    assert!(alarms.is_empty(), "{alarms:#?}");
    for Left { sigmas, .. } in [of_one, of_all] {
        let within = sigmas.iter().filter(|sigma| **sigma < 3.0).count() as f64;
        assert!(within >= COVERED * sigmas.len() as f64, "{within} of {}", sigmas.len());
    }
}
