//! Corrections made exact: yaw, place in plan and clock of each radar, jointly from range rates and the LiDAR, with
//! standard deviations.
//!
//! What is maximised is a log-likelihood: detections lie beside LiDAR points, velocities are those of the vehicle,
//! and small corrections are likelier than large ones.

mod beside;
mod evidence;
mod fronts;
mod quantity;
mod search;

use super::case::Case;
use crate::change::SensorChange;
use crate::doppler::clock;
use crate::overlap::Measure;
use evidence::Evidence;
use quantity::{QUANTITIES, Quantity, Values};
use search::{Deviations, Open, deviations, likeliest};
use serde::Serialize;

/// A correction is proposed when it is so many of the standard deviations that chance gives.
const SIGMAS: f64 = 3.0;
/// And so many of those that are told: what one recording in twenty shows that is right is no reason to change it.
const TOLD_SIGMAS: f64 = 2.0;

/// The correction of one sensor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Refinement {
    /// The sensor's name.
    pub name: String,
    /// What is likeliest to be added.
    pub change: SensorChange,
    /// Standard deviations of yaw (degrees), of the place forward and to the left (m) and of the clock (ms), each with
    /// the others unknown, and with what more measurements would not take away. NaN of a sensor whose change was found
    /// and not refined.
    pub deviations: [f64; 4],
    /// What is proposed: quantities that are three standard deviations of chance, two of [`Self::deviations`], and more
    /// than labels notice, and the likeliest of these with all others left alone.
    pub proposed: SensorChange,
}

/// The corrections of all radars that can be refined; a LiDAR's and an unrefined one's are those that were found.
pub(super) fn refine(case: &Case) -> Vec<Refinement> {
    let rig = &case.sequence.rig;
    let found =
        rig.lidars.iter().zip(&case.lidar_changes).filter(|(_, change)| **change != SensorChange::default());
    let found = found.map(|(lidar, change)| Refinement {
        name: lidar.name.clone(),
        change: *change,
        deviations: [f64::NAN; 4],
        proposed: *change,
    });
    let radars = case.radars().map(|radar| of_radar(case, radar).unwrap_or_else(|| as_found(case, radar)));
    found.chain(radars).collect()
}

/// A radar's change as it was found.
fn as_found(case: &Case, radar: usize) -> Refinement {
    let change = case.radar_changes[radar];
    Refinement { name: case.name(radar).to_owned(), change, deviations: [f64::NAN; 4], proposed: change }
}

/// `None` where the LiDARs don't see what the radar sees: whatever would lay one onto the other is chance.
fn of_radar(case: &Case, radar: usize) -> Option<Refinement> {
    let beside = case.overlap(radar, &SensorChange::default(), Measure::Beside);
    if beside.is_enough() && !beside.is_above_chance(&case.elsewhere(radar)) {
        return None;
    }
    let evidence = Evidence::of(case, radar);
    let (open, values) = found(&evidence, judgeable(case, radar));
    let deviations = deviations(&evidence, &values, open);
    Some(Refinement {
        name: case.name(radar).to_owned(),
        change: evidence.change(&values),
        deviations: std::array::from_fn(|i| told(&deviations, i)),
        proposed: evidence.change(&proposed(&evidence, values, &deviations, open)),
    })
}

/// The likeliest values of what is open. A LiDAR that doesn't tell how far along the way things are would pull at that
/// and at the clock all the same: then both are left alone.
fn found(evidence: &Evidence, open: Open) -> (Open, Values) {
    let [yaw, forward, left, _] = open;
    let values = likeliest(evidence, &evidence.start(), open);
    if !forward || evidence.tells_along(&values) {
        return (open, values);
    }
    let open = [yaw, false, left, false];
    (open, likeliest(evidence, &evidence.start(), open))
}

/// How well a quantity is known in its unit, with what more measurements would not take away.
fn told(deviations: &Deviations, quantity: usize) -> f64 {
    let measured = deviations.chance[quantity].hypot(deviations.contradiction[quantity]).min(1.0);
    let Quantity { prior, systematic, .. } = QUANTITIES[quantity];
    (measured * prior).hypot(systematic)
}

/// Quantities that say nothing are left alone, the least telling one first; what goes together with them is sought
/// again without. What can't be judged here stays as it was found.
fn proposed(
    evidence: &Evidence,
    likeliest_of_all: Values,
    deviations: &Deviations,
    mut open: Open,
) -> Values {
    let mut values = likeliest_of_all;
    while let Some(least) = idle(&values, deviations, open).or_else(|| hardly_missed(evidence, &values, open))
    {
        values = without(evidence, &values, open, least);
        open[least] = false;
    }
    values
}

/// The least telling quantity of those that are smaller than what is proposed.
fn idle(values: &Values, deviations: &Deviations, open: Open) -> Option<usize> {
    let in_sigmas = |i: &usize| values[*i].abs() / deviations.chance[*i];
    let is_idle = |i: &usize| {
        let least = QUANTITIES[*i].smallest.max(TOLD_SIGMAS * told(deviations, *i));
        in_sigmas(i) < SIGMAS || values[*i].abs() * QUANTITIES[*i].prior < least
    };
    let idle = (0..4).filter(|i| open[*i]).filter(is_idle);
    idle.min_by(|a, b| in_sigmas(a).total_cmp(&in_sigmas(b)))
}

/// The quantity without which values are least less likely, if that is less than so many standard deviations mean:
/// farther from its maximum a likelihood may fall off less than about it.
fn hardly_missed(evidence: &Evidence, values: &Values, open: Open) -> Option<usize> {
    let highest = evidence.posterior(values);
    let gain = |i: usize| highest - evidence.posterior(&without(evidence, values, open, i));
    let gains = (0..4).filter(|i| open[*i]).map(|i| (i, gain(i)));
    let hardly = gains.filter(|(_, gain)| *gain < SIGMAS * SIGMAS / 2.0);
    hardly.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
}

/// The likeliest values without a quantity.
fn without(evidence: &Evidence, values: &Values, mut open: Open, quantity: usize) -> Values {
    let mut start = *values;
    (start[quantity], open[quantity]) = (0.0, false);
    likeliest(evidence, &start, open)
}

/// Which quantities can be judged: a yaw by range rates or the LiDAR, a place by the LiDAR alone, a clock by the
/// LiDAR or by speeds that change.
fn judgeable(case: &Case, radar: usize) -> Open {
    let by_lidar = case.overlap(radar, &SensorChange::default(), Measure::Beside).is_enough();
    let mount = case.mount(radar);
    let figures = case.doppler(radar, &case.motion, &mount);
    let timed = figures.and_then(|figures| clock(&case.fits[radar], &case.motion, &mount, &figures));
    [by_lidar || figures.is_some(), by_lidar, by_lidar, by_lidar || timed.is_some_and(|clock| clock.is_sharp)]
}
