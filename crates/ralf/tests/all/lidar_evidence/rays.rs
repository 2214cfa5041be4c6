//! Votes of rays: a wall by hand, and a sum over all points.

use super::{close, column, observe};
use crate::support::{MS, Memory, lidar, radar};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use ralf::config::Config;
use ralf::evidence;
use ralf::scene::FrameWindow;
use ralf::sensors::Elevation;
use ralf::space::Spherical;

/// A wall 20 m ahead of where the vehicle begins, 4 m high and 12 m wide, on a road that is seen up to 15 m; the
/// vehicle drives 1 m from LiDAR scan to LiDAR scan, of which there are five, and the radar's scan is at the third.
pub(super) fn wall(elevation: Elevation, detections: Vec<[f32; 3]>) -> Memory {
    before_wall(Memory::new(10.0).radar(radar(elevation), vec![(200 * MS, Some(detections))]))
}

/// That wall before a vehicle with a radar of any kind.
pub(super) fn before_wall(memory: Memory) -> Memory {
    let scan = |driven: f32| -> Vec<[f32; 3]> {
        let wall =
            (-60..=60).flat_map(|y| (0..40).map(move |z| [20.0, y as f32 * 0.1, z as f32 * 0.1 - 2.0]));
        let road = (0..60).flat_map(|x| (-40..=40).map(move |y| [x as f32 * 0.25, y as f32 * 0.25, -2.0]));
        wall.chain(road).map(|[x, y, z]| [x - driven, y, z]).collect()
    };
    let scans = (0..5).map(|k| (k * 100 * MS, scan(k as f32))).collect();
    memory.lidar(lidar(), scans)
}

const NAMES: [&str; 4] = ["in", "ground", "beyond", "before"];

#[test]
fn a_lidar_sees_as_far_as_its_tenth_farthest_return() {
    // Nine reflections 90 m ahead are none that a reach could be told from. From the LiDAR, 2 m up, the tenth farthest
    // return is 40 m away; 0.2 s later the LiDAR is 2 m farther on.
    let scan =
        || (0..9).map(|_| [90.0, 0.0, 0.0]).chain((0..30).map(|n| [11.0 + n as f32, 0.0, 0.0])).collect();
    let memory = Memory::new(10.0)
        .radar(
            radar(Elevation::Measured),
            vec![(0, Some(vec![[31.0, 0.0, 2.0], [0.0, 60.0, 2.0], [f32::NAN; 3]]))],
        )
        .lidar(lidar(), vec![(0, scan()), (200 * MS, scan())]);
    let found = observe(&memory, 0);
    let reach = column(&found, "lidar_reach");
    close(reach[0], 29.0 / 40.0, 1e-6);
    close(reach[1], 60.0 / 40.0, 1e-6);
    assert_eq!(reach[2], None);
    let few = Memory::new(10.0)
        .radar(radar(Elevation::Measured), vec![(0, Some(vec![[31.0, 0.0, 2.0]]))])
        .lidar(lidar(), vec![(0, vec![[40.0, 0.0, 0.0]; 9])]);
    assert_eq!(column(&observe(&few, 0), "lidar_reach"), [None], "nine returns tell of no reach");
}

#[test]
fn before_a_wall_on_it_behind_it_and_beside_it() {
    // Before, on and behind the wall, which is 18 m ahead by then; where no ray goes; on the road.
    let detections = vec![
        [9.0, 0.0, 1.5],
        [18.0, 0.0, 1.5],
        [27.0, 0.0, 1.0],
        [0.0, 15.0, 1.5],
        [8.0, 0.0, 0.0],
        [f32::NAN; 3],
    ];
    let found = observe(&wall(Elevation::Measured, detections), 0);
    for (i, ends) in
        [Some("beyond"), Some("in"), Some("before"), None, Some("ground")].into_iter().enumerate()
    {
        for prefix in ["lidar_rays", "lidar_window"] {
            for name in NAMES {
                let share = column(&found, &format!("{prefix}_{name}"))[i];
                match ends {
                    None => assert_eq!(share, None, "{prefix}_{name}"),
                    // On the road the nearer and the farther rays of the cone end elsewhere.
                    Some("ground") => {
                        assert!((share.unwrap() > 0.5) == (name == "ground"), "{prefix}_{name}")
                    }
                    Some(ends) => close(share, f64::from(name == ends), 1e-6),
                }
            }
        }
    }
    for (name, expected) in [
        ("lidar_free", [1.0, 0.0, 0.0, 0.0]),
        ("lidar_surface", [0.0, 1.0, 0.0, 0.0]),
        ("lidar_occluded", [0.0, 0.0, 1.0, 0.0]),
        ("lidar_unseen", [0.0, 0.0, 0.0, 1.0]),
    ] {
        for (value, expected) in column(&found, name).iter().zip(expected) {
            close(*value, expected, 0.0);
        }
    }
    // ln(0.02 / 1.02) and back.
    for (odds, expected) in column(&found, "lidar_window_odds").iter().zip([-3.9318, 3.9318]) {
        close(*odds, expected, 1e-3);
    }
    // The wall has a point within 5 cm, of a place that is known to 0.3, 0.18 and 0.36 m and 0.1 m besides.
    close(column(&found, "lidar_chi")[1], 0.0, 0.35);
    // 9 m behind it in range, which is known to 0.3 and 0.1 m: more than 10 sigmas.
    assert_eq!(column(&found, "lidar_chi")[2], Some(10.0));
    for name in ["lidar_window_chi_least", "lidar_window_chi_quartile", "lidar_window_chi_median"] {
        close(column(&found, name)[1], 0.0, 0.35);
        assert_eq!(column(&found, name)[3], None);
    }
    let near = column(&found, "lidar_window_near");
    assert_eq!(near, [Some(0.0), Some(1.0), Some(0.0), None, near[4], None]);
    assert!(found.iter().all(|column| column.values[5].is_none()));
}

