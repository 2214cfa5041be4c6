//! What stands around the lorry, and what sensors see of it.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

/// Unix time of the first scan, us.
pub(crate) const T0: i64 = 1_695_473_372_704_727;
/// m/s
pub(crate) const SPEED: f64 = 15.0;
/// rad/s, to the left.
pub(crate) const YAW_RATE: f64 = 0.35;
/// A revolution, us; its middle is the scan's time.
const REVOLUTION: f64 = 100_000.0;
/// Nothing returns from farther, m.
const FARTHEST: f64 = 90.0;

/// Two corners of each box, in the vehicle's frame at the first scan, m: walls on both sides, a wall ahead, containers and posts.
const BOXES: [[[f64; 3]; 2]; 9] = [
    [[-60.0, 22.0, 0.0], [25.0, 23.0, 6.0]],
    [[-60.0, -15.0, 0.0], [80.0, -14.0, 5.0]],
    [[45.0, -10.0, 0.0], [46.0, 40.0, 7.0]],
    [[12.0, -9.0, 0.0], [16.0, -6.8, 2.4]],
    [[20.0, 9.0, 0.0], [24.0, 11.5, 2.6]],
    [[-14.0, 6.0, 0.0], [-9.0, 8.4, 2.9]],
    [[-25.0, -7.0, 0.0], [-20.5, -5.0, 1.6]],
    [[30.0, -3.0, 0.0], [30.4, -2.6, 4.0]],
    [[33.0, 14.0, 0.0], [33.4, 14.4, 4.0]],
];

/// The vehicle at a time, in its frame at the first scan.
pub(crate) fn start_from_vehicle(us: i64) -> Isometry3<f64> {
    let turned = YAW_RATE * (us - T0) as f64 * 1e-6;
    let radius = SPEED / YAW_RATE;
    let place = Translation3::new(radius * turned.sin(), radius * (1.0 - turned.cos()), 0.0);
    Isometry3::from_parts(place, UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turned))
}

/// What a radar measured.
pub(crate) struct Detection {
    /// In the radar's frame, m.
    pub(crate) place: Vector3<f64>,
    /// Its relative radial velocity, m/s.
    pub(crate) velocity: Vector3<f64>,
    pub(crate) is_real: bool,
}

/// Each ray of a radar finds what stands there, and every other one something between or behind that is not there.
pub(crate) fn detections(mounting: &Isometry3<f64>, us: i64, rays: usize) -> Vec<Detection> {
    let start_from_radar = start_from_vehicle(us) * mounting;
    let lever = mounting.translation.vector;
    let own = Vector3::new(SPEED, 0.0, 0.0) + Vector3::new(0.0, 0.0, YAW_RATE).cross(&lever);
    let own = mounting.rotation.inverse() * own;
    let mut found = Vec::new();
    for ray in 0..rays {
        let azimuth = 100f64.to_radians() * ((ray as f64 + 0.5) / rays as f64 - 0.5);
        let direction = direction(azimuth, [-0.02, 0.0, 0.03][ray % 3]);
        let mut add = |range: f64, is_real: bool| {
            let velocity = direction * -own.dot(&direction);
            found.push(Detection { place: direction * range, velocity, is_real });
        };
        let Some((range, true)) = cast(&start_from_radar, &direction) else { continue };
        add(range, true);
        if ray % 2 == 0 {
            add(range * if ray % 4 == 0 { 0.6 } else { 1.5 }, false);
        }
    }
    found
}

/// Points of a revolution in the LiDAR's frame at their own times, us.
pub(crate) fn revolution(
    mounting: &Isometry3<f64>,
    us: i64,
    [columns, beams]: [usize; 2],
) -> Vec<(Vector3<f64>, i64)> {
    let mut points = Vec::new();
    for column in 0..columns {
        let turned = column as f64 / columns as f64 - 0.5;
        let time = us + (REVOLUTION * turned) as i64;
        let start_from_lidar = start_from_vehicle(time) * mounting;
        for beam in 0..beams {
            let elevation = (-24.0 + 30.0 * beam as f64 / beams as f64).to_radians();
            let direction = direction(-std::f64::consts::TAU * turned, elevation);
            let range = cast(&start_from_lidar, &direction).map_or(0.0, |(range, _)| range);
            points.push((direction * range, time));
        }
    }
    points
}

/// How far a point in the vehicle's frame of this time lies from the nearest surface, m.
pub(crate) fn from_surface(us: i64, point: [f64; 3]) -> f64 {
    let place = start_from_vehicle(us) * Point3::from(point);
    let from_box = |[low, high]: &[[f64; 3]; 2]| {
        let outside = |axis: usize| (low[axis] - place[axis]).max(place[axis] - high[axis]);
        let all = [outside(0), outside(1), outside(2)];
        let beyond = all.iter().map(|o| o.max(0.0).powi(2)).sum::<f64>().sqrt();
        if beyond > 0.0 { beyond } else { -all.iter().copied().fold(f64::MIN, f64::max) }
    };
    BOXES.iter().map(from_box).fold(place.z.abs(), f64::min)
}

fn direction(azimuth: f64, elevation: f64) -> Vector3<f64> {
    Vector3::new(elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin())
}

/// The range of the first thing that a ray meets, and whether it is a box (else the road).
fn cast(start_from_sensor: &Isometry3<f64>, direction: &Vector3<f64>) -> Option<(f64, bool)> {
    let (from, along) = (start_from_sensor.translation.vector, start_from_sensor.rotation * direction);
    let road = Some(-from.z / along.z).filter(|range| *range > 0.0).map(|range| (range, false));
    let boxes = BOXES.iter().filter_map(|corners| Some((enter(&from, &along, corners)?, true)));
    let nearest = boxes.chain(road).min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.filter(|(range, _)| *range < FARTHEST)
}

/// Where a ray enters a box, from outside.
fn enter(from: &Vector3<f64>, along: &Vector3<f64>, [low, high]: &[[f64; 3]; 2]) -> Option<f64> {
    let (mut near, mut far) = (0.0f64, f64::INFINITY);
    for axis in 0..3 {
        let [a, b] = [low[axis], high[axis]].map(|side| (side - from[axis]) / along[axis]);
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    (near > 0.0 && near < far).then_some(near)
}
