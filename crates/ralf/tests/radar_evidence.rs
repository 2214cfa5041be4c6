//! Evidence from the radars alone, on drives of a few detections, with numbers worked out by hand and by brute force.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "of tests alone")]

mod support;

use nalgebra::Matrix3;
use proptest::prelude::*;
use ralf::config::Config;
use ralf::evidence::{self, Column};
use ralf::scene::{Detection, Frame, FrameWindow, NeighbouringDetections};
use ralf::sensors::{Elevation, Radar};
use ralf::space::{Transform, Vector};
use std::f64::consts::SQRT_2;
use support::{MS, Memory, lidar, radar};

/// x, y, z, range rate and cross-section of each detection of a scan.
type Rows = Vec<[f32; 5]>;

const SPEED: f64 = 10.0;
const NO_PLACE: [f32; 5] = [f32::NAN, 0.0, 0.0, 0.0, 0.0];

fn front() -> Radar {
    let fields = ["x", "y", "z", "doppler", "rcs"].map(str::to_owned).to_vec();
    Radar { name: "front".into(), fields, ..radar(Elevation::Measured) }
}

/// A drive ahead at [`SPEED`]; each radar with its scans and their times, ms.
fn drive(radars: Vec<(Radar, Vec<(i64, Rows)>)>) -> Memory {
    let mut memory = Memory::new(SPEED);
    for (radar, scans) in radars {
        memory = memory.measured(radar, scans.into_iter().map(|(ms, rows)| (ms * MS, rows)).collect());
    }
    memory
}

fn with_frame<R>(memory: &Memory, radar: usize, scan: usize, look: impl FnOnce(&Frame) -> R) -> R {
    let config = Config::default();
    let mut window = FrameWindow::new(memory, &memory.sequence.rig, &config).with_evidence();
    look(&window.frame(radar, scan).unwrap())
}

fn observe(memory: &Memory, scan: usize) -> Vec<Column> {
    with_frame(memory, 0, scan, |frame| evidence::observe(frame, &Config::default()))
}

fn column(columns: &[Column], name: &str) -> Vec<Option<f64>> {
    columns.iter().find(|column| column.feature.name == name).expect("a column of this name").values.clone()
}

#[track_caller]
fn close(found: &[Option<f64>], expected: &[Option<f64>]) {
    let near = |(found, expected): (&Option<f64>, &Option<f64>)| match (found, expected) {
        (Some(found), Some(expected)) => (found - expected).abs() < 1e-4 * expected.abs().max(1.0),
        (found, expected) => found.is_none() && expected.is_none(),
    };
    let same = found.len() == expected.len() && found.iter().zip(expected).all(near);
    assert!(same, "found {found:?}, expected {expected:?}");
}

#[test]
fn amplitude_by_hand() {
    let scan = vec![
        [10.0, 0.0, 0.0, 0.0, 0.0],
        [14.0, 0.0, 0.0, 0.0, 10.0],
        [100.0, 0.0, 0.0, 0.0, 30.0],
        [20.0, 0.0, 0.0, 0.0, f32::NAN],
        NO_PLACE,
    ];
    let found = observe(&drive(vec![(front(), vec![(0, scan)])]), 0);
    // The last has a cross-section, but no place that a power could be told from.
    let ranks = column(&found, "amplitude_rank");
    close(&ranks, &[Some(0.5 / 3.0), Some(2.0 / 3.0), Some(1.0), None, Some(0.5 / 3.0)]);
    // Powers: -40, 10 - 45.845 = -35.845, 30 - 80 = -50.
    close(&column(&found, "amplitude_power_rank"), &[Some(0.5), Some(1.0), Some(0.0), None, None]);
    // Within 5 m: 0 and 10 dB; alone.
    close(&column(&found, "amplitude_over_ring"), &[Some(-5.0), Some(5.0), Some(0.0), None, None]);
    // The floor is the weakest of three.
    close(&column(&found, "amplitude_over_floor"), &[Some(10.0), Some(14.15488), Some(0.0), None, None]);
    close(&column(&found, "amplitude_over_ring_floor"), &[Some(0.0), Some(4.15488), Some(0.0), None, None]);
}

