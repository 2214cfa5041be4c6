//! A sequence: its sensors, and what its files hold.

use super::calibration::Calibration;
use super::info::{Frame, Info};
use super::radar::{RadarFiles, Scans};
use super::{lidar, motion, radar};
use crate::disk::files::Folders;
use crate::error::DataError;
use crate::read::file_sequence::{FileFormat, FileSequence};
use crate::read::measured_files::{MeasuredFiles, present};
use crate::read::row_scans::torn_scans;
use ralf::sensors::{DepthOutput, Lidar, LidarScan, Rig, Sequence, Timelines};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How the files of a sequence are read.
pub(super) struct Zod {
    /// Which rows of the radar's file each scan has.
    rows: Vec<Range<usize>>,
    radar_files: Arc<RadarFiles>,
    is_rolling: bool,
}

/// A sequence's rig, times and files, in the making.
#[derive(Default)]
struct Found {
    rig: Rig,
    times: Timelines,
    files: MeasuredFiles,
    warnings: Vec<String>,
}

/// The sequence that `list` has under this name.
pub(super) fn sequence(
    dataset: &Path,
    name: &str,
    list: &Path,
    info: Info,
    radar_files: &Arc<RadarFiles>,
) -> Result<FileSequence<Zod>, DataError> {
    let [calibration_file, motion_file] =
        [&info.calibration_path, &info.ego_motion_path].map(|path| dataset.join(path));
    let calibration = Calibration::read(&calibration_file)?;
    let motion = motion::read(&motion_file)?;
    let mut found = Found::default();
    let Scans { rows, .. } = found.add_radar(dataset, &calibration, &info)?;
    let mut folders = Folders::default();
    let is_rolling = found.add_lidar(dataset, &calibration, &info, &mut folders)?;
    found.add_camera(dataset, &calibration, &info, &mut folders)?;
    let Found { rig, times, files, warnings } = found;
    let (name, title) = (name.to_owned(), "Zenseact Open Dataset".to_owned());
    let sequence = Sequence { name, title, rig, times, motion, depth_output: DepthOutput::default() };
    let further = vec![list.to_owned(), calibration_file, motion_file];
    let format = Zod { rows, radar_files: radar_files.clone(), is_rolling };
    Ok(FileSequence { sequence, files, further, warnings, format })
}

impl Found {
    fn add_radar(
        &mut self,
        dataset: &Path,
        calibration: &Calibration,
        info: &Info,
    ) -> Result<Scans, DataError> {
        let frames = info.radar_frames.iter().flat_map(|sensors| sensors.get("front")).flatten();
        let mut names: Vec<&String> = frames.map(|frame| &frame.filepath).collect();
        names.dedup();
        let [name] = names[..] else {
            let found =
                if names.is_empty() { "no radar file is listed" } else { "several radar files are listed" };
            self.warnings.push(format!(
                "{found}, and one with all scans is expected: the radar is left out (downloads from the end of 2024 on \
                 have it)"
            ));
            return Ok(Scans::default());
        };
        let Some(radar) = calibration.radar()? else {
            self.warnings.push(
                "the calibration has no `radar_extrinsics`: the radar can't be placed and is left out (downloads from \
                 May 2025 on have them)"
                    .into(),
            );
            return Ok(Scans::default());
        };
        let file = dataset.join(name);
        let scans = Scans::find(&file)?;
        self.warnings.extend(torn_scans(scans.torn));
        self.rig.radars.push(radar);
        self.times.radars.push(scans.times.clone());
        self.files.radars.push(vec![file; scans.times.len()]);
        Ok(scans)
    }

    /// Whether its points lie where they were measured.
    fn add_lidar(
        &mut self,
        dataset: &Path,
        calibration: &Calibration,
        info: &Info,
        folders: &mut Folders,
    ) -> Result<bool, DataError> {
        let frames = info.lidar_frames.get("velodyne").map_or(&[][..], Vec::as_slice);
        let compensated = frames.iter().filter(|frame| frame.is_compensated).count();
        if compensated != 0 && compensated != frames.len() {
            let found = format!("{compensated} of {}", frames.len());
            let expected = "all of a sequence's LiDAR frames compensated, or none";
            return Err(DataError::content(dataset, format!("sequence {}", info.id), expected, found));
        }
        let (times, files) = self.present("lidar_velodyne", dataset, frames, folders)?;
        self.rig.lidars.push(calibration.lidar()?);
        self.times.lidars.push(times);
        self.files.lidars.push(files);
        Ok(compensated == 0)
    }

    /// The first kind of anonymisation that is on disk.
    fn add_camera(
        &mut self,
        dataset: &Path,
        calibration: &Calibration,
        info: &Info,
        folders: &mut Folders,
    ) -> Result<(), DataError> {
        for (_, frames) in info.camera_frames.iter().filter(|(kind, _)| kind.starts_with("front")) {
            let mut is_there = false;
            for frame in frames {
                is_there |= folders.hold(&dataset.join(&frame.filepath))?;
            }
            if is_there {
                let (times, files) = self.present("camera_front", dataset, frames, folders)?;
                self.rig.cameras.push(calibration.camera()?);
                self.times.cameras.push(times);
                self.files.cameras.push(files);
                break;
            }
        }
        Ok(())
    }

    /// Times and files of those frames that are on disk, in the order of time, with a warning of the others.
    fn present(
        &mut self,
        sensor: &str,
        dataset: &Path,
        frames: &[Frame],
        folders: &mut Folders,
    ) -> Result<(Vec<i64>, Vec<PathBuf>), DataError> {
        let listed = frames.iter().map(|frame| (frame.t_ns, dataset.join(&frame.filepath)));
        let mut found = present(sensor, listed.collect(), folders, &mut self.warnings)?;
        found.sort();
        Ok(found.into_iter().unzip())
    }
}

impl FileFormat for Zod {
    fn is_rolling(&self) -> bool {
        self.is_rolling
    }

    fn radar_columns(&self, file: &Path, _: usize, scan: usize) -> Result<Vec<Vec<f32>>, DataError> {
        radar::scan(file, &self.radar_files.of(file)?, &self.rows[scan])
    }

    fn lidar_scan(&self, file: &Path, _: &Lidar, t_ns: i64) -> Result<LidarScan, DataError> {
        lidar::read(file, t_ns)
    }
}
