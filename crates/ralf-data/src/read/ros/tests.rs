//! On tiny recordings made by the tests themselves.

use super::*;
use crate::read::SequenceReader;
use crate::settings::Settings;
use ralf::sensors::{Elevation, Intrinsics};
use ralf::space::Point;
use ralf_ros::message::{
    CameraInfo, Datatype, Header, Image, Imu, Odometry, PointCloud2, PointField, Pose, RadarReturn,
    RadarScan, TfMessage, TransformStamped, Twist,
};
use ralf_ros::writer::{Compression, Delivery, MessageWriter, Topic};
use std::fs::File;
use std::path::PathBuf;
use tempfile::TempDir;

const MS: i64 = 1_000_000;
const T0: i64 = 1_600_000_000_000 * MS;

/// What to change in a tiny recording.
struct Drive {
    bag: bool,
    stamped: bool,
    camera_frame: &'static str,
    infos: Vec<f64>,
    mast_moves: bool,
    vehicle: &'static str,
    radar_fields: [&'static str; 2],
}

impl Default for Drive {
    fn default() -> Self {
        let (bag, stamped, mast_moves) = (false, true, false);
        let (camera_frame, infos) = ("camera", vec![100.0]);
        let (vehicle, radar_fields) = ("base", ["vx", "vx"]);
        Self { bag, stamped, camera_frame, infos, mast_moves, vehicle, radar_fields }
    }
}

impl Drive {
    fn header(&self, ms: i64, frame: &str) -> Header {
        let stamp_ns = if self.stamped { T0 + ms * MS } else { 0 };
        Header { stamp_ns, frame_id: frame.to_owned(), ..Header::default() }
    }

    fn transform(&self, ms: i64, [parent, child]: [&str; 2], position: [f64; 3]) -> TfMessage {
        let transform = Pose { position, ..Pose::default() };
        let header = Header { stamp_ns: T0 + ms * MS, frame_id: parent.to_owned(), ..Header::default() };
        TfMessage {
            transforms: vec![TransformStamped { header, child_frame_id: child.to_owned(), transform }],
        }
    }

    /// x, y, z, two components of a velocity.
    fn cloud(&self, ms: i64, points: &[[f32; 5]], velocity: &str) -> PointCloud2 {
        let names = ["x", "y", "z", velocity, "vy"];
        let fields = names.iter().zip(0..).map(|(name, k)| PointField::new(name, 4 * k, Datatype::Float32));
        let width = points.len() as u32;
        PointCloud2 {
            header: self.header(ms, "radar"),
            height: 1,
            width,
            fields: fields.collect(),
            point_step: 20,
            row_step: 20 * width,
            data: points.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect(),
            ..PointCloud2::default()
        }
    }

    fn odometry(&self, ms: i64) -> Odometry {
        let twist = Twist { linear: [8.0, 0.0, 0.0], angular: [0.0, 0.0, 0.1] };
        let pose = Pose { position: [ms as f64 * 0.008, 0.0, 0.0], ..Pose::default() };
        let child_frame_id = self.vehicle.to_owned();
        Odometry { header: self.header(ms, "odom"), child_frame_id, pose, twist, ..Odometry::default() }
    }

    fn write(&self) -> (TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(if self.bag { "drive.bag" } else { "drive.mcap" });
        let file = File::create(&path).unwrap();
        let writer =
            if self.bag { MessageWriter::bag(file) } else { MessageWriter::mcap(file, Compression::None) };
        self.fill(writer.unwrap());
        (folder, path)
    }

