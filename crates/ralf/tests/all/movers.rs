//! What moves: Doppler-consistent tracking, and LiDAR points at their own times.

use crate::support::{MS, Memory, lidar, radar};
use proptest::prelude::*;
use ralf::config::{Config, GroundConfig, GroundModel};
use ralf::evidence::observe;
use ralf::label::flag;
use ralf::paper::DetectionLabel;
use ralf::scene::{
    FrameWindow, LidarCloud, LidarSearch, LidarSnapshot, LidarView, LocatedScan, Mover, mismatch,
};
use ralf::sensors::{Elevation, LidarScan, Radar, RadarScan};
use ralf::space::{Transform, Vector};
use std::sync::Arc;

/// x, y and compensated range rate of the detections of a scan.
type Scan = Vec<[f32; 3]>;

/// A radar in the plane that measures compensated range rates: 0.3 m, 0.01 rad.
fn doppler_radar() -> Radar {
    let mut radar = radar(Elevation::None);
    radar.fields[2] = "doppler_compensated".into();
    radar
}

/// Scans of a standing radar every 50 ms.
fn standing(scans: Vec<Scan>) -> Memory {
    let times = (0..).map(|scan| scan * 50 * MS);
    Memory::new(0.0).radar(doppler_radar(), times.zip(scans.into_iter().map(Some)).collect())
}

fn label(memory: &Memory, scan: usize, assignments: &[&str]) -> Vec<DetectionLabel> {
    memory.label(&Config::from_toml("[ground]\nmodel = 'none'", assignments).unwrap(), 0, scan)
}

/// `d_tr` of the first detection of a scan, of the paper's tracking and of Doppler-consistent tracking.
fn tracked(memory: &Memory, scan: usize) -> [Option<f64>; 2] {
    [false, true].map(|doppler| label(memory, scan, &[&format!("tracking.doppler={doppler}")])[0].d_tr)
}

#[test]
fn what_moves_is_sought_where_its_range_rate_takes_it_among_those_with_the_same() {
    // A car at 20 m/s comes 1 m farther in 50 ms; something else lies where it was.
    let car =
        standing(vec![vec![[30.0, 0.0, 20.0]], vec![[30.0, 0.0, 0.0], [31.0, 0.0, 20.2], [40.0, 0.0, 0.0]]]);
    let [paper, consistent] = tracked(&car, 0);
    assert_eq!((paper, consistent), (Some(0.0), Some(0.0)), "the paper takes what lies there for the car");
    let otherwise =
        standing(vec![vec![[30.0, 0.0, 20.0]], vec![[30.0, 0.0, 0.0], [31.0, 0.0, 20.4], [40.0, 0.0, 0.0]]]);
    let [paper, consistent] = tracked(&otherwise, 0);
    assert_eq!((paper, consistent), (Some(0.0), Some(3.0)), "20.4 m/s is another thing");
    let ghost = standing(vec![vec![[30.0, 0.0, 20.0]], vec![[30.0, 0.0, 20.0], [40.0, 0.0, 0.0]]]);
    // 1 m from where it should be, 0.3 m at both ends: 1 / sqrt(2 * 0.09 + 1e-6) = 2.35702.
    let d = tracked(&ghost, 0)[1].unwrap();
    assert!((d - 2.35702).abs() < 1e-4, "{d}");
}

#[test]
fn the_motion_across_the_ray_is_not_known() {
    // At 20 m/s along the ray and 4 m/s across it, for 250 ms: h = (0, -1 m). Across 30 * 0.01 = 0.3 m at one end, with
    // the drift 0.3 * 5 m = 1.5 m besides; the other, at (35, 1), knows y by 35 * 0.01 = 0.35 m and by
    // 0.3 / sqrt(35^2 + 1) = 0.0085678 m of its range: 1 / sqrt(0.09 + 2.25 + 0.1225 + 0.0000734 + 1e-6) = 0.63726.
    let scans = vec![(0, Some(vec![[30.0, 0.0, 20.0]])), (250 * MS, Some(vec![[35.0, 1.0, 20.0]]))];
    let d = tracked(&Memory::new(0.0).radar(doppler_radar(), scans), 0)[1].unwrap();
    assert!((d - 0.63726).abs() < 1e-4, "{d}");
}

#[test]
fn a_scan_that_missed_it_costs_little() {
    // Seen in three of six scans: (6 + 5 + 4) * 0 + (3 + 2 + 1) * 20 or 3, by 21.
    let (there, elsewhere) = (vec![[30.0, 0.0, 0.0]], vec![[50.0, 3.0, 9.0]]);
    let [e, t] = [elsewhere, there].map(|scan| move || scan.clone());
    let flickering = standing(vec![e(), t(), e(), t(), e(), t(), t()]);
    let [paper, consistent] = tracked(&flickering, 3);
    assert!((paper.unwrap() - 6.0 * 20.0 / 21.0).abs() < 1e-9, "{paper:?}");
    assert!((consistent.unwrap() - 6.0 * 3.0 / 21.0).abs() < 1e-9, "{consistent:?}");
    let settings = ["tracking.doppler=true", "tracking.absence=7"];
    assert!((label(&flickering, 3, &settings)[0].d_tr.unwrap() - 2.0).abs() < 1e-9);
}

