//! Labels one radar scan that lies in memory: `cargo run -p ralf-radar --example label_one_scan`.
//!
//! Whatever delivers measurements is a [`Source`]. Here it is a street of a few points: a wall 10 m ahead, seen by a
//! LiDAR and twice by a radar, which also reports something in the empty air.

use ralf::config::Config;
use ralf::paper::Labeler;
use ralf::scene::FrameWindow;
use ralf::sensors::{
    CameraImage, DepthImage, DepthOutput, Elevation, Lidar, LidarScan, Radar, RadarScan, Reliability, Rig,
    Sequence, Source, SourceError, Timelines,
};
use ralf::space::{EgoMotion, OdometrySample, Transform};
use std::io::Write;

/// Times of the two radar scans, ns.
const TIMES: [i64; 2] = [0, 60_000_000];
/// Seen by the radar at its own frame's x, y and z, m: two points on the wall, and nothing at all.
const DETECTIONS: [[f32; 3]; 3] = [[10.0, -1.0, 0.5], [10.1, 1.0, 0.5], [6.0, 3.0, 0.5]];

struct Street {
    sequence: Sequence,
}

impl Source for Street {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        // The noise isn't there the second time.
        let seen = &DETECTIONS[..3 - scan];
        let columns = (0..3).map(|axis| seen.iter().map(|p| p[axis]).collect()).collect();
        Ok(RadarScan::new(&self.sequence.rig.radars[radar], TIMES[scan], columns)?)
    }

    fn lidar_scan(&self, _lidar: usize, _scan: usize) -> Result<LidarScan, SourceError> {
        // The wall, from 3 m left to 3 m right and from the road to 3 m above it; the LiDAR stands 2 m above the road.
        let wall = (-30..30).flat_map(|y| (0..30).map(move |z| [10.0, 0.1 * y as f32, 0.1 * z as f32 - 2.0]));
        Ok(LidarScan { t_ns: 0, points: wall.collect(), ..Default::default() })
    }

    fn image(&self, _camera: usize, _image: usize) -> Result<CameraImage, SourceError> {
        Err("the vehicle has no camera".into())
    }

    fn depth(&self, _camera: usize, _image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        Ok(None)
    }
}

/// A vehicle with a radar and a LiDAR.
fn rig() -> Rig {
    let radar = Radar {
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
    };
    let lidar = Lidar {
        name: "lidar_top".into(),
        vehicle_from_lidar: Transform::translation(0.0, 0.0, 2.0),
        sigma_range: 0.03,
        lowest_beam: 0.4,
        max_range: None,
    };
    Rig { radars: vec![radar], lidars: vec![lidar], cameras: vec![] }
}

fn main() -> Result<(), SourceError> {
    let standing = OdometrySample { t_ns: 0, velocity: 0.0, yaw_rate: 0.0 };
    let motion = EgoMotion::new(vec![standing], vec![]).ok_or("no motion")?;
    let times = Timelines { radars: vec![TIMES.to_vec()], lidars: vec![vec![0]], cameras: vec![] };
    let street = Street {
        sequence: Sequence {
            name: "street".into(),
            title: "A wall".into(),
            rig: rig(),
            times,
            motion,
            depth_output: DepthOutput::Depth,
        },
    };
    let config = Config::from_toml("", &["ground.model=flat"])?;
    let mut window = FrameWindow::new(&street, &street.sequence.rig, &config);
    let labels = Labeler::new(&config).label(&window.frame(0, 0)?);
    let mut out = std::io::stdout();
    for ([x, y, z], label) in DETECTIONS.iter().zip(&labels) {
        let class = if label.plausible { "plausible" } else { "artifact" };
        writeln!(out, "({x:4.1}, {y:4.1}, {z:3.1}) m: w = {:.3}, {class}", label.w)?;
    }
    Ok(())
}
