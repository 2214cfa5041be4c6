//! A sequence of a format that keeps its measurements in files: what all readers of this kind have in common.

use crate::error::DataError;
use crate::read::SequenceReader;
use crate::read::measured_files::MeasuredFiles;
use crate::read::recording::measurement;
use ralf::sensors::{CameraImage, DepthImage, Lidar, LidarScan, RadarScan, Sequence, Source, SourceError};
use std::any::Any;
use std::path::{Path, PathBuf};

/// What the files of a format hold.
pub(crate) trait FileFormat: Send + Sync {
    /// Whether the LiDARs' points lie where each was measured, at its own time; else they are motion-corrected.
    fn is_rolling(&self) -> bool {
        false
    }

    /// What is said where no file tells the vehicle's motion: [`SequenceReader::warning_of_motion`].
    fn warning_of_motion(&self) -> Option<&'static str> {
        None
    }

    /// The columns of a radar's scan, out of its file.
    fn radar_columns(&self, file: &Path, radar: usize, scan: usize) -> Result<Vec<Vec<f32>>, DataError>;

    /// A LiDAR's scan of this time, as the file has it.
    fn lidar_scan(&self, file: &Path, lidar: &Lidar, t_ns: i64) -> Result<LidarScan, DataError>;

    /// What only the format knows of the sequence: [`SequenceReader::origin`].
    fn origin(&self) -> Option<&dyn Any> {
        None
    }
}

/// The sequence, where its measurements lie, and what reads them.
pub(crate) struct FileSequence<F> {
    pub(crate) sequence: Sequence,
    pub(crate) files: MeasuredFiles,
    /// Files that belong to no measurement: tables, calibrations, poses.
    pub(crate) further: Vec<PathBuf>,
    pub(crate) warnings: Vec<String>,
    pub(crate) format: F,
}

impl<F: FileFormat> FileSequence<F> {
    /// A LiDAR's scan as its file has it.
    fn recorded(&self, lidar: usize, scan: usize) -> Result<LidarScan, DataError> {
        let file = measurement("lidar", &self.files.lidars, lidar, scan)?;
        let Sequence { rig, times, .. } = &self.sequence;
        self.format.lidar_scan(file, &rig.lidars[lidar], times.lidars[lidar][scan])
    }
}

impl<F: FileFormat> Source for FileSequence<F> {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let file = measurement("radar", &self.files.radars, radar, scan)?;
        let Sequence { rig, times, .. } = &self.sequence;
        let columns = self.format.radar_columns(file, radar, scan)?;
        let scan = RadarScan::new(&rig.radars[radar], times.radars[radar][scan], columns);
        Ok(scan.map_err(|found| DataError::content(file, "columns", "those of the radar", found))?)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        let recorded = self.recorded(lidar, scan)?;
        let Sequence { rig, motion, .. } = &self.sequence;
        Ok(if self.format.is_rolling() && motion.is_known() {
            recorded.motion_corrected(&rig.lidars[lidar].vehicle_from_lidar, motion)
        } else {
            recorded
        })
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        self.files.image(&self.sequence, camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        self.files.image_file(camera, image)?;
        Ok(None)
    }
}

impl<F: FileFormat> SequenceReader for FileSequence<F> {
    fn inputs(&self) -> Vec<PathBuf> {
        let mut inputs: Vec<PathBuf> = self.further.iter().chain(self.files.all()).cloned().collect();
        // A file may hold all scans of a radar.
        inputs.dedup();
        inputs
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn warning_of_motion(&self) -> Option<&'static str> {
        self.format.warning_of_motion()
    }

    fn image_file(&self, camera: usize, image: usize) -> Option<PathBuf> {
        self.files.image_file(camera, image).ok().cloned()
    }

    fn rolling_scan(&self, lidar: usize, scan: usize) -> Result<Option<LidarScan>, SourceError> {
        Ok(if self.format.is_rolling() { Some(self.recorded(lidar, scan)?) } else { None })
    }

    fn origin(&self) -> Option<&dyn Any> {
        self.format.origin()
    }
}
