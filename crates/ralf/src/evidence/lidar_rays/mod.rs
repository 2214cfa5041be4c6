//! What the LiDARs' rays towards a detection say: do they end in it, on the ground there, before it, or do they pass
//! through?
//!
//! Each scan of the LiDAR window votes, weighted towards the middle of the cone in which the detection can lie: the
//! nearest scan on where it was measured, those of the window on where all scans of the radar that saw it again
//! together place what stands still. *In free space*, *on a surface*, *occluded* and *not looked at* follow from the
//! votes.

mod moving;
mod tally;
mod votes;

pub(super) use moving::PIECE as MOVING;

use super::columns::{set, unobserved};
use super::probe::Probe;
use super::{Feature, Piece, Surroundings, Values};
use crate::scene::{LidarSnapshot, direction_of};
use crate::space::Transform;
use votes::{Sweep, Votes};

const GROUP: &str = "LiDAR rays";
/// Added to both shares of the odds.
const FEW: f64 = 0.02;
/// A point nearer than this is the detection's own, sigmas.
const NEAR: f64 = 2.0;
/// Rays that are looked at in the nearest scan, and in each of the others, at most about; more are thinned evenly.
const RAYS_NEAREST: usize = 128;
const RAYS: usize = 40;

pub(super) const PIECE: Piece = Piece { features: FEATURES, observe };

const FEATURES: &[Feature] = &[
    Feature {
        name: "lidar_rays_in",
        unit: "1",
        group: GROUP,
        meaning: "share of the nearest LiDAR scan's rays towards the detection that end in it",
    },
    Feature {
        name: "lidar_rays_ground",
        unit: "1",
        group: GROUP,
        meaning: "share of the nearest LiDAR scan's rays towards the detection that end on the ground there",
    },
    Feature {
        name: "lidar_rays_beyond",
        unit: "1",
        group: GROUP,
        meaning: "share of the nearest LiDAR scan's rays towards the detection that pass through and end beyond",
    },
    Feature {
        name: "lidar_rays_before",
        unit: "1",
        group: GROUP,
        meaning: "share of the nearest LiDAR scan's rays towards the detection that end before it",
    },
    Feature {
        name: "lidar_chi",
        unit: "sigma",
        group: GROUP,
        meaning: "Mahalanobis distance from the nearest LiDAR scan's closest point, at most 10",
    },
    Feature {
        name: "lidar_window_in",
        unit: "1",
        group: GROUP,
        meaning: "share of all rays of the seconds around that end in the detection",
    },
    Feature {
        name: "lidar_window_ground",
        unit: "1",
        group: GROUP,
        meaning: "share of all rays of the seconds around that end on the ground there",
    },
    Feature {
        name: "lidar_window_beyond",
        unit: "1",
        group: GROUP,
        meaning: "share of all rays of the seconds around that pass through the detection and end beyond",
    },
    Feature {
        name: "lidar_window_before",
        unit: "1",
        group: GROUP,
        meaning: "share of all rays of the seconds around that end before the detection",
    },
    Feature {
        name: "lidar_window_odds",
        unit: "1",
        group: GROUP,
        meaning: "logarithm of the odds that a ray of the seconds around ends in the detection and not beyond it",
    },
    Feature {
        name: "lidar_window_chi_least",
        unit: "sigma",
        group: GROUP,
        meaning: "least over the LiDAR scans around of the Mahalanobis distance from the closest point",
    },
    Feature {
        name: "lidar_window_chi_quartile",
        unit: "sigma",
        group: GROUP,
        meaning: "lower quartile over the LiDAR scans around of the Mahalanobis distance from the closest point",
    },
    Feature {
        name: "lidar_window_chi_median",
        unit: "sigma",
        group: GROUP,
        meaning: "median over the LiDAR scans around of the Mahalanobis distance from the closest point",
    },
    Feature {
        name: "lidar_window_near",
        unit: "1",
        group: GROUP,
        meaning: "share of the LiDAR scans that look there with a point within 2 sigmas",
    },
    Feature {
        name: "lidar_free",
        unit: "1",
        group: GROUP,
        meaning: "share of the LiDAR scans around for which the detection lies in free space",
    },
    Feature {
        name: "lidar_surface",
        unit: "1",
        group: GROUP,
        meaning: "share of the LiDAR scans around for which the detection lies on a surface",
    },
    Feature {
        name: "lidar_occluded",
        unit: "1",
        group: GROUP,
        meaning: "share of the LiDAR scans around for which the detection lies behind a surface",
    },
    Feature {
        name: "lidar_unseen",
        unit: "1",
        group: GROUP,
        meaning: "share of the LiDAR scans around that have no ray towards the detection",
    },
];

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let mut columns = unobserved(FEATURES, frame.scan.len());
    let Some(window) = &frame.lidar_window else { return columns };
    let window_from_vehicle = window.vehicle_from_window.inverse();
    let nearest = frame.lidar.as_ref().map(|view| {
        let window_from_moment = window_from_vehicle * view.vehicle_from_moment;
        let probes = surroundings.probes();
        vote(sweeps_of(&view.moment, window_from_moment, RAYS_NEAREST), probes, &by_direction(probes))
    });
    let probes = surroundings.joint_probes();
    let order = by_direction(probes);
    // Scan by scan, so that the rays of one stay at hand.
    let mut around = Vec::with_capacity(window.window.views.len());
    for view in &window.window.views {
        around.push(vote(sweeps_of(&view.moment, view.vehicle_from_moment, RAYS), probes, &order));
    }
    for (i, _) in probes.iter().enumerate().filter(|(_, probe)| probe.is_some()) {
        let around: Vec<Votes> = around.iter().map(|votes| votes[i]).collect();
        set(&mut columns, i, answers(nearest.as_ref().map(|votes| votes[i]), &around));
    }
    columns
}