    fn fill(&self, mut to: MessageWriter<File>) {
        let frames: Topic<TfMessage> = to.topic("/tf_static", Delivery::Latched).unwrap();
        to.write(&frames, T0, &self.transform(0, ["mast", "radar"], [0.5, 0.0, 0.0])).unwrap();
        to.write(&frames, T0, &self.transform(0, ["base", "camera"], [1.0, 0.0, 1.5])).unwrap();
        to.write(&frames, T0, &self.transform(0, ["base", "lidar"], [0.0, 0.0, 2.0])).unwrap();
        let moving: Topic<TfMessage> = to.topic("/tf", Delivery::Live).unwrap();
        for (ms, x) in [(-500, 3.0), (500, if self.mast_moves { 4.0 } else { 3.0 })] {
            to.write(&moving, T0, &self.transform(ms, ["base", "mast"], [x, 0.0, 0.25])).unwrap();
        }
        let clouds: Topic<PointCloud2> = to.topic("/front/points", Delivery::Live).unwrap();
        // Recorded in another order than measured.
        let near = [[4.0, 3.0, 0.0, 10.0, 5.0], [6.0, -8.0, 0.0, -1.0, 2.0]];
        to.write(&clouds, T0 + 90 * MS, &self.cloud(70, &near, self.radar_fields[0])).unwrap();
        to.write(&clouds, T0 + 95 * MS, &self.cloud(0, &near[..1], self.radar_fields[1])).unwrap();
        to.write(&clouds, T0 + 160 * MS, &self.cloud(140, &[], self.radar_fields[0])).unwrap();
        let scans: Topic<RadarScan> = to.topic("/rear/scan", Delivery::Live).unwrap();
        let detection = RadarReturn {
            range: 10.0,
            azimuth: 0.5,
            elevation: 0.25,
            doppler_velocity: -3.0,
            amplitude: 12.0,
        };
        let returns = vec![detection, RadarReturn { elevation: 0.0, ..detection }];
        to.write(&scans, T0 + 30 * MS, &RadarScan { header: self.header(20, "radar"), returns }).unwrap();
        let lidar: Topic<PointCloud2> = to.topic("/roof/points", Delivery::Live).unwrap();
        let cloud = self.cloud(60, &[[1.0, 2.0, 3.0, 0.0, 0.0]], "other");
        to.write(&lidar, T0 + 70 * MS, &PointCloud2 { header: self.header(60, "lidar"), ..cloud }).unwrap();
        let odometry: Topic<Odometry> = to.topic("/odom", Delivery::Live).unwrap();
        (0..8).for_each(|k| to.write(&odometry, T0 + 20 * k * MS, &self.odometry(20 * k)).unwrap());
        let imu: Topic<Imu> = to.topic("/imu", Delivery::Live).unwrap();
        for (ms, rate) in [(0, 0.25), (40, 0.75)] {
            let header = self.header(ms, "base");
            let angular_velocity = [0.0, 0.0, rate];
            to.write(&imu, T0 + ms * MS, &Imu { header, angular_velocity, ..Imu::default() }).unwrap();
        }
        self.fill_camera(&mut to);
        to.finish().unwrap();
    }

