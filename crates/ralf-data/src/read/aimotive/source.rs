//! A sequence as a source: measurements typed.

use super::calibration::Calibrated;
use super::cloud::rolling_scan;
use super::frames::{FrameTimes, Frames, list};
use super::raw::{Calibration, RadarFile, Target};
use super::{CALIBRATION, RADARS, motion};
use crate::disk::files;
use crate::disk::json;
use crate::error::DataError;
use crate::read::file_sequence::{FileFormat, FileSequence};
use crate::read::measured_files::MeasuredFiles;
use ralf::sensors::{DepthOutput, Lidar, LidarScan, Rig, Sequence, Timelines};
use ralf::space::EgoMotion;
use ralf_files::Kind;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// What is said where no file of a sequence tells the vehicle's motion.
const NO_POSES: &str = "no poses (sensor/gnssins/egomotion.json): the vehicle's motion has to come from a trajectory \
                        or from range rates, and only with it are LiDAR points motion-corrected";

/// How the files of a sequence are read.
pub(super) struct Drive;

/// The files of all sensors, by the sensor's name where there can be several of a kind.
struct Listed {
    radars: BTreeMap<String, Frames>,
    lidar: Frames,
    cameras: BTreeMap<String, Frames>,
}

/// A sequence's folder: reads the names of all measurements, the calibration, the frames' times and the poses.
pub(super) fn drive(folder: &Path) -> Result<FileSequence<Drive>, DataError> {
    let calibration_file = folder.join(CALIBRATION);
    let calibration: Calibration = json::read(&calibration_file, Kind::Settings, "the sensors by name")?;
    let listed = Listed::new(folder)?;
    let frames = listed.frames(folder)?;
    let told = FrameTimes::read(folder, &frames, &listed.lidar)?;
    let mut warnings: Vec<String> = told.warning.into_iter().collect();
    let (rig, sensors) = listed.rig(&calibration_file, &calibration, &mut warnings)?;
    let (times, files) = timelines(&rig, &sensors, &told.times, &mut warnings);
    let poses = motion::read(folder, &told.times)?;
    if poses.is_none() {
        warnings.push(NO_POSES.into());
    }
    let (motion, pose_file) =
        poses.map_or((EgoMotion::unknown(), None), |(motion, file)| (motion, Some(file)));
    let further = [calibration_file].into_iter().chain(pose_file).chain(told.boxes).collect();
    let sequence = Sequence {
        name: name_of(folder),
        title: title(folder),
        rig,
        times,
        motion,
        depth_output: DepthOutput::default(),
    };
    Ok(FileSequence { sequence, files, further, warnings, format: Drive })
}

/// Tells the folder that a sequence lies in, whichever way its path was typed.
fn title(folder: &Path) -> String {
    let above = files::whole(folder).parent().map(name_of).filter(|name| !name.is_empty());
    above.map_or_else(|| "aiMotive".to_owned(), |name| format!("aiMotive, {name}"))
}