#[test]
fn the_floor_is_that_of_the_radars_own_scans_around() {
    let rows = |rcs: f32| vec![[10.0, 0.0, 0.0, 0.0, rcs]];
    let other = Radar { name: "other".into(), ..front() };
    let memory = drive(vec![
        (front(), vec![(0, rows(0.0)), (100, rows(-7.0)), (700, rows(-20.0))]),
        (other, vec![(0, rows(-30.0))]),
    ]);
    let found = observe(&memory, 0);
    close(&column(&found, "amplitude_over_floor"), &[Some(7.0)]);
    close(&column(&found, "amplitude_over_ring_floor"), &[Some(7.0)]);
}

#[test]
fn a_radar_that_measures_place_alone_has_geometry_and_no_amplitude_or_doppler() {
    let memory = Memory::new(SPEED).radar(radar(Elevation::None), vec![(0, Some(vec![[3.0, 4.0, 9.0]]))]);
    let found = observe(&memory, 0);
    for Column { feature, values } in &found {
        if ["Amplitude", "Doppler"].contains(&feature.group) {
            assert_eq!(values, &[None], "{}", feature.name);
        }
    }
    close(&column(&found, "geometry_range"), &[Some(5.0)]);
    close(&column(&found, "geometry_azimuth"), &[Some((4.0f64 / 3.0).atan() / 1.25)]);
    close(&column(&found, "geometry_elevation"), &[None]);
    close(&column(&found, "geometry_sigma_across"), &[Some(0.05)]);
    close(&column(&found, "geometry_beside_course"), &[Some(4.0)]);
}

#[test]
fn doppler_by_hand() {
    // Ahead, what stands still comes nearer at 10 m/s.
    let scan = vec![
        [10.0, 0.0, 0.0, -10.0, 0.0],
        [10.5, 0.0, 0.0, -10.1, 0.0],
        [11.0, 0.0, 0.0, -4.0, 0.0],
        [10.0, 0.0, 9.0, f32::NAN, 0.0],
        [40.0, 0.0, 0.0, -10.0, 0.0],
        NO_PLACE,
    ];
    let found = observe(&drive(vec![(front(), vec![(0, scan)])]), 0);
    // The rates 0, -0.1, 6, 0, 0 have a spread of 0, for which 0.12 m/s is taken.
    let residuals = [Some(0.0), Some(0.1 / 0.12), Some(50.0), None, Some(0.0), None];
    close(&column(&found, "doppler_residual"), &residuals);
    close(&column(&found, "doppler_agreeing"), &[Some(1.0), Some(1.0), Some(0.0), None, Some(0.0), None]);
    close(&column(&found, "doppler_agreeing_share"), &[Some(0.5), Some(0.5), Some(0.0), None, None, None]);
    close(&column(&found, "doppler_track_residual"), &[None; 6]);
}

/// Scans every 100 ms, made of where things are at a time, s.
fn scans(count: i64, rows: impl Fn(f32) -> Rows) -> Vec<(i64, Rows)> {
    (0..count).map(|scan| (scan * 100, rows(scan as f32 * 0.1))).collect()
}

#[test]
fn what_stands_still_what_moves_and_what_moves_along() {
    // A post ahead on the left; a car ahead that drives at 25 m/s; something on the own bumper.
    let memory = drive(vec![(
        front(),
        scans(13, |t| {
            let post = [40.0 - 10.0 * t, 8.0];
            let towards_post = post[0] / post[0].hypot(post[1]);
            vec![
                [post[0], post[1], 0.0, -10.0 * towards_post, 0.0],
                [20.0 + 15.0 * t, 0.0, 0.0, 15.0, 0.0],
                [3.0, -1.0, 0.0, 0.0, 0.0],
            ]
        }),
    )]);
    let found = observe(&memory, 6);
    close(&column(&found, "persistence_own"), &[Some(1.0), Some(0.0), Some(0.0)]);
    // What lies on the bumper drives as the vehicle does.
    close(&column(&found, "persistence_moving"), &[Some(1.0); 3]);
    close(&column(&found, "persistence_others"), &[None; 3]);
    // What moves along has the range rate of what drives away as fast.
    close(&column(&found, "doppler_track_residual"), &[Some(0.0); 3]);
    close(&column(&found, "persistence_distance")[..1], &[Some(0.0)]);
    // All scans saw the post again, and none the last where it would be if it stood still; all look at the car along
    // one line.
    close(&column(&found, "persistence_aspect"), &[Some(1.0), None, Some(0.0)]);
    // All 12 scans see it; in each of them one detection lies within 5 m, and within 2 sigma of it an ellipse of
    // variances 2 * 0.3^2 + 0.01 along the ray and 2 * (0.01 r)^2 + 0.01 across it.
    let r = 34.0f64.hypot(8.0);
    let area = std::f64::consts::PI * 4.0 * (0.19 * (2.0 * (0.01 * r).powi(2) + 0.01)).sqrt();
    let expected = 12.0 * (1.0 - (-area / (std::f64::consts::PI * 25.0)).exp());
    close(&column(&found, "persistence_excess")[..1], &[Some((12.5 / (expected + 0.5)).ln())]);
    // What moves along is at the same place of the radar's frame in all scans. Where it would be if it stood still, it
    // isn't: 3 sigma of 2 * (0.3^2 + 0.03162^2) + 0.01 are 1.31 m, which the vehicle drives in 0.2 s, so that 10 scans
    // count, with one detection each within 5 m. Variances are 0.19 and 2 * 0.03162^2 + 0.01 = 0.012.
    let area = std::f64::consts::PI * 4.0 * (0.19f64 * 0.012).sqrt();
    let expected = 10.0 * (1.0 - (-area / (std::f64::consts::PI * 25.0)).exp());
    close(&column(&found, "persistence_sensor")[2..], &[Some((10.5 / (expected + 0.5)).ln())]);
}