    fn fill_camera(&self, to: &mut MessageWriter<File>) {
        let infos: Topic<CameraInfo> = to.topic("/cam/camera_info", Delivery::Live).unwrap();
        for focal in &self.infos {
            let info = CameraInfo {
                header: self.header(50, self.camera_frame),
                height: 1,
                width: 2,
                distortion_model: "plumb_bob".to_owned(),
                d: vec![0.1, 0.0, 0.0, 0.0, 0.2],
                k: [*focal, 0.0, 1.0, 0.0, *focal, 0.5, 0.0, 0.0, 1.0],
                ..CameraInfo::default()
            };
            to.write(&infos, T0 + 60 * MS, &info).unwrap();
        }
        let images: Topic<Image> = to.topic("/cam/image_raw", Delivery::Live).unwrap();
        let header = self.header(50, self.camera_frame);
        let (height, width, step, data) = (1, 2, 6, vec![1, 2, 3, 4, 5, 6]);
        let image =
            Image { header, height, width, step, encoding: "rgb8".to_owned(), data, is_bigendian: false };
        to.write(&images, T0 + 60 * MS, &image).unwrap();
    }
}

const TABLE: &str = "
[topics]
tf = { topic = '/tf', kind = 'tf' }
tf_static = { topic = '/tf_static', kind = 'tf_static' }
front = { topic = '/front/points', kind = 'radar', model = 'ars408-21' }
rear = { topic = '/rear/scan', kind = 'radar', model = 'generic' }
roof = { topic = '/roof/points', kind = 'lidar', model = 'hdl-32e' }
cam = { topic = '/cam/image_raw', kind = 'camera', info = '/cam/camera_info' }
odom = { topic = '/odom', kind = 'odometry' }
imu = { topic = '/imu', kind = 'imu' }
";

fn table(text: &str) -> Topics {
    Settings::from_toml(text, &[]).unwrap().topics
}

fn open_file(path: &Path, text: &str) -> Result<Box<dyn SequenceReader>, DataError> {
    let recording = crate::read::open_with(path, None, &table(text))?;
    assert_eq!(recording.format, NAME);
    Ok(recording.sequences.into_iter().next().unwrap())
}

fn error(drive: &Drive, text: &str) -> String {
    let (_folder, path) = drive.write();
    open_file(&path, text).err().unwrap().to_string()
}

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
    assert!(error(&drive, TABLE).contains("`vehicle_frame` with the odometry"));
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
    assert_eq!(guess.unused, ["/imu is not used: /odom tells the motion"]);
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
fn what_a_table_asks_for_and_the_file_lacks_is_named() {
    let with = |from: &str, to: &str| error(&Drive::default(), &TABLE.replace(from, to));
    let missing = with("'/front/points'", "'/side/points'");
    assert!(missing.contains("topics.front: expected one of the topics /cam/camera_info,"), "{missing}");
    assert!(
        with("'/rear/scan', kind = 'radar'", "'/rear/scan', kind = 'lidar'")
            .contains("sensor_msgs/PointCloud2, found radar_msgs")
    );
    assert!(
        with("hdl-32e", "hdl-99").contains("topics.roof.model: expected one of the models generic, hdl-32e")
    );
    assert!(with("odom =", "# odom =").contains("`vehicle_frame`"));
    let unmoved = with(
        "odom = { topic = '/odom', kind = 'odometry' }\nimu = { topic = '/imu', kind = 'imu' }",
        "imu = { topic = '/imu', kind = 'imu', vehicle_frame = 'base' }",
    );
    assert!(unmoved.contains("which tells how the vehicle moves"), "{unmoved}");
    assert!(with("tf =", "# tf =").contains("nothing connects `base`"));
    assert!(with("'/front/points', ", "'/front/points', frame = 'side', ").contains("no frame `side`"));
    assert!(with("info = '/cam/camera_info'", "info = '/imu'").contains("topics.cam.info"));
}

#[test]
fn what_contradicts_itself_is_refused() {
    let error = |drive: &Drive| error(drive, TABLE);
    let moved = error(&Drive { mast_moves: true, ..Drive::default() });
    assert!(moved.contains("expected a sensor that doesn't move on `base`"), "{moved}");
    let changed = error(&Drive { infos: vec![100.0, 101.0], ..Drive::default() });
    assert!(changed.contains("/cam/camera_info recorded at") && changed.contains("another one"), "{changed}");
    let unknown = error(&Drive { camera_frame: "", ..Drive::default() });
    assert!(unknown.contains("frame ``"), "{unknown}");
}

#[test]
fn drivers_without_stamps_can_have_those_of_the_recorder() {
    let drive = Drive { stamped: false, ..Drive::default() };
    let refused = error(&drive, TABLE);
    assert!(
        refused.contains("/front/points, header.stamp: expected times (`topics.front.stamps"),
        "{refused}"
    );
    let text = TABLE
        .replace("'radar', ", "'radar', stamps = 'log', ")
        .replace("kind = 'odometry'", "kind = 'odometry', stamps = 'log'")
        .replace("'lidar', ", "'lidar', stamps = 'log', ")
        .replace("'camera', ", "'camera', stamps = 'log', ")
        .replace("kind = 'imu'", "kind = 'imu', stamps = 'log'");
    let (_folder, path) = drive.write();
    let opened = open_file(&path, &text).unwrap();
    assert_eq!(opened.sequence().times.radars[0], [90, 95, 160].map(|ms| T0 + ms * MS));
}

#[test]
fn a_scan_of_other_fields_is_refused_when_it_is_read() {
    let (_folder, path) = Drive { radar_fields: ["vx", "v_x"], ..Drive::default() }.write();
    let drive = open_file(&path, TABLE).unwrap();
    let error = drive.radar_scan(0, 1).unwrap_err().to_string();
    assert!(error.contains("those of the first scan, x, y, z, v_x, vy, found x, y, z, vx"), "{error}");
    assert!(drive.radar_scan(0, 0).is_ok());
}

#[test]
fn a_file_that_is_cut_is_read_up_to_the_cut_and_the_loss_is_said() {
    let (_folder, path) = Drive { bag: true, ..Drive::default() }.write();
    let whole = std::fs::metadata(&path).unwrap().len();
    File::options().write(true).open(&path).unwrap().set_len(whole - 3000).unwrap();
    let drive = open_file(&path, TABLE).unwrap();
    assert!(drive.warnings()[0].contains("cut short or damaged"), "{:?}", drive.warnings());
    assert_eq!(drive.sequence().times.radars[0].len(), 3);
}

#[test]
fn damaged_chunks_are_left_out_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.mcap");
    let mut to = MessageWriter::mcap(File::create(&path).unwrap(), Compression::None).unwrap();
    let drive = Drive::default();
    let odometry: Topic<Odometry> = to.topic("/odom", Delivery::Live).unwrap();
    to.write(&odometry, T0, &drive.odometry(0)).unwrap();
    let scans: Topic<RadarScan> = to.topic("/scan", Delivery::Live).unwrap();
    for ms in 0..4000 {
        let scan = RadarScan { header: drive.header(ms, "base"), returns: vec![RadarReturn::default(); 40] };
        to.write(&scans, T0 + ms * MS, &scan).unwrap();
    }
    to.finish().unwrap();
    let table = "[topics]\nodom = { topic = '/odom', kind = 'odometry' }\n\
                 scan = { topic = '/scan', kind = 'radar', model = 'generic' }";
    assert_eq!(open_file(&path, table).unwrap().sequence().times.radars[0].len(), 4000);
    let whole = std::fs::read(&path).unwrap();
    let damaged = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x10;
        std::fs::write(&path, bytes).unwrap();
        open_file(&path, table)
    };
    let opened = damaged(whole.len() / 2).unwrap();
    let left = opened.sequence().times.radars[0].len();
    let [told] = opened.warnings() else { panic!("{:?}", opened.warnings()) };
    assert!(told.starts_with(&format!("{} messages of /scan can't be read", 4000 - left)), "{told}");
    assert!(told.contains("expected the checksum") && (1000..4000).contains(&left), "{told}");
    // The only odometry lies in the first chunk.
    let refused = damaged(2000).err().unwrap().to_string();
    assert!(refused.contains("/odom: expected a message that can be read"), "{refused}");
}
