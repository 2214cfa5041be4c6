//! The whole method on recordings of a few points, with numbers worked out by hand.

use crate::support::{MS, Memory, lidar, radar};
use ralf::config::Config;
use ralf::label::flag;
use ralf::sensors::{Elevation, Reliability};

/// Round weights, which the numbers worked out by hand go by; the defaults are tuned.
const BY_HAND: &str = "
[ground]
model = 'none'
radar_sigmas = 0
[lidar]
beta = 0.2
[tracking]
beta = 0.2
[fusion]
alpha = 0.5
threshold = 0.5";

fn config(assignments: &[&str]) -> Config {
    Config::from_toml(BY_HAND, assignments).unwrap()
}

fn close(found: Option<f64>, expected: f64) {
    let found = found.expect("a value");
    assert!((found - expected).abs() < 1e-4 * expected.abs().max(1e-3), "found {found}, expected {expected}");
}

/// One detection 10 m ahead; a LiDAR point half a metre behind it; the next scan sees something 1 m to its left.
fn small() -> Memory {
    let scans = vec![(0, Some(vec![[10.0, 0.0, 2.0]])), (60 * MS, Some(vec![[10.0, 1.0, 2.0]]))];
    Memory::new(0.0)
        .radar(radar(Elevation::Measured), scans)
        .lidar(lidar(), vec![(10 * MS, vec![[10.5, 0.0, 0.0]])])
}

#[test]
fn by_hand() {
    let labels = small().label(&config(&[]), 0, 0);
    // LiDAR: h = (-0.5, 0, 0), r^2 = 104. Along x the radar's range knows (10^2 / 104) 0.3^2 = 0.0865385, its elevation
    // (r sin(theta) 0.02)^2 = (2 * 0.02)^2 = 0.0016; the LiDAR's ray is x: 0.04^2 = 0.0016.
    // d = 0.5 / sqrt(0.0897385 + 0.000001) = 1.66909.
    close(labels[0].d_lm, 1.66909);
    close(labels[0].w_lm, (-0.2f64 * 1.66909).exp());
    // Tracking: h = (0, -1, 0). Of the detection: azimuth moves y by 10 * 0.01, so 0.01. Of the other, at (10, 1, 2)
    // with r^2 = 105 and rho^2 = 101: range (1^2 / 105) 0.09 = 0.000857; azimuth 100 * 0.0001 = 0.01; elevation moves y
    // by r sin(theta) sin(phi) = 2 / sqrt(101) = 0.19901: (0.19901 * 0.02)^2 = 0.0000158. d = 1 / sqrt(0.0208739) =
    // 6.9214.
    close(labels[0].d_tr, 6.9214);
    let (w_lm, w_tr) = ((-0.2f64 * 1.66909).exp(), (-0.2f64 * 6.9214).exp());
    close(Some(labels[0].w), 0.5 * w_lm + 0.5 * w_tr);
    assert_eq!((labels[0].d_cm, labels[0].w_cm, labels[0].flags), (None, None, 0));
    assert!(!labels[0].plausible, "0.48 is below 0.5");
}

/// A spiral of points that runs from 1 m to 80 m around the vehicle, from -2 m to 3 m high.
fn spiral(step: f32) -> Vec<[f32; 3]> {
    let at = |i: u16| {
        let (range, angle) = (1.0 + f32::from(i) * 0.5, f32::from(i) * step);
        [range * angle.cos(), range * angle.sin(), (f32::from(i) * 0.37) % 5.0 - 2.0]
    };
    (0..160).map(at).collect()
}

#[test]
fn a_cap_changes_nothing_below_it() {
    for elevation in [Elevation::Measured, Elevation::None] {
        let memory = Memory::new(0.0)
            .radar(radar(elevation), vec![(0, Some(spiral(0.105)))])
            .lidar(lidar(), vec![(0, spiral(0.1).into_iter().map(|[x, y, z]| [x, y, z - 2.0]).collect())]);
        let with_cap = |cap: f64| {
            let settings = config(&["lidar.neighbours=2", &format!("lidar.max_mismatch={cap}")]);
            memory.label(&settings, 0, 0)
        };
        let exact = with_cap(1e6);
        for cap in [6.0, 15.0] {
            let capped = with_cap(cap);
            for (exact, capped) in exact.iter().zip(&capped) {
                assert_eq!(capped.d_lm, exact.d_lm.map(|d| d.min(cap)));
            }
            let beyond = exact.iter().filter(|label| label.d_lm.unwrap() > cap).count();
            assert!((1..160).contains(&beyond), "{beyond} of 160 are beyond {cap}");
        }
    }
}

