//! Five real files hold the first seconds of a scene of nuScenes: they label to the numbers of the tables that they
//! were made from.

use ralf::config::Config;
use ralf::paper::{DetectionLabel, Labeler};
use ralf::scene::FrameWindow;
use ralf::sensors::{
    CameraImage, DepthImage, LidarScan, RadarScan, Sequence, Source, SourceError, Timelines,
};
use ralf::space::EgoMotion;
use ralf_data::read::ros::Topics;
use ralf_data::{Recording, SequenceReader, Settings};
use std::path::{Path, PathBuf};

const FILES: [&str; 5] = [
    "nuscenes-0061.bag",
    "nuscenes-0061-lz4.bag",
    "nuscenes-0061.mcap",
    "nuscenes-0061-zstd.mcap",
    "nuscenes-0061-lz4.mcap",
];

/// The sensors of nuScenes by the names of their topics, with what the reader of its tables takes them for.
fn topics() -> Topics {
    let mut text = String::new();
    for radar in ["front", "front_left", "front_right", "back_left", "back_right"] {
        text += &format!(
            "[topics.radar_{radar}]\ntopic = \"/radar_{radar}/points\"\nkind = \"radar\"\nmodel = \"ars408-21\"\n"
        );
    }
    for camera in ["front", "front_left", "front_right", "back", "back_left", "back_right"] {
        text += &format!(
            "[topics.cam_{camera}]\ntopic = \"/cam_{camera}/image_rect_compressed\"\nkind = \"camera\"\n\
             info = \"/cam_{camera}/camera_info\"\n"
        );
    }
    text += "[topics.lidar_top]\ntopic = \"/lidar_top/points\"\nkind = \"lidar\"\nmodel = \"hdl-32e\"\n\
             [topics.odom]\ntopic = \"/odom\"\nkind = \"odometry\"\n\
             [topics.tf]\ntopic = \"/tf_static\"\nkind = \"tf_static\"\n";
    Settings::from_toml(&text, &[]).unwrap().topics
}

/// Of the tables: the measurements that a file holds, under the names and in the order of the file, with any motion.
struct Tables<'a> {
    tables: &'a dyn SequenceReader,
    sequence: Sequence,
    radars: Vec<Of>,
    lidars: Vec<Of>,
    cameras: Vec<Of>,
}

/// A sensor of the tables, and which of its measurements the file holds.
struct Of {
    sensor: usize,
    measurements: Vec<usize>,
}

/// Finds each sensor by its name and each measurement by its time.
fn find<'a>(
    names: impl Iterator<Item = &'a str>,
    times: &[Vec<i64>],
    of_tables: impl Iterator<Item = &'a str> + Clone,
    times_of_tables: &[Vec<i64>],
) -> Vec<Of> {
    names
        .zip(times)
        .map(|(name, times)| {
            let sensor = of_tables.clone().position(|known| known.eq_ignore_ascii_case(name)).unwrap();
            let place = |time: &i64| times_of_tables[sensor].binary_search(time).unwrap();
            Of { sensor, measurements: times.iter().map(place).collect() }
        })
        .collect()
}

impl<'a> Tables<'a> {
    fn new(tables: &'a dyn SequenceReader, file: &Sequence, motion: &EgoMotion) -> Self {
        let known = tables.sequence();
        let (rig, times) = (&file.rig, &file.times);
        let radars = find(
            rig.radars.iter().map(|radar| radar.name.as_str()),
            &times.radars,
            known.rig.radars.iter().map(|radar| radar.name.as_str()),
            &known.times.radars,
        );
        let lidars = find(
            rig.lidars.iter().map(|lidar| lidar.name.as_str()),
            &times.lidars,
            known.rig.lidars.iter().map(|lidar| lidar.name.as_str()),
            &known.times.lidars,
        );
        let cameras = find(
            rig.cameras.iter().map(|camera| camera.name.as_str()),
            &times.cameras,
            known.rig.cameras.iter().map(|camera| camera.name.as_str()),
            &known.times.cameras,
        );
        let mut sequence = Sequence { motion: motion.clone(), times: times.clone(), ..known.clone() };
        sequence.rig.radars = radars.iter().map(|of| known.rig.radars[of.sensor].clone()).collect();
        sequence.rig.lidars = lidars.iter().map(|of| known.rig.lidars[of.sensor].clone()).collect();
        sequence.rig.cameras = cameras.iter().map(|of| known.rig.cameras[of.sensor].clone()).collect();
        Self { tables, sequence, radars, lidars, cameras }
    }
}

impl Source for Tables<'_> {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let of = &self.radars[radar];
        self.tables.radar_scan(of.sensor, of.measurements[scan])
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        let of = &self.lidars[lidar];
        self.tables.lidar_scan(of.sensor, of.measurements[scan])
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        let of = &self.cameras[camera];
        self.tables.image(of.sensor, of.measurements[image])
    }

    fn depth(&self, _: usize, _: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        Ok(None)
    }
}

fn data() -> Option<PathBuf> {
    let root = std::env::var_os("RALF_TEST_DATA").map(PathBuf::from);
    if root.is_none() {
        println!("skipped: RALF_TEST_DATA is not set");
    }
    root
}

