//! A recording in the project's own layout (docs/formats.md, section 1), in a folder of its own.

use super::world::{ARTIFACT, CAR, Chance, SPEED, Thing, seen_ahead, seen_left, surfaces};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const SEQUENCE_TOML: &str = r#"
format = 1
name = "a street"

[[radar]]
name = "radar_front"
fields = ["x", "y", "z", "doppler", "rcs"]
translation = [3.6, 0.0, 0.5]
quaternion_xyzw = [0.0, 0.0, 0.0, 1.0]
elevation = "measured"
fov_azimuth_deg = 160.0
fov_elevation_deg = 20.0
sigma_range_m = 0.10
sigma_azimuth_deg = 0.6
sigma_elevation_deg = 1.2
reliability = [[-80.0, 1.2], [-50.0, 1.0], [50.0, 1.0], [80.0, 1.2]]

[[radar]]
name = "radar_left"
fields = ["range", "azimuth", "doppler"]
translation = [2.0, 0.9, 0.5]
quaternion_xyzw = [0.0, 0.0, 0.7071067811865476, 0.7071067811865476]
elevation = "none"
fov_azimuth_deg = 150.0
fov_elevation_deg = 20.0
sigma_range_m = 0.15
sigma_azimuth_deg = 0.8

[[lidar]]
name = "lidar_top"
translation = [1.2, 0.0, 1.9]
quaternion_xyzw = [0.0, 0.0, 0.0, 1.0]
sigma_range_m = 0.03
lowest_beam_deg = 25.0
max_range_m = 120.0
"#;

const BEGIN_NS: i64 = 1_700_000_000_000_000_000;
const PERIOD_NS: i64 = 100_000_000;

/// How much a recording holds.
pub(crate) struct Shape {
    /// Of each sensor.
    pub(crate) scans: usize,
    /// Whether LiDAR points carry classes.
    pub(crate) classes: bool,
    /// Names of its sequences.
    pub(crate) sequences: &'static [&'static str],
}

impl Default for Shape {
    fn default() -> Self {
        Self { scans: 8, classes: false, sequences: &["00"] }
    }
}

/// A recording on disk, removed in the end, and room for results beside it.
pub(crate) struct Dataset {
    folder: TempDir,
    /// Its folder.
    pub(crate) path: String,
    /// A folder for results, which is still to be made.
    pub(crate) out: String,
}

impl Dataset {
    /// Eight scans of each sensor in one sequence.
    pub(crate) fn new() -> Self {
        Self::of(&Shape::default())
    }

    /// A recording of this shape.
    pub(crate) fn of(shape: &Shape) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
        let (path, out) = (place("dataset"), place("out"));
        for name in shape.sequences {
            write_sequence(&Path::new(&path).join("sequences").join(name), shape);
        }
        Self { folder, path, out }
    }

    /// The same with measurements that are in no other recording, as little as they differ.
    pub(crate) fn of_another_drive(shape: &Shape) -> Self {
        let dataset = Self::of(shape);
        for name in shape.sequences {
            for sensor in ["radar_front", "radar_left", "lidar_top"] {
                for scan in 0..shape.scans {
                    let file = format!("{}/sequences/{name}/{sensor}/{scan:06}.bin", dataset.path);
                    let mut bytes = fs::read(&file).unwrap();
                    bytes[0] ^= 1;
                    fs::write(file, bytes).unwrap();
                }
            }
        }
        dataset
    }

    /// Something beside the recording.
    pub(crate) fn beside(&self, name: &str) -> String {
        self.folder.path().join(name).to_str().unwrap().to_owned()
    }

    /// A file of sequence 00.
    pub(crate) fn file(&self, name: &str) -> PathBuf {
        Path::new(&self.path).join("sequences/00").join(name)
    }

    /// A result of sequence 00.
    pub(crate) fn result(&self, name: &str) -> PathBuf {
        Path::new(&self.out).join("sequences/00").join(name)
    }

    /// Puts other bytes into a file of sequence 00.
    pub(crate) fn put(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.file(name), bytes).unwrap();
    }

    /// Cuts the last bytes off a file of sequence 00.
    pub(crate) fn cut(&self, name: &str, bytes: usize) {
        let whole = fs::read(self.file(name)).unwrap();
        self.put(name, &whole[..whole.len() - bytes]);
    }

    /// Replaces the one place of a text in a file of sequence 00.
    pub(crate) fn edit(&self, name: &str, from: &str, to: &str) {
        let text = fs::read_to_string(self.file(name)).unwrap();
        assert_eq!(text.matches(from).count(), 1, "`{from}` in {name}");
        self.put(name, text.replace(from, to));
    }
}

