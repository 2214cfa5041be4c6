//! What is whole is read.

use super::*;
use ralf::sensors::LidarScan;
use ralf_ros::container::{Channel, Container};

#[test]
fn measurements_come_in_the_order_of_their_stamps() {
    for bag in [false, true] {
        let (_folder, path) = Drive { bag, ..Drive::default() }.write();
        let drive = open_file(&path, TABLE).unwrap();
        assert_eq!(drive.warnings(), [""; 0]);
        let sequence = drive.sequence();
        assert_eq!(sequence.name, "drive");
        let times = |ms: &[i64]| ms.iter().map(|ms| T0 + ms * MS).collect::<Vec<_>>();
        assert_eq!(sequence.times.radars, [times(&[0, 70, 140]), times(&[20])]);
        assert_eq!(
            (&sequence.times.lidars, &sequence.times.cameras),
            (&vec![times(&[60])], &vec![times(&[50])])
        );
        let lengths: Vec<usize> = (0..3).map(|scan| drive.radar_scan(0, scan).unwrap().len()).collect();
        assert_eq!(lengths, [1, 2, 0]);
        assert_eq!(drive.lidar_scan(0, 0).unwrap().points, [[1.0, 2.0, 3.0]]);
        assert_eq!(drive.image(0, 0).unwrap().rgb, [[1, 2, 3], [4, 5, 6]]);
        assert_eq!(drive.inputs(), [path]);
    }
}

#[test]
fn radars_keep_their_fields_and_gain_range_rates() {
    let (_folder, path) = Drive::default().write();
    let drive = open_file(&path, TABLE).unwrap();
    let [front, rear] = drive.sequence().rig.radars.as_slice() else { panic!() };
    assert_eq!((front.elevation, rear.elevation), (Elevation::None, Elevation::Measured));
    assert_eq!(front.fields, ["x", "y", "z", "vx", "vy", "doppler"]);
    // (10 * 4 + 5 * 3) / 5 and (-1 * 6 - 2 * 8) / 10.
    assert_eq!(drive.radar_scan(0, 1).unwrap().columns[5], [11.0, -2.2]);
    assert_eq!(rear.fields, ["range", "azimuth", "elevation", "doppler", "amplitude"]);
    let scan = drive.radar_scan(1, 0).unwrap();
    assert_eq!((scan.columns[3].as_slice(), scan.spherical[0].elevation), ([-3.0; 2].as_slice(), 0.25));
}

/// Corrections are known again by that, whichever way somebody labels.
#[test]
fn whether_range_rates_are_derived_is_no_other_content() {
    let (_folder, path) = Drive::default().write();
    let derived = open_file(&path, TABLE).unwrap();
    let not = TABLE.replace("model = 'ars408-21'", "model = 'ars408-21', derive_doppler = false");
    let plain = open_file(&path, &not).unwrap();
    let radars = |drive: &dyn SequenceReader| [0, 1].map(|radar| drive.alters_values(radar));
    assert_eq!((radars(derived.as_ref()), radars(plain.as_ref())), ([false; 2], [true, false]));
    for scan in 0..3 {
        let (read, other) = (derived.radar_scan(0, scan).unwrap(), plain.radar_scan(0, scan).unwrap());
        assert_ne!(read.columns, other.columns);
        for drive in [&derived, &plain] {
            assert_eq!(drive.delivered(0, scan).unwrap().columns, read.columns, "scan {scan}");
        }
    }
    assert_eq!(plain.delivered(1, 0).unwrap().columns, derived.radar_scan(1, 0).unwrap().columns);
}

#[test]
fn sensors_hang_on_the_tree_of_frames() {
    let (_folder, path) = Drive::default().write();
    let drive = open_file(&path, TABLE).unwrap();
    let rig = &drive.sequence().rig;
    let origin =
        |transform: &ralf::space::Transform| (transform * Point::origin()).coords.as_slice().to_vec();
    assert_eq!(origin(&rig.radars[0].vehicle_from_radar), [3.5, 0.0, 0.25], "by way of the mast");
    assert_eq!(origin(&rig.lidars[0].vehicle_from_lidar), [0.0, 0.0, 2.0]);
    assert_eq!(origin(&rig.cameras[0].vehicle_from_camera), [1.0, 0.0, 1.5]);
    let distortion = [0.1, 0.0, 0.0, 0.0, 0.2];
    let expected = Intrinsics::Pinhole { focal: [100.0; 2], center: [1.0, 0.5], distortion };
    assert_eq!((&rig.cameras[0].intrinsics, rig.cameras[0].width), (&expected, 2));
}