#[test]
fn an_absent_branch_leaves_the_other_alone_and_says_so() {
    let far = config(&["sync.lidar_tolerance_ms=9"]);
    let labels = small().label(&far, 0, 0);
    assert_eq!((labels[0].w_lm, labels[0].w_opt, labels[0].flags), (None, None, flag::NO_LIDAR));
    assert_eq!(Some(labels[0].w), labels[0].w_tr);

    let gap = config(&["tracking.max_gap_ms=59"]);
    let labels = small().label(&gap, 0, 0);
    assert_eq!((labels[0].w_tr, labels[0].flags), (None, flag::NO_NEIGHBOURS));
    assert_eq!(Some(labels[0].w), labels[0].w_lm);
    assert!(labels[0].plausible, "0.72 alone");

    let neither = config(&["tracking.max_gap_ms=59", "sync.lidar_tolerance_ms=9", "fusion.threshold=0"]);
    let labels = small().label(&neither, 0, 0);
    assert_eq!((labels[0].w, labels[0].plausible), (0.0, false), "unobserved is never plausible");
    assert_eq!(labels[0].flags, flag::NO_LIDAR | flag::NO_NEIGHBOURS | flag::UNOBSERVED);

    let disabled = config(&["tracking.enabled=false", "lidar.enabled=false"]);
    assert_eq!(small().label(&disabled, 0, 0)[0].flags, flag::UNOBSERVED, "a disabled branch sets no flag");
}

#[test]
fn the_prior_divides_also_a_branch_that_is_alone() {
    let mut memory = small();
    memory.sequence.rig.radars[0].reliability = Reliability::new(vec![(-1.0, 1.0), (1.0, 2.0)]).unwrap();
    let labels = memory.label(&config(&["tracking.enabled=false"]), 0, 0);
    close(Some(labels[0].w), labels[0].w_lm.unwrap() / 1.5);
}

#[test]
fn everything_moves_with_the_vehicle() {
    // At 10 m/s a wall 10 m ahead is 1 m nearer after 100 ms: detections and LiDAR points must fall together.
    let scans = vec![(0, Some(vec![[10.0, 2.0, 0.5]])), (100 * MS, Some(vec![[9.0, 2.0, 0.5]]))];
    let memory = Memory::new(10.0)
        .radar(radar(Elevation::Measured), scans)
        .lidar(lidar(), vec![(50 * MS, vec![[9.5, 2.0, -1.5]])]);
    for scan in [0, 1] {
        let label = memory.label(&config(&[]), 0, scan)[0];
        assert!(label.d_lm.unwrap() < 1e-3 && label.d_tr.unwrap() < 1e-3, "scan {scan}: {label:?}");
    }
}

#[test]
fn a_detection_without_a_place_keeps_its_row() {
    let nan = [[f32::NAN, 0.0, 0.0], [10.0, 0.0, 2.0], [1.0, f32::INFINITY, 0.0]].map(Vec::from);
    let mut memory = small();
    memory.radar_scans[0][0] = Some(nan.to_vec());
    let labels = memory.label(&config(&[]), 0, 0);
    assert_eq!(labels.len(), 3);
    for i in [0, 2] {
        assert_eq!((labels[i].w, labels[i].plausible, labels[i].flags), (0.0, false, flag::UNOBSERVED));
        assert_eq!((labels[i].d_lm, labels[i].d_tr, labels[i].w_opt), (None, None, None));
    }
    close(labels[1].d_lm, 1.66909);
    // Nor is it a reference: the other scan finds the one with a place.
    memory.radar_scans[0][0] = Some(vec![nan[0].clone()]);
    assert_eq!(memory.label(&config(&[]), 0, 1)[0].d_tr, Some(20.0), "a scan that saw nothing gives the cap");
}

#[test]
fn a_neighbour_that_cannot_be_read_is_left_out() {
    let mut memory = small();
    memory.radar_scans[0][1] = None;
    assert_eq!(memory.label(&config(&[]), 0, 0)[0].flags, flag::NO_NEIGHBOURS);
    let config = config(&[]);
    let mut window = ralf::scene::FrameWindow::new(&memory, &memory.sequence.rig, &config);
    assert!(window.frame(0, 1).unwrap_err().to_string().contains("cut short"));
}

