//! Scans without a point, topics without a message, and motion of which little is told.

use super::*;
use ralf_ros::message::Message;

/// A recording of a LiDAR, a radar and a tree of frames, and what else is filled in.
pub(super) fn recording(fill: impl FnOnce(&Drive, &mut MessageWriter<File>)) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drive.mcap");
    let mut to = MessageWriter::mcap(File::create(&path).unwrap(), Compression::None).unwrap();
    let drive = Drive::default();
    let frames: Topic<TfMessage> = to.topic("/tf_static", Delivery::Latched).unwrap();
    to.write(&frames, T0, &drive.transform(0, ["base", "radar"], [3.0, 0.0, 0.5])).unwrap();
    to.write(&frames, T0, &drive.transform(0, ["base", "lidar"], [0.0, 0.0, 2.0])).unwrap();
    fill(&drive, &mut to);
    to.finish().unwrap();
    (folder, path)
}

/// Writes messages of a topic, each at its time, ms.
pub(super) fn write<M: Message>(
    to: &mut MessageWriter<File>,
    topic: &str,
    messages: impl IntoIterator<Item = (i64, M)>,
) {
    let topic: Topic<M> = to.topic(topic, Delivery::Live).unwrap();
    messages.into_iter().for_each(|(ms, message)| to.write(&topic, T0 + ms * MS, &message).unwrap());
}

pub(super) fn odometry(drive: &Drive, to: &mut MessageWriter<File>) {
    write(to, "/odom", (0..8).map(|k| (100 * k, drive.odometry(100 * k))));
}

/// A radar's scan with detections at these heights.
pub(super) fn scan(drive: &Drive, ms: i64, heights: &[f32]) -> (i64, PointCloud2) {
    let detections: Vec<[f32; 5]> = heights.iter().map(|z| [8.0, 1.0, *z, 1.0, 0.0]).collect();
    (ms, drive.cloud(ms, &detections, "vx"))
}

/// One without detections, whose driver leaves the fields out then.
fn nothing(drive: &Drive, ms: i64) -> (i64, PointCloud2) {
    (ms, PointCloud2 { fields: Vec::new(), point_step: 0, ..scan(drive, ms, &[]).1 })
}

/// A LiDAR's scan, two metres from point to point, with the time of each, s.
pub(super) fn revolution(drive: &Drive, ms: i64, times: &[f32]) -> (i64, PointCloud2) {
    let points: Vec<[f32; 5]> =
        times.iter().enumerate().map(|(k, t)| [10.0 + 2.0 * k as f32, 0.0, 0.0, *t, 0.0]).collect();
    (ms, PointCloud2 { header: drive.header(ms, "lidar"), ..drive.cloud(ms, &points, "time") })
}

pub(super) const SPARSE: &str = "
[topics]
tf_static = { topic = '/tf_static', kind = 'tf_static' }
front = { topic = '/front', kind = 'radar', model = 'generic' }
roof = { topic = '/roof', kind = 'lidar', model = 'generic' }
odom = { topic = '/odom', kind = 'odometry' }
";

fn without(name: &str) -> String {
    SPARSE.lines().filter(|line| !line.starts_with(name)).fold(String::new(), |text, line| text + line + "\n")
}

#[test]
fn the_first_scan_whose_times_differ_tells_how_points_tell_theirs() {
    let spread = [-0.04, 0.04];
    for first in [&[][..], &[0.0], &[0.0, 0.0], &[f32::NAN, 0.1]] {
        let (_folder, path) = recording(|drive, to| {
            odometry(drive, to);
            let roof = [(100, first), (200, &spread), (300, &[])];
            write(to, "/roof", roof.map(|(ms, times)| revolution(drive, ms, times)));
        });
        let drive = open_file(&path, &without("front")).unwrap();
        assert!(
            drive.warnings()[0].contains("points carry their times (`time`, s)"),
            "{:?}",
            drive.warnings()
        );
        assert_eq!(drive.lidar_scan(0, 1).unwrap().times.unwrap(), spread);
        assert_eq!(drive.rolling_scan(0, 2).unwrap().unwrap().times, Some(vec![]));
    }
}