#[test]
fn scans_together_place_what_stands() {
    // A post that is told 0.4 m to the left, to the right, and where it is, in turn; a car that drives ahead.
    let memory = drive(vec![(
        front(),
        scans(13, |t| {
            let post = [40.0 - 10.0 * t, 0.0];
            let aside = [0.4, 0.0, -0.4][(t * 10.0).round() as usize % 3];
            vec![[post[0], post[1] + aside, 0.0, -10.0, 0.0], [20.0 + 15.0 * t, 5.0, 0.0, 14.5, 0.0]]
        }),
    )]);
    let found = observe(&memory, 6);
    // At 34 m it is told 0.4 m aside, where it is known to 0.34 m; of all 13 scans five tell it so and four each of the
    // other two ways. Nearer ones know it better.
    let [post, car] = column(&found, "persistence_shift")[..] else { panic!("two detections") };
    assert!((post.unwrap() - 0.4 / 0.34f64.hypot(0.1)).abs() < 0.2, "{post:?}");
    assert_eq!(car, Some(0.0), "what moves stays where it was measured");
    let scatter = column(&found, "persistence_scatter");
    // Across the ray 0.4^2 2 / 3 over some 0.34^2 + 0.01, along the other axes nearly nothing.
    let expected = (0.4f64.powi(2) * 2.0 / 3.0 / (0.34f64.powi(2) + 0.01) / 3.0).sqrt();
    assert!((scatter[0].unwrap() - expected).abs() < 0.15, "{scatter:?}, {expected}");
    assert_eq!(scatter[1], None);
}

#[test]
fn what_drives_beside_is_sought_along_the_road() {
    // A car in the next lane, as fast as the vehicle and 2 m/s faster: at 45 degrees and beside the radar. Along the ray
    // they would be 0.5, 0.5 and 0.4 m aside in a tenth of a second, and more.
    let car = |t: f32, ahead: f32, speed: f32| {
        let x = ahead + (speed - 10.0) * t;
        [x, 4.0, 0.0, (speed - 10.0) * x / x.hypot(4.0), 0.0]
    };
    let rows = |t: f32| vec![car(t, 4.0, 10.0), car(t, 2.0, 12.0), car(t, 12.0, 12.0)];
    let found = observe(&drive(vec![(front(), scans(13, rows))]), 6);
    close(&column(&found, "persistence_moving"), &[Some(1.0); 3]);
    close(&column(&found, "doppler_track_residual"), &[Some(0.0); 3]);
    // What crosses the road goes along its ray: one of the two ways is enough. In half a second the other would lead 3 m
    // aside.
    let crossing = |t: f32| {
        let range = 30.0 + 8.0 * t;
        vec![[0.8 * range, 0.6 * range, 0.0, 8.0, 0.0]]
    };
    let mut memory = drive(vec![(front(), scans(13, crossing))]);
    memory.sequence.motion = Memory::new(0.0).sequence.motion;
    close(&column(&observe(&memory, 6), "persistence_moving"), &[Some(1.0)]);
}