fn scene(root: &Path) -> Recording {
    let nuscenes = ralf_data::open(&root.join("nuscenes"), None).unwrap();
    nuscenes.select(&["scene-0061".to_owned()]).unwrap()
}

fn open(file: &Path) -> Box<dyn SequenceReader> {
    let recording = ralf_data::open_with(file, None, &topics()).unwrap();
    assert_eq!(recording.format, "ros");
    recording.sequences.into_iter().next().unwrap()
}

/// Labels of every scan of every radar.
fn labels(source: &dyn Source) -> Vec<Vec<DetectionLabel>> {
    let config = Config::default();
    let rig = &source.sequence().rig;
    let mut window = FrameWindow::new(source, rig, &config);
    let mut all = Vec::new();
    for (radar, times) in source.sequence().times.radars.iter().enumerate() {
        all.extend(
            (0..times.len())
                .map(|scan| Labeler::new(&config).unwrap().label(&window.frame(radar, scan).unwrap())),
        );
    }
    all
}

fn same_bits(a: &[f32], b: &[f32]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

/// Every measurement is the tables' own, bit by bit; and so is every sensor.
fn check_measurements(file: &dyn SequenceReader, tables: &Tables<'_>) {
    let (found, known) = (file.sequence(), tables.sequence());
    for (radar, times) in found.times.radars.iter().enumerate() {
        let [a, b] = [&found.rig.radars[radar], &known.rig.radars[radar]];
        assert_eq!(a.vehicle_from_radar, b.vehicle_from_radar, "{}", a.name);
        assert_eq!(
            (a.sigma_range, a.sigma_azimuth, a.elevation),
            (b.sigma_range, b.sigma_azimuth, b.elevation)
        );
        for scan in 0..times.len() {
            let [of_file, of_tables] =
                [file.radar_scan(radar, scan), tables.radar_scan(radar, scan)].map(Result::unwrap);
            for (field, column) in a.fields.iter().zip(&of_file.columns) {
                let expected = &of_tables.columns[b.column(field).unwrap()];
                assert!(
                    same_bits(column, expected),
                    "{} scan {scan}, {field}: {column:?} {expected:?}",
                    a.name
                );
            }
        }
    }
    for (lidar, times) in found.times.lidars.iter().enumerate() {
        let [a, b] = [&found.rig.lidars[lidar], &known.rig.lidars[lidar]];
        assert_eq!(a.vehicle_from_lidar, b.vehicle_from_lidar);
        for scan in 0..times.len() {
            let [a, b] = [file.lidar_scan(lidar, scan), tables.lidar_scan(lidar, scan)].map(Result::unwrap);
            assert!(
                same_bits(a.points.as_flattened(), b.points.as_flattened())
                    && same_bits(&a.intensity, &b.intensity)
            );
        }
    }
    for (camera, times) in found.times.cameras.iter().enumerate() {
        let [a, b] = [&found.rig.cameras[camera], &known.rig.cameras[camera]];
        assert_eq!((a.vehicle_from_camera, &a.intrinsics), (b.vehicle_from_camera, &b.intrinsics));
        for image in 0..times.len() {
            assert_eq!(file.image(camera, image).unwrap(), tables.image(camera, image).unwrap());
        }
    }
}

#[test]
fn five_files_label_to_the_numbers_of_their_tables() {
    let Some(root) = data() else { return };
    let nuscenes =
        ralf_data::open(&root.join("nuscenes"), None).unwrap().select(&["scene-0061".to_owned()]).unwrap();
    let first = open(&root.join("ros").join(FILES[0]));
    let tables = Tables::new(nuscenes.sequences[0].as_ref(), first.sequence(), &first.sequence().motion);
    let expected = labels(&tables);
    assert_eq!(expected.len(), 654);
    for name in FILES {
        let file = open(&root.join("ros").join(name));
        assert_eq!(file.warnings(), [""; 0]);
        let times: &Timelines = &file.sequence().times;
        assert_eq!(times, &first.sequence().times, "{name}");
        assert_eq!(file.sequence().motion.poses(), first.sequence().motion.poses());
        check_measurements(file.as_ref(), &tables);
        assert_eq!(labels(file.as_ref()), expected, "{name}");
    }
}

/// The files hold the odometry of the CAN bus, the tables 6-DoF poses as well: labels stay the same but for a few.
#[test]
fn another_source_of_motion_changes_few_labels() {
    let Some(root) = data() else { return };
    let nuscenes = scene(&root);
    let file = open(&root.join("ros").join(FILES[2]));
    let tables = nuscenes.sequences[0].as_ref();
    let own_motion = Tables::new(tables, file.sequence(), &tables.sequence().motion);
    let pairs: Vec<_> = labels(file.as_ref())
        .into_iter()
        .zip(labels(&own_motion))
        .flat_map(|(a, b)| a.into_iter().zip(b))
        .collect();
    let differences = pairs.iter().map(|(a, b)| (a.w - b.w).abs());
    let (worst, flips) =
        (differences.fold(0.0, f64::max), pairs.iter().filter(|(a, b)| a.plausible != b.plausible).count());
    assert!(
        worst < 0.1 && flips * 1000 < pairs.len(),
        "{flips} of {} flip; w differs by up to {worst}",
        pairs.len()
    );
}