/// Nanoseconds: the first scan is half a millisecond long, or has a stray time, and the others are whole.
#[test]
fn a_scan_that_is_cut_short_does_not_tell_the_unit_alone() {
    let whole = [0.0, 9.9e7];
    for scans in
        [&[[0.0, 5e5], whole][..], &[[0.0, 5e5], [0.0, 4e5], whole, whole], &[[0.0, 3.0], whole, whole]]
    {
        let (_folder, path) = recording(|drive, to| {
            odometry(drive, to);
            let roof = scans.iter().zip(1..).map(|(times, k)| revolution(drive, 100 * k, times));
            write(to, "/roof", roof.collect::<Vec<_>>());
        });
        let drive = open_file(&path, &without("front")).unwrap();
        assert!(
            drive.warnings()[0].contains("points carry their times (`time`, ns)"),
            "{:?}",
            drive.warnings()
        );
        assert_eq!(drive.lidar_scan(0, scans.len() - 1).unwrap().times.unwrap(), [0.0, 0.099]);
    }
}

/// Seconds: most scans have a stray time, and one has none.
#[test]
fn a_scan_among_strange_ones_does_not_tell_the_unit_for_them() {
    let (_folder, path) = recording(|drive, to| {
        odometry(drive, to);
        let times = |k: i64| if k == 4 { [0.0, 0.1] } else { [0.0, 1e10] };
        write(to, "/roof", (1..8).map(|k| revolution(drive, 100 * k, &times(k))));
    });
    let drive = open_file(&path, &without("front")).unwrap();
    let told = "roof: `time` from 0 to 10000000000 is a time of points in no known unit, and is not used";
    assert_eq!(drive.warnings(), [told]);
    for scan in 0..7 {
        assert!(drive.lidar_scan(0, scan).unwrap().times.is_none());
    }
}

#[test]
fn times_that_never_differ_are_told_and_not_used() {
    let (_folder, path) = recording(|drive, to| {
        odometry(drive, to);
        let roof = [&[][..], &[0.0, 0.0], &[0.5, 0.5]].into_iter().zip([100, 200, 300]);
        write(to, "/roof", roof.map(|(times, ms)| revolution(drive, ms, times)));
    });
    let drive = open_file(&path, &without("front")).unwrap();
    let told = "roof: `time` is the same for all points of each scan, and is not used";
    assert_eq!(drive.warnings(), [told]);
    assert!(drive.lidar_scan(0, 1).unwrap().times.is_none());
    // Whoever says that points are of one time needs no word of it.
    let done = without("front").replace("kind = 'lidar'", "kind = 'lidar', motion_corrected = true");
    assert_eq!(open_file(&path, &done).unwrap().warnings(), [""; 0]);
}

#[test]
fn a_scan_without_detections_needs_no_fields() {
    let (_folder, path) = recording(|drive, to| {
        odometry(drive, to);
        let with = |ms| scan(drive, ms, &[0.0, 0.5]);
        write(to, "/front", [nothing(drive, 0), with(100), nothing(drive, 200), with(300)]);
        write(to, "/roof", [(0, PointCloud2 { header: drive.header(0, "lidar"), ..nothing(drive, 0).1 })]);
        write(to, "/rear", [nothing(drive, 0), nothing(drive, 100)]);
    });
    let rear = "rear = { topic = '/rear', kind = 'radar', model = 'generic' }\n";
    let drive = open_file(&path, &(SPARSE.to_owned() + rear)).unwrap();
    let radars = &drive.sequence().rig.radars;
    assert_eq!(radars[0].fields, ["x", "y", "z", "vx", "vy", "doppler"]);
    let lengths = |radar: usize, scans: usize| -> Vec<usize> {
        (0..scans).map(|scan| drive.radar_scan(radar, scan).unwrap().len()).collect()
    };
    assert_eq!((lengths(0, 4), lengths(1, 2)), (vec![0, 2, 0, 2], vec![0, 0]));
    assert_eq!(radars[1].fields, ["x", "y", "z"], "nothing tells any");
    assert_eq!(drive.lidar_scan(0, 0).unwrap().points, [[0.0; 3]; 0]);
    assert_eq!(guess(&path).unwrap().topics["front"].elevation, Some(true));
}