#[test]
fn scans_that_could_not_have_seen_it_are_not_asked() {
    // At 30 m/s what stands at 40 m comes into the radar's reach, 41 m, with the second scan, and leaves its side.
    let wall = |x: f32| Some(vec![[x, 0.0, 0.0], [20.0, 15.0, 0.0]]);
    let scans = vec![(0, wall(41.0)), (300 * MS, wall(41.0)), (600 * MS, wall(32.0))];
    let driving = Memory::new(30.0).radar(doppler_radar(), scans);
    assert_eq!(
        tracked(&driving, 1)[1],
        Some(0.0),
        "50 m away, in the first scan, is beyond the radar's reach"
    );
    assert_eq!(tracked(&driving, 0)[1], Some(3.0), "and within it, later, there was nothing");
    // Behind the radar is nothing to be seen: without a scan that could see it there is no answer.
    let behind = standing(vec![vec![[3.0, 40.0, -900.0]], vec![[30.0, 0.0, 0.0]]]);
    let label = label(&behind, 0, &["tracking.doppler=true"])[0];
    assert_eq!((label.d_tr, label.flags & flag::NO_NEIGHBOURS), (None, flag::NO_NEIGHBOURS));
}

#[test]
fn a_radar_without_range_rates_is_tracked_as_if_all_stood() {
    let scans = vec![(0, Some(vec![[10.0, 0.0, 5.0]])), (50 * MS, Some(vec![[10.0, 0.0, 5.0]]))];
    let memory = Memory::new(0.0).radar(radar(Elevation::None), scans);
    assert_eq!(tracked(&memory, 0)[1], Some(0.0));
}

/// What stands 20 m ahead when the radar looks, and goes away at 30 m/s; LiDAR points a while later.
fn chased(points: Vec<[f32; 3]>, times: Option<Vec<f32>>) -> Memory {
    let memory = Memory::new(0.0)
        .radar(doppler_radar(), vec![(0, Some(vec![[20.0, 0.0, 30.0], [20.0, 0.0, 0.5]]))])
        .lidar(lidar(), vec![(50 * MS, points)]);
    Memory { point_times: times, ..memory }
}

#[test]
fn a_lidar_point_is_compared_with_where_the_mover_was_at_its_time() {
    let dynamic = ["lidar.dynamic=true", "lidar.neighbours=1"];
    // 20 ms before the LiDAR's time are 30 ms after the radar's: 0.9 m farther.
    let points = vec![[20.9, 0.0, -2.0], [26.0, 0.0, -2.0]];
    let labels = label(&chased(points.clone(), Some(vec![-0.02, 0.02])), 0, &dynamic);
    assert!(labels[0].d_lm.unwrap() < 1e-3, "{:?}", labels[0]);
    // What moves less than its range is known, 0.5 m/s for 70 ms, stays as it is: 0.9 m off.
    let still = label(&chased(points.clone(), Some(vec![-0.02, 0.02])), 0, &["lidar.neighbours=1"]);
    assert_eq!(labels[1], still[1]);
    assert!(still[0].d_lm.unwrap() > 2.9);
    // Without times the points are of the scan's time, 1.5 m farther: 0.6 m off.
    let untimed = label(&chased(points, None), 0, &dynamic)[0].d_lm.unwrap();
    assert!(untimed > 1.8 && untimed < 2.1, "{untimed}");
    // Where the world stands still is the better fit, it stays.
    let standing = label(&chased(vec![[20.0, 0.0, -2.0]], None), 0, &dynamic);
    assert_eq!(
        standing[0].d_lm,
        Some(0.0).filter(|d| standing[0].d_lm.unwrap() < 1e-3 || *d > 0.0).and(standing[0].d_lm)
    );
}

/// A column of evidence on the first scan.
fn evidence_on(memory: &Memory, name: &str) -> Vec<Option<f64>> {
    let config = Config::default();
    let mut window = FrameWindow::new(memory, &memory.sequence.rig, &config).with_evidence();
    let columns = observe(&window.frame(0, 0).unwrap(), &config);
    columns.into_iter().find(|column| column.feature.name == name).unwrap().values
}

