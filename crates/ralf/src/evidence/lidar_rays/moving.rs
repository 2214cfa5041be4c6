//! What the LiDARs' rays say of a detection that moves: each scan is asked where the detection's range rate takes it
//! by the time at which the rays towards it were sent, along the ray or along the road, whichever fits better.

use super::super::going::{Going, Goings, fit};
use super::super::probe::{Probe, Probing};
use super::super::{Feature, Piece, Surroundings, Values, columns};
use super::votes::{Sweep, Votes};
use super::{GROUP, NEAR, RAYS, by_direction, sweeps_of};
use crate::scene::{ACROSS_PER_ALONG, Frame, LidarSweep, LidarView, median};

pub(in super::super) const PIECE: Piece = Piece { features: FEATURES, observe };

const FEATURES: &[Feature] = &[
    Feature {
        name: "lidar_moving_in",
        unit: "1",
        group: GROUP,
        meaning: "of what moves: share of the rays of half a second around that end in it, where its range rate takes \
                  it by the time of the rays, along the ray or along the vehicle's course, whichever fits better",
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
    let goings = Goings::new(frame, rates);
    let mut ways: Vec<Way> = Vec::new();
    for i in by_direction(surroundings.probes()) {
        let going = frame.scan.detections[i].map(|known| goings.of(i, &known, ACROSS_PER_ALONG));
        ways.extend(going.into_iter().flatten().flatten().map(|going| Way { row: i, going }));
    }
    let is_near = |view: &&LidarView| {
        let seconds = (view.moment.t_ns - frame.scan.t_ns()) as f64 * 1e-9;
        seconds.abs() <= AROUND
    };
    let views = lidar.window.views.iter().filter(is_near);
    let probing = Probing::new(frame, lidar);
    let around: Vec<Vec<Votes>> =
        views.map(|view| Asked { frame, probing: &probing, view }.vote(&ways)).collect();
    let answered = |place: usize| Answers::of(around.iter().map(|votes| &votes[place]));
    let mut best: Vec<Option<Answers>> = vec![None; frame.scan.len()];
    for (place, Way { row, .. }) in ways.iter().enumerate() {
        let answers = answered(place);
        if best[*row].as_ref().is_none_or(|known| answers.fit() > known.fit()) {
            best[*row] = Some(answers);
        }
    }
    for (i, answers) in best.into_iter().enumerate() {
        if let Some(answers) = answers {
            columns::set(&mut columns, i, answers.values());
        }
    }
    columns
}

/// A way to go, and whose it is.
struct Way {
    /// The detection's place in the scan.
    row: usize,
    going: Going,
}

/// What the scans say of one way to go.
#[derive(Debug, Clone)]
struct Answers {
    all: Votes,
    chi: Option<f64>,
    /// How many scans have a point within [`NEAR`], and how many look there.
    near: [usize; 2],
}

impl Answers {
    fn of<'a>(scans: impl Iterator<Item = &'a Votes> + Clone) -> Self {
        let mut all = Votes::default();
        scans.clone().for_each(|votes| all.add(votes));
        let chis: Vec<f64> = scans.filter_map(|votes| votes.chi).collect();
        let near = [chis.iter().filter(|chi| **chi < NEAR).count(), chis.len()];
        Self { all, chi: median(chis), near }
    }

    fn fit(&self) -> [f64; 2] {
        let [near, scans] = self.near;
        fit(near, scans, self.chi.unwrap_or(f64::INFINITY))
    }

    fn values(&self) -> [Option<f64>; 4] {
        let [near, scans] = self.near;
        let share = (scans > 0).then(|| near as f64 / scans as f64);
        [self.all.share(self.all.inside), self.all.share(self.all.beyond), self.chi, share]
    }
}

/// The scans of one moment.
struct Asked<'a> {
    frame: &'a Frame<'a>,
    probing: &'a Probing<'a>,
    view: &'a LidarView,
}

impl Asked<'_> {
    /// The moment's votes on each of the ways.
    fn vote(&self, ways: &[Way]) -> Vec<Votes> {
        let LidarView { moment, vehicle_from_moment, .. } = self.view;
        let mut sums = vec![Votes::default(); ways.len()];
        for (sweep, mut rays) in moment.sweeps().iter().zip(sweeps_of(moment, *vehicle_from_moment, RAYS)) {
            for (sum, Way { going, .. }) in sums.iter_mut().zip(ways) {
                let there = self.at_time_of(sweep, &mut rays, going);
                sum.add(&rays.vote(&there));
            }
        }
        sums
    }

    /// Where a mover is when the rays towards it are sent.
    fn at_time_of(&self, sweep: &LidarSweep, rays: &mut Sweep, going: &Going) -> Probe {
        let seconds = (sweep.scan.t_ns - self.frame.scan.t_ns()) as f64 * 1e-9;
        let at = |seconds: f64| self.probing.probe(&going.after(seconds));
        let there = at(seconds);
        let Some(times) = &sweep.scan.times else { return there };
        // The rays turn far faster than things move: where it is at the scan's time tells which of them meet it.
        match rays.towards(&there) {
            Some(ray) => at(seconds + f64::from(times[ray as usize])),
            None => there,
        }
    }
}
