//! What drivers of real radars publish: range rates of other names, two kinds of coordinates, no time at first.

use super::sparse::{SPARSE, odometry, recording, revolution, scan, write};
use super::*;

/// A scan of one detection with these fields.
fn cloud(drive: &Drive, ms: i64, frame: &str, detection: &[(&str, f32)]) -> (i64, PointCloud2) {
    let fields =
        detection.iter().zip(0..).map(|((name, _), k)| PointField::new(name, 4 * k, Datatype::Float32));
    let step = 4 * detection.len() as u32;
    let cloud = PointCloud2 {
        header: drive.header(ms, frame),
        height: 1,
        width: 1,
        fields: fields.collect(),
        point_step: step,
        row_step: step,
        data: detection.iter().flat_map(|(_, value)| value.to_le_bytes()).collect(),
        ..PointCloud2::default()
    };
    (ms, cloud)
}

/// As the driver of a TI radar has it.
const OF_TI: [(&str, f32); 5] = [("x", 8.0), ("y", 1.0), ("z", 0.5), ("intensity", 12.0), ("velocity", -3.5)];

/// What is said of all but the LiDAR.
fn of_others(drive: &dyn SequenceReader) -> Vec<&str> {
    drive.warnings().iter().map(String::as_str).filter(|warning| !warning.starts_with("roof")).collect()
}

#[test]
fn a_range_rate_of_another_name_is_used_where_it_is_named_or_guessed() {
    let (_folder, path) = recording(|drive, to| {
        odometry(drive, to);
        write(to, "/front", [cloud(drive, 50, "radar", &OF_TI)]);
        write(to, "/roof", [revolution(drive, 60, &[0.0])]);
    });
    let table = |key: &str| SPARSE.replace("kind = 'radar',", &format!("kind = 'radar', {key}"));
    let plain = open_file(&path, &table("")).unwrap();
    assert!(!plain.sequence().rig.radars[0].fields.contains(&"doppler".to_owned()));
    let told = "front: the field `velocity` looks like a range rate, and is not used as such: \
                `topics.front.doppler = \"velocity\"` if it is one";
    assert!(plain.warnings().iter().any(|warning| warning.starts_with(told)), "{:?}", plain.warnings());

    let named = open_file(&path, &table("doppler = 'velocity',")).unwrap();
    let fields = &named.sequence().rig.radars[0].fields;
    assert_eq!(fields, &["x", "y", "z", "intensity", "velocity", "doppler"]);
    assert_eq!(named.radar_scan(0, 0).unwrap().columns[4..], [[-3.5], [-3.5]]);
    assert_eq!(of_others(named.as_ref()), [""; 0]);
    // Which field it is is a setting: corrections of the one are those of the other.
    let [one, other] = [&plain, &named].map(|drive| drive.delivered(0, 0).unwrap().columns);
    assert_eq!((one, plain.alters_values(0), named.alters_values(0)), (other, false, true));

    let guess = guess(&path).unwrap();
    assert_eq!(guess.topics["front"].doppler.as_deref(), Some("velocity"));
    assert!(guess.remarks[0].starts_with("/front: the field `velocity` is taken for the range rate"));
    let error = open_file(&path, &table("doppler = 'speed',")).err().unwrap().to_string();
    assert!(
        error.contains("expected a field `speed` and none `doppler` beside it (topics.front.doppler)"),
        "{error}"
    );
    let of_lidar = SPARSE.replace("kind = 'lidar',", "kind = 'lidar', doppler = 'x',");
    assert!(Settings::from_toml(&of_lidar, &[]).is_err());
}

#[test]
fn a_radar_that_tells_both_kinds_of_coordinates_lies_at_x_y_z() {
    let both = [("x", 3.0), ("y", 4.0), ("z", 0.0), ("range", 5.1), ("azimuth", 53.0), ("elevation", 0.1)];
    let (_folder, path) = recording(|drive, to| {
        odometry(drive, to);
        write(to, "/front", [cloud(drive, 50, "radar", &both)]);
        write(to, "/roof", [revolution(drive, 60, &[0.0])]);
    });
    for elevation in ["true", "false"] {
        let key = format!("kind = 'radar', elevation = {elevation},");
        let drive = open_file(&path, &SPARSE.replace("kind = 'radar',", &key)).unwrap();
        let scan = drive.radar_scan(0, 0).unwrap();
        assert_eq!((scan.positions[0].x, scan.positions[0].y, scan.spherical[0].range), (3.0, 4.0, 5.0));
        assert_eq!(scan.columns[4], [53.0], "it is kept as it is");
    }
}