#[test]
fn rays_are_asked_where_what_moves_is_when_they_are_sent() {
    let mut radar = radar(Elevation::Measured);
    radar.fields.push("doppler_compensated".into());
    let look = |point: [f32; 3], times: Option<Vec<f32>>| Memory {
        point_times: times,
        ..Memory::new(0.0)
            .measured(radar.clone(), vec![(0, vec![[20.0, 0.0, 0.0, 30.0], [20.0, 0.0, 0.0, 0.5]])])
            .lidar(lidar(), vec![(50 * MS, vec![point])])
    };
    // As above: 0.9 m farther when the ray is sent, or 0.6 m off where nobody tells when that was. Range is known by
    // 0.3 m, and 0.1 m besides; the speed by 0.3 m/s, which in 50 ms are 0.015 m.
    for (times, expected) in [(Some(vec![-0.02]), 0.0), (None, 0.6 / (0.1f64 + 0.015 * 0.015).sqrt())] {
        let memory = look([20.9, 0.0, -2.0], times);
        let [chi, standing] = evidence_on(&memory, "lidar_moving_chi")[..] else { panic!("two detections") };
        assert!((chi.unwrap() - expected).abs() < 1e-3 && standing.is_none(), "{chi:?}");
        assert_eq!(evidence_on(&memory, "lidar_moving_near"), [Some(1.0), None]);
        assert!(evidence_on(&memory, "lidar_chi")[0].unwrap() > 2.8, "as if it stood");
    }
    // A ray that passes through where it has gone by then: at 23 m it is 2.1 m beyond.
    let through = look([23.0, 0.0, -2.0 / 20.9 * 23.0], Some(vec![-0.02]));
    assert_eq!(evidence_on(&through, "lidar_moving_beyond"), [Some(1.0), None]);
    assert_eq!(evidence_on(&through, "lidar_moving_in"), [Some(0.0), None]);
}

#[test]
fn rays_are_asked_where_the_road_takes_what_drives_beside() {
    let mut radar = radar(Elevation::Measured);
    radar.fields.push("doppler_compensated".into());
    // 15 m away on a ray of slope 3 / 4, 24 m/s away: 30 m/s along the road, 1.5 m in 50 ms. Along the ray it would be
    // 0.9 m aside.
    let memory = Memory::new(0.0)
        .measured(radar, vec![(0, vec![[12.0, 9.0, 0.0, 24.0]])])
        .lidar(lidar(), vec![(50 * MS, vec![[13.5, 9.0, -2.0]])]);
    let chi = evidence_on(&memory, "lidar_moving_chi")[0].unwrap();
    assert!(chi < 1e-3, "{chi}");
    assert_eq!(evidence_on(&memory, "lidar_moving_near"), [Some(1.0)]);
}

