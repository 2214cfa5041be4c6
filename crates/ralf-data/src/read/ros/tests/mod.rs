//! On tiny recordings made by the tests themselves.

mod damage;
mod drivers;
mod reading;
mod refusals;
mod sparse;

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
    /// The focal length of each calibration, px.
    infos: Vec<f64>,
    distortion: [f64; 5],
    /// As the calibration has it, px.
    image_width: u32,
    images: i64,
    /// How far ahead the radars' mast is at these times, ms and m.
    mast: Vec<(i64, f64)>,
    vehicle: &'static str,
    radar_fields: [&'static str; 2],
    /// The frame of both radars.
    radar: &'static str,
    /// The vehicle is parked, and says nothing of it.
    parked: bool,
    /// The LiDAR's points: x, y, z and what the field of this name holds.
    lidar: (Vec<[f32; 4]>, &'static str),
}

impl Default for Drive {
    fn default() -> Self {
        let (bag, stamped, mast) = (false, true, vec![(-500, 3.0), (500, 3.0)]);
        let (camera_frame, infos, images) = ("camera", vec![100.0], 1);
        let (vehicle, radar_fields) = ("base", ["vx", "vx"]);
        let (radar, parked) = ("radar", false);
        let lidar = (vec![[1.0, 2.0, 3.0, 0.0]], "other");
        Self {
            bag,
            stamped,
            camera_frame,
            infos,
            distortion: [0.1, 0.0, 0.0, 0.0, 0.2],
            image_width: 2,
            images,
            mast,
            vehicle,
            radar_fields,
            radar,
            parked,
            lidar,
        }
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
            header: self.header(ms, self.radar),
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
        to.write(&frames, T0, &self.transform(0, ["mast", self.radar], [0.5, 0.0, 0.0])).unwrap();
        to.write(&frames, T0, &self.transform(0, ["base", "camera"], [1.0, 0.0, 1.5])).unwrap();
        to.write(&frames, T0, &self.transform(0, ["base", "lidar"], [0.0, 0.0, 2.0])).unwrap();
        let moving: Topic<TfMessage> = to.topic("/tf", Delivery::Live).unwrap();
        for (ms, x) in &self.mast {
            to.write(&moving, T0, &self.transform(*ms, ["base", "mast"], [*x, 0.0, 0.25])).unwrap();
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
        to.write(&scans, T0 + 30 * MS, &RadarScan { header: self.header(20, self.radar), returns }).unwrap();
        let lidar: Topic<PointCloud2> = to.topic("/roof/points", Delivery::Live).unwrap();
        let (points, field) = &self.lidar;
        let points: Vec<[f32; 5]> = points.iter().map(|[x, y, z, value]| [*x, *y, *z, *value, 0.0]).collect();
        let cloud = self.cloud(60, &points, field);
        to.write(&lidar, T0 + 70 * MS, &PointCloud2 { header: self.header(60, "lidar"), ..cloud }).unwrap();
        let odometry: Topic<Odometry> = to.topic("/odom", Delivery::Live).unwrap();
        let samples = if self.parked { 0 } else { 8 };
        (0..samples).for_each(|k| to.write(&odometry, T0 + 20 * k * MS, &self.odometry(20 * k)).unwrap());
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
                width: self.image_width,
                distortion_model: "plumb_bob".to_owned(),
                d: self.distortion.to_vec(),
                k: [*focal, 0.0, 1.0, 0.0, *focal, 0.5, 0.0, 0.0, 1.0],
                p: [*focal, 0.0, 1.0, -focal * 0.25, 0.0, *focal, 0.5, 0.0, 0.0, 0.0, 1.0, 0.0],
                ..CameraInfo::default()
            };
            to.write(&infos, T0 + 60 * MS, &info).unwrap();
        }
        let images: Topic<Image> = to.topic("/cam/image_raw", Delivery::Live).unwrap();
        for ms in (0..self.images).map(|k| 50 + 10 * k) {
            let header = self.header(ms, self.camera_frame);
            let (height, width, step, data) = (1, 2, 6, vec![1, 2, 3, 4, 5, 6]);
            let image =
                Image { header, height, width, step, encoding: "rgb8".to_owned(), data, is_bigendian: false };
            to.write(&images, T0 + (ms + 10) * MS, &image).unwrap();
        }
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
