//! Several LiDAR scans as one reference cloud: `lidar.scans`.

use crate::support::{MS, Memory, lidar, radar};
use proptest::prelude::*;
use ralf::config::Config;
use ralf::scene::{FrameWindow, LocatedScan, Mover, Spread, mismatch};
use ralf::sensors::{
    CameraImage, DepthImage, Elevation, LidarScan, Radar, RadarScan, Sequence, Source, SourceError,
};
use ralf::space::{Point, Vector};
use std::sync::Mutex;

fn settings(assignments: &[&str]) -> Config {
    Config::from_toml("[ground]\nmodel = 'none'\n[lidar]\nneighbours = 1", assignments).unwrap()
}

fn d_lm(memory: &Memory, assignments: &[&str]) -> Vec<Option<f64>> {
    memory.label(&settings(assignments), 0, 0).iter().map(|label| label.d_lm).collect()
}

/// 10 m/s ahead, along a rail of which each LiDAR scan meets another post: 22 m, 23 m and 21.5 m ahead of where the
/// vehicle is at first. The radar sees what is at 21.5 m when the vehicle has come 1 m.
fn rail() -> Memory {
    let post = |ahead: f32| vec![[ahead, 0.0, -2.0]];
    Memory::new(10.0)
        .radar(radar(Elevation::Measured), vec![(100 * MS, Some(vec![[20.5, 0.0, 0.0]]))])
        .lidar(lidar(), vec![(0, post(22.0)), (100 * MS, post(22.0)), (200 * MS, post(19.5))])
}

#[test]
fn the_nearest_point_of_the_scans_around_counts() {
    // Both 22 m ahead, 2 m below the LiDAR: along the road 0.04 * 22 / sqrt(22^2 + 2^2) = 0.039836 m.
    let sigma = (0.3f64 * 0.3 + 0.039836 * 0.039836 + 1e-6).sqrt();
    // Of one scan 1.5 m off. Of two, both as far in time, the earlier: at 22 m, half a metre off. Of three the same post.
    for (scans, expected) in [("1", 1.5 / sigma), ("2", 0.5 / sigma), ("3", 0.0), ("50", 0.0)] {
        let d = d_lm(&rail(), &[&format!("lidar.scans={scans}")])[0].unwrap();
        assert!((d - expected).abs() < 1e-4, "{scans} scans: {d}, {expected}");
    }
    assert_eq!(d_lm(&rail(), &[]), d_lm(&rail(), &["lidar.scans=3", "lidar.reach_ms=99"]), "too far in time");
    assert_eq!(d_lm(&rail(), &["lidar.scans=3", "lidar.reach_ms=100"])[0], Some(0.0));
}

#[test]
fn without_a_scan_within_the_tolerance_there_is_none_around_it() {
    let late = Memory::new(0.0)
        .radar(radar(Elevation::Measured), vec![(0, Some(vec![[20.0, 0.0, 0.0]]))])
        .lidar(lidar(), vec![(61 * MS, vec![[20.0, 0.0, -2.0]])]);
    assert_eq!(d_lm(&late, &["lidar.scans=5"]), [None]);
}

#[test]
fn what_moves_is_compared_with_other_scans_at_their_times_alone() {
    let mut radar = radar(Elevation::Measured);
    radar.fields.push("doppler_compensated".into());
    // A car at 30 m/s, and what stands in the same place. 100 ms before, the car was at 17 m, and something at 20 m;
    // 100 ms later it is at 23 m. The scan at the radar's time saw neither.
    let memory = Memory::new(0.0)
        .measured(radar, vec![(100 * MS, vec![[20.0, 0.0, 0.0, 30.0], [20.0, 0.0, 0.0, 0.5]])])
        .lidar(
            lidar(),
            vec![
                (0, vec![[20.0, 0.0, -2.0], [17.2, 0.0, -2.0]]),
                (100 * MS, vec![[26.0, 0.0, -2.0]]),
                (200 * MS, vec![[23.0, 0.0, -2.0]]),
            ],
        );
    let alone = d_lm(&memory, &[])[0];
    let around = d_lm(&memory, &["lidar.scans=3"]);
    assert_eq!(around[0], alone, "it was elsewhere in the other scans");
    assert!(around[1].unwrap() < 1e-3, "what stands was at 20 m in the first");
    let dynamic = d_lm(&memory, &["lidar.scans=3", "lidar.dynamic=true"]);
    assert!(dynamic[0].unwrap() < 1e-3 && dynamic[1] == around[1], "{dynamic:?}");
    // Of the first two scans it is the first alone that tells of it: 0.2 m from where it was, known to 0.3 m.
    let before = d_lm(&memory, &["lidar.scans=2", "lidar.dynamic=true"])[0].unwrap();
    assert!((before - 0.2 / 0.3f64.hypot(0.04 * 17.2 / 17.2f64.hypot(2.0))).abs() < 1e-3, "{before}");
}