proptest! {
    /// All points of all LiDAR scans: each with the detection as it is, and moved to the point's time.
    #[test]
    fn nearest_points_at_their_own_times_as_by_brute_force(
        scans in prop::collection::vec(
            (prop::collection::vec(([5f32..60.0, -20f32..20.0, -2f32..1.0], -0.06f32..0.06), 0..60), -60i64..60), 1..4,
        ),
        place in [8f32..50.0, -15f32..15.0, -1f32..1.0],
        rate in -40f64..40.0,
        measured in any::<bool>(),
        neighbours in 1usize..4,
        cap in 0.5f64..60.0,
    ) {
        let radar = radar(if measured { Elevation::Measured } else { Elevation::None });
        let columns = place.map(|value| vec![value]).to_vec();
        let scan = LocatedScan::new(&radar, RadarScan::new(&radar, 0, columns).unwrap());
        let detection = scan.detections[0].unwrap();
        let mover = Mover::new(&radar, &detection, rate, &Vector::zeros());

        let ground = GroundConfig { model: GroundModel::None, ..GroundConfig::default() };
        let view = |(points, lidar_ms): (Vec<([f32; 3], f32)>, i64)| {
            let (points, times): (Vec<_>, Vec<_>) = points.into_iter().unzip();
            let scan = LidarScan { t_ns: lidar_ms * MS, points, times: Some(times), ..LidarScan::default() };
            let roof = lidar();
            let parts = vec![(&roof, Arc::new(scan), Transform::translation(0.3, 0.0, 0.0))];
            let moment = Arc::new(LidarSnapshot::new(lidar_ms * MS, parts, &ground, 0));
            LidarView { moment, vehicle_from_moment: Transform::translation(0.004 * lidar_ms as f64, -0.2, 0.0) }
        };
        let views: Vec<LidarView> = scans.into_iter().map(view).collect();
        let clouds: Vec<LidarCloud> = views.iter().map(|view| LidarCloud::new(view, &radar)).collect();
        let mut search = LidarSearch::new(&clouds, neighbours);
        let found = [
            search.mean_mismatch(&detection, clouds.len(), cap).map(|d| d.min(cap)),
            search.mean_mismatch(&detection, 1, f64::INFINITY),
            search.mean_mismatch_of_mover(&mover, 0),
        ];

        let radar_from_vehicle = radar.vehicle_from_radar.inverse();
        let nearest = |views: &[LidarView], moves: bool| {
            let mut all = Vec::new();
            for view in views {
                let moment = &view.moment;
                for id in 0..moment.sweeps()[0].scan.points.len() as u32 {
                    let reference = moment.reference(id, &moment.vehicle_from_lidars(&view.vehicle_from_moment));
                    if !measured && !radar.sees_height_of(&(radar_from_vehicle * reference.position)) {
                        continue;
                    }
                    let there = if moves { mover.after(moment.seconds_after(0, id)) } else { detection };
                    let mut h = there.position - reference.position;
                    if !measured {
                        h.z = 0.0;
                    }
                    all.push((h.norm(), mismatch(&h, &there.spread(), &reference.spread)));
                }
            }
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            all.truncate(neighbours);
            (!all.is_empty()).then(|| all.iter().map(|(_, m)| m).sum::<f64>() / all.len() as f64)
        };
        let all = nearest(&views, false);
        // Where every point is beyond the cap, it isn't told by how much.
        let capped = found[0].or(all.map(|_| cap));
        let expected = [all.map(|d| d.min(cap)), nearest(&views[..1], false), nearest(&views, true)];
        for (found, expected) in [capped, found[1], found[2]].into_iter().zip(expected) {
            prop_assert!(
                found == expected || (found.unwrap() - expected.unwrap()).abs() < 1e-6 * expected.unwrap().max(1.0),
                "{found:?} {expected:?}"
            );
        }
    }

    /// All detections of all scans, by the sentences of the method's page.
    #[test]
    fn doppler_consistent_tracking_as_by_brute_force(
        scans in prop::collection::vec(
            prop::collection::vec(([4f32..60.0, -30f32..30.0, -20f32..20.0], any::<bool>()), 1..12), 2..6,
        ),
        neighbours in 1usize..3,
    ) {
        let stand = |(detection, stands): ([f32; 3], bool)| [detection[0], detection[1], if stands { 0.0 } else { detection[2] }];
        let scans: Vec<Scan> = scans.into_iter().map(|scan| scan.into_iter().map(stand).collect()).collect();
        let memory = standing(scans.clone());
        let radar = doppler_radar();
        let located = |scan: &Scan| {
            let columns = (0..3).map(|axis| scan.iter().map(|detection| detection[axis]).collect()).collect();
            LocatedScan::new(&radar, RadarScan::new(&radar, 0, columns).unwrap())
        };
        let sector = |p: &Vector| ((p.y.atan2(p.x) / std::f64::consts::TAU + 0.5) * 36.0) as i64;
        let all: Vec<_> = scans.iter().map(located).collect();
        let settings = ["tracking.doppler=true", &format!("tracking.neighbours={neighbours}")];
        for (i, label) in label(&memory, 0, &settings).into_iter().enumerate() {
            let mover = Mover::new(&radar, &all[0].detections[i].unwrap(), f64::from(scans[0][i][2]), &Vector::zeros());
            let mut mismatches = Vec::new();
            for (j, other) in all.iter().enumerate().skip(1) {
                let expected = mover.after(0.05 * j as f64);
                let near = |a: i64, b: i64| [0, 1, 35].contains(&((a - b).rem_euclid(36)));
                let at = sector(&expected.position.coords);
                let in_reach = all.iter().flat_map(|scan| scan.detections.iter().flatten()).any(|there| {
                    near(sector(&there.position.coords), at)
                        && expected.position.coords.norm() <= there.position.coords.norm() + 0.9
                });
                if !in_reach {
                    continue;
                }
                let mut found = Vec::new();
                for (there, row) in other.detections.iter().zip(&scans[j]) {
                    let there = there.as_ref().unwrap();
                    if (f64::from(row[2]) - mover.rate()).abs() <= 0.3 {
                        let h = expected.position - there.position;
                        found.push((h.norm(), mismatch(&h, &expected.spread(), &there.spread())));
                    }
                }
                found.sort_by(|a, b| a.0.total_cmp(&b.0));
                found.truncate(neighbours);
                let mean = found.iter().map(|(_, m)| m).sum::<f64>() / found.len() as f64;
                mismatches.push(if found.is_empty() { 3.0 } else { mean.min(3.0) });
            }
            mismatches.sort_by(f64::total_cmp);
            let n = mismatches.len();
            let sum: f64 = (0..n).map(|k| (n - k) as f64 * mismatches[k]).sum();
            let d = (n > 0).then(|| sum / (n * (n + 1) / 2) as f64);
            let close = match (label.d_tr, d) {
                (Some(found), Some(d)) => (found - d).abs() < 1e-3 * d.max(1.0),
                (found, d) => found == d,
            };
            prop_assert!(close, "detection {i}: {:?} {d:?}", label.d_tr);
        }
    }
}
