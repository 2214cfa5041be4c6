//! What a simulated recording promises.
use ralf::label::Cause;
use ralf::sensors::{RadarScan, Source};
use ralf_sim::{Scenario, ScenarioError, SimulatedSequence, presets};

fn tiny(seed: u64) -> SimulatedSequence {
    presets::find("tiny").unwrap().sequences[0].simulate(seed, 6).unwrap()
}

fn columns(sequence: &SimulatedSequence, radar: usize, scan: usize) -> Vec<Vec<f32>> {
    let RadarScan { columns, .. } = sequence.radar_scan(radar, scan).unwrap();
    columns
}

#[test]
fn a_seed_gives_the_same_measurements_in_any_order_and_another_others() {
    let [a, b, other] = [tiny(1), tiny(1), tiny(2)];
    let late = columns(&a, 2, 5);
    assert_eq!(columns(&a, 0, 0), columns(&b, 0, 0));
    assert_eq!(late, columns(&b, 2, 5));
    assert_ne!(late, columns(&other, 2, 5));
    assert_eq!(a.lidar_scan(0, 2).unwrap().points, b.lidar_scan(0, 2).unwrap().points);
    assert_ne!(a.lidar_scan(0, 2).unwrap().points, other.lidar_scan(0, 2).unwrap().points);
    assert_eq!(a.image(1, 1).unwrap(), b.image(1, 1).unwrap());
    assert_ne!(a.image(1, 1).unwrap(), other.image(1, 1).unwrap());
    assert_eq!(a.depth(1, 1).unwrap(), b.depth(1, 1).unwrap());
    assert_eq!(a.sequence().motion.odometry(), b.sequence().motion.odometry());
    assert_eq!(a.truth(3, 3).unwrap(), b.truth(3, 3).unwrap());
}

#[test]
fn the_paper_has_its_share_of_plausible_detections_and_every_cause() {
    let paper = presets::find("paper").unwrap();
    let mut counts = [0_usize; 7];
    let mut scans = 0;
    for (sequence, length) in paper.sequences.iter().zip(paper.spread(33)) {
        let sequence = sequence.simulate(0, length).unwrap();
        for (radar, scan) in (0..4).flat_map(|radar| (0..length).map(move |scan| (radar, scan))) {
            for truth in sequence.truth(radar, scan).unwrap() {
                assert_eq!(truth.cause == Cause::Plausible, truth.class != 1);
                counts[truth.cause as usize] += 1;
            }
            scans += 1;
        }
    }
    let all: usize = counts.iter().sum();
    let share = counts[0] as f64 / all as f64;
    assert!((share - 0.215).abs() < 0.03, "{share}: {counts:?}");
    assert!(counts.iter().all(|count| count * 100 > all), "{counts:?}");
    let per_moment = 4.0 * all as f64 / f64::from(scans);
    assert!((1000.0..1400.0).contains(&per_moment), "{per_moment}");
}

/// Cameras have their say there alone.
#[test]
fn many_plausible_detections_lie_in_the_lidars_blind_spot() {
    let paper = presets::find("paper").unwrap();
    let (mut plausible, mut hidden) = (0, 0);
    for preset in paper.sequences {
        let sequence = preset.simulate(0, 3).unwrap();
        let rig = &sequence.sequence().rig;
        let lidar = rig.lidars[0].vehicle_from_lidar.translation.vector;
        for (radar, sensor) in rig.radars.iter().enumerate() {
            let scan = sequence.radar_scan(radar, 2).unwrap();
            for (found, truth) in scan.spherical.iter().zip(sequence.truth(radar, 2).unwrap()) {
                let p = sensor.vehicle_from_radar * found.to_cartesian();
                let reach = (lidar.z - p.z) / rig.lidars[0].lowest_beam.tan();
                let is_hidden = p.z >= 0.0 && (p.x - lidar.x).hypot(p.y - lidar.y) <= reach;
                plausible += usize::from(truth.cause == Cause::Plausible);
                hidden += usize::from(truth.cause == Cause::Plausible && is_hidden);
            }
        }
    }
    assert!(hidden * 10 > plausible, "{hidden} of {plausible}");
}

#[test]
fn nothing_lies_in_the_lidars_blind_spot() {
    let sequence = tiny(3);
    let lidar = &sequence.sequence().rig.lidars[0];
    let height = lidar.vehicle_from_lidar.translation.z;
    for scan in 0..3 {
        for [x, y, z] in sequence.lidar_scan(0, scan).unwrap().points {
            let [x, y, z] = [x, y, z].map(f64::from);
            let below = -z;
            // Five standard deviations of range, along the lowest beam.
            let inside =
                below > 0.0 && below <= height && x.hypot(y) < below / lidar.lowest_beam.tan() - 0.17;
            assert!(!inside, "{x} {y} {z}");
        }
    }
}

#[test]
fn wheel_odometry_follows_the_true_path() {
    let sequence = presets::find("paper").unwrap().sequences[3].simulate(4, 400).unwrap();
    let end = *sequence.sequence().times.radars[0].last().unwrap();
    let start = sequence.sequence().times.radars[0][0];
    let found = sequence.sequence().motion.between(start, end);
    let truth = sequence.true_pose(end);
    let travelled = truth.translation.vector.norm();
    let off = (found.translation.vector - truth.translation.vector).xy().norm();
    assert!(travelled > 20.0 && off < 0.05 * travelled && off > 0.0, "{off} of {travelled}");
    assert!(found.rotation.angle_to(&truth.rotation) < 0.1);
    let fastest = sequence.sequence().motion.odometry().iter().map(|s| s.velocity).fold(0.0, f64::max);
    assert!(fastest < 10.0 / 3.6);
}

#[test]
fn measurements_that_are_not_there_and_worlds_that_cannot_be_are_refused() {
    let sequence = tiny(1);
    assert!(sequence.radar_scan(0, 6).is_err() && sequence.radar_scan(4, 0).is_err());
    assert!(sequence.truth(0, 6).is_err() && sequence.lidar_scan(1, 0).is_err());
    assert!(sequence.image(4, 0).is_err() && sequence.depth(0, 99).is_err());
    let with = |speed: &str, thing: &str| {
        Scenario::from_toml(&format!(
            "title = ''\nego = {{ start = [0, 0, 0], speed_kmh = {speed} }}\nthing = [{thing}]"
        ))
    };
    assert!(with("7", "").is_ok());
    let refused = |text: Result<Scenario, ScenarioError>| text.unwrap_err().to_string();
    assert!(refused(with("130", "")).contains("below 130 km/h, found 130"));
    assert!(refused(with("nan", "")).contains("speed_kmh"));
    assert!(
        refused(with("7", "{ kind = 'car', at = [inf, 0] }")).contains("thing.at: expected a number from")
    );
    assert!(refused(with("7", "{ kind = 'car', at = [1, 0], size = [0, 1, 1] }")).contains("above 0 m"));
    for count in ["4294967296", "1001", "0"] {
        let things = format!("{{ kind = 'car', at = [1, 0], step = [9, 0], count = {count} }}");
        assert!(refused(with("7", &things)).contains("thing.count: expected 1 to 1000"), "{count}");
    }
    assert!(
        refused(with("7", "{ kind = 'tree', at = [1, 0], size = [1e3, 1e3, 1e3] }"))
            .contains("a few streets")
    );
    assert!(refused(with("7", "{ kind = 'castle', at = [1, 0] }")).contains("castle"));
    assert!(refused(with("7", "{ kind = 'car', at = [1, 0], wings = 2 }")).contains("wings"));
}
