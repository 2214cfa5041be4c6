//! Motion by a LiDAR alone, on drives whose truth is known.

use crate::{STRAIGHT, TURNING};
use ralf::sensors::Source;
use ralf_check::odometry::from_lidar;
use ralf_sim::{Scenario, SimulatedSequence};

/// Of the way driven, the end may be off by so much, and in degrees per 10 m.
const DRIFT: f64 = 0.01;
const TURN: f64 = 0.5;

/// Off at the end, in shares of the way; degrees off; the way, m.
fn drift(simulated: &SimulatedSequence) -> [f64; 3] {
    let found = from_lidar(simulated).unwrap();
    let times = &simulated.sequence().times.lidars[0];
    let (first, last) = (times[0], times[times.len() - 1]);
    let poses =
        times.windows(2).map(|pair| simulated.true_pose(pair[0]).inv_mul(&simulated.true_pose(pair[1])));
    let way = poses.map(|step| step.translation.vector.norm()).sum::<f64>();
    let truth = simulated.true_pose(first).inv_mul(&simulated.true_pose(last));
    let off = truth.inv_mul(&found.between(first, last));
    [off.translation.vector.norm() / way, off.rotation.angle().to_degrees(), way]
}

fn street(drive: &str, scans: usize, seed: u64) -> SimulatedSequence {
    let text = format!("{}\n{drive}", include_str!("street.toml"));
    SimulatedSequence::new("street", &Scenario::from_toml(&text).unwrap(), seed, scans).unwrap()
}

#[test]
fn a_lidar_alone_tells_where_the_vehicle_was() {
    for (title, drive, seed) in [("30 km/h", STRAIGHT, 1), ("18 km/h, turning", TURNING, 2)] {
        let [share, degrees, way] = drift(&street(drive, 120, seed));
        println!("{title}: {:.2} % and {degrees:.2} degrees off after {way:.0} m", share * 100.0);
        assert!(share < DRIFT && degrees < TURN * (way / 10.0).max(1.0));
    }
}

#[test]
#[ignore = "takes minutes"]
fn a_lidar_alone_tells_where_the_vehicle_was_in_the_sequences_of_the_paper() {
    let mut worst = 0.0_f64;
    for sequence in crate::sweep::sequences() {
        let [share, degrees, way] = drift(&sequence.simulate(1, sequence.scans.min(200)).unwrap());
        println!("{}: {:.2} % and {degrees:.2} degrees off after {way:.0} m", sequence.name, share * 100.0);
        worst = worst.max(share);
    }
    assert!(worst < DRIFT, "{worst}");
}