/// A moment's sweeps, and how to get from each to the window's frame.
fn sweeps_of(moment: &LidarSnapshot, window_from_moment: Transform, rays: usize) -> Vec<Sweep<'_>> {
    let sweeps = moment.sweeps().iter();
    sweeps.map(|sweep| Sweep::new(sweep, window_from_moment * sweep.moment_from_lidar, rays)).collect()
}

/// The probes that have a place in the order of their azimuth: rays in one direction lie side by side in memory.
fn by_direction(probes: &[Option<Probe>]) -> Vec<usize> {
    let azimuth = |probe: &Probe| {
        let p = probe.detection.position;
        direction_of(p.x as f32, p.y as f32, 0.0).0
    };
    let known = probes.iter().enumerate().filter_map(|(i, probe)| Some((azimuth(probe.as_ref()?), i)));
    let mut order: Vec<(f32, usize)> = known.collect();
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    order.into_iter().map(|(_, i)| i).collect()
}

/// The votes of all LiDARs of one moment on each of the detections; nobody votes on one without a position.
fn vote(mut sweeps: Vec<Sweep>, probes: &[Option<Probe>], order: &[usize]) -> Vec<Votes> {
    let mut all = vec![Votes::default(); probes.len()];
    for (i, probe) in order.iter().filter_map(|i| Some((*i, probes[*i].as_ref()?))) {
        sweeps.iter_mut().for_each(|sweep| all[i].add(&sweep.vote(probe)));
    }
    all
}

/// The values of all columns from the votes of the nearest scan and of those around.
fn answers(nearest: Option<Votes>, around: &[Votes]) -> [Option<f64>; 18] {
    let mut all = Votes::default();
    around.iter().for_each(|votes| all.add(votes));
    let mut chis: Vec<f64> = around.iter().filter_map(|votes| votes.chi).collect();
    chis.sort_unstable_by(f64::total_cmp);
    let rank = |share: f64| chis.get(((chis.len().max(1) - 1) as f64 * share).round() as usize).copied();
    let near = chis.partition_point(|chi| *chi < NEAR);
    let of_all = |count: usize, scans: usize| (scans > 0).then(|| count as f64 / scans as f64);
    let seen_as =
        |sight: Sight| of_all(around.iter().filter(|votes| sight == Sight::of(votes)).count(), around.len());
    let nearest = nearest.unwrap_or_default();
    let odds = all.share(all.inside).zip(all.share(all.beyond));
    [
        nearest.share(nearest.inside),
        nearest.share(nearest.ground),
        nearest.share(nearest.beyond),
        nearest.share(nearest.before),
        nearest.chi,
        all.share(all.inside),
        all.share(all.ground),
        all.share(all.beyond),
        all.share(all.before),
        odds.map(|(inside, beyond)| ((inside + FEW) / (beyond + FEW)).ln()),
        rank(0.0),
        rank(0.25),
        rank(0.5),
        of_all(near, chis.len()),
        seen_as(Sight::Free),
        seen_as(Sight::Surface),
        seen_as(Sight::Occluded),
        seen_as(Sight::Unseen),
    ]
}

/// How a scan sees the place of a detection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sight {
    /// Rays pass through it, or reach the ground on which it would stand.
    Free,
    /// Rays end in it.
    Surface,
    /// Rays end before it.
    Occluded,
    /// No ray goes there.
    Unseen,
}

impl Sight {
    /// What most of the rays say. The ground under a detection counts as free space where no ray says anything else.
    fn of(votes: &Votes) -> Self {
        let Votes { inside, ground, beyond, before, .. } = *votes;
        if votes.total() <= 0.0 {
            Self::Unseen
        } else if inside > 0.0 && inside >= beyond && inside >= before {
            Self::Surface
        } else if beyond + ground >= before {
            Self::Free
        } else {
            Self::Occluded
        }
    }
}