/// Neither the topic nor a field in small letters says what it is.
#[test]
fn a_radar_is_known_by_its_frame_and_by_fields_in_capitals() {
    let capitals = [("x", 8.0), ("y", 1.0), ("z", 0.5), ("v", -2.0), ("RCS", 3.0), ("range", 9.0)];
    let plain = [("x", 8.0), ("y", 1.0), ("z", 0.5)];
    let (_folder, path) = recording(|drive, to| {
        odometry(drive, to);
        write(to, "/detections/one", [cloud(drive, 50, "front", &capitals)]);
        write(to, "/detections/two", [cloud(drive, 50, "ARS_548", &plain)]);
        write(to, "/detections/three", [cloud(drive, 50, "roof", &plain)]);
    });
    let guess = guess(&path).unwrap();
    let kind = |name: &str| guess.topics[name].kind;
    let names = ["detections_one", "detections_two", "detections_three"];
    assert_eq!(names.map(kind), [TopicKind::Radar, TopicKind::Radar, TopicKind::Lidar]);
    assert_eq!(guess.topics["detections_one"].doppler.as_deref(), Some("v"));
    assert_eq!(guess.topics["detections_two"].model.as_deref(), Some("ars548"));
}

#[test]
fn two_topics_of_one_radar_are_remarked() {
    let (_folder, path) = recording(|drive, to| {
        odometry(drive, to);
        let scans = || [50, 100].map(|ms| cloud(drive, ms, "radar", &OF_TI));
        write(to, "/radar/filtered", scans());
        write(to, "/radar/raw", scans());
        write(to, "/radar/other", [50, 101].map(|ms| cloud(drive, ms, "radar", &OF_TI)));
    });
    let guess = guess(&path).unwrap();
    let told = "/radar/raw has the frame and the times of /radar/filtered: if they are one radar's, leave one of them out";
    assert_eq!(
        guess.remarks.iter().filter(|remark| remark.contains("the times of")).collect::<Vec<_>>(),
        [told]
    );
    assert_eq!(guess.topics.values().filter(|topic| topic.kind == TopicKind::Radar).count(), 3);
}

#[test]
fn messages_from_before_their_driver_knew_the_time_take_the_recorders() {
    let (_folder, path) = recording(|drive, to| {
        let unstamped = Drive { stamped: false, ..Drive::default() };
        write(to, "/odom", [(0, unstamped.odometry(0))]);
        odometry(drive, to);
        // Recorded 30 ms after they were measured.
        let scans = [(0, &unstamped), (50, &unstamped), (100, drive), (150, drive), (200, drive)];
        write(to, "/front", scans.map(|(ms, drive)| (ms + 30, scan(drive, ms, &[0.5, 1.0]).1)));
        write(to, "/roof", [revolution(drive, 60, &[0.0])]);
    });
    let drive = open_file(&path, SPARSE).unwrap();
    assert_eq!(drive.sequence().times.radars[0], [0, 50, 100, 150, 200].map(|ms| T0 + ms * MS));
    assert_eq!(drive.radar_scan(0, 0).unwrap().len(), 2);
    assert_eq!(drive.sequence().motion.poses().len(), 8, "the pose without a time is not used");
    let told = [
        "/front: 2 of 5 messages have no time (header.stamp is 0): they take the recorder's, less the usual delay",
        "/odom: 1 of 9 messages have no time (header.stamp is 0): they are not used",
    ];
    assert_eq!(of_others(drive.as_ref()), told);
}

/// A frame 1.4 m ahead of the rear axle, in a turn.
#[test]
fn where_the_frame_goes_sideways_the_poses_tell_the_velocity() {
    let turning = |drive: &Drive, ms: i64| {
        let twist = Twist { linear: [10.0, 0.56, 0.0], angular: [0.0, 0.0, 0.4] };
        let s = ms as f64 * 1e-3;
        let pose = Pose { position: [10.0 * s, 0.56 * s, 0.0], ..Pose::default() };
        Odometry { twist, pose, ..drive.odometry(ms) }
    };
    let (_folder, path) = recording(|drive, to| {
        write(to, "/odom", (0..8).map(|k| (100 * k, turning(drive, 100 * k))));
        write(to, "/front", [scan(drive, 350, &[0.5, 1.0])]);
        write(to, "/roof", [revolution(drive, 360, &[0.0])]);
    });
    let drive = open_file(&path, SPARSE).unwrap();
    assert!(
        drive.warnings()[0].contains("the vehicle's frame goes sideways, by up to 0.6 m/s"),
        "{:?}",
        drive.warnings()
    );
    let (velocity, _) = drive.sequence().motion.twist(T0 + 350 * MS);
    assert!((velocity.x - 10.0).abs() < 1e-6 && (velocity.y - 0.56).abs() < 1e-6, "{velocity}");
    let twist = open_file(&path, &SPARSE.replace("'odometry'", "'twist', vehicle_frame = 'base'")).unwrap();
    assert!(
        twist.warnings()[0].contains("which is not used: a frame above the rear axle"),
        "{:?}",
        twist.warnings()
    );
    assert_eq!(twist.sequence().motion.odometry().len(), 8);
}