#[test]
fn the_imu_turns_what_the_odometry_moves() {
    let (_folder, path) = Drive::default().write();
    let drive = open_file(&path, TABLE).unwrap();
    let motion = &drive.sequence().motion;
    assert_eq!((motion.poses().len(), motion.odometry().len()), (8, 8));
    let rates: Vec<f64> = motion.odometry().iter().map(|sample| sample.yaw_rate).collect();
    assert_eq!(rates, [0.25, 0.5, 0.75, 0.75, 0.75, 0.75, 0.75, 0.75]);
    assert!(motion.odometry().iter().all(|sample| sample.velocity == 8.0));
    // Without poses, the same velocities from the twist alone.
    let text = TABLE.replace("kind = 'odometry'", "kind = 'twist'").replace("imu =", "# imu =");
    let drive = open_file(&path, &text).unwrap();
    assert_eq!(drive.sequence().motion.poses(), []);
    assert!(drive.sequence().motion.odometry().iter().all(|sample| sample.yaw_rate == 0.1));
}

#[test]
fn odometry_without_a_frame_is_the_vehicles() {
    let drive = Drive { vehicle: "", ..Drive::default() };
    assert!(error(&drive, TABLE).contains("expected `vehicle_frame` with one of the topics"));
    let (_folder, path) = drive.write();
    let text = TABLE.replace("'odometry' }", "'odometry', vehicle_frame = 'base' }");
    assert_eq!(open_file(&path, &text).unwrap().sequence().motion.poses().len(), 8);
}

#[test]
fn without_a_table_a_guess_is_made_and_said() {
    let (_folder, path) = Drive::default().write();
    let guess = guess(&path).unwrap();
    let text = topics_toml(&guess).unwrap();
    assert_eq!(table(&text), guess.topics);
    let expected = table(
        &TABLE
            .replace("ars408-21'", "generic', elevation = false")
            .replace("hdl-32e", "generic")
            .replace("imu =", "# imu ="),
    );
    let mut found = guess.topics.clone();
    // The second radar is told by its values to measure elevation, and is called after its topic.
    assert_eq!(found.get("rear").map(|rear| rear.elevation), Some(Some(true)), "{text}");
    found.get_mut("rear").unwrap().elevation = None;
    // Its fields make the roof's cloud a LiDAR's.
    assert_eq!(found, expected, "{text}");
    assert_eq!(guess.remarks, ["/imu is not used: /odom tells the motion"]);
    let drive = crate::read::open(&path, None).unwrap().sequences.remove(0);
    assert!(drive.warnings()[0].contains("a first guess of it is used"), "{:?}", drive.warnings());
    assert_eq!(drive.sequence().rig.radars.len(), 2);
}

#[test]
fn inspection_tells_rates_delays_and_frames() {
    let (_folder, path) = Drive::default().write();
    let (inspection, _) = inspect(&path).unwrap();
    let of = |name: &str| inspection.topics.iter().find(|topic| topic.topic == name).unwrap();
    let odom = of("/odom");
    assert_eq!(
        (odom.count, odom.rate_hz, odom.jitter_ms, odom.delay_ms),
        (8, Some(50.0), Some(0.0), Some(0.0))
    );
    let front = of("/front/points");
    assert_eq!((front.delay_ms, front.frame.as_deref()), (Some(20.0), Some("radar")));
    assert!(of("/rear/scan").rate_hz.is_none() && of("/tf_static").frame.is_none());
    assert!(is_ros(&path) && !is_ros(path.parent().unwrap()));
}

#[test]
fn the_model_of_a_radar_is_the_one_that_its_frame_tells() {
    let (_folder, path) = Drive { radar: "ARS408_front", ..Drive::default() }.write();
    let guess = guess(&path).unwrap();
    let model = |name: &str| guess.topics[name].model.as_deref();
    assert_eq!(
        [model("front"), model("rear"), model("roof")],
        [Some("ars408-21"), Some("ars408-21"), Some("generic")]
    );
}

#[test]
fn a_parked_vehicle_needs_no_message_of_its_odometry() {
    let (_folder, path) = Drive { parked: true, ..Drive::default() }.write();
    let text = TABLE.replace("'odometry' }", "'odometry', vehicle_frame = 'base' }");
    let drive = open_file(&path, &text).unwrap();
    let told = "/odom: no messages: the vehicle is taken to stand still";
    assert!(drive.warnings().iter().any(|warning| warning == told), "{:?}", drive.warnings());
    let motion = &drive.sequence().motion;
    assert_eq!((motion.odometry().len(), motion.odometry()[0].velocity), (1, 0.0));
    assert_eq!(motion.between(T0, T0 + 1000 * MS), ralf::space::Transform::identity());
    // Without a frame for the vehicle nothing can be placed on it, and that is what is said.
    assert!(error(&Drive { parked: true, ..Drive::default() }, TABLE).contains("`vehicle_frame`"));
}