#[test]
fn a_guess_of_elevation_takes_scans_with_detections() {
    let elevation = |heights: &[&[f32]]| {
        let (_folder, path) = recording(|drive, to| {
            let late = heights.iter().zip(12..).map(|(heights, k)| scan(drive, 100 * k, heights));
            write(to, "/radar", (0..12).map(|k| scan(drive, 100 * k, &[])).chain(late).collect::<Vec<_>>());
        });
        let guess = guess(&path).unwrap();
        assert_eq!(guess.topics["radar"].kind, TopicKind::Radar);
        guess.topics["radar"].elevation
    };
    assert_eq!(elevation(&[&[0.5], &[0.75, 1.0]]), Some(true));
    assert_eq!(elevation(&[&[0.0, 0.0]]), Some(false));
    assert_eq!(elevation(&[&[0.5]]), None, "the model tells it");
    assert_eq!(elevation(&[]), None);
}

#[test]
fn a_topic_without_messages_is_a_sensor_without_measurements() {
    let (_folder, path) = recording(|drive, to| {
        odometry(drive, to);
        write(to, "/front", [scan(drive, 0, &[0.5])]);
        write::<PointCloud2>(to, "/rear", []);
        write::<PointCloud2>(to, "/roof", []);
        write::<Image>(to, "/cam", []);
        write::<CameraInfo>(to, "/info", []);
        write::<Imu>(to, "/imu", []);
    });
    let more = "rear = { topic = '/rear', kind = 'radar', model = 'generic', frame = 'radar' }
                imu = { topic = '/imu', kind = 'imu' }
                cam = { topic = '/cam', kind = 'camera', info = '/info' }";
    let drive = open_file(&path, &(SPARSE.to_owned() + more)).unwrap();
    let sequence = drive.sequence();
    let names: Vec<&str> = sequence.rig.radars.iter().map(|radar| radar.name.as_str()).collect();
    assert_eq!((names, &sequence.times.radars), (vec!["front", "rear"], &vec![vec![T0], vec![]]));
    assert_eq!(sequence.rig.radars[1].vehicle_from_radar.translation.x, 3.0);
    // What has no frame has no place.
    assert_eq!((sequence.rig.lidars.len(), drive.absent()), (0, &["cam".to_owned(), "roof".to_owned()][..]));
    let left_out = "nothing tells its frame";
    let told = [
        "/imu: no messages",
        &format!("cam: no messages of /cam, and {left_out} (`topics.cam.frame` would): left out"),
        "rear: no messages of /rear",
        &format!("roof: no messages of /roof, and {left_out} (`topics.roof.frame` would): left out"),
    ];
    assert_eq!((drive.warnings(), drive.lost()), (&told.map(str::to_owned)[..], &[][..]));
}

#[test]
fn without_a_word_of_motion_the_vehicle_is_known_by_the_tree_or_the_settings() {
    let (_folder, path) = recording(|drive, to| {
        write(to, "/front", [scan(drive, 0, &[0.5])]);
        write(to, "/roof", [revolution(drive, 0, &[])]);
        write(to, "/imu", [(0, Imu { header: drive.header(0, "imu"), ..Imu::default() })]);
    });
    let guess = guess(&path).unwrap();
    let of_tree = "neither odometry nor a twist names the vehicle's frame: by the tree of frames `base` is taken for it";
    assert_eq!(guess.remarks, ["/imu is not used: it tells no velocity", of_tree]);
    assert_eq!(guess.topics["tf_static"].vehicle_frame.as_deref(), Some("base"));
    assert!(topics_toml(&guess).unwrap().contains("\nvehicle_frame = \"base\"\n"));
    let named = without("odom").replace("'tf_static' }", "'tf_static', vehicle_frame = 'base' }");
    for drive in
        [crate::read::open(&path, None).unwrap().sequences.remove(0), open_file(&path, &named).unwrap()]
    {
        let sequence = drive.sequence();
        assert!(!sequence.motion.is_known());
        assert_eq!(sequence.rig.radars[0].vehicle_from_radar.translation.x, 3.0);
    }
    let refused = open_file(&path, &without("odom")).err().unwrap().to_string();
    assert!(refused.contains("`topics.tf_static.vehicle_frame = \"base_link\"`"), "{refused}");
}