#[test]
fn a_radar_without_elevation_ignores_heights_but_not_its_field_of_view() {
    // The file's z is ignored. Of the LiDAR's points at 10.2 m one lies level with the radar, one 5 m above it.
    let scans = vec![(0, Some(vec![[10.0, 0.0, 7.0]]))];
    let level = [10.2, 0.0, -2.0];
    let above = [10.1, 0.0, 3.0];
    let memory = |points| {
        Memory::new(0.0).radar(radar(Elevation::None), scans.clone()).lidar(lidar(), vec![(0, points)])
    };
    let settings = config(&["lidar.neighbours=1"]);
    // h = (0.2, 0): the range knows 0.3; the ray of the LiDAR, 2 m above, points along (10.2, -2) / 10.394.
    let expected = 0.2 / (0.09f64 + (0.04 * 10.2 / 10.394f64).powi(2) + 1e-6).sqrt();
    close(memory(vec![above, level]).label(&settings, 0, 0)[0].d_lm, expected);
    // With the one above alone the reference cloud is empty: absent, though there was a scan.
    let label = memory(vec![above]).label(&settings, 0, 0)[0];
    assert_eq!((label.d_lm, label.flags & flag::NO_LIDAR), (None, 0));
}

#[test]
fn a_floor_detection_is_an_artifact_whatever_the_branches_say() {
    let scans =
        vec![(0, Some(vec![[10.0, 0.0, 0.05], [10.0, 0.0, 0.5]])), (60 * MS, Some(vec![[10.0, 0.0, 0.05]]))];
    let memory = Memory::new(0.0)
        .radar(radar(Elevation::Measured), scans)
        .lidar(lidar(), vec![(0, vec![[10.0, 0.0, -1.95], [10.0, 0.0, -1.5]])]);
    let settings =
        Config::from_toml("[ground]\nmodel = \"flat\"\nradar_sigmas = 0.0", &["fusion.alpha=0.1"]).unwrap();
    let labels = memory.label(&settings, 0, 0);
    assert_eq!(labels[0].flags & flag::GROUND, flag::GROUND);
    assert_eq!(
        (labels[0].d_lm, labels[0].w_lm, labels[0].w_cm, labels[0].w_opt),
        (None, Some(0.0), Some(0.0), Some(0.0))
    );
    close(labels[0].w_tr, 1.0);
    assert!(labels[0].w >= 0.5 && !labels[0].plausible);
    // The LiDAR point 0.05 m above the road has left: the one at 0.5 m answers the other detection.
    close(labels[1].w_lm, 1.0);
    assert_eq!(labels[1].flags & flag::GROUND, 0);
}

#[test]
fn every_radar_is_a_source_where_that_is_wanted() {
    let own = vec![(0, Some(vec![[10.0, 0.0, 0.5]])), (60 * MS, Some(vec![]))];
    let other = vec![(50 * MS, Some(vec![[10.0, 0.0, 0.5]]))];
    let memory =
        Memory::new(0.0).radar(radar(Elevation::Measured), own).radar(radar(Elevation::Measured), other);
    assert_eq!(memory.label(&config(&[]), 0, 0)[0].d_tr, Some(20.0), "an empty scan");
    assert_eq!(memory.label(&config(&["tracking.sources=all"]), 0, 0)[0].d_tr, Some(0.0));
}

#[test]
fn what_moves_is_found_where_its_doppler_takes_it() {
    // A car goes away at 5 m/s: 0.5 m in 100 ms.
    let scans = vec![(0, Some(vec![[10.0, 0.0, 5.0]])), (100 * MS, Some(vec![[10.5, 0.0, 5.0]]))];
    let mut moving = radar(Elevation::None);
    moving.fields[2] = "doppler_compensated".into();
    let memory = Memory::new(0.0).radar(moving, scans);
    let standing = memory.label(&config(&[]), 0, 0)[0].d_tr.unwrap();
    assert!(standing > 1.0, "0.5 m against 0.3 m at both ends: {standing}");
    assert!(memory.label(&config(&["tracking.dynamic=true"]), 0, 0)[0].d_tr.unwrap() < 1e-3);
}

#[test]
fn in_the_blind_spot_the_lidar_answers_only_if_no_camera_does() {
    let scans = vec![(0, Some(vec![[1.0, 0.0, 0.5], [5.0, 0.0, 0.5]]))];
    let memory = Memory::new(0.0)
        .radar(radar(Elevation::Measured), scans)
        .lidar(lidar(), vec![(0, vec![[1.0, 0.0, -1.5]])]);
    let labels = memory.label(&config(&[]), 0, 0);
    assert_eq!(
        [labels[0].flags & flag::BLIND_SPOT, labels[1].flags & flag::BLIND_SPOT],
        [flag::BLIND_SPOT, 0]
    );
    assert_eq!(labels[0].w_opt, labels[0].w_lm);
}
