//! What is whole is read to the last field.

use super::*;

#[test]
fn tables_in_any_order_become_a_scene() {
    let set = DataSet::new();
    let scene = set.open().unwrap();
    let sequence = scene.sequence();
    assert_eq!(
        (sequence.name.as_str(), sequence.title.as_str()),
        ("scene-0001", "Turn (boston, 2018-07-24)")
    );
    let names: Vec<_> = sequence.rig.radars.iter().map(|radar| radar.name.as_str()).collect();
    assert_eq!(names, ["RADAR_FRONT", "RADAR_BACK_LEFT"]);
    let at = |ms: i64| (T0 + ms * MS) * 1000;
    assert_eq!(sequence.times.radars, [vec![at(0), at(75), at(150)], vec![at(20)]]);
    assert_eq!((&sequence.times.lidars, &sequence.times.cameras), (&vec![vec![at(50)]], &vec![vec![at(30)]]));
    assert_eq!(scene.warnings(), ["1 of 2 files of RADAR_BACK_LEFT are not there and were left out"]);

    // A quarter turn to the left, in w x y z.
    let ahead = sequence.rig.radars[1].vehicle_from_radar * Point::new(1.0, 0.0, 0.0);
    assert!((ahead - Point::new(3.0, 2.0, 0.5)).norm() < 1e-9);
    let camera = &sequence.rig.cameras[0];
    let Intrinsics::Pinhole { focal, center, .. } = camera.intrinsics else {
        panic!("{:?}", camera.intrinsics)
    };
    assert_eq!((focal, center, camera.width, camera.height), ([10.0, 11.0], [1.5, 0.5], 4, 2));

    let poses = sequence.motion.poses();
    assert_eq!(poses.len(), 7);
    assert!(poses.is_sorted_by(|a, b| a.t_ns < b.t_ns));
    assert!((sequence.motion.odom_from_vehicle(at(85)).translation.x - 0.85).abs() < 1e-9);
    let odometry: Vec<_> =
        sequence.motion.odometry().iter().map(|s| (s.t_ns, s.velocity, s.yaw_rate)).collect();
    assert_eq!(odometry, [(at(0), 9.0, 0.25), (at(20), 10.0, 0.25)]);
}

#[test]
fn a_radar_file_that_is_missing_beside_others_is_a_scan_that_can_not_be_read() {
    let set = DataSet::new();
    let whole = set.open().unwrap();
    let file = set.0.path().join("sweeps/RADAR_FRONT/b.pcd");
    fs::remove_file(&file).unwrap();
    let scene = set.open().unwrap();
    assert_eq!(scene.sequence().times, whole.sequence().times);
    assert_eq!((scene.warnings(), scene.inputs()), (whole.warnings(), whole.inputs()));
    let error = scene.radar_scan(0, 1).unwrap_err().to_string();
    assert!(error.contains(file.to_str().unwrap()) && error.contains("found none of this name"), "{error}");
    let tokens = |scene: &dyn SequenceReader| {
        let origin = scene.origin().and_then(|origin| origin.downcast_ref::<TableOrigin>()).unwrap();
        (0..3).map(|scan| origin.sample_data_token(0, scan).unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(tokens(scene.as_ref()), tokens(whole.as_ref()));
    // Without the last of a folder, that folder is a part that isn't there: nobody is told of each of its files.
    fs::remove_file(set.0.path().join("sweeps/RADAR_FRONT/c.pcd")).unwrap();
    let scene = set.open().unwrap();
    assert_eq!(scene.sequence().times.radars[0].len(), 1);
    assert_eq!(scene.warnings()[0], "2 of 3 files of RADAR_FRONT are not there and were left out");
}

#[test]
fn measurements_are_read_to_the_last_field() {
    let set = DataSet::new();
    let scene = set.open().unwrap();
    let radar = &scene.sequence().rig.radars[0];
    let scan = scene.radar_scan(0, 0).unwrap();
    assert_eq!(scan.len(), 2);
    let first: Vec<_> =
        radar.fields.iter().zip(&scan.columns).map(|(name, column)| (name.as_str(), column[0])).collect();
    let expected = [
        ("x", 3.0),
        ("y", 4.0),
        ("z", 0.0),
        ("dyn_prop", 3.0),
        ("id", 300.0),
        ("rcs", 7.5),
        ("vx", 1.0),
        ("vy", 2.0),
        ("vx_comp", -5.0),
        ("vy_comp", 0.0),
        ("is_quality_valid", 1.0),
        ("ambig_state", 3.0),
        ("x_rms", 20.0),
        ("y_rms", 21.0),
        ("invalid_state", 17.0),
        ("pdh0", 2.0),
        ("vx_rms", -4.0),
        ("vy_rms", 5.0),
        ("doppler", 2.2),
        ("doppler_compensated", -3.0),
    ];
    assert_eq!(first, expected);
    assert_eq!(scan.columns[18][1], -1.0);
    assert!(scene.radar_scan(0, 2).unwrap().is_empty(), "NaN with id -1 is an empty scan");
    let cloud = scene.lidar_scan(0, 0).unwrap();
    assert_eq!((cloud.points, cloud.intensity), (vec![[1.0, 2.0, 3.0]], vec![200.0]));
    assert_eq!(scene.image(0, 0).unwrap().rgb[6], [2, 1, 9]);
    assert!(scene.depth(0, 0).unwrap().is_none());
    let inputs = scene.inputs();
    assert_eq!(inputs.len(), 7 + 1 + 4 + 1 + 1);
    assert!(inputs.iter().all(|file| file.is_file()));
    assert_eq!(scene.image_file(0, 0).unwrap(), set.0.path().join("samples/CAM_FRONT/a.png"));
    assert!(scene.image_file(0, 1).is_none() && scene.image_file(1, 0).is_none());
}

#[test]
fn scans_keep_their_names_in_the_tables() {
    let set = DataSet::new();
    let scene = set.open().unwrap();
    let origin = scene.origin().and_then(|origin| origin.downcast_ref::<TableOrigin>()).unwrap();
    let token = |scan| origin.sample_data_token(0, scan).map(|token| (origin.version.clone(), token));
    // Of the fixture's tables: a token is the file's name.
    for (scan, file) in [(0, "samples/RADAR_FRONT/a.pcd"), (2, "sweeps/RADAR_FRONT/c.pcd")] {
        assert_eq!(token(scan), Some((VERSION.to_owned(), file.to_owned())));
    }
    assert_eq!((token(3), origin.sample_data_token(9, 0)), (None, None));
}

#[test]
fn a_nan_that_is_not_the_mark_of_an_empty_scan_stays() {
    let set = DataSet::new();
    set.write("sweeps/RADAR_FRONT/b.pcd", &pcd(&[detection(f32::NAN, f32::NAN, 4, [0.0; 4])]));
    assert_eq!(set.open().unwrap().radar_scan(0, 1).unwrap().len(), 1);
}

#[test]
fn folders_that_are_missing_leave_timelines_empty() {
    let set = DataSet::new();
    for folder in ["samples/LIDAR_TOP", "samples/RADAR_BACK_LEFT", "can_bus"] {
        fs::remove_dir_all(set.0.path().join(folder)).unwrap();
    }
    let scene = set.open().unwrap();
    let times = &scene.sequence().times;
    assert_eq!((times.lidars[0].len(), times.radars[1].len(), scene.warnings().len()), (0, 0, 2));
    assert!(scene.sequence().motion.odometry().is_empty());
}