fn name_of(folder: &Path) -> String {
    folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

impl Listed {
    fn new(folder: &Path) -> Result<Self, DataError> {
        Ok(Self {
            radars: by_name(&folder.join(RADARS), "json")?,
            lidar: list(&folder.join("dynamic/raw-revolutions"), "frame", "laz")?,
            cameras: by_name(&folder.join("sensor/camera"), "jpg")?,
        })
    }

    /// All frames that any sensor has; at least one.
    fn frames(&self, folder: &Path) -> Result<BTreeSet<u64>, DataError> {
        let sensors = self.radars.values().chain([&self.lidar]).chain(self.cameras.values());
        let frames: BTreeSet<u64> = sensors.flat_map(BTreeMap::keys).copied().collect();
        if frames.is_empty() {
            return Err(DataError::content(
                folder,
                "files",
                "measurements of radars, LiDAR or cameras",
                "none",
            ));
        }
        Ok(frames)
    }

    /// The sensors, and the files of each in the rig's order.
    fn rig(
        &self,
        file: &Path,
        calibration: &Calibration,
        warnings: &mut Vec<String>,
    ) -> Result<(Rig, [Vec<&Frames>; 3]), DataError> {
        let mut rig = Rig::default();
        let mut sensors = [Vec::new(), Vec::new(), Vec::new()];
        for (name, frames) in &self.radars {
            rig.radars.push(Calibrated::find(file, calibration, name, "radar")?.radar()?);
            sensors[0].push(frames);
        }
        let radars = calibration.iter().filter(|(_, sensor)| sensor.sensor_type == "radar");
        for (name, _) in radars.filter(|(name, _)| !self.radars.contains_key(*name)) {
            warnings.push(format!("{name}: a radar in {CALIBRATION} without a folder in {RADARS}: left out"));
        }
        if !self.lidar.is_empty() {
            rig.lidars.push(Calibrated::only_lidar(file, calibration)?.lidar()?);
            sensors[1].push(&self.lidar);
        }
        for (name, frames) in &self.cameras {
            let calibrated = Calibrated::find(file, calibration, name, "camera")?;
            if calibrated.is_mei() {
                warnings
                    .push(format!("{name}: a fisheye of the model `mei`, which RALF doesn't know: left out"));
                continue;
            }
            rig.cameras.push(calibrated.camera()?);
            sensors[2].push(frames);
        }
        Ok((rig, sensors))
    }
}

/// The frames of all sensors of a kind: each has a folder of its own.
fn by_name(folder: &Path, extension: &str) -> Result<BTreeMap<String, Frames>, DataError> {
    let mut found = BTreeMap::new();
    for name in files::folders(folder)? {
        let frames = list(&folder.join(&name), &name, extension)?;
        found.insert(name, frames);
    }
    Ok(found)
}

/// When each sensor delivered and where its files are, with a warning of frames that it lacks.
fn timelines(
    rig: &Rig,
    [radars, lidars, cameras]: &[Vec<&Frames>; 3],
    times: &BTreeMap<u64, i64>,
    warnings: &mut Vec<String>,
) -> (Timelines, MeasuredFiles) {
    let mut of_kind = |names: Vec<&String>, sensors: &[&Frames]| {
        let (mut timelines, mut files) = (Vec::new(), Vec::new());
        for (name, frames) in names.into_iter().zip(sensors) {
            let missing = times.len() - frames.len();
            if missing > 0 {
                let all = times.len();
                warnings.push(format!("{missing} of {all} files of {name} are not there and were left out"));
            }
            timelines.push(frames.keys().filter_map(|frame| times.get(frame).copied()).collect());
            files.push(frames.values().cloned().collect());
        }
        (timelines, files)
    };
    let (radar_times, radar_files) = of_kind(rig.radars.iter().map(|radar| &radar.name).collect(), radars);
    let (lidar_times, lidar_files) = of_kind(rig.lidars.iter().map(|lidar| &lidar.name).collect(), lidars);
    let (camera_times, camera_files) =
        of_kind(rig.cameras.iter().map(|camera| &camera.name).collect(), cameras);
    let times = Timelines { radars: radar_times, lidars: lidar_times, cameras: camera_times };
    (times, MeasuredFiles { radars: radar_files, lidars: lidar_files, cameras: camera_files })
}

/// The columns of a radar's file: as published, then what is derived.
fn columns(file: &Path) -> Result<Vec<Vec<f32>>, DataError> {
    let expected = "`targets`, each with azimuth, elevation, range, speed, rcs, power, noise";
    let RadarFile { targets } = json::read(file, Kind::Measurement, expected)?;
    let column = |value: fn(&Target) -> f64| targets.iter().map(|target| value(target) as f32).collect();
    Ok(vec![
        column(|target| target.azimuth),
        column(|target| target.elevation),
        column(|target| target.range),
        column(|target| target.speed),
        column(|target| target.rcs),
        column(|target| target.power),
        column(|target| target.noise),
        column(|target| 10.0 * target.rcs.log10()),
        column(|target| target.power - target.noise),
    ])
}

impl FileFormat for Drive {
    fn is_rolling(&self) -> bool {
        true
    }

    fn warning_of_motion(&self) -> Option<&'static str> {
        Some(NO_POSES)
    }

    fn radar_columns(&self, file: &Path, _: usize, _: usize) -> Result<Vec<Vec<f32>>, DataError> {
        columns(file)
    }

    fn lidar_scan(&self, file: &Path, lidar: &Lidar, t_ns: i64) -> Result<LidarScan, DataError> {
        rolling_scan(file, lidar, t_ns)
    }
}

#[cfg(test)]
mod tests {
    use super::title;
    use std::path::Path;

    #[test]
    fn a_title_tells_where_a_sequence_lies_if_anywhere() {
        let here = std::env::current_dir().unwrap();
        let here = here.file_name().unwrap().to_str().unwrap();
        let titles = ["highway/20210401", "20210401", "/20210401"].map(|folder| title(Path::new(folder)));
        assert_eq!(
            titles,
            ["aiMotive, highway".to_owned(), format!("aiMotive, {here}"), "aiMotive".to_owned()]
        );
    }
}