#[test]
fn only_scans_that_could_have_seen_it_count() {
    // A second radar looks ahead as far as 20 m, and saw one of two posts once in two scans.
    let post = |t: f32| [20.0 - 10.0 * t, 0.0, 0.0, -10.0, 0.0];
    let far = |t: f32| [60.0 - 10.0 * t, 0.0, 0.0, -10.0, 0.0];
    let other = Radar { name: "other".into(), ..front() };
    let memory = drive(vec![
        (front(), vec![(0, vec![post(0.0), far(0.0)])]),
        (other, vec![(-100, vec![post(-0.1)]), (100, vec![[20.0, 2.0, 0.0, 0.0, 0.0]])]),
    ]);
    let found = observe(&memory, 0);
    close(&column(&found, "persistence_others"), &[Some(0.5), None]);
    close(&column(&found, "persistence_own"), &[None, None]);
    close(&column(&found, "persistence_sensor"), &[None, None]);
}

#[test]
fn a_vehicle_that_stands_tells_nothing_of_what_moves_along() {
    let mut memory = drive(vec![(front(), scans(3, |_| vec![[9.0, 1.0, 0.0, 0.0, 0.0]]))]);
    memory.sequence.motion = Memory::new(0.0).sequence.motion;
    close(&column(&observe(&memory, 1), "persistence_sensor"), &[None]);
    close(&column(&observe(&memory, 1), "persistence_own"), &[Some(1.0)]);
}

#[test]
fn context_by_hand() {
    let degrees =
        |range: f32, degrees: f32| [range * degrees.to_radians().cos(), range * degrees.to_radians().sin()];
    let row = |[x, y]: [f32; 2], rate: f32, rcs: f32| [x, y, 0.0, rate, rcs];
    let scan = vec![
        row([10.0, 0.0], 0.0, 20.0),
        row([20.5, 0.0], 0.0, 5.0),
        row([14.5, 0.0], 0.0, 0.0),
        row(degrees(10.0, 30.0), 0.08, -5.0),
        row(degrees(10.0, 31.0), 9.0, -8.0),
        NO_PLACE,
    ];
    let found = observe(&drive(vec![(front(), vec![(0, scan)])]), 0);
    let crowded = [0.25, 0.25, 0.25, 0.875, 0.875].map(Some);
    close(&column(&found, "context_density_rank")[..5], &crowded);
    close(&column(&found, "context_density_around"), &[None; 6]);
    // Behind the first lie the second and the third; before the second lies the third, which is weaker.
    close(&column(&found, "context_before")[..5], &[0.0, 1.0, 1.0, 0.0, 0.0].map(Some));
    close(&column(&found, "context_before_distance"), &[None, Some(10.5), Some(4.5), None, None, None]);
    // 20.5 - 2 * 10 and 14.5 - 2 * 10, of a variance of 5 * (0.09 + 0.01).
    let sigma = 0.5f64.sqrt();
    close(
        &column(&found, "context_double_bounce"),
        &[None, Some(0.5 / sigma), Some(5.5 / sigma), None, None, None],
    );
    // Three at 10 m.
    close(&column(&found, "context_beside_rank"), &[Some(1.0), None, None, Some(0.5), Some(0.0), None]);
    close(&column(&found, "context_beside_angle"), &[None, None, None, Some(30.0), Some(1.0), None]);
    // The rates of the first and the fourth agree, those of the others don't; one degree is the same azimuth.
    close(&column(&found, "context_side_lobe"), &[Some(-25.0), None, None, Some(25.0), None, None]);
}

#[test]
fn what_a_wall_mirrors_is_found_on_the_radars_side_of_it() {
    // A wall along the left, 5 m away. A post at (10, 2) and its image at (10, 8), a weaker one that is nobody's
    // image, and one that is stronger than the post.
    let scan = vec![
        [10.0, 2.0, 1.0, 0.0, 10.0],
        [10.0, 8.0, 1.0, 0.0, 0.0],
        [20.0, 8.0, 1.0, 0.0, 0.0],
        [10.2, 8.0, 1.0, 0.0, 20.0],
        NO_PLACE,
    ];
    let wall: Vec<[f32; 3]> =
        (0..4000).map(|k| [(k % 200) as f32 * 0.1, 5.05, (k / 200) as f32 * 0.12 - 1.8]).collect();
    let memory = drive(vec![(front(), vec![(0, scan)])]).lidar(lidar(), vec![(0, wall)]);
    let found = column(&observe(&memory, 0), "context_mirror");
    // Columns are 0.25 m wide: the wall is taken to be 5.125 m away, the image to come from (10, 2.25). That misses by
    // 0.25 m, across rays whose ends are known by 0.1 m each, with 0.1 m of room: 1.44 sigma at most.
    let [none_before, image, nobodys, stronger] = [0, 1, 2, 3].map(|row| found[row]);
    assert!(image.is_some_and(|distance| distance < 1.5), "{image:?}");
    assert_eq!([none_before, nobodys, stronger, found[4]], [None; 4]);
}

