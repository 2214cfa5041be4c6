//! The training frames as a source: measurements typed.

use super::calibration::{Mounting, camera, camera_from_sensor, odom_from_vehicle, vehicle_from_lidar};
use super::raw::{Calib, Frame, frames};
use crate::disk::files;
use crate::disk::files::Folders;
use crate::disk::images;
use crate::error::DataError;
use crate::read::file_sequence::{FileFormat, FileSequence};
use crate::read::measured_files::{MeasuredFiles, lidar_rows, present};
use crate::read::models::{HDL_64E_S3, ZF_FRGEN21};
use ralf::sensors::{DepthOutput, Lidar, LidarScan, Rig, Sequence, Timelines};
use ralf::space::{EgoMotion, PoseSample};
use std::path::{Path, PathBuf};

/// The columns of a radar file: `v_r` is `doppler`, `v_r_compensated` `doppler_compensated`; `time` counts scans back.
const RADAR_FIELDS: [&str; 7] = ["x", "y", "z", "rcs", "doppler", "doppler_compensated", "time"];
/// Frames are taken at 10 Hz.
const FRAME_NS: i64 = 100_000_000;
/// Width and height of the published images, px, for a data set that is copied without them.
const IMAGE_SIZE: [usize; 2] = [1936, 1216];
/// A pose this far from the frame before belongs to another drive, m: half of it would be 25 m/s.
const LARGEST_STEP: f64 = 5.0;

/// How the files of the sequence `training` are read.
pub(super) struct Training;

/// The frames and where their files are.
struct Layout {
    radar: PathBuf,
    lidar: PathBuf,
    frames: Vec<Frame>,
    folders: Folders,
}

