//! Whether the plane that a LiDAR sees is the vehicle's z = 0.

use crate::change::SensorChange;
use crate::remedy::Remedy;
use crate::sample::{LidarLook, Sample};
use crate::statistics::{Estimate, estimate, median};
use crate::verdict::{Question, Verdict};
use ralf::sensors::Sequence;

/// Roads are cambered by two degrees, and vehicles pitch by one: a median beyond this is the mounting's, degrees.
const TILT_DEG: f64 = 2.0;
/// z = 0 is the road within, m: loaded vehicles sink by a decimetre.
const OFFSET: f64 = 0.2;
/// Less of what is nearby on the plane is no ground.
const SUPPORT: f64 = 0.15;
/// Scans that are needed: one may stand on a kerb.
const FEWEST: usize = 3;

pub(super) fn judge(sequence: &Sequence, sample: &Sample) -> Vec<Verdict> {
    let lidars = sequence.rig.lidars.iter().enumerate();
    lidars
        .map(|(i, lidar)| {
            let looks: Vec<&LidarLook> = sample.lidars.iter().filter(|look| look.lidar == i).collect();
            one(&lidar.name, &looks)
        })
        .collect()
}

fn one(name: &str, looks: &[&LidarLook]) -> Verdict {
    let fits: Vec<_> = looks.iter().filter_map(|look| look.ground.as_ref()).collect();
    let support = median(&fits.iter().map(|fit| fit.support).collect::<Vec<_>>()).unwrap_or(0.0);
    if fits.len() < FEWEST || support < SUPPORT {
        let missing = format!(
            "a plane in {} of {} scans, with {:.0} % of the points nearby on it: {FEWEST} scans and {:.0} % are needed",
            fits.len(),
            looks.len(),
            support * 100.0,
            SUPPORT * 100.0
        );
        return Verdict::cannot_judge(name, Question::Ground, missing);
    }
    let of = |values: Vec<f64>| estimate(&values).unwrap_or(Estimate { value: 0.0, error: f64::INFINITY });
    let forward = of(fits.iter().map(|fit| fit.slope[0].to_degrees()).collect());
    let left = of(fits.iter().map(|fit| fit.slope[1].to_degrees()).collect());
    let height = of(fits.iter().map(|fit| fit.offset).collect());
    let evidence = format!(
        "the ground rises by {:+.1} degrees to the front and {:+.1} to the left, and lies {:+.2} m high, over {} scans",
        forward.value,
        left.value,
        height.value,
        fits.len()
    );
    let beyond = |estimate: &Estimate, limit: f64| {
        estimate.value.abs() > limit && estimate.value.abs() - 4.0 * estimate.error > limit / 2.0
    };
    if !beyond(&forward, TILT_DEG) && !beyond(&left, TILT_DEG) && !beyond(&height, OFFSET) {
        return Verdict::good(name, Question::Ground, evidence);
    }
    // About the vehicle's axes, for a LiDAR that looks forward: what rises in front is put down by a positive pitch.
    let turn =
        |estimate: &Estimate, sign: f64| if beyond(estimate, TILT_DEG) { sign * estimate.value } else { 0.0 };
    let up = if beyond(&height, OFFSET) { -height.value } else { 0.0 };
    let change = SensorChange {
        turn_deg: [turn(&left, -1.0), turn(&forward, 1.0), 0.0],
        shift_m: [0.0, 0.0, up],
        ..SensorChange::default()
    };
    Verdict::doubt(name, Question::Ground, evidence, Some(Remedy::Sensor(change)))
}