/// A detection anywhere before the radar, on few places, so that there is something to meet.
fn row() -> impl Strategy<Value = [f32; 5]> {
    let place = (0..12, -6..6).prop_map(|(x, y)| [12.0 + x as f32 * 0.5, y as f32]);
    (place, -2..3, prop_oneof![Just(-10.0f32), Just(-4.0), Just(2.0), Just(f32::NAN)])
        .prop_map(|([x, y], z, rate)| [x, y, z as f32 * 0.3, rate, 0.0])
}

/// `chi` of two detections, by solving a system of equations.
fn chi(a: &Detection, b: &Detection) -> f64 {
    let room = Matrix3::identity() * 0.01;
    let covariance = a.axes * a.axes.transpose() + b.axes * b.axes.transpose() + room;
    let h = a.position - b.position;
    h.dot(&covariance.lu().solve(&h).unwrap()).sqrt()
}

/// Which of the own scans around, by their places, have a detection within 2 sigmas of where one would be that goes a
/// way at a speed, with a range rate that such a thing has there.
fn met(frame: &Frame, i: usize, spread: f64, (way, speed, sigma): (Vector, f64, f64)) -> Vec<bool> {
    let around = NeighbouringDetections::around(frame);
    let detection = frame.scan.detections[i].unwrap();
    let ray = detection.position.coords.normalize();
    // The rate shows as much of how both move across the ray as the place is uncertain there.
    let across = way * speed - Vector::new(SPEED, 0.0, 0.0);
    let seen = detection.axes.columns(1, 2).transpose() * across / detection.position.coords.norm();
    let rate_sigma = spread.hypot(seen.norm());
    let own = (0..around.radars.len()).filter(|scan| around.radars[*scan] == 0);
    own.map(|scan| {
        let seconds = around.seconds[scan];
        let mut there = detection;
        there.position += way * speed * seconds;
        for column in 0..2 {
            let axis = detection.axes.column(column).into_owned();
            let share = axis.normalize().dot(&way);
            let along = rate_sigma / ray.dot(&way) * seconds * share;
            let beside = sigma * speed * seconds * (1.0 - share * share).max(0.0).sqrt();
            let length = (axis.norm_squared() + along * along + beside * beside).sqrt();
            there.axes.set_column(column, &(axis.normalize() * length));
        }
        let origin = frame.radar_window[scan].vehicle_from_scan.translation.vector;
        let agrees = |j: &usize| {
            let rate = (way * speed).dot(&(around.detections[*j].position.coords - origin).normalize());
            (around.doppler[*j] - rate).abs() <= 2.0 * SQRT_2 * rate_sigma
        };
        let all = (0..around.len()).filter(|j| around.scans[*j] as usize == scan).filter(agrees);
        all.into_iter().any(|j| chi(&there, &around.detections[j]) <= 2.0)
    })
    .collect()
}

/// How far the joint place of a detection and of the nearest ones that it meets where it stands lies from its own, and
/// how far they scatter about it, by solving one system of equations for all of them.
fn joint(detection: &Detection, met: &[&Detection]) -> [Option<f64>; 2] {
    let weight = |detection: &Detection| {
        let covariance = detection.axes * detection.axes.transpose() + Matrix3::identity() * 0.01;
        covariance.try_inverse().unwrap()
    };
    let all: Vec<&Detection> = std::iter::once(detection).chain(met.iter().copied()).collect();
    let weights: Matrix3<f64> = all.iter().map(|detection| weight(detection)).sum();
    let pull: Vector = all.iter().map(|detection| weight(detection) * detection.position.coords).sum();
    let place = weights.lu().solve(&pull).unwrap();
    let squared = |detection: &Detection| {
        let h = detection.position.coords - place;
        h.dot(&(weight(detection) * h))
    };
    let scatter: f64 = all.iter().map(|detection| squared(detection)).sum();
    let scatter = (!met.is_empty()).then(|| (scatter / (3 * met.len()) as f64).sqrt());
    [Some(squared(detection).sqrt()), scatter]
}