/// An IMU 2 m ahead of the vehicle's frame, in which everything else is placed.
#[test]
fn odometry_of_a_part_is_taken_over_to_the_vehicle() {
    let (_folder, path) = recording(|drive, to| {
        let fixed = [(["base_link", "base"], 1.0), (["base_link", "imu"], 2.0)];
        write(to, "/tf_static", fixed.map(|(frames, x)| (0, drive.transform(0, frames, [x, 0.0, 0.0]))));
        write(to, "/front", [scan(drive, 0, &[0.5])]);
        let of_imu = |ms| Odometry { child_frame_id: "imu".to_owned(), ..drive.odometry(ms) };
        write(to, "/odom", (0..8).map(|k| (100 * k, of_imu(100 * k))));
    });
    let told = "the motion is told of `imu`, which is fixed to `base_link`: `base_link` is taken for the vehicle's frame";
    assert!(guess(&path).unwrap().remarks.contains(&told.to_owned()));
    let drive = crate::read::open(&path, None).unwrap().sequences.remove(0);
    let sequence = drive.sequence();
    assert_eq!(sequence.rig.radars[0].vehicle_from_radar.translation.x, 4.0);
    assert_eq!(sequence.motion.poses()[0].odom_from_vehicle.translation.x, -2.0);
    // A table that names no frame means the odometry's own, as ever.
    let as_told = open_file(&path, &without("roof")).unwrap();
    assert_eq!(as_told.sequence().rig.radars[0].vehicle_from_radar.translation.x, 2.0);
    assert_eq!(as_told.sequence().motion.poses()[0].odom_from_vehicle.translation.x, 0.0);
}

/// Programs that estimate poses leave the twist at zero, or at NaN.
#[test]
fn velocities_that_are_none_are_not_taken() {
    let velocities = |speed: fn(i64) -> f64, metres: f64| {
        let (_folder, path) = recording(|drive, to| {
            write(to, "/front", [scan(drive, 0, &[0.5])]);
            let message = |k: i64| {
                let twist = Twist { linear: [speed(k), 0.0, 0.0], angular: [0.0; 3] };
                let pose = Pose { position: [metres * k as f64, 0.0, 0.0], ..Pose::default() };
                (100 * k, Odometry { pose, twist, ..drive.odometry(100 * k) })
            };
            write(to, "/odom", (0..8).map(message));
        });
        let drive = open_file(&path, &without("roof")).unwrap();
        let motion = &drive.sequence().motion;
        assert_eq!(motion.poses().len(), 8);
        (motion.odometry().len(), motion.twist(T0 + 350 * MS).0.x.round(), drive.warnings().concat())
    };
    let (samples, speed, told) = velocities(|_| 0.0, 0.8);
    assert_eq!((samples, speed), (0, 8.0), "the poses tell it");
    assert!(told.starts_with("/odom: all its velocities are 0 while the poses move by 6 m: "), "{told}");
    let (samples, speed, told) = velocities(|_| f64::NAN, 0.8);
    assert_eq!(
        (samples, speed, told.as_str()),
        (0, 8.0, "/odom: 8 of 8 twists are no numbers, and not used")
    );
    let (samples, speed, told) = velocities(|k| if k == 2 { f64::NAN } else { 7.0 }, 0.8);
    assert_eq!(
        (samples, speed, told.as_str()),
        (7, 7.0, "/odom: 1 of 8 twists are no numbers, and not used")
    );
    assert_eq!(velocities(|_| 0.0, 0.01), (8, 0.0, String::new()), "a parked vehicle");
}

