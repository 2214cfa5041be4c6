//! A sequence in memory.

#![allow(dead_code, reason = "not every test uses all of it")]

use ralf::config::Config;
use ralf::paper::{DetectionLabel, Labeler};
use ralf::scene::FrameWindow;
use ralf::sensors::{
    CameraImage, DepthImage, DepthOutput, Elevation, Lidar, LidarScan, Radar, RadarScan, Reliability, Rig,
    Sequence, Source, SourceError, Timelines,
};
use ralf::space::{EgoMotion, OdometrySample, Transform};

pub(crate) const MS: i64 = 1_000_000;

/// Scans of radars and LiDARs at given times, in the sensors' frames.
#[derive(Debug)]
pub(crate) struct Memory {
    pub(crate) sequence: Sequence,
    /// Per radar and scan: one row per detection of all its fields; none where the scan can't be read.
    pub(crate) radar_scans: Vec<Vec<Option<Vec<Vec<f32>>>>>,
    /// Per LiDAR and scan.
    pub(crate) lidar_scans: Vec<Vec<Vec<[f32; 3]>>>,
    /// Of every LiDAR scan.
    pub(crate) point_times: Option<Vec<f32>>,
}

/// A radar at the vehicle's origin: 0.3 m, 0.01 rad, 0.02 rad.
pub(crate) fn radar(elevation: Elevation) -> Radar {
    Radar {
        name: "radar".into(),
        fields: ["x", "y", "z"].map(str::to_owned).to_vec(),
        vehicle_from_radar: Transform::identity(),
        elevation,
        fov_azimuth: 2.5,
        fov_elevation: 0.4,
        sigma_range: 0.3,
        sigma_azimuth: 0.01,
        sigma_elevation: 0.02,
        reliability: Reliability::default(),
    }
}

/// A LiDAR 2 m above the vehicle's origin: 0.04 m, lowest beam at 45 degrees.
pub(crate) fn lidar() -> Lidar {
    Lidar {
        name: "lidar".into(),
        vehicle_from_lidar: Transform::translation(0.0, 0.0, 2.0),
        sigma_range: 0.04,
        lowest_beam: std::f64::consts::FRAC_PI_4,
        max_range: None,
    }
}

impl Memory {
    /// A vehicle that drives straight ahead at a constant velocity.
    pub(crate) fn new(velocity: f64) -> Self {
        let odometry = vec![OdometrySample { t_ns: 0, velocity, yaw_rate: 0.0 }];
        let sequence = Sequence {
            name: "memory".into(),
            title: String::new(),
            rig: Rig::default(),
            times: Timelines::default(),
            motion: EgoMotion::new(odometry, vec![]).unwrap(),
            depth_output: DepthOutput::Depth,
        };
        Self { sequence, radar_scans: vec![], lidar_scans: vec![], point_times: None }
    }

    /// With another radar and its scans.
    pub(crate) fn radar(self, radar: Radar, scans: Vec<(i64, Option<Vec<[f32; 3]>>)>) -> Self {
        let rows = |points: Vec<[f32; 3]>| points.into_iter().map(Vec::from).collect();
        self.rows(radar, scans.into_iter().map(|(t_ns, points)| (t_ns, points.map(rows))).collect())
    }

    /// With another radar and its scans, a row of all its fields for each detection.
    pub(crate) fn measured<const N: usize>(self, radar: Radar, scans: Vec<(i64, Vec<[f32; N]>)>) -> Self {
        let rows = |rows: Vec<[f32; N]>| Some(rows.into_iter().map(Vec::from).collect());
        self.rows(radar, scans.into_iter().map(|(t_ns, scan)| (t_ns, rows(scan))).collect())
    }

    fn rows(mut self, radar: Radar, scans: Vec<(i64, Option<Vec<Vec<f32>>>)>) -> Self {
        self.sequence.rig.radars.push(radar);
        self.sequence.times.radars.push(scans.iter().map(|(t_ns, _)| *t_ns).collect());
        self.radar_scans.push(scans.into_iter().map(|(_, rows)| rows).collect());
        self
    }

    /// With another LiDAR and its scans.
    pub(crate) fn lidar(mut self, lidar: Lidar, scans: Vec<(i64, Vec<[f32; 3]>)>) -> Self {
        self.sequence.rig.lidars.push(lidar);
        self.sequence.times.lidars.push(scans.iter().map(|(t_ns, _)| *t_ns).collect());
        self.lidar_scans.push(scans.into_iter().map(|(_, points)| points).collect());
        self
    }

    /// The labels of one scan.
    pub(crate) fn label(&self, config: &Config, radar: usize, scan: usize) -> Vec<DetectionLabel> {
        let mut window = FrameWindow::new(self, &self.sequence.rig, config);
        let frame = window.frame(radar, scan).unwrap();
        Labeler::new(config).unwrap().label(&frame)
    }
}

impl Source for Memory {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let rows = self.radar_scans[radar][scan].as_ref().ok_or("cut short")?;
        let sensor = &self.sequence.rig.radars[radar];
        let columns =
            (0..sensor.fields.len()).map(|field| rows.iter().map(|row| row[field]).collect()).collect();
        let t_ns = self.sequence.times.radars[radar][scan];
        Ok(RadarScan::new(sensor, t_ns, columns)?)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        let points = self.lidar_scans[lidar][scan].clone();
        let intensity = vec![0.0; points.len()];
        Ok(LidarScan {
            t_ns: self.sequence.times.lidars[lidar][scan],
            points,
            times: self.point_times.clone(),
            intensity,
            classes: None,
        })
    }

    fn image(&self, _: usize, _: usize) -> Result<CameraImage, SourceError> {
        Err("no camera".into())
    }

    fn depth(&self, _: usize, _: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        Ok(None)
    }
}