#[test]
fn without_elevation_the_height_is_supposed() {
    // As recorded these lie on the road; they are looked for 0.7 m above it, where the wall is.
    let found = observe(&wall(Elevation::None, vec![[18.0, 0.0, 0.0], [9.0, 0.0, 0.0]]), 0);
    close(column(&found, "lidar_window_in")[0], 1.0, 0.05);
    close(column(&found, "lidar_surface")[0], 1.0, 0.0);
    close(column(&found, "lidar_free")[1], 1.0, 0.0);
}

/// What stands for exp(-x) in the votes.
fn weight(x: f64) -> f64 {
    (1.0 - x / 64.0).powi(64)
}

#[test]
fn weights_are_nearly_a_gaussian() {
    for x in (0..=625).map(|x| f64::from(x) / 100.0) {
        assert!((0.0..0.005).contains(&((-x).exp() - weight(x))), "{x}");
    }
}

/// Shares and chi of one scan as they are defined, from all of its points.
fn from_all_points(points: &[[f32; 3]], detection: [f32; 3], ground: f64) -> ([f64; 4], Option<f64>) {
    let up = Vector3::new(0.0, 0.0, 2.0);
    let p = Vector3::from(detection.map(f64::from));
    let seen = Spherical::from_cartesian(&(p - up).into());
    let axes = Spherical::from_cartesian(&p.into()).jacobian()
        * Matrix3::from_diagonal(&Vector3::new(0.3, 0.01, 0.02));
    let ray = (p - up).normalize();
    let aside = Vector3::new(-ray.y, ray.x, 0.0).normalize();
    let sigma = |direction: &Vector3<f64>| axes.tr_mul(direction).norm();
    let least = 0.7f64.to_radians();
    let half_azimuth = (2.5 * sigma(&aside) / (p - up).xy().norm()).clamp(least, 0.35);
    let half_elevation = (2.5 * sigma(&ray.cross(&aside)) / seen.range).clamp(least, 0.35);
    let depth = 3.0 * (sigma(&ray).powi(2) + 0.04f64.powi(2) + 0.01).sqrt();
    let precision = (axes * axes.transpose() + Matrix3::identity() * 0.01).try_inverse().unwrap();
    let (mut sums, mut chi) = ([0.0; 4], f64::INFINITY);
    for point in points {
        let q = Vector3::from(point.map(f64::from));
        let to = Spherical::from_cartesian(&q.into());
        let beside = (to.azimuth - seen.azimuth + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU);
        let [beside, above] = [
            (beside - std::f64::consts::PI) / half_azimuth,
            (to.elevation - seen.elevation) / half_elevation,
        ];
        if beside.abs() > 1.0 || above.abs() > 1.0 {
            continue;
        }
        let h = q + up - p;
        chi = chi.min(h.dot(&(precision * h)).sqrt());
        let past = to.range - seen.range;
        let ending = match past {
            _ if past >= depth => 2,
            _ if past <= -depth => 3,
            _ => usize::from(q.z + 2.0 < ground + 0.2),
        };
        sums[ending] += weight(3.125 * (beside * beside + above * above));
    }
    (sums, Some(chi.min(10.0)).filter(|_| chi.is_finite()))
}

proptest! {
    #[test]
    fn votes_are_the_sum_over_all_points(
        detection in (6.0f32..40.0, -12.0f32..12.0, 0.0f32..3.0),
        around in prop::collection::vec(prop::array::uniform3(-0.12f32..0.12), 1..35),
        scale in prop::collection::vec(0.5f32..1.5, 40),
    ) {
        let detection: [f32; 3] = detection.into();
        let [x, y, z] = detection;
        // Points in about the detection's direction, as seen from the LiDAR, and one on the ground.
        let mut points: Vec<[f32; 3]> = around
            .iter()
            .zip(scale)
            .map(|([dx, dy, dz], s)| [s * (x + dx * x), s * (y + dy * x), s * (z - 2.0 + dz * x)])
            .collect();
        points.push([x, y, -2.0]);
        let memory = Memory::new(0.0)
            .radar(radar(Elevation::Measured), vec![(0, Some(vec![detection]))])
            .lidar(lidar(), vec![(0, points.clone())]);
        let config = Config::default();
        let mut window = FrameWindow::new(&memory, &memory.sequence.rig, &config).with_evidence();
        let frame = window.frame(0, 0).unwrap();
        let ground = frame.lidar_window.as_ref().unwrap().window.ground();
        let ground = ground.and_then(|ground| ground.height_at(x.into(), y.into())).unwrap_or(0.0);
        let (sums, chi) = from_all_points(&points, detection, ground);
        let found = evidence::observe(&frame, &config);
        let total: f64 = sums.iter().sum();
        for (name, sum) in NAMES.into_iter().zip(sums) {
            for prefix in ["lidar_rays", "lidar_window"] {
                if let Some(share) = column(&found, &format!("{prefix}_{name}"))[0] {
                    prop_assert!((share - sum / total).abs() < 1e-3, "{prefix}_{name} {share} {sums:?}");
                } else {
                    prop_assert!(total < 0.01, "{sums:?}");
                }
            }
        }
        // Of points beside the cone but in one of its bins the distance may count, too.
        if let Some(chi) = chi {
            prop_assert!(column(&found, "lidar_chi")[0].unwrap() <= chi + 0.01);
        }
    }
}
