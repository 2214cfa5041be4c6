//! What is whole is read to the last field, and LiDARs are moved to their scans' times.

use super::recording::world::{T0, from_surface, start_from_vehicle};
use super::recording::{RADARS, truth};
use super::*;
use ralf::scene::Doppler;
use ralf::sensors::{LidarScan, is_return};
use ralf::space::Point;

#[test]
fn tables_become_a_scene() {
    let set = DataSet::new();
    let scene = set.open().unwrap();
    let sequence = scene.sequence();
    assert_eq!((sequence.name.as_str(), sequence.title.as_str()), (SCENE, "weather.clear|area.highway"));
    let rig = &sequence.rig;
    assert_eq!(rig.radars.iter().map(|radar| radar.name.as_str()).collect::<Vec<_>>(), RADARS);
    let lidars: Vec<_> = rig.lidars.iter().map(|lidar| lidar.name.as_str()).collect();
    let expected =
        ["LIDAR_TOP_FRONT", "LIDAR_LEFT", "LIDAR_RIGHT", "LIDAR_TOP_LEFT", "LIDAR_TOP_RIGHT", "LIDAR_REAR"];
    assert_eq!((lidars, rig.cameras.len()), (expected.to_vec(), 4));
    assert_eq!(sequence.times.radars[0], [0, 1, 2].map(|scan| (T0 + 3_100 + 100_000 * scan) * 1000));
    assert!(scene.warnings().is_empty(), "{:?}", scene.warnings());
    assert!(scene.inputs().iter().all(|file| file.is_file()));
    assert_eq!(scene.image(0, 0).unwrap().width, 8);
}

/// Poses are those of their own times, wherever `ego_pose_token` leads, and keep their digits.
#[test]
fn poses_are_interpolated_by_their_own_times() {
    let set = DataSet::new();
    let scene = set.open().unwrap();
    let motion = &scene.sequence().motion;
    assert_eq!(motion.poses().len(), 125, "another day's pose is no part of it");
    for ms in [0, 37, 211] {
        let us = T0 + ms * 1000;
        let expected = start_from_vehicle(T0).inverse() * start_from_vehicle(us);
        let found = motion.between(T0 * 1000, us * 1000);
        assert!((found.translation.vector - expected.translation.vector).norm() < 1e-4, "{ms} ms");
    }
    let sample = motion.odometry()[0];
    assert_eq!((sample.velocity, sample.yaw_rate), (15.0, 0.35), "the cab's");
}

#[test]
fn the_radial_vector_becomes_a_range_rate_and_what_stands_still_stands_still() {
    let set = DataSet::new();
    let scene = set.open().unwrap();
    for (r, radar) in scene.sequence().rig.radars.iter().enumerate() {
        let scan = scene.radar_scan(r, 1).unwrap();
        assert_eq!(radar.fields, ["x", "y", "z", "vrel_x", "vrel_y", "vrel_z", "rcs", "doppler"]);
        assert_eq!(scan.len(), truth(r, 1, &TINY).len(), "none is dropped");
        let rates = Doppler::new(radar, &scan, &scene.sequence().motion).unwrap();
        assert!(rates.compensated.iter().all(|rate| rate.abs() < 1e-4), "{:?}", rates.compensated);
        assert!(rates.raw.iter().any(|rate| rate.abs() > 5.0));
    }
}

/// How far each return lies from the surfaces, at the scan's time, m.
fn off(scan: &LidarScan, vehicle_from_lidar: &ralf::space::Transform) -> Vec<f64> {
    let returns = scan.points.iter().filter(|point| is_return(point));
    let place = |point: &[f32; 3]| vehicle_from_lidar * Point::from(point.map(f64::from));
    returns.map(|point| from_surface(scan.t_ns / 1000, place(point).coords.into())).collect()
}

#[test]
fn six_lidars_are_brought_to_the_times_of_their_scans() {
    let set = DataSet::new();
    let scene = set.open().unwrap();
    for (l, lidar) in scene.sequence().rig.lidars.iter().enumerate() {
        let scan = scene.lidar_scan(l, 1).unwrap();
        let measured = scene.rolling_scan(l, 1).unwrap().unwrap();
        let worst = |scan| off(scan, &lidar.vehicle_from_lidar).into_iter().fold(0.0, f64::max);
        let [corrected, rolling] = [worst(&scan), worst(&measured)];
        assert!(corrected < 2e-3 && rolling > 0.05, "{}: {corrected} {rolling}", lidar.name);
        let times = scan.times.unwrap();
        assert!(times.iter().all(|time| time.abs() <= 0.0501) && times.iter().any(|time| *time < -0.02));
    }
}

#[test]
fn a_copy_without_sweeps_has_its_keyframes() {
    let set = DataSet::new();
    fs::remove_dir_all(set.0.path().join("sweeps")).unwrap();
    let scene = set.open().unwrap();
    assert!(scene.sequence().times.radars.iter().all(|times| times.len() == 1));
    assert_eq!(scene.warnings().len(), 16, "one for each sensor");
    assert_eq!(scene.warnings()[0], "2 of 3 files of RADAR_LEFT_FRONT are not there and were left out");
}

#[test]
fn a_radar_file_that_is_missing_beside_others_is_a_scan_that_can_not_be_read() {
    let set = DataSet::new();
    let file = set.file("sweeps", RADARS[0], 1);
    fs::remove_file(&file).unwrap();
    let scene = set.open().unwrap();
    assert_eq!((scene.sequence().times.radars[0].len(), scene.warnings().len()), (3, 0));
    let told = |scan: usize| scene.radar_scan(0, scan).map_err(|error| error.to_string());
    let missing: Vec<String> = (0..3).filter_map(|scan| told(scan).err()).collect();
    assert!(missing.len() == 1 && missing[0].contains(file.to_str().unwrap()), "{missing:?}");
}

#[test]
fn without_a_cab_the_chassis_tells_the_speed() {
    let set = DataSet::new();
    fs::remove_file(set.0.path().join(VERSION).join("ego_motion_cabin.json")).unwrap();
    let scene = set.open().unwrap();
    assert!((scene.sequence().motion.odometry()[0].velocity - 15.15).abs() < 1e-9);
    assert!(scene.inputs().iter().any(|file| file.ends_with(TELLING)));
}

/// Rows without a place, and scans without rows, are kept.
#[test]
fn what_has_no_place_stays() {
    let set = DataSet::new();
    let head = |points| {
        format!(
            "FIELDS x y z vrel_x vrel_y vrel_z rcs\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\n\
             WIDTH {points}\nHEIGHT 1\nPOINTS {points}\n"
        )
    };
    let rows = head(3) + "DATA ascii\n0 0 0 0 0 0 1\nnan 1 1 0 0 0 2\n3 0 4 6 0 8 3\n";
    testing::write(&set.file("samples", RADARS[0], 0), rows.as_bytes());
    testing::write(&set.file("samples", RADARS[1], 0), (head(0) + "DATA binary_compressed\n").as_bytes());
    let scene = set.open().unwrap();
    let scan = scene.radar_scan(0, 0).unwrap();
    assert!(scan.columns[7][0].is_nan() && scan.columns[7][1].is_nan());
    let placed = scan.positions.iter().map(|place| place.coords.iter().all(|axis| axis.is_finite()));
    assert_eq!(placed.collect::<Vec<_>>(), [false, false, true]);
    assert_eq!((scan.columns[7][2], &scan.columns[6]), (10.0, &vec![1.0, 2.0, 3.0]));
    assert!(scene.radar_scan(1, 0).unwrap().is_empty());
}
