//! Worlds whose mountings and clocks are off by what a good calibration leaves: no sensor of these is in any other test.

use crate::{is_asked_for, told};
use ralf::sensors::Source;
use ralf_check::{Refinement, check_and_refine};
use ralf_sim::SimulatedSequence;
use ralf_sim::world::{FAMILIES, Family, Recording};

/// Worlds of each family, and scans of each radar.
const SEEDS: [u64; 2] = [101, 102];
const SCANS: usize = 80;
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

/// Errors that are left, in standard deviations.
fn left(world: &SimulatedSequence, refined: &[Refinement]) -> Vec<f64> {
    let mut sigmas = Vec::new();
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
            sigmas.extend((0..4).map(|i| (found[i] - missing[i]).abs() / deviations[i]));
        }
    }
    sigmas
}

#[test]
#[ignore = "takes minutes: RALF_FAMILIES names some families"]
fn worlds_with_small_errors_raise_nothing_and_corrections_know_how_good_they_are() {
    let (mut sigmas, mut alarms, mut count) = (Vec::new(), Vec::new(), 0);
    for family in families() {
        for seed in SEEDS {
            let world = Recording::new(family, seed).sequence(0, SCANS).unwrap();
            let (checked, refined) = check_and_refine(&world);
            let says = told(&checked);
            println!("{} {seed}, {}: {says}", family.name, world.sequence().title);
            sigmas.extend(left(&world, &refined));
            alarms.extend((!says.is_empty()).then(|| format!("{} {seed}: {says}", family.name)));
            count += 1;
        }
    }
    let within = sigmas.iter().filter(|sigma| **sigma < 3.0).count() as f64 / sigmas.len().max(1) as f64;
    println!(
        "{} alarms in {count} worlds; {:.1} % of {} errors within three standard deviations",
        alarms.len(),
        within * 100.0,
        sigmas.len()
    );
    assert!(alarms.is_empty(), "{alarms:#?}");
    assert!(within >= COVERED, "{within}");
}
