//! A clip's frames as a source: measurements typed.

use super::calibration::{Mounting, camera, camera_from_sensor, vehicle_from_lidar};
use super::motion;
use super::raw::{Calib, Frame, frames};
use crate::disk::files;
use crate::disk::files::Folders;
use crate::disk::images;
use crate::error::DataError;
use crate::read::file_sequence::{FileFormat, FileSequence};
use crate::read::measured_files::{MeasuredFiles, lidar_rows, present};
use crate::read::models::{HDL_64E_S3, ZF_FRGEN21};
use ralf::sensors::{DepthOutput, Lidar, LidarScan, Rig, Sequence, Timelines};
use std::path::{Path, PathBuf};

/// The columns of a radar file: `v_r` is `doppler`, `v_r_compensated` `doppler_compensated`; `time` counts scans back.
const RADAR_FIELDS: [&str; 7] = ["x", "y", "z", "rcs", "doppler", "doppler_compensated", "time"];
/// Width and height of the published images, px, for a data set that is copied without them.
const IMAGE_SIZE: [usize; 2] = [1936, 1216];

/// How a clip's files are read.
pub(super) struct Published;

/// Where the files of the data set lie.
pub(super) struct Layout {
    radar: PathBuf,
    lidar: PathBuf,
    images: PathBuf,
    poses: PathBuf,
    folders: Folders,
}

impl Layout {
    /// Images and poses are the same for both sensors. Published are links from the radar's folder to the LiDAR's,
    /// which get lost where a system has none.
    pub(super) fn of(dataset: &Path) -> Self {
        let [radar, lidar] = ["radar", "lidar"].map(|sensor| dataset.join(sensor).join("training"));
        let shared = |folder: &str| {
            let [own, other] = [&radar, &lidar].map(|sensor| sensor.join(folder));
            if !own.is_dir() && other.is_dir() { other } else { own }
        };
        let [images, poses] = ["image_2", "pose"].map(shared);
        Self { radar, lidar, images, poses, folders: Folders::default() }
    }

    /// All frames that the radar has.
    pub(super) fn frames(&self) -> Result<Vec<Frame>, DataError> {
        frames(&self.radar.join("velodyne"))
    }

    /// The sequence of some frames, at least one: reads the names of all measurements, and all calibrations and poses.
    pub(super) fn sequence(
        &mut self,
        name: &str,
        frames: &[Frame],
    ) -> Result<FileSequence<Published>, DataError> {
        let mut warnings = Vec::new();
        let mounting = self.mounting(&frames[0])?;
        self.compare_mountings(frames, &mounting, &mut warnings)?;
        let (motion, poses) = motion::read(&self.poses, frames, &mounting, &mut warnings)?;
        let calibrations = frames.iter().flat_map(|frame| self.calib_files(frame));
        let further = calibrations.chain(poses).collect();
        let [radar, lidar] = [&self.radar, &self.lidar].map(|folder| folder.join("velodyne"));
        let images = self.images.clone();
        let (radar_times, radar_files) = self.present("radar", &radar, "bin", frames, &mut warnings)?;
        let (lidar_times, lidar_files) = self.present("lidar", &lidar, "bin", frames, &mut warnings)?;
        let (camera_times, camera_files) = self.present("camera", &images, "jpg", frames, &mut warnings)?;
        let image_size = camera_files.first().map_or(Ok(IMAGE_SIZE), |file| images::size(file))?;
        let sequence = Sequence {
            name: name.to_owned(),
            title: format!("View-of-Delft, {name}"),
            rig: self.rig(&frames[0], &mounting, image_size)?,
            times: Timelines {
                radars: vec![radar_times],
                lidars: vec![lidar_times],
                cameras: vec![camera_times],
            },
            motion,
            depth_output: DepthOutput::default(),
        };
        let [radars, lidars, cameras] = [radar_files, lidar_files, camera_files].map(|files| vec![files]);
        let files = MeasuredFiles { radars, lidars, cameras };
        Ok(FileSequence { sequence, files, further, warnings, format: Published })
    }

    fn calib_files(&self, frame: &Frame) -> [PathBuf; 2] {
        [&self.radar, &self.lidar].map(|folder| folder.join("calib").join(format!("{}.txt", frame.stem)))
    }

    fn mounting(&self, frame: &Frame) -> Result<Mounting, DataError> {
        let [radar, lidar] = self.calib_files(frame);
        Ok(Mounting {
            camera_from_radar: camera_from_sensor(&radar, &Calib::read(&radar)?)?,
            camera_from_lidar: camera_from_sensor(&lidar, &Calib::read(&lidar)?)?,
        })
    }

    fn compare_mountings(
        &self,
        frames: &[Frame],
        first: &Mounting,
        warnings: &mut Vec<String>,
    ) -> Result<(), DataError> {
        let mut different = Vec::new();
        for frame in &frames[1..] {
            if !self.mounting(frame)?.agrees_with(first) {
                different.push(frame.stem.as_str());
            }
        }
        if let Some(stem) = different.first() {
            let (count, used) = (different.len(), &frames[0].stem);
            warnings.push(format!(
                "the calibration of {count} frames ({stem} first) is not that of frame {used}, which was used"
            ));
        }
        Ok(())
    }

    /// Times and files of those frames that a sensor has, with a warning of the others.
    fn present(
        &mut self,
        sensor: &str,
        folder: &Path,
        extension: &str,
        frames: &[Frame],
        warnings: &mut Vec<String>,
    ) -> Result<(Vec<i64>, Vec<PathBuf>), DataError> {
        let file = |frame: &Frame| folder.join(&frame.stem).with_extension(extension);
        let listed = frames.iter().map(|frame| (frame.time_ns(), file(frame))).collect();
        Ok(present(sensor, listed, &mut self.folders, warnings)?.into_iter().unzip())
    }

    fn rig(&self, first: &Frame, mounting: &Mounting, image_size: [usize; 2]) -> Result<Rig, DataError> {
        let [calib, _] = self.calib_files(first);
        Ok(Rig {
            radars: vec![ZF_FRGEN21.mounted("radar", &RADAR_FIELDS, mounting.vehicle_from_radar())],
            lidars: vec![HDL_64E_S3.mounted("lidar", vehicle_from_lidar())],
            cameras: vec![camera(&calib, &Calib::read(&calib)?, mounting, image_size)?],
        })
    }
}

impl FileFormat for Published {
    fn radar_columns(&self, file: &Path, _: usize, _: usize) -> Result<Vec<Vec<f32>>, DataError> {
        files::read_f32_columns(file, RADAR_FIELDS.len())
    }

    fn lidar_scan(&self, file: &Path, _: &Lidar, t_ns: i64) -> Result<LidarScan, DataError> {
        lidar_rows::<4>(file, t_ns)
    }
}