/// The yaw rate comes from the nearest messages of the IMU that are numbers; from the odometry where none of them is.
#[test]
fn what_an_imu_tells_that_is_no_number_is_not_used() {
    let rates = |told: [f64; 3]| {
        let (_folder, path) = recording(|drive, to| {
            odometry(drive, to);
            write(to, "/front", [scan(drive, 0, &[0.5])]);
            let message = |(rate, k): (f64, i64)| {
                let (header, angular_velocity) = (drive.header(350 * k, "base"), [0.0, 0.0, rate]);
                (350 * k, Imu { header, angular_velocity, ..Imu::default() })
            };
            write(to, "/imu", told.into_iter().zip(0..).map(message));
        });
        let text = without("roof") + "imu = { topic = '/imu', kind = 'imu' }";
        let drive = open_file(&path, &text).unwrap();
        let rates: Vec<f64> =
            drive.sequence().motion.odometry().iter().map(|sample| sample.yaw_rate).collect();
        (rates, drive.warnings().concat())
    };
    let told = |count: usize| format!("/imu: {count} of 3 twists are no numbers, and not used");
    assert_eq!(rates([0.5, f64::NAN, 0.5]), (vec![0.5; 8], told(1)));
    assert_eq!(rates([f64::NAN, 0.5, f64::INFINITY]), (vec![0.5; 8], told(2)));
    assert_eq!(rates([f64::NAN; 3]), (vec![0.1; 8], told(3)));
}

/// A mast is told of now and then, and by numbers that tremble: from 20 to 60 ms, or before and after all scans.
#[test]
fn a_mounting_is_held_where_nothing_tells_of_it() {
    let trembling = [3.0, 3.000_000_1, 3.0 + 4e-16, 3.004];
    for ms in [[-10, 20, 60, 200], [20, 30, 50, 60], [20, 30, 50, 200], [-40, -30, -20, -10]] {
        let mast: Vec<(i64, f64)> = ms.into_iter().zip(trembling).collect();
        let (_folder, path) = Drive { mast, ..Drive::default() }.write();
        let opened = open_file(&path, TABLE).unwrap();
        let x = opened.sequence().rig.radars[0].vehicle_from_radar.translation.x;
        assert!((x - 3.5).abs() <= 0.005 && opened.warnings().is_empty(), "{x} of {ms:?}");
    }
}

/// A program that has just begun has no pose yet, and one that loses its way has none for a while.
#[test]
fn odometry_without_a_pose_is_not_used() {
    let opened = |nones: std::ops::Range<i64>| {
        let (_folder, path) = recording(|drive, to| {
            write(to, "/front", [scan(drive, 0, &[0.5])]);
            let none = Pose { orientation: [0.0; 4], ..Pose::default() };
            let message = |k: i64| match drive.odometry(100 * k) {
                odometry if nones.contains(&k) => {
                    (100 * k, Odometry { pose: none, twist: Twist::default(), ..odometry })
                }
                odometry => (100 * k, odometry),
            };
            write(to, "/odom", (0..20).map(message));
        });
        open_file(&path, &without("roof"))
    };
    // At the begin, at the end, and for a second between two poses.
    for nones in [0..2, 0..15, 5..20, 5..14] {
        let lost = nones.clone().count();
        let drive = opened(nones).unwrap();
        let told = format!(
            "/odom: {lost} of 20 messages have no pose (a finite position and a unit quaternion), and are not used"
        );
        assert_eq!(drive.warnings()[0], told);
        let motion = &drive.sequence().motion;
        assert_eq!((motion.poses().len(), motion.odometry().len()), (20 - lost, 20 - lost));
        assert!(motion.odometry().iter().all(|sample| sample.velocity == 8.0));
    }
    for (nones, k) in [(0..20, 0), (5..15, 5), (1..19, 1)] {
        let refused = opened(nones).err().unwrap().to_string();
        let place = format!("/odom at {} ns", T0 + 100 * k * MS);
        assert!(refused.contains(&place), "{refused}");
        assert!(refused.contains("(the kind twist takes the velocities alone), found Pose"), "{refused}");
    }
}

