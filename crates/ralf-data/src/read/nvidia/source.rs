//! A clip as a source: measurements typed.

use super::calibration::{Extrinsics, motion};
use super::layout::Clip;
use super::tables::{COLUMNS, Scans};
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::read::last_read::LastRead;
use crate::read::models::{NVIDIA_RADAR, NVIDIA_RADAR_2D};
use crate::read::recording::{measurement, no_measurement};
use crate::read::row_scans::Scan;
use ralf::sensors::{
    CameraImage, DepthImage, DepthOutput, LidarScan, RadarScan, Rig, Sequence, Source, SourceError, Timelines,
};
use ralf::space::EgoMotion;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What is said where a clip doesn't tell the vehicle's motion.
const NO_EGOMOTION: &str = "no egomotion: the motion has to come from a trajectory or from range rates";

/// What the clips of a recording have in common.
pub(super) struct Shared<'a> {
    pub(super) scans: Arc<LastRead<Scans>>,
    pub(super) extrinsics: &'a Extrinsics,
}

/// A clip, opened.
pub(super) struct Drive {
    sequence: Sequence,
    /// One per radar.
    files: Vec<PathBuf>,
    /// Poses and mountings.
    further: Vec<PathBuf>,
    tables: Arc<LastRead<Scans>>,
    /// The rows of each scan of each radar.
    radars: Vec<Vec<Scan>>,
    warnings: Vec<String>,
}

impl Drive {
    /// Reads mountings, poses, and which rows are which scan.
    pub(super) fn new(name: &str, clip: &Clip, shared: &Shared) -> Result<Self, DataError> {
        let mut warnings = left_out(clip);
        let extrinsics = clip.extrinsics(name)?;
        let mut further = Vec::new();
        let motion = match clip.label(name, "egomotion.offline")?.or(clip.label(name, "egomotion")?) {
            Some(file) => {
                let motion = motion(&file)?;
                further.push(file);
                motion
            }
            None => {
                warnings.push(NO_EGOMOTION.to_owned());
                EgoMotion::unknown()
            }
        };
        let (rig, times, depth_output) = (Rig::default(), Timelines::default(), DepthOutput::default());
        let title = format!("PhysicalAI-AV, {} radars", clip.radars.len());
        let sequence = Sequence { name: name.to_owned(), title, rig, times, motion, depth_output };
        let (files, tables, radars) = (Vec::new(), shared.scans.clone(), Vec::new());
        let mut drive = Self { sequence, files, further, tables, radars, warnings };
        for (sensor, file) in &clip.radars {
            drive.add(sensor, file, &extrinsics, shared)?;
        }
        Ok(drive)
    }

    fn add(
        &mut self,
        sensor: &str,
        file: &Path,
        extrinsics: &[PathBuf],
        shared: &Shared,
    ) -> Result<(), DataError> {
        let name = &self.sequence.name;
        let mounting = shared.extrinsics.find(name, sensor, extrinsics)?;
        let (mounting, table) = mounting.ok_or_else(|| {
            let expected = format!("a mounting of the clip {name} in calibration/sensor_extrinsics");
            DataError::content(file, sensor, expected, "none")
        })?;
        if !self.further.iter().any(|known| known == table) {
            self.further.push(table.to_owned());
        }
        let table = self.tables.of(file)?;
        let model = if table.has_elevation { NVIDIA_RADAR } else { NVIDIA_RADAR_2D };
        let fields = COLUMNS.map(|(_, field)| field);
        self.sequence.rig.radars.push(model.mounted(sensor, &fields, mounting));
        self.sequence.times.radars.push(table.scans.iter().map(|scan| scan.t_ns).collect());
        self.radars.push(table.scans.clone());
        self.files.push(file.to_owned());
        Ok(())
    }
}

/// A sentence for each kind of sensor that isn't read.
fn left_out(clip: &Clip) -> Vec<String> {
    let mut sentences = Vec::new();
    if clip.has("lidar") {
        sentences.push("the LiDAR's points are compressed with Draco, which isn't read: left out".to_owned());
    }
    if clip.has("camera") {
        sentences.push("the cameras are films behind f-theta lenses, which aren't read: left out".to_owned());
    }
    sentences
}

impl Source for Drive {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let scan = measurement("radar", &self.radars, radar, scan)?;
        let file = &self.files[radar];
        let table = self.tables.of(file)?;
        let columns = table.columns.iter().map(|column| scan.of(column)).collect::<Option<Vec<_>>>();
        let columns = columns.ok_or_else(|| {
            DataError::content(file, "rows", "as many as when the file was opened", "fewer")
        })?;
        Ok(RadarScan::new(&self.sequence.rig.radars[radar], scan.t_ns, columns)?)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        no_measurement("lidar", lidar, scan)
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        no_measurement("camera", camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        no_measurement("camera", camera, image)
    }
}

impl SequenceReader for Drive {
    fn inputs(&self) -> Vec<PathBuf> {
        self.further.iter().chain(&self.files).cloned().collect()
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn warning_of_motion(&self) -> Option<&'static str> {
        Some(NO_EGOMOTION)
    }
}