fn write_sequence(folder: &Path, shape: &Shape) {
    write(&folder.join("sequence.toml"), SEQUENCE_TOML);
    let samples =
        (-5..5 * shape.scans as i64 + 5).map(|i| format!("{},{SPEED},0\n", BEGIN_NS + i * PERIOD_NS / 5));
    write(
        &folder.join("odometry.csv"),
        format!("t_ns,v_mps,yaw_rate_radps\n{}", samples.collect::<String>()),
    );
    let mut chance = Chance(7);
    for (sensor, offset_ns) in [("radar_front", 0), ("radar_left", 37_000_000), ("lidar_top", 20_000_000)] {
        let times: Vec<i64> = (0..shape.scans as i64).map(|i| BEGIN_NS + offset_ns + i * PERIOD_NS).collect();
        write(
            &folder.join(sensor).join("timestamps.txt"),
            times.iter().map(|t| format!("{t}\n")).collect::<String>(),
        );
        for (scan, t_ns) in times.iter().enumerate() {
            let x = SPEED * (t_ns - BEGIN_NS) as f64 * 1e-9;
            write_measurement(folder, sensor, scan, x, &mut chance, shape.classes);
        }
    }
}

/// One scan of a sensor while the vehicle is at `x`.
fn write_measurement(folder: &Path, sensor: &str, scan: usize, x: f64, chance: &mut Chance, classes: bool) {
    let file = folder.join(sensor).join(format!("{scan:06}.bin"));
    let truth = folder.join("ground_truth").join(sensor).join(format!("{scan:06}.label"));
    match sensor {
        "radar_front" => {
            let things = seen_ahead(chance);
            write(
                &file,
                floats(things.iter().flat_map(|(p, _)| [p[0] - x - 3.6, p[1], p[2] - 0.5, -SPEED, 3.0])),
            );
            write(
                &truth,
                labels(&things, |class| if class == CAR || class == ARTIFACT { class } else { 99 }),
            );
        }
        "radar_left" => {
            let things = seen_left(chance);
            // Boresight is the vehicle's y.
            let places = things.iter().map(|(p, _)| (p[1] - 0.9, -(p[0] - x - 2.0)));
            write(&file, floats(places.flat_map(|(x, y): (f64, f64)| [x.hypot(y), y.atan2(x), 0.0])));
            write(&truth, labels(&things, |class| if class == ARTIFACT { ARTIFACT } else { 99 }));
        }
        _ => {
            let things = surfaces();
            write(&file, floats(things.iter().flat_map(|(p, _)| [p[0] - x - 1.2, p[1], p[2] - 1.9, 0.5])));
            if classes {
                write(&file.with_extension("label"), labels(&things, |class| class));
            }
        }
    }
}

fn floats(values: impl Iterator<Item = f64>) -> Vec<u8> {
    values.flat_map(|value| (value as f32).to_le_bytes()).collect()
}

fn labels(things: &[Thing], class: impl Fn(u16) -> u16) -> Vec<u8> {
    things.iter().flat_map(|thing| u32::from(class(thing.1)).to_le_bytes()).collect()
}

fn write(file: &Path, bytes: impl AsRef<[u8]>) {
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    fs::write(file, bytes).unwrap();
}

const CAMERA_TOML: &str = r#"
[[camera]]
name = "camera_front"
translation = [2.0, 0.0, 1.2]
quaternion_xyzw = [-0.5, 0.5, -0.5, 0.5]
width = 160
height = 120
model = "pinhole"
fx = 80.0
fy = 80.0
cx = 79.5
cy = 59.5
distortion = [0.0, 0.0, 0.0, 0.0, 0.0]
"#;

impl Dataset {
    /// Adds a camera to sequence 00 that looks ahead: grey images, and depth images which say that all is equally far.
    pub(crate) fn with_camera(self, images: usize) -> Self {
        let toml = fs::read_to_string(self.file("sequence.toml")).unwrap();
        self.put("sequence.toml", toml + CAMERA_TOML);
        let mut pixels = tiny_skia::Pixmap::new(160, 120).unwrap();
        pixels.fill(tiny_skia::Color::from_rgba8(120, 120, 120, 255));
        let image = pixels.encode_png().unwrap();
        let times = (0..images as i64).map(|i| format!("{}\n", BEGIN_NS + 10_000_000 + i * PERIOD_NS));
        let camera = self.file("camera_front");
        write(&camera.join("timestamps.txt"), times.collect::<String>());
        for number in 0..images {
            write(&camera.join(format!("{number:06}.png")), &image);
            write(&camera.join(format!("depth/{number:06}.npy")), npy(120, 160));
        }
        self
    }
}

/// A NumPy file of float32 ones.
fn npy(rows: usize, columns: usize) -> Vec<u8> {
    let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
    // Magic, version and length take 10 bytes; the values begin at a multiple of 64.
    let header = format!("{header:<117}\n");
    let length = u16::try_from(header.len()).unwrap().to_le_bytes();
    let ones = floats(std::iter::repeat_n(1.0, rows * columns));
    [b"\x93NUMPY\x01\x00".as_slice(), &length, header.as_bytes(), &ones].concat()
}
