//! The genuine scene-0061, where it is at hand.

use super::*;

#[test]
fn the_genuine_scene() {
    let Some(folder) = testing::data("nuscenes") else { return };
    let recording = crate::read::open(&folder, None).unwrap();
    assert_eq!(recording.format, "nuscenes");
    assert_eq!(recording.sequences.len(), 1);
    let scene = &recording.sequences[0];
    let sequence = scene.sequence();
    let names =
        |radars: &[ralf::sensors::Radar]| radars.iter().map(|radar| radar.name.clone()).collect::<Vec<_>>();
    let expected =
        ["RADAR_FRONT", "RADAR_FRONT_LEFT", "RADAR_FRONT_RIGHT", "RADAR_BACK_LEFT", "RADAR_BACK_RIGHT"];
    assert_eq!(names(&sequence.rig.radars), expected);
    let cameras: Vec<_> = sequence.rig.cameras.iter().map(|camera| camera.name.as_str()).collect();
    let expected =
        ["CAM_FRONT", "CAM_FRONT_LEFT", "CAM_FRONT_RIGHT", "CAM_BACK", "CAM_BACK_LEFT", "CAM_BACK_RIGHT"];
    assert_eq!((sequence.name.as_str(), cameras.as_slice()), ("scene-0061", &expected[..]));
    assert!(scene.warnings().is_empty(), "{:?}", scene.warnings());

    let mut sizes = Vec::new();
    for (radar, times) in sequence.times.radars.iter().enumerate() {
        assert!(times.is_sorted_by(|a, b| a < b));
        sizes.extend((0..times.len()).map(|scan| scene.radar_scan(radar, scan).unwrap().len()));
    }
    assert_eq!((sizes.len(), sizes.iter().sum::<usize>()), (1263, 126_749));
    assert_eq!((sizes.iter().min(), sizes.iter().max()), (Some(&2), Some(&125)));
    assert_eq!(scene.lidar_scan(0, 0).unwrap().points.len(), 34_688);
    let image = scene.image(0, 0).unwrap();
    assert_eq!((image.width, image.height), (1600, 900));

    // 91 m of road, turning by 98 deg.
    let motion = &sequence.motion;
    let poses = motion.poses();
    let turn =
        motion.between(poses[0].t_ns, poses[poses.len() - 1].t_ns).rotation.euler_angles().2.to_degrees();
    assert!((turn.abs() - 98.0).abs() < 1.0, "{turn}");
    assert!(motion.odometry().len() > 900 && (motion.odometry()[0].velocity - 8.99).abs() < 0.01);
}

/// What stands still has no Doppler velocity of its own: `doppler_compensated` is `doppler` plus the vehicle's motion.
#[test]
fn the_genuine_velocities_agree_with_the_motion() {
    let Some(folder) = testing::data("nuscenes") else { return };
    let recording = crate::read::open(&folder, None).unwrap();
    assert_eq!(recording.format, "nuscenes");
    let scene = &recording.sequences[0];
    let radar = &scene.sequence().rig.radars[0];
    let scan = scene.radar_scan(0, 20).unwrap();
    let (linear, angular) = scene.sequence().motion.twist(scan.t_ns);
    let mounting = radar.vehicle_from_radar;
    let velocity = mounting.rotation.inverse() * (linear + angular.cross(&mounting.translation.vector));
    let [raw, compensated] =
        ["doppler", "doppler_compensated"].map(|name| &scan.columns[radar.column(name).unwrap()]);
    let mut differences: Vec<f64> = (0..scan.len())
        .map(|i| {
            let ray = scan.positions[i].coords.normalize();
            (f64::from(compensated[i] - raw[i]) - velocity.dot(&ray)).abs()
        })
        .collect();
    differences.sort_by(f64::total_cmp);
    // Of some 9 m/s.
    assert!(differences[differences.len() / 2] < 0.4, "{differences:?}");
}
