//! A dataset of two sequences in the own layout, as small as one can be that has a sensor of every kind.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

pub(crate) const SEQUENCE_TOML: &str = r#"format = 1
name = "tiny"

[[radar]]
name = "radar_front"
fields = ["x", "y", "z", "doppler", "rcs"]
translation = [3.6, 0.0, 0.5]
quaternion_xyzw = [0.0, 0.0, 0.38268343, 0.92387953]
elevation = "measured"
fov_azimuth_deg = 160.0
fov_elevation_deg = 20.0
sigma_range_m = 0.10
sigma_azimuth_deg = 0.6
sigma_elevation_deg = 1.2
reliability = [[-80.0, 1.5], [-50.0, 1.0], [50.0, 1.0], [80.0, 1.5]]

[[radar]]
name = "radar_rear"
fields = ["power", "azimuth", "range"]
translation = [-1, 0, 0.5]
quaternion_xyzw = [0, 0, 1, 0]
elevation = "none"
fov_azimuth_deg = 120.0
fov_elevation_deg = 12.0
sigma_range_m = 0.2
sigma_azimuth_deg = 1.7

[[lidar]]
name = "lidar_top"
translation = [1.2, 0.0, 1.9]
quaternion_xyzw = [0.0, 0.0, 0.0, 1.0]
sigma_range_m = 0.03
lowest_beam_deg = 25.0

[[camera]]
name = "camera_front"
translation = [2.0, 0.0, 1.0]
quaternion_xyzw = [-0.5, 0.5, -0.5, 0.5]
width = 4
height = 2
model = "kannala-brandt"
fx = 3.3
fy = 3.3
cx = 1.5
cy = 0.5
distortion = [0.05, -0.01]

[[camera.view]]
yaw_deg = 45.0
pitch_deg = 0.1
horizontal_fov_deg = 100.0
width = 2
height = 2

[[camera.view]]
yaw_deg = -45.0
pitch_deg = 0.0
horizontal_fov_deg = 100.0
width = 2
height = 2

[depth]
output = "disparity"
"#;

/// The dataset in a new folder, and that of its first sequence.
pub(crate) fn tiny() -> (TempDir, PathBuf) {
    let dataset = tempfile::tempdir().unwrap();
    for name in ["00", "01"] {
        sequence(&dataset.path().join("sequences").join(name));
    }
    let first = dataset.path().join("sequences/00");
    (dataset, first)
}

/// Writes a file and the folders above it.
pub(crate) fn write(file: &Path, bytes: impl AsRef<[u8]>) {
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    fs::write(file, bytes).unwrap();
}

fn sequence(folder: &Path) {
    let put = |name: &str, bytes: &[u8]| write(&folder.join(name), bytes);
    put("sequence.toml", SEQUENCE_TOML.as_bytes());
    put("odometry.csv", b"t_ns,v_mps,yaw_rate_radps\n0,3.5,0.125\n100000000,3.25,0.1\n");
    put("poses.csv", b"t_ns,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n100000000,0.3,0.1,0,0,0,0.006,0.999982\n");
    put("radar_front/timestamps.txt", b"1000\n50001000\n50001000\n");
    put("radar_front/000000.bin", &floats(&[10.0, 1.0, 0.5, -3.5, 7.0, 20.0, -4.0, f32::NAN, 0.25, -2.0]));
    put("radar_front/000001.bin", &floats(&[]));
    put("radar_front/000002.bin", &floats(&[8.0, 0.0, 0.0, -3.5, f32::INFINITY]));
    put("ground_truth/radar_front/000000.label", &labels(&[99, 1]));
    put("radar_rear/timestamps.txt", b"-7\r\n30000000");
    // A gap in the numbers is none in the measurements.
    put("radar_rear/000003.bin", &floats(&[12.0, 0.5, 9.0]));
    put("radar_rear/000010.bin", &floats(&[13.0, -0.5, 19.0, 14.0, 0.0, 3.0]));
    put("lidar_top/timestamps.txt", b"0\n100000000\n");
    put("lidar_top/000000.bin", &floats(&[5.0, 0.0, -1.0, 0.5, 6.0, 1.0, -1.9, 0.25]));
    put("lidar_top/000000.label", &labels(&[10 | 7 << 16, 40]));
    put("lidar_top/000000.time", &floats(&[-0.048, 0.025]));
    put("lidar_top/000001.bin", &floats(&[0.0, 0.0, 0.0, 1.0]));
    put("camera_front/timestamps.txt", b"5000\n100005000\n");
    put("camera_front/000000.png", &picture(image::ImageFormat::Png));
    put("camera_front/000001.jpg", &picture(image::ImageFormat::Jpeg));
    put("camera_front/depth/000001.npy", &depth());
}

pub(crate) fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn labels(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn picture(format: image::ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let rgb: Vec<u8> = (0..24).map(|i| i * 10).collect();
    image::write_buffer_with_format(&mut bytes, &rgb, 4, 2, image::ColorType::Rgb8, format).unwrap();
    bytes.into_inner()
}

/// Two views of 2 x 2.
fn depth() -> Vec<u8> {
    let header = format!("{:<117}\n", "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2, 2), }");
    let values = floats(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, f32::NAN, 0.0]);
    [b"\x93NUMPY\x01\x00\x76\x00", header.as_bytes(), &values].concat()
}