#[test]
fn a_scan_without_points_has_no_time_that_counts() {
    let mut radar = radar(Elevation::Measured);
    radar.fields.push("doppler_compensated".into());
    // Within 12 ms it moves by 0.24 m, less than its range is uncertain by; within 60 ms by 1.2 m.
    let beside = |points: Vec<[f32; 3]>| {
        let memory = Memory::new(0.0)
            .measured(radar.clone(), vec![(60 * MS, vec![[20.0, 0.0, 0.0, 20.0]])])
            .lidar(lidar(), vec![(48 * MS, vec![[19.8, 0.0, -2.0]])])
            .lidar(lidar(), vec![(0, points)]);
        d_lm(&memory, &["lidar.dynamic=true"])[0].unwrap()
    };
    let alone = 0.2 / 0.3f64.hypot(0.04 * 19.8 / 19.8f64.hypot(2.0));
    assert!((beside(vec![]) - alone).abs() < 1e-3, "{} {alone}", beside(vec![]));
    // With a point there it moves; 12 ms before it was at 19.76 m.
    assert!(beside(vec![[40.0, 0.0, -2.0]]) < alone / 2.0);
}

/// Writes down which LiDAR scans are read.
struct Counted(Memory, Mutex<Vec<usize>>);

impl Source for Counted {
    fn sequence(&self) -> &Sequence {
        self.0.sequence()
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        self.0.radar_scan(radar, scan)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        self.1.lock().unwrap().push(scan);
        if scan == 7 { Err("cut short".into()) } else { self.0.lidar_scan(lidar, scan) }
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        self.0.image(camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        self.0.depth(camera, image)
    }
}

#[test]
fn scans_are_read_once_and_shared_and_one_that_is_damaged_is_named() {
    let post = || vec![[20.0, 0.0, -2.0]];
    let radar_scans = || (0..60).map(|scan| (scan * 50 * MS, Some(vec![[20.0, 0.0, 0.0]]))).collect();
    let memory = Memory::new(0.0)
        .radar(radar(Elevation::Measured), radar_scans())
        .radar(radar(Elevation::None), radar_scans())
        .lidar(lidar(), (0..30).map(|scan| (scan * 100 * MS, post())).collect());
    let source = Counted(memory, Mutex::default());
    let config = settings(&["lidar.scans=5"]);
    let mut window = FrameWindow::new(&source, &source.0.sequence.rig, &config);
    let mut named = Vec::new();
    for scan in 0..60 {
        for radar in 0..2 {
            let frame = window.frame(radar, scan).unwrap();
            let damaged: Vec<usize> = frame.unreadable.iter().map(|unreadable| unreadable.index).collect();
            assert_eq!(frame.lidar_clouds().len() + damaged.len(), if frame.lidar.is_some() { 5 } else { 1 });
            named.extend(damaged);
        }
    }
    assert!(!named.is_empty() && named.iter().all(|scan| *scan == 7), "{named:?}");
    let mut read = source.1.into_inner().unwrap();
    read.sort_unstable();
    assert_eq!(read, (0..30).collect::<Vec<_>>(), "each scan once");
}

/// A LiDAR and its scan.
type Key = (usize, usize);

/// Above any mismatch.
const CAP: f64 = 1e6;

/// The scans of each moment that the method's page asks for: of all LiDARs those nearest to the radar scan, and around
/// the first one's the others, with those nearest to them.
fn moments(times: &[Vec<i64>], t_ns: i64, scans: usize, reach_ns: i64) -> Vec<Vec<Key>> {
    let together = |t_ns: i64| -> Vec<Key> {
        let nearest = |times: &Vec<i64>| {
            (0..times.len())
                .min_by_key(|i| times[*i].abs_diff(t_ns))
                .filter(|i| times[*i].abs_diff(t_ns) <= 60 * MS as u64)
        };
        times.iter().enumerate().filter_map(|(lidar, times)| Some((lidar, nearest(times)?))).collect()
    };
    let first = together(t_ns);
    let Some(&(lidar, middle)) = first.first() else { return vec![] };
    let away = |scan: &usize| times[lidar][*scan].abs_diff(times[lidar][middle]);
    let mut around: Vec<usize> =
        (0..times[lidar].len()).filter(|scan| away(scan) <= reach_ns as u64).collect();
    around.sort_by_key(away);
    around.truncate(scans);
    let mut found = vec![first];
    for scan in around.into_iter().filter(|scan| *scan != middle) {
        let new = together(times[lidar][scan])
            .into_iter()
            .filter(|key| !found.iter().flatten().any(|known| known == key));
        let new = new.collect();
        found.push(new);
    }
    found
}

/// `d_lm` of each detection of the only scan.
fn by_brute_force(
    memory: &Memory,
    radar: &Radar,
    moments: &[Vec<Key>],
    dynamic: bool,
    k: usize,
) -> Vec<Option<f64>> {
    let (sequence, sees) = (memory.sequence(), radar.sees_heights_of());
    let measured = radar.elevation == Elevation::Measured;
    // The points of a moment's scans, where the vehicle is at the radar scan's time, with their rays.
    let points = |moment: &[Key]| -> Vec<(f64, Point, Vector)> {
        let of_scan = |&(lidar, scan): &Key| {
            let t_ns = sequence.times.lidars[lidar][scan];
            let ahead = sequence.motion.between(0, t_ns) * Point::origin();
            let moved = move |p: &[f32; 3]| {
                let p = Vector::from(p.map(f64::from));
                (t_ns as f64 * 1e-9, ahead + Vector::new(0.0, 0.0, 2.0) + p, p.normalize() * 0.04)
            };
            memory.lidar_scans[lidar][scan].iter().map(moved).collect::<Vec<_>>()
        };
        moment.iter().flat_map(of_scan).filter(|(_, p, _)| measured || sees(p)).collect()
    };
    let filled = moments.iter().filter(|moment| !points(moment).is_empty());
    // An empty scan beside another has no points whose time could count.
    let has_points = |&&(lidar, scan): &&Key| !memory.lidar_scans[lidar][scan].is_empty();
    let scans = filled.flatten().filter(has_points);
    let times = scans.map(|&(lidar, scan)| sequence.times.lidars[lidar][scan] as f64 * 1e-9);
    let farthest = times.map(f64::abs).fold(f64::NEG_INFINITY, f64::max);
    let level = |h: Vector| if measured { h } else { Vector::new(h.x, h.y, 0.0) };
    let located = LocatedScan::new(radar, memory.radar_scan(0, 0).unwrap());
    let mut all = Vec::new();
    for (i, detection) in located.detections.iter().enumerate() {
        let rate = f64::from(memory.radar_scans[0][0].as_ref().unwrap()[i][3]);
        let mover = Mover::new(radar, &detection.unwrap(), rate, &Vector::zeros());
        let mismatches = |moment: &Vec<Key>, moved: bool| -> Vec<(f64, f64)> {
            let compared = |(t, q, ray): (f64, Point, Vector)| {
                let there = if moved { mover.after(t) } else { detection.unwrap() };
                let h = level(there.position - q);
                (h.norm(), mismatch(&h, &there.spread(), &Spread::Ray(ray)))
            };
            points(moment).into_iter().map(compared).collect()
        };
        let moves = rate.abs() * farthest > radar.sigma_range;
        let as_standing = &moments[..if moves { moments.len().min(1) } else { moments.len() }];
        let standing =
            nearest_of(as_standing.iter().flat_map(|moment| mismatches(moment, false)).collect(), k);
        let moving = nearest_of(moments.iter().flat_map(|moment| mismatches(moment, true)).collect(), k);
        let least = standing.into_iter().chain(moving.filter(|_| dynamic && moves)).reduce(f64::min);
        // Points there are, but none that it may be compared with: the cap.
        all.push(moving.map(|_| least.unwrap_or(CAP)));
    }
    all
}

/// Of distances with their mismatches: the mean mismatch of the `k` nearest.
fn nearest_of(mut all: Vec<(f64, f64)>, k: usize) -> Option<f64> {
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all.truncate(k);
    (!all.is_empty()).then(|| all.iter().map(|(_, d)| d).sum::<f64>() / all.len() as f64)
}

fn timeline(gaps: Vec<i64>) -> Vec<i64> {
    gaps.into_iter()
        .scan(-200 * MS, |t_ns, gap| {
            *t_ns += gap * MS;
            Some(*t_ns)
        })
        .collect()
}

proptest! {
    /// Every point of every scan, by the sentences of the method's page.
    #[test]
    fn as_by_brute_force(
        clouds in prop::collection::vec(
            prop::collection::vec((5i64..90, prop::collection::vec([5f32..40.0, -10f32..10.0, -2f32..1.0], 0..9)), 1..8),
            1..3,
        ),
        detections in prop::collection::vec([5f32..40.0, -10f32..10.0, -1f32..1.0, -30f32..30.0], 1..6),
        speed in -30f64..30.0,
        measured in any::<bool>(),
        dynamic in any::<bool>(),
        (scans, reach_ms, neighbours) in (1usize..6, 0i64..300, 1usize..4),
    ) {
        let mut radar = radar(if measured { Elevation::Measured } else { Elevation::None });
        radar.fields.push("doppler_compensated".into());
        let mut memory = Memory::new(speed).measured(radar.clone(), vec![(0, detections)]);
        for cloud in clouds {
            let (gaps, points): (Vec<i64>, Vec<_>) = cloud.into_iter().unzip();
            memory = memory.lidar(lidar(), timeline(gaps).into_iter().zip(points).collect());
        }
        let assignments = [
            format!("lidar.scans={scans}"), format!("lidar.reach_ms={reach_ms}"), format!("lidar.dynamic={dynamic}"),
            format!("lidar.neighbours={neighbours}"), format!("lidar.max_mismatch={CAP}"),
        ];
        let found = d_lm(&memory, &assignments.each_ref().map(String::as_str));
        let moments = moments(&memory.sequence.times.lidars, 0, scans, reach_ms * MS);
        let expected = by_brute_force(&memory, &radar, &moments, dynamic, neighbours);
        for (found, expected) in found.into_iter().zip(expected) {
            let same = found.zip(expected).is_some_and(|(a, b)| (a - b).abs() < 1e-6 * b.max(1.0));
            prop_assert!(same || found == expected, "{found:?} {expected:?}");
        }
    }
}