/// A gripper's transform that is none, a mast that is told of twice, and a vehicle in two frames.
#[test]
fn a_transform_that_is_none_costs_those_alone_who_need_it() {
    let opened = |at: [&'static str; 2], turned: [f64; 4], kind: &str| {
        let (_folder, path) = recording(|drive, to| {
            odometry(drive, to);
            write(to, "/front", [scan(drive, 0, &[0.5])]);
            let mut message = drive.transform(0, at, [3.0, 0.0, 0.5]);
            message.transforms[0].transform.orientation = turned;
            let fixed = drive.transform(0, ["odom", "base"], [0.0; 3]);
            write(to, "/tf_static", [(1, fixed), (2, message.clone()), (3, message)]);
        });
        open_file(&path, &without("roof").replace("'tf_static' }", kind))
    };
    let (none, unturned, kind) = ([0.0; 4], [0.0, 0.0, 0.0, 1.0], "'tf_static' }");
    for (at, turned, reason) in [
        (
            ["base", "gripper"],
            none,
            "transforms gripper in base: expected finite numbers and a unit quaternion",
        ),
        (["map", "base"], unturned, "transforms base: expected one parent, found odom and map"),
    ] {
        let drive = opened(at, turned, kind).unwrap();
        let [told] = drive.warnings() else { panic!("{:?}", drive.warnings()) };
        let count = format!("2 transforms of the frame `{}` are not used; the first: ", at[1]);
        assert!(told.starts_with(&count) && told.contains(reason), "{told}");
    }
    assert!(opened(["base", "radar"], unturned, kind).unwrap().warnings().is_empty(), "told again");
    let error = |at, turned, kind| opened(at, turned, kind).err().unwrap().to_string();
    assert!(
        error(["base", "radar"], none, kind).contains("transforms radar in base: expected finite numbers")
    );
    assert!(error(["mast", "radar"], unturned, kind).contains("transforms radar: expected one parent"));
    // Where the way to the vehicle's frame lacks it, it is told, too.
    let lacking = error(["base", "car"], none, "'tf_static', vehicle_frame = 'car' }");
    assert!(
        lacking.contains("no frame `car`") && lacking.contains("; 2 transforms of the frame `car`"),
        "{lacking}"
    );
}

/// Detections at (2, 3, 6), 7 m away, whose velocities are (7, 14) and what the third field holds.
#[test]
fn range_rates_lie_along_the_ray_that_is_measured() {
    let doppler = |elevation: &str, third: &str, values: &[f32]| {
        let (_folder, path) = recording(|drive, to| {
            odometry(drive, to);
            let mut cloud = drive.cloud(0, &vec![[2.0, 3.0, 6.0, 7.0, 14.0]; values.len()], "vx");
            cloud.fields.push(PointField::new(third, 20, Datatype::Float32));
            let rows = cloud.data.chunks(20).zip(values);
            cloud.data = rows.flat_map(|(row, value)| [row, &value.to_le_bytes()].concat()).collect();
            (cloud.point_step, cloud.row_step) = (24, 24 * cloud.width);
            write(to, "/front", [(0, cloud)]);
        });
        let table = without("roof").replace("'generic'", &format!("'generic', elevation = {elevation}"));
        let drive = open_file(&path, &table).unwrap();
        assert_eq!(drive.sequence().rig.radars[0].fields[6], "doppler");
        drive.radar_scan(0, 0).unwrap().columns[6].clone()
    };
    assert_eq!(doppler("true", "vz", &[21.0, 0.0]), [26.0, 8.0]);
    let in_plane = doppler("true", "other", &[21.0])[0];
    assert!((in_plane - 56.0 / 13.0_f32.sqrt()).abs() < 1e-5, "{in_plane}");
    assert_eq!(doppler("false", "vz", &[21.0]), [in_plane]);
    // Drivers that don't know the third component leave it at NaN, or at 0 in the whole scan.
    assert_eq!(doppler("true", "vz", &[21.0, f32::NAN, f32::INFINITY]), [26.0, in_plane, in_plane]);
    assert_eq!(doppler("true", "vz", &[0.0, -0.0]), [in_plane; 2]);
    assert_eq!(doppler("true", "vz", &[f32::NAN, 0.0]), [in_plane; 2]);
}

