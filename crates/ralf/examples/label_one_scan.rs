//! Labels one radar scan that lies in memory: `cargo run -p ralf-radar --example label_one_scan`.
//!
//! Whatever delivers measurements is a [`Source`]; arrays become one as a [`MemorySource`]. Here it is a street of a
//! few points: a wall 10 m ahead, seen by a LiDAR and twice by a radar, which also reports something in the empty air.

use ralf::config::Config;
use ralf::paper::Labeler;
use ralf::scene::FrameWindow;
use ralf::sensors::{Elevation, Lidar, LidarScan, MemorySource, Radar, Reliability, Source, SourceError};
use ralf::space::{EgoMotion, OdometrySample, Transform};
use std::io::Write;

/// Seen by the radar at its own frame's x, y and z, m: two points on the wall, and nothing at all.
const DETECTIONS: [[f32; 3]; 3] = [[10.0, -1.0, 0.5], [10.1, 1.0, 0.5], [6.0, 3.0, 0.5]];

fn radar() -> Radar {
    Radar {
        name: "radar_front".into(),
        fields: ["x", "y", "z"].map(str::to_owned).to_vec(),
        vehicle_from_radar: Transform::translation(0.0, 0.0, 0.5),
        elevation: Elevation::Measured,
        fov_azimuth: 2.6,
        fov_elevation: 0.4,
        sigma_range: 0.1,
        sigma_azimuth: 0.01,
        sigma_elevation: 0.02,
        reliability: Reliability::default(),
    }
}

/// A column for each axis.
fn columns(detections: &[[f32; 3]]) -> Vec<Vec<f32>> {
    (0..3).map(|axis| detections.iter().map(|place| place[axis]).collect()).collect()
}

fn lidar() -> Lidar {
    Lidar {
        name: "lidar_top".into(),
        vehicle_from_lidar: Transform::translation(0.0, 0.0, 2.0),
        sigma_range: 0.03,
        lowest_beam: 0.4,
        max_range: None,
    }
}

/// The wall, from 3 m left to 3 m right and from the road to 3 m above it; the LiDAR stands 2 m above the road.
fn wall() -> LidarScan {
    let points = (-30..30).flat_map(|y| (0..30).map(move |z| [10.0, 0.1 * y as f32, 0.1 * z as f32 - 2.0]));
    let points: Vec<[f32; 3]> = points.collect();
    LidarScan { intensity: vec![0.0; points.len()], points, ..LidarScan::default() }
}

fn main() -> Result<(), SourceError> {
    let standing = OdometrySample { t_ns: 0, velocity: 0.0, yaw_rate: 0.0 };
    let motion = EgoMotion::new(vec![standing], vec![]).ok_or("no motion")?;
    // The noise isn't there the second time.
    let scans = vec![(0, columns(&DETECTIONS)), (60_000_000, columns(&DETECTIONS[..2]))];
    let street =
        MemorySource::new("street", motion)?.with_radar(radar(), scans)?.with_lidar(lidar(), vec![wall()])?;
    let config = Config::from_toml("", &["ground.model=flat"])?;
    let mut window = FrameWindow::new(&street, &street.sequence().rig, &config);
    let labels = Labeler::new(&config)?.label(&window.frame(0, 0)?);
    let mut out = std::io::stdout();
    for ([x, y, z], label) in DETECTIONS.iter().zip(&labels) {
        let class = if label.plausible { "plausible" } else { "artifact" };
        writeln!(out, "({x:4.1}, {y:4.1}, {z:3.1}) m: w = {:.3}, {class}", label.w)?;
    }
    Ok(())
}
