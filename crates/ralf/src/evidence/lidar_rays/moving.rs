//! What the LiDARs' rays say of a detection that moves: each scan is asked where the detection's range rate takes it
//! by the time at which the rays towards it were sent.

use super::super::probe::{Probe, Probing};
use super::super::{Feature, Piece, Surroundings, Values, columns};
use super::votes::{Sweep, Votes};
use super::{GROUP, NEAR, RAYS, sweeps_of};
use crate::scene::{Frame, LidarSweep, LidarView, Mover, median};

pub(in super::super) const PIECE: Piece = Piece { features: FEATURES, observe };

const FEATURES: &[Feature] = &[
    Feature {
        name: "lidar_moving_in",
        unit: "1",
        group: GROUP,
        meaning: "of what moves: share of the rays of half a second around that end in it, where its range rate takes \
                  it along the ray by the time of the rays",
    },
    Feature {
        name: "lidar_moving_beyond",
        unit: "1",
        group: GROUP,
        meaning: "of what moves: share of these rays that pass through and end beyond",
    },
    Feature {
        name: "lidar_moving_chi",
        unit: "sigma",
        group: GROUP,
        meaning: "of what moves: median over these scans of the Mahalanobis distance from the closest point, with an \
                  uncertainty across the ray that grows with the way",
    },
    Feature {
        name: "lidar_moving_near",
        unit: "1",
        group: GROUP,
        meaning: "of what moves: share of these scans that look there with a point within 2 sigmas",
    },
];

/// Scans farther off in time say little of a thing whose motion across the ray nobody measures, s.
const AROUND: f64 = 0.5;

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let mut columns = columns::unobserved(FEATURES, frame.scan.len());
    let (Some(lidar), Some(rates)) = (&frame.lidar_window, surroundings.rates()) else { return columns };
    let moves = |i: &usize| rates.motion(*i) != 0.0;
    let movers: Vec<(usize, Mover)> = frame
        .movers()
        .into_iter()
        .enumerate()
        .filter_map(|(i, mover)| Some((i, mover?)))
        .filter(|(i, _)| moves(i))
        .collect();
    let is_near = |view: &&LidarView| {
        let seconds = (view.moment.t_ns - frame.scan.t_ns()) as f64 * 1e-9;
        seconds.abs() <= AROUND
    };
    let views = lidar.window.views.iter().filter(is_near);
    let probing = Probing::new(frame, lidar);
    let around: Vec<Vec<Votes>> =
        views.map(|view| Asked { frame, probing: &probing, view }.vote(&movers)).collect();
    for (place, (i, _)) in movers.iter().enumerate() {
        let votes: Vec<Votes> = around.iter().map(|votes| votes[place]).collect();
        columns::set(&mut columns, *i, answers(&votes));
    }
    columns
}

fn answers(scans: &[Votes]) -> [Option<f64>; 4] {
    let mut all = Votes::default();
    scans.iter().for_each(|votes| all.add(votes));
    let chis: Vec<f64> = scans.iter().filter_map(|votes| votes.chi).collect();
    let near = chis.iter().filter(|chi| **chi < NEAR).count();
    let share = (!chis.is_empty()).then(|| near as f64 / chis.len() as f64);
    [all.share(all.inside), all.share(all.beyond), median(chis), share]
}

/// The scans of one moment.
struct Asked<'a> {
    frame: &'a Frame<'a>,
    probing: &'a Probing<'a>,
    view: &'a LidarView,
}

impl Asked<'_> {
    /// The moment's votes on each of the movers.
    fn vote(&self, movers: &[(usize, Mover)]) -> Vec<Votes> {
        let LidarView { moment, vehicle_from_moment, .. } = self.view;
        let mut sums = vec![Votes::default(); movers.len()];
        for (sweep, mut rays) in moment.sweeps().iter().zip(sweeps_of(moment, *vehicle_from_moment, RAYS)) {
            for (sum, (_, mover)) in sums.iter_mut().zip(movers) {
                let there = self.at_time_of(sweep, &mut rays, mover);
                sum.add(&rays.vote(&there));
            }
        }
        sums
    }

    /// Where a mover is when the rays towards it are sent.
    fn at_time_of(&self, sweep: &LidarSweep, rays: &mut Sweep, mover: &Mover) -> Probe {
        let seconds = (sweep.scan.t_ns - self.frame.scan.t_ns()) as f64 * 1e-9;
        let at = |seconds: f64| self.probing.probe(&mover.after(seconds));
        let there = at(seconds);
        let Some(times) = &sweep.scan.times else { return there };
        // The rays turn far faster than things move: where it is at the scan's time tells which of them meet it.
        match rays.towards(&there) {
            Some(ray) => at(seconds + f64::from(times[ray as usize])),
            None => there,
        }
    }
}
