//! Corrections made exact: yaw, place in plan and clock of each radar, jointly from range rates and the LiDAR, with
//! standard deviations.
//!
//! What is maximised is a log-likelihood: detections lie beside LiDAR points, velocities are those of the vehicle,
//! and small corrections are likelier than large ones. Standard deviations come from leaving out a quarter of the
//! time each (jackknife), so that they hold what differs from place to place.

use super::case::Case;
use crate::change::SensorChange;
use crate::doppler::{Timed, clock, predicted};
use crate::overlap::{Measure, Setup, overlap};
use crate::sample::LidarLook;
use serde::Serialize;

/// Detections of a moment lie on the same walls: a fifth of them count as independent. Each is beside its surface
/// within 0.25 m.
const LIDAR_WEIGHT: f64 = 0.2 / (2.0 * 0.25 * 0.25);
/// A scan's velocity is right within this, m/s, whatever its noise: yaw rates and wheels are.
const VELOCITY_SIGMA: f64 = 0.1;
/// What a single scan's velocity can cost.
const VELOCITY_CAP: f64 = 4.0;
/// Quantities, with how far off one expects them, and the first and the last step of the search.
const AXES: [Axis; 4] = [
    Axis { unit: SensorChange { turn_deg: [0.0, 0.0, 1.0], ..NOTHING }, prior: 5.0, steps: [1.0, 0.02] },
    Axis { unit: SensorChange { shift_m: [1.0, 0.0, 0.0], ..NOTHING }, prior: 0.3, steps: [0.1, 0.005] },
    Axis { unit: SensorChange { shift_m: [0.0, 1.0, 0.0], ..NOTHING }, prior: 0.3, steps: [0.1, 0.005] },
    Axis { unit: SensorChange { clock_ms: 1.0, ..NOTHING }, prior: 200.0, steps: [40.0, 1.0] },
];
const NOTHING: SensorChange =
    SensorChange { turn_deg: [0.0; 3], shift_m: [0.0; 3], clock_ms: 0.0, mirrored: false };
/// Rounds over all quantities.
const ROUNDS: usize = 6;
/// Parts of the time, each left out once.
const PARTS: usize = 4;

/// One quantity of a correction.
struct Axis {
    unit: SensorChange,
    /// Standard deviation before anything is measured.
    prior: f64,
    steps: [f64; 2],
}

/// The correction of one sensor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Refinement {
    /// The sensor's name.
    pub name: String,
    /// What is added.
    pub change: SensorChange,
    /// Standard deviations of yaw (degrees), of the place forward and to the left (m) and of the clock (ms).
    pub deviations: [f64; 4],
}

/// The corrections of all radars that can be refined; a LiDAR's and an unrefined one's are those that were found.
pub(super) fn refine(case: &Case) -> Vec<Refinement> {
    let rig = &case.sequence.rig;
    let lidars = rig.lidars.iter().zip(&case.lidar_changes).filter(|(_, change)| **change != NOTHING);
    let found = lidars.map(|(lidar, change)| Refinement {
        name: lidar.name.clone(),
        change: *change,
        deviations: [f64::NAN; 4],
    });
    let radars = case.radars().map(|radar| of_radar(case, radar));
    found.chain(radars).collect()
}

fn of_radar(case: &Case, radar: usize) -> Refinement {
    let open = judgeable(case, radar);
    let best = |start: SensorChange, evidence: &Evidence| {
        climb(start, open, |change| evidence.likelihood(case, radar, change))
    };
    let change = best(case.radar_changes[radar], &Evidence::without(case, radar, None));
    let parts = (0..PARTS).map(|part| Evidence::without(case, radar, Some(part)));
    let without: Vec<SensorChange> = parts.map(|evidence| best(change, &evidence)).collect();
    let deviation = |value: fn(&SensorChange) -> f64| {
        let squares = without.iter().map(|other| (value(other) - value(&change)).powi(2)).sum::<f64>();
        ((PARTS - 1) as f64 / PARTS as f64 * squares).sqrt()
    };
    // The search itself ends at its last step.
    let resolution = |axis: usize| AXES[axis].steps[1];
    let deviations = [
        deviation(|change| change.turn_deg[2]).hypot(resolution(0)),
        deviation(|change| change.shift_m[0]).hypot(resolution(1)),
        deviation(|change| change.shift_m[1]).hypot(resolution(2)),
        deviation(|change| change.clock_ms).hypot(resolution(3)),
    ];
    Refinement { name: case.name(radar).to_owned(), change, deviations }
}