#[test]
fn a_camera_that_can_not_be_placed_or_calibrated_is_left_out() {
    for drive in [
        Drive { camera_frame: "nowhere", ..Drive::default() },
        Drive { infos: vec![0.0], ..Drive::default() },
        Drive { infos: vec![f64::NAN; 2], ..Drive::default() },
        Drive { distortion: [f64::NAN, 0.0, 0.0, 0.0, 0.0], infos: vec![100.0; 2], ..Drive::default() },
        Drive { distortion: [0.0, 0.0, 0.0, 0.0, f64::INFINITY], ..Drive::default() },
        Drive { image_width: 0, ..Drive::default() },
    ] {
        let (_folder, path) = drive.write();
        let drive = open_file(&path, TABLE).unwrap();
        assert!(drive.sequence().rig.cameras.is_empty() && drive.sequence().times.cameras.is_empty());
        assert_eq!(drive.sequence().rig.radars.len(), 2);
        assert!(drive.warnings().iter().any(|warning| warning.starts_with("the camera cam is left out: ")));
    }
}

#[test]
fn the_shift_of_a_right_camera_is_told() {
    let (_folder, path) = Drive::default().write();
    let rectified = TABLE.replace("info = '/cam/camera_info'", "info = '/cam/camera_info', rectified = true");
    let drive = open_file(&path, &rectified).unwrap();
    let told = "cam: by its calibration rectified images are seen from 0.250 m to the right and 0.000 m below (`P`), \
                which is not applied: right if the frame `camera` is theirs, else `corrections.cam` moves the camera";
    assert_eq!(drive.warnings(), [told]);
    assert_eq!(drive.sequence().rig.cameras[0].vehicle_from_camera.translation.x, 1.0);
    assert_eq!(open_file(&path, TABLE).unwrap().warnings(), [""; 0], "raw images");
}

/// At 8 m/s a post ahead is measured 40 ms before the scan's time, and another 40 ms after it.
#[test]
fn lidar_points_with_times_are_brought_to_the_time_of_their_scan() {
    let points = vec![[10.0, 0.0, 0.0, -0.04], [20.0, 0.0, 0.0, 0.04]];
    let (_folder, path) = Drive { lidar: (points, "time"), ..Drive::default() }.write();
    let drive = open_file(&path, TABLE).unwrap();
    let ahead = |scan: LidarScan| scan.points.iter().map(|point| point[0]).collect::<Vec<_>>();
    let near = |found: Vec<f32>, expected: [f32; 2]| {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4), "{found:?}");
    };
    near(ahead(drive.lidar_scan(0, 0).unwrap()), [9.68, 20.32]);
    near(ahead(drive.rolling_scan(0, 0).unwrap().unwrap()), [10.0, 20.0]);
    assert_eq!(drive.lidar_scan(0, 0).unwrap().times.unwrap(), [-0.04, 0.04]);
    assert!(
        drive.warnings()[0].contains("roof: points carry their times (`time`, s)"),
        "{:?}",
        drive.warnings()
    );
    // The recorder has done so already.
    let done = TABLE.replace("model = 'hdl-32e'", "model = 'hdl-32e', motion_corrected = true");
    let drive = open_file(&path, &done).unwrap();
    near(ahead(drive.lidar_scan(0, 0).unwrap()), [10.0, 20.0]);
    assert!(drive.rolling_scan(0, 0).unwrap().is_none() && drive.warnings().is_empty());
}

#[test]
fn times_in_no_unit_are_told_and_left_alone() {
    let points = vec![[10.0, 0.0, 0.0, 3e30], [20.0, 0.0, 0.0, 4e30]];
    let (_folder, path) = Drive { lidar: (points, "timestamp"), ..Drive::default() }.write();
    let drive = open_file(&path, TABLE).unwrap();
    assert!(drive.warnings()[0].starts_with("roof: `timestamp` from 2999999"), "{:?}", drive.warnings());
    assert!(drive.lidar_scan(0, 0).unwrap().times.is_none());
}

/// A node of old and one of new tf, both on `/tf_static`.
#[test]
fn both_spellings_of_a_type_are_read_from_one_topic() {
    let (folder, path) = Drive { bag: true, ..Drive::default() }.write();
    let one = Container::open(&path).unwrap();
    let both = folder.path().join("both.bag");
    let mut to = MessageWriter::bag(File::create(&both).unwrap()).unwrap();
    let copies: Vec<_> = one.channels().iter().map(|channel| to.raw_topic(channel).unwrap()).collect();
    let frames = one.channels().iter().position(|channel| channel.topic == "/tf_static").unwrap();
    let old = Channel { type_name: "tf/tfMessage".to_owned(), ..one.channels()[frames].clone() };
    let old = to.raw_topic(&old).unwrap();
    for (place, message) in one.messages().iter().enumerate() {
        let is_old = message.channel() == frames && place % 2 == 0;
        let channel = if is_old { &old } else { &copies[message.channel()] };
        to.write_raw(channel, message.log_ns, &one.read(message).unwrap()).unwrap();
    }
    to.finish().unwrap();
    let [expected, found] = [&path, &both].map(|path| open_file(path, TABLE).unwrap());
    assert_eq!(format!("{:?}", found.sequence().rig), format!("{:?}", expected.sequence().rig));
    assert_eq!(guess(&both).unwrap().topics, guess(&path).unwrap().topics);
}