/// A LiDAR on a tripod, in whose frame the vehicle, which stands still, is placed.
#[test]
fn a_cloud_in_a_frame_of_the_world_is_taken_where_it_is_fixed_to_the_vehicle() {
    let guessed = |edges: &[[&'static str; 2]], moves: bool| {
        let (folder, path) = recording(|drive, to| {
            let of_map = PointCloud2 { header: drive.header(0, "map"), ..revolution(drive, 0, &[0.0]).1 };
            write(to, "/lidar", [(0, of_map)]);
            write(to, "/radar", [scan(drive, 0, &[0.5, 1.0])]);
            write(to, "/tf_static", edges.iter().map(|edge| (0, drive.transform(0, *edge, [1.0, 0.0, 0.0]))));
            if moves {
                odometry(drive, to);
            }
        });
        let guess = guess(&path).unwrap();
        (folder, path, guess)
    };
    let standing = [["map", "base_link"], ["base_link", "base"]];
    for (edges, moves) in [(&standing[..], false), (&[["map", "base"]], true)] {
        let (_folder, path, guess) = guessed(edges, moves);
        assert_eq!(guess.topics["lidar"].kind, TopicKind::Lidar);
        let drive = crate::read::open(&path, None).unwrap().sequences.remove(0);
        let x = drive.sequence().rig.lidars[0].vehicle_from_lidar.translation.x;
        assert_eq!(x, -1.0, "{edges:?}");
    }
    let moving = [["map", "odom"], ["base_link", "base"]];
    for (edges, moves) in [(&moving[..], false), (&standing[1..], true), (&[["map", "base"]], false)] {
        let guess = guessed(edges, moves).2;
        assert!(!guess.topics.contains_key("lidar"), "{edges:?}");
        let told = "/lidar is not used: its points lie in the frame `map`, which is no part of a vehicle";
        assert!(guess.remarks.contains(&told.to_owned()), "{:?}", guess.remarks);
    }
}

#[test]
fn a_guess_knows_names_in_capitals_maps_and_names_that_are_taken() {
    let (_folder, path) = recording(|drive, to| {
        odometry(drive, to);
        write(to, "/RADAR_FRONT", [(0, drive.cloud(0, &[[8.0; 5]], "other"))]);
        write(to, "/ground_truth/points", [revolution(drive, 0, &[0.0])]);
        let map = PointCloud2 { header: drive.header(0, "/map"), ..revolution(drive, 0, &[0.0]).1 };
        write(to, "/surroundings", [(0, map)]);
    });
    let guess = guess(&path).unwrap();
    let found: Vec<(&str, TopicKind)> =
        guess.topics.iter().map(|(name, topic)| (name.as_str(), topic.kind)).collect();
    use TopicKind::{Lidar, Odometry, Radar, TfStatic};
    let expected =
        [("RADAR_FRONT", Radar), ("ground_truth_points", Lidar), ("odom", Odometry), ("tf_static", TfStatic)];
    assert_eq!(found, expected);
    let told = "/surroundings is not used: its points lie in the frame `/map`, which is no part of a vehicle";
    assert_eq!(guess.remarks, [told]);
}

/// Nothing is written by the name of an odometry.
#[test]
fn only_a_sensor_is_not_called_as_the_folder_of_truth() {
    let (_folder, path) = recording(|drive, to| {
        write(to, "/ground_truth", (0..8).map(|k| (100 * k, drive.odometry(100 * k))));
        write(to, "/ground_truth/points", [scan(drive, 0, &[0.5, 1.0])]);
    });
    let guess = guess(&path).unwrap();
    assert_eq!(guess.topics["ground_truth"].kind, TopicKind::Odometry);
    assert!(guess.topics.contains_key("ground_truth_points"), "{:?}", guess.topics);
    let drive = open_file(&path, &topics_toml(&guess).unwrap()).unwrap();
    assert_eq!(drive.sequence().motion.poses().len(), 8);
}