/// Which quantities can be judged: a yaw by range rates or the LiDAR, a place by the LiDAR alone, a clock by the
/// LiDAR or by speeds that change.
fn judgeable(case: &Case, radar: usize) -> [bool; 4] {
    let by_lidar = case.overlap(radar, &NOTHING, Measure::Beside).is_enough();
    let mount = case.mount(radar);
    let figures = case.doppler(radar, &case.motion, &mount);
    let timed = figures.and_then(|figures| clock(&case.fits[radar], &case.motion, &mount, &figures));
    [by_lidar || figures.is_some(), by_lidar, by_lidar, by_lidar || timed.is_some_and(|clock| clock.is_sharp)]
}

/// The likeliest change near a start: each quantity in turn, in steps that are halved.
fn climb(start: SensorChange, open: [bool; 4], likelihood: impl Fn(&SensorChange) -> f64) -> SensorChange {
    let (mut best, mut highest) = (start, likelihood(&start));
    for round in 0..ROUNDS {
        let before = best;
        for (axis, _) in AXES.iter().zip(open).filter(|(_, open)| *open) {
            let mut step = axis.steps[0] / f64::from(1 << round);
            while step >= axis.steps[1] {
                let sides = [-step, step].map(|step| best.and(&axis.unit.times(step)));
                let scored = sides.map(|side| (likelihood(&side), side));
                let [left, right] = scored;
                let better = if left.0 > right.0 { left } else { right };
                if better.0 > highest {
                    (highest, best) = better;
                } else {
                    step /= 2.0;
                }
            }
        }
        // Quantities that go together, such as a clock and a place along the way, are followed in their common
        // direction.
        let moved = SensorChange { mirrored: false, ..best.and(&before.times(-1.0)) };
        let mut ahead = best.and(&moved);
        while moved != NOTHING && likelihood(&ahead) > highest {
            (highest, best) = (likelihood(&ahead), ahead);
            ahead = best.and(&moved);
        }
    }
    best
}

/// What a radar's correction rests on.
struct Evidence {
    lidars: Vec<LidarLook>,
    fits: Vec<Timed>,
    /// Of the speed by range rates to the recorded one: wheels are known to half a percent, which is no matter of
    /// mounting or time.
    ratio: f64,
}

impl Evidence {
    /// All of it, or without a part of the time.
    fn without(case: &Case, radar: usize, part: Option<usize>) -> Self {
        let figures = case.doppler(radar, &case.motion, &case.mount(radar));
        let ratio = figures.map_or(1.0, |figures| figures.ratio.value);
        Self { lidars: kept(&case.lidars, part), fits: kept(&case.fits[radar], part), ratio }
    }

    /// The logarithm, but for a constant.
    fn likelihood(&self, case: &Case, radar: usize, change: &SensorChange) -> f64 {
        let setup = Setup { lidars: &self.lidars, ..case.setup() };
        let tally = overlap(&setup, radar, &case.sample.radars[radar], change, Measure::Smooth);
        let beside: f64 = tally.moments.iter().map(|[near, _]| near).sum();
        let mount = change.mount(&case.sequence.rig.radars[radar].vehicle_from_radar);
        let off = self.fits.iter().map(|timed| {
            let told = predicted(&case.motion, &mount, change.time(timed.t_ns));
            let squared = (timed.fit.velocity / self.ratio - told).norm_squared();
            (squared / (2.0 * VELOCITY_SIGMA * VELOCITY_SIGMA)).min(VELOCITY_CAP)
        });
        let small = AXES.iter().map(|axis| (axis.unit.value_in(change) / axis.prior).powi(2) / 2.0);
        LIDAR_WEIGHT * beside - off.sum::<f64>() - small.sum::<f64>()
    }
}

/// The items outside of a part of the list.
fn kept<T: Clone>(items: &[T], part: Option<usize>) -> Vec<T> {
    let count = items.len().max(1);
    let inside = |i: &usize| part.is_none_or(|part| i * PARTS / count != part);
    (0..items.len()).filter(inside).map(|i| items[i].clone()).collect()
}
