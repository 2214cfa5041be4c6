//! What is seen again, by going through everything.

use super::{Rows, SPEED, close, column, drive, front, with_frame};
use nalgebra::Matrix3;
use proptest::prelude::*;
use ralf::config::Config;
use ralf::evidence;
use ralf::scene::{Detection, Frame, NeighbouringDetections};
use ralf::sensors::Radar;
use ralf::space::{Transform, Vector};
use std::f64::consts::SQRT_2;

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
