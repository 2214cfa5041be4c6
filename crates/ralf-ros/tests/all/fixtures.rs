//! Files that other programs wrote (`testdata/make_ros.py`): every container, compression and encoding gives the same
//! messages.

use ralf_ros::container::{Container, recognises};
use ralf_ros::message::*;
use ralf_ros::point_cloud::PointTable;
use std::path::{Path, PathBuf};

const FILES: [&str; 10] = [
    "plain.bag",
    "bz2.bag",
    "lz4.bag",
    "plain.mcap",
    "lz4.mcap",
    "zstd.mcap",
    "ros1.mcap",
    "db3",
    "db3_zstd",
    "folder",
];

const START: i64 = 1_500_000_000_000_000_000;
const STEP: i64 = 77_000_000;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/ros").join(name)
}

/// All messages of a topic, in the order of the file.
fn read<M: Message>(container: &Container, name: &str) -> Vec<M> {
    let place = container.topics().iter().position(|topic| topic.name == name).unwrap();
    let topic = &container.topics()[place];
    assert!(M::DEFINITION.is(&topic.type_name), "{name}: {}", topic.type_name);
    let encoding = topic.known_encoding().unwrap();
    let messages = container.messages().iter().filter(|message| container.topic_of(message) == place);
    let decoded: Vec<M> =
        messages.map(|message| M::from_bytes(encoding, &container.read(message).unwrap()).unwrap()).collect();
    assert_eq!(decoded.len(), topic.count);
    decoded
}

#[test]
fn every_file_holds_the_same_clouds() {
    for name in FILES {
        assert!(recognises(&fixture(name)), "{name}");
        let container = Container::open(&fixture(name)).unwrap();
        assert_eq!(container.losses(), [], "{name}");
        assert_eq!((container.topics().len(), container.messages().len()), (9, 11), "{name}");
        let clouds: Vec<PointCloud2> = read(&container, "/radar/points");
        let stamps = [1, 0, 2].map(|k| START + k * STEP);
        assert_eq!(clouds.iter().map(|cloud| cloud.header.stamp_ns).collect::<Vec<_>>(), stamps, "{name}");
        for (cloud, k) in clouds.iter().zip([1.0, 0.0, 2.0]) {
            assert_eq!(cloud.is_bigendian, k == 1.0);
            let table = PointTable::new(cloud).unwrap();
            assert_eq!(table.names().collect::<Vec<_>>(), ["rcs", "x", "y", "z", "invalid_state", "ring"]);
            let column = |name| table.column(name).unwrap();
            assert_eq!(column("x"), [10.5, 11.5], "{name}");
            assert_eq!(column("y"), [-2.25 - k; 2]);
            assert_eq!(column("z"), [0.125; 2]);
            assert_eq!(column("invalid_state"), [200.0, 201.0]);
            assert_eq!(column("ring"), [60000.0, 60001.0]);
        }
    }
}

#[test]
fn every_file_holds_the_same_of_each_type() {
    for name in FILES {
        let container = Container::open(&fixture(name)).unwrap();
        let transforms = read::<TfMessage>(&container, "/tf_static").remove(0).transforms;
        let [transform] = transforms.as_slice() else { panic!("{name}: {transforms:?}") };
        assert_eq!(
            (transform.header.frame_id.as_str(), transform.child_frame_id.as_str()),
            ("base_link", "radar")
        );
        assert_eq!(
            transform.transform,
            Pose { position: [3.5, 0.25, 0.5], orientation: [0.0, 0.0, 0.0, 1.0] }
        );
        let odometry = read::<Odometry>(&container, "/odom").remove(0);
        assert_eq!((odometry.pose.position, odometry.twist.linear), ([1.0, 2.0, 3.0], [8.0, 0.0, 0.0]));
        assert_eq!(odometry.child_frame_id, "base_link");
        assert_eq!(read::<TwistStamped>(&container, "/twist")[0].twist.angular, [0.0, 0.0, 0.25]);
        let imu = read::<Imu>(&container, "/imu").remove(0);
        assert_eq!((imu.angular_velocity, imu.linear_acceleration), ([0.0, 0.0, 0.5], [0.0, 0.0, 9.81]));
        let scan = read::<RadarScan>(&container, "/scan").remove(0);
        assert_eq!(scan.returns[0].values(), [20.0, 0.5, 0.25, -3.0, 12.0]);
        let info = read::<CameraInfo>(&container, "/cam/camera_info").remove(0);
        assert_eq!((info.width, info.height, info.d), (640, 480, vec![0.1, 0.2, 0.3, 0.4, 0.5]));
        assert_eq!((info.k[0], info.p[6]), (500.0, 240.0));
        let image = read::<Image>(&container, "/cam/image_raw").remove(0);
        assert_eq!((image.encoding.as_str(), image.width, image.data), ("rgb8", 2, vec![0, 1, 2, 3, 4, 5]));
        let compressed = read::<CompressedImage>(&container, "/cam/image_raw/compressed").remove(0);
        assert_eq!((compressed.format.as_str(), compressed.data.len()), ("jpeg", 6));
    }
}

#[test]
fn log_times_are_those_of_the_recorder() {
    for name in FILES {
        let container = Container::open(&fixture(name)).unwrap();
        let mut times: Vec<i64> = container.messages().iter().map(|message| message.log_ns).collect();
        times.sort_unstable();
        assert_eq!(times, (0..11).map(|k| START + k * STEP).collect::<Vec<_>>(), "{name}");
    }
}

/// The checksum by which ROS 1 knows a type, and its fields, as another program spells them.
#[test]
fn definitions_are_those_of_ros() {
    let bag = std::fs::read(fixture("plain.bag")).unwrap();
    let holds = |text: &str| bag.windows(text.len()).any(|window| window == text.as_bytes());
    for definition in DEFINITIONS {
        assert!(holds(&format!("md5sum={}", definition.md5)), "{}", definition.name);
        assert!(holds(&format!("type={}", definition.name)), "{}", definition.name);
    }
}