/// The sequence: reads the names of all measurements, and all calibrations and poses.
pub(super) fn training(dataset: &Path) -> Result<FileSequence<Training>, DataError> {
    let [radar, lidar] = ["radar", "lidar"].map(|sensor| dataset.join(sensor).join("training"));
    let frames = frames(&radar.join("velodyne"))?;
    let mut layout = Layout { radar, lidar, frames, folders: Folders::default() };
    let mut warnings = Vec::new();
    let mounting = layout.mounting(&layout.frames[0])?;
    let further = layout.further_files();
    layout.compare_mountings(&mounting, &mut warnings)?;
    let poses = layout.poses(&mounting)?;
    warn_of_jumps(&poses, &mut warnings);
    let motion = EgoMotion::new(Vec::new(), poses)
        .ok_or_else(|| DataError::content(&layout.radar, "poses", "one per frame", "none"))?;
    let (radar_times, radar_files) = layout.present("radar", "velodyne", "bin", &mut warnings)?;
    let (lidar_times, lidar_files) = layout.present("lidar", "velodyne", "bin", &mut warnings)?;
    let (camera_times, camera_files) = layout.present("camera", "image_2", "jpg", &mut warnings)?;
    let image_size = camera_files.first().map_or(Ok(IMAGE_SIZE), |file| images::size(file))?;
    let sequence = Sequence {
        name: "training".to_owned(),
        title: "View-of-Delft, training".to_owned(),
        rig: layout.rig(&mounting, image_size)?,
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
    Ok(FileSequence { sequence, files, further, warnings, format: Training })
}

impl Layout {
    fn calib_files(&self, frame: &Frame) -> [PathBuf; 2] {
        [&self.radar, &self.lidar].map(|folder| folder.join("calib").join(format!("{}.txt", frame.stem)))
    }

    fn pose_file(&self, frame: &Frame) -> PathBuf {
        self.radar.join("pose").join(format!("{}.json", frame.stem))
    }

    fn further_files(&self) -> Vec<PathBuf> {
        let files = |frame| self.calib_files(frame).into_iter().chain([self.pose_file(frame)]);
        self.frames.iter().flat_map(files).collect()
    }

    fn mounting(&self, frame: &Frame) -> Result<Mounting, DataError> {
        let [radar, lidar] = self.calib_files(frame);
        Ok(Mounting {
            camera_from_radar: camera_from_sensor(&radar, &Calib::read(&radar)?)?,
            camera_from_lidar: camera_from_sensor(&lidar, &Calib::read(&lidar)?)?,
        })
    }

    fn compare_mountings(&self, first: &Mounting, warnings: &mut Vec<String>) -> Result<(), DataError> {
        let mut different = Vec::new();
        for frame in &self.frames[1..] {
            if !self.mounting(frame)?.agrees_with(first) {
                different.push(frame.stem.as_str());
            }
        }
        if let Some(stem) = different.first() {
            let (count, used) = (different.len(), &self.frames[0].stem);
            warnings.push(format!(
                "the calibration of {count} frames ({stem} first) is not that of frame {used}, which was used"
            ));
        }
        Ok(())
    }

    fn poses(&self, mounting: &Mounting) -> Result<Vec<PoseSample>, DataError> {
        let folder = self.radar.join("pose");
        if !folder.is_dir() {
            let expected = "a pose per frame, as without them the vehicle's motion is unknown";
            return Err(DataError::content(&folder, "files", expected, "no such folder"));
        }
        let pose = |frame: &Frame| {
            let odom_from_vehicle = odom_from_vehicle(&self.pose_file(frame), mounting)?;
            Ok(PoseSample { t_ns: time(frame), odom_from_vehicle })
        };
        self.frames.iter().map(pose).collect()
    }

    /// Times and files of those frames that a sensor has, with a warning of the others.
    fn present(
        &mut self,
        sensor: &str,
        folder: &str,
        extension: &str,
        warnings: &mut Vec<String>,
    ) -> Result<(Vec<i64>, Vec<PathBuf>), DataError> {
        let root = if sensor == "lidar" { &self.lidar } else { &self.radar };
        let file = |frame: &Frame| root.join(folder).join(&frame.stem).with_extension(extension);
        let listed = self.frames.iter().map(|frame| (time(frame), file(frame))).collect();
        Ok(present(sensor, listed, &mut self.folders, warnings)?.into_iter().unzip())
    }

    fn rig(&self, mounting: &Mounting, image_size: [usize; 2]) -> Result<Rig, DataError> {
        let [calib, _] = self.calib_files(&self.frames[0]);
        Ok(Rig {
            radars: vec![ZF_FRGEN21.mounted("radar", &RADAR_FIELDS, mounting.vehicle_from_radar())],
            lidars: vec![HDL_64E_S3.mounted("lidar", vehicle_from_lidar())],
            cameras: vec![camera(&calib, &Calib::read(&calib)?, mounting, image_size)?],
        })
    }
}

fn time(frame: &Frame) -> i64 {
    i64::from(frame.number) * FRAME_NS
}

/// The data set's drives are numbered through, each with an odom frame of its own.
fn warn_of_jumps(poses: &[PoseSample], warnings: &mut Vec<String>) {
    let step = |pair: &[PoseSample]| {
        let [before, after] = [&pair[0], &pair[1]].map(|pose| pose.odom_from_vehicle.translation.vector);
        (after - before).norm()
    };
    for pair in poses.windows(2).filter(|pair| pair[1].t_ns - pair[0].t_ns == FRAME_NS) {
        let metres = step(pair);
        if metres > LARGEST_STEP {
            let [before, after] = [pair[0].t_ns / FRAME_NS, pair[1].t_ns / FRAME_NS];
            warnings.push(format!(
                "the pose jumps by {metres:.1} m between the frames {before} and {after}: tracking across them is not \
                 to be trusted"
            ));
        }
    }
}

impl FileFormat for Training {
    fn radar_columns(&self, file: &Path, _: usize, _: usize) -> Result<Vec<Vec<f32>>, DataError> {
        files::read_f32_columns(file, RADAR_FIELDS.len())
    }

    fn lidar_scan(&self, file: &Path, _: &Lidar, t_ns: i64) -> Result<LidarScan, DataError> {
        lidar_rows::<4>(file, t_ns)
    }
}