/// Shares of persistence, the mean distance, and the shift and scatter of the joint place, by going through everything.
fn brute_force(frame: &Frame, i: usize) -> [Option<f64>; 6] {
    let around = NeighbouringDetections::around(frame);
    let rates = &frame.doppler().unwrap().compensated;
    // Made of so few different rates that the spread is at its lower bound, or its upper.
    let finite: Vec<f64> = rates.iter().copied().filter(|rate| rate.is_finite()).collect();
    let middle = ralf::scene::median(finite.clone()).unwrap_or(0.0);
    let distances = finite.iter().map(|rate| (rate - middle).abs()).collect();
    let spread = (1.48 * ralf::scene::median(distances).unwrap_or(0.0)).clamp(0.12, 0.3);
    let moves = rates[i].abs() > 3.0 * spread;
    let (mut own, mut moving, mut others, mut distance) = (vec![], vec![], vec![], vec![]);
    let detection = frame.scan.detections[i].unwrap();
    let mut met_again = Vec::new();
    for (scan, radar) in around.radars.iter().enumerate() {
        let there = |j: &usize| around.scans[*j] as usize == scan;
        let all: Vec<usize> = (0..around.len()).filter(there).collect();
        let still = all.iter().map(|j| chi(&detection, &around.detections[*j])).fold(f64::INFINITY, f64::min);
        if *radar != 0 {
            others.push(still <= 2.0);
            continue;
        }
        own.push(still <= 2.0);
        distance.push(still.min(3.0));
        let agrees = |j: &&usize| (around.doppler[**j] - rates[i]).abs() <= 2.0 * SQRT_2 * spread;
        if rates[i].is_finite() && !moves {
            let agreeing = all.iter().filter(agrees).map(|j| &around.detections[*j]);
            let distances = agreeing.map(|other| (chi(&detection, other), other));
            let nearest = distances.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(chi, _)| *chi <= 2.0);
            moving.push(nearest.is_some());
            met_again.extend(nearest.map(|(_, other)| other));
        }
    }
    if moves {
        // Along the ray, or along the road; the course is the vehicle's x axis.
        let ray = detection.position.coords.normalize();
        let along_ray = met(frame, i, spread, (ray, rates[i], 0.0));
        let along_road = met(frame, i, spread, (Vector::x(), rates[i] / ray.x, 0.03));
        let hits = |met: &[bool]| met.iter().filter(|met| **met).count();
        moving = if hits(&along_road) > hits(&along_ray) { along_road } else { along_ray };
    }
    let share = |hits: Vec<bool>| {
        let count = hits.len();
        (count > 0).then(|| hits.into_iter().filter(|hit| *hit).count() as f64 / count as f64)
    };
    let mean = (!distance.is_empty()).then(|| distance.iter().sum::<f64>() / distance.len() as f64);
    let [shift, scatter] = joint(&detection, &met_again);
    [share(own), share(moving), share(others), mean, shift, scatter]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn persistence_is_what_brute_force_gives(
        own in prop::collection::vec(prop::collection::vec(row(), 0..12), 2..6),
        other in prop::collection::vec(prop::collection::vec(row(), 0..12), 0..4),
    ) {
        // A detection far away in each direction lets every scan see all.
        let wide = |mut rows: Rows| {
            rows.extend((-6..=6).map(|k| {
                let angle = k as f32 * 10f32.to_radians();
                [60.0 * angle.cos(), 60.0 * angle.sin(), 0.0, 0.0, 0.0]
            }));
            rows
        };
        let timed = |scans: Vec<Rows>, first: i64| (0..).map(|k| first + 100 * k).zip(scans.into_iter().map(wide)).collect();
        let beside = Radar {
            name: "beside".into(), vehicle_from_radar: Transform::translation(0.5, 0.3, 0.2), ..front()
        };
        let memory = drive(vec![(front(), timed(own, 0)), (beside, timed(other, 20))]);
        with_frame(&memory, 0, 1, |frame| {
            let found = evidence::observe(frame, &Config::default());
            let names = ["own", "moving", "others", "distance", "shift", "scatter"];
            let found = names.map(|name| column(&found, &format!("persistence_{name}")));
            // Those far away lie at the very limit of what can be seen.
            for i in 0..frame.scan.len() - 13 {
                close(&found.each_ref().map(|values| values[i]), &brute_force(frame, i));
            }
        });
    }
}
