//! A sequence of the own layout, read on demand.

use super::depth_card::contradicted;
use super::listing::{Partner, SensorFiles};
use super::raw::SequenceToml;
use super::{rig, tables};
use crate::disk::label_file::read_labels;
use crate::disk::{class_images, files, images, npy};
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::read::measured_files::lidar_rows;
use crate::read::view_origin::refuse_other;
use crate::tree::{self, CAUSE_NAMES, GROUND_TRUTH, LABELS, ODOMETRY, POSES, SENSORS, TIMES};
use ralf::sensors::{
    Camera, CameraImage, ClassImage, DepthImage, LONGEST_AFTER, Lidar, LidarScan, Radar, RadarScan, Rig,
    Sequence, Source, SourceError, Timelines,
};
use ralf::space::{EgoMotion, OdometrySample};
use std::path::{Path, PathBuf};

/// Place of a radar's truth, a LiDAR's classes, a camera's depth among its partners.
const FIRST: usize = 0;
/// Place of a radar's causes among its partners.
const CAUSES: usize = 1;
/// Place of the times of a LiDAR's points among its partners.
const POINT_TIMES: usize = 1;
/// Place of a camera's segmentation among its partners.
const SEGMENTATION: usize = 1;

/// A sequence's folder, opened: `sequence.toml`, times and motion are read, measurements are listed.
#[derive(Debug)]
pub struct LayoutSequence {
    sequence: Sequence,
    radars: Vec<SensorFiles>,
    lidars: Vec<SensorFiles>,
    cameras: Vec<SensorFiles>,
    /// `sequence.toml`, and what is there of `odometry.csv` and `poses.csv`.
    metadata: Vec<PathBuf>,
    /// Where causes have names.
    cause_names: Option<PathBuf>,
    warnings: Vec<String>,
}

impl LayoutSequence {
    /// Opens `DATASET/sequences/NN`. All that needs no measurement is checked: the sensors' settings, that times don't
    /// go back and that there is one for each file, the motion.
    pub fn open(folder: &Path) -> Result<Self, DataError> {
        let name = folder.file_name().and_then(|name| name.to_str());
        let name = name.ok_or_else(|| DataError::content(folder, "name", "UTF-8 text", "other bytes"))?;
        let toml_file = folder.join(SENSORS);
        let (toml, mut warnings) = SequenceToml::read(&toml_file)?;
        let rig = rig::rig(&toml_file, &toml)?;
        warnings.extend(odd_lenses(&toml_file, &rig));
        let [radars, lidars, cameras] = list(folder, &rig, &mut warnings)?;
        warnings.extend(unnamed(folder, &rig)?);
        if cameras.iter().any(|files| files.has_partners(FIRST)) {
            warnings.extend(contradicted(&toml_file, toml.depth.output));
        }
        let (motion, motion_files) = motion(folder, first_scan(&radars), &mut warnings)?;
        let times = |sensors: &[SensorFiles]| sensors.iter().map(|sensor| sensor.times.clone()).collect();
        let times = Timelines { radars: times(&radars), lidars: times(&lidars), cameras: times(&cameras) };
        let sequence = Sequence {
            name: name.to_owned(),
            title: toml.name,
            rig,
            times,
            motion,
            depth_output: toml.depth.output,
        };
        let metadata = [vec![toml_file], motion_files].concat();
        let cause_names = existing(folder.join(GROUND_TRUTH).join(CAUSE_NAMES))?;
        Ok(Self { sequence, radars, lidars, cameras, metadata, cause_names, warnings })
    }
}

impl LayoutSequence {
    /// What a network said of an image's views, of this kind of partner; refused where it said it of another image.
    fn of_views(&self, kind: usize, camera: usize, image: usize) -> Result<Option<&PathBuf>, DataError> {
        let (sensor, image_file) = measurement("camera", &self.cameras, camera, image)?;
        let Some(file) = sensor.partner(kind, image) else { return Ok(None) };
        refuse_other(file, &self.sequence.rig.cameras[camera], image_file)?;
        Ok(Some(file))
    }
}

/// Lenses that can't be straightened. Depth that is there already needs no lens, so these are no errors.
fn odd_lenses(file: &Path, rig: &Rig) -> Vec<String> {
    let check = |camera: &Camera| {
        let expected = camera.intrinsics.check(camera.width, camera.height).err()?;
        Some(format!("{}: {}: expected {expected}", file.display(), camera.name))
    };
    rig.cameras.iter().filter_map(check).collect()
}

/// A sensor's files, and that of one measurement, if it exists.
fn measurement<'a>(
    kind: &'static str,
    sensors: &'a [SensorFiles],
    sensor: usize,
    index: usize,
) -> Result<(&'a SensorFiles, &'a Path), DataError> {
    let found = sensors.get(sensor).and_then(|files| Some((files, files.files.get(index)?.as_path())));
    found.ok_or(DataError::NoMeasurement { kind, sensor, index })
}

/// The files of all radars, LiDARs and cameras.
fn list(folder: &Path, rig: &Rig, warnings: &mut Vec<String>) -> Result<[Vec<SensorFiles>; 3], DataError> {
    let label = |folder: PathBuf| Partner { folder, extension: LABELS };
    let mut list = |name: &str, extensions: &[&str], partners: &[Partner]| {
        SensorFiles::list(&folder.join(name), extensions, partners, warnings)
    };
    let truth = |name: &str| {
        let truth = folder.join(GROUND_TRUTH).join(name);
        [label(truth.clone()), Partner { folder: truth, extension: "cause" }]
    };
    let of_points = |name: &str| {
        let times = Partner { folder: folder.join(name), extension: "time" };
        [label(folder.join(name)), times]
    };
    let of_images = |name: &str| {
        let of = |kind, extension| Partner { folder: folder.join(name).join(kind), extension };
        [of(tree::DEPTH, "npy"), of(tree::SEGMENTATION, "png")]
    };
    let radars = rig.radars.iter().map(|Radar { name, .. }| list(name, &["bin"], &truth(name)));
    let radars = radars.collect::<Result<_, _>>()?;
    let lidars = rig.lidars.iter().map(|Lidar { name, .. }| list(name, &["bin"], &of_points(name)));
    let lidars = lidars.collect::<Result<_, _>>()?;
    let cameras =
        rig.cameras.iter().map(|Camera { name, .. }| list(name, &images::EXTENSIONS, &of_images(name)));
    Ok([radars, lidars, cameras.collect::<Result<_, _>>()?])
}

/// Folders of measurements that no table of `sequence.toml` names, which are not read.
fn unnamed(folder: &Path, rig: &Rig) -> Result<Option<String>, DataError> {
    let is_named = |name: &String| rig.names().any(|known| known == name);
    let mut names = files::folders(folder)?;
    names.retain(|name| name != GROUND_TRUTH && !is_named(name) && folder.join(name).join(TIMES).is_file());
    let sentence = |names: String| {
        let what = format!("folders with {TIMES} that no table of {SENSORS} names, and that are not read");
        format!("{}: {what}: {names}", folder.display())
    };
    Ok(Some(names.join(", ")).filter(|names| !names.is_empty()).map(sentence))
}

/// When the first radar scan was made, ns.
fn first_scan(radars: &[SensorFiles]) -> i64 {
    radars.iter().filter_map(|radar| radar.times.first()).min().copied().unwrap_or_default()
}

/// How the vehicle moved, and the files that say so. Of a parked one an odometry without rows is enough.
fn motion(
    folder: &Path,
    first_scan: i64,
    warnings: &mut Vec<String>,
) -> Result<(EgoMotion, Vec<PathBuf>), DataError> {
    let odometry_file = existing(folder.join(ODOMETRY))?;
    let poses_file = existing(folder.join(POSES))?;
    let mut odometry = odometry_file.as_deref().map_or(Ok(vec![]), tables::read_odometry)?;
    let poses = poses_file.as_deref().map_or(Ok(vec![]), tables::read_poses)?;
    let files: Vec<PathBuf> = [odometry_file, poses_file].into_iter().flatten().collect();
    if let (true, true, Some(file)) = (odometry.is_empty(), poses.is_empty(), files.first()) {
        warnings.push(format!("{}: no rows: the vehicle is taken to stand still", file.display()));
        odometry.push(OdometrySample { t_ns: first_scan, velocity: 0.0, yaw_rate: 0.0 });
    }
    // Where there is neither file, another trajectory or the radars have to tell it.
    let motion = EgoMotion::new(odometry, poses).unwrap_or_else(EgoMotion::unknown);
    Ok((motion, files))
}

/// The file, if there is one.
fn existing(file: PathBuf) -> Result<Option<PathBuf>, DataError> {
    let exists = files::exists(&file)?;
    Ok(exists.then_some(file))
}

impl Source for LayoutSequence {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let (sensor, file) = measurement("radar", &self.radars, radar, scan)?;
        let radar = &self.sequence.rig.radars[radar];
        let columns = files::read_f32_columns(file, radar.fields.len())?;
        Ok(RadarScan::new(radar, sensor.times[scan], columns)?)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        let (sensor, file) = measurement("lidar", &self.lidars, lidar, scan)?;
        let recorded = lidar_rows::<4>(file, sensor.times[scan])?;
        let points = recorded.points.len();
        let classes = sensor.partner(FIRST, scan).map(|file| classes(file, points)).transpose()?;
        let times = sensor.partner(POINT_TIMES, scan).map(|file| point_times(file, points)).transpose()?;
        Ok(LidarScan { times, classes, ..recorded })
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        let (_, file) = measurement("camera", &self.cameras, camera, image)?;
        images::read(file, &self.sequence.rig.cameras[camera])
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        let Some(file) = self.of_views(FIRST, camera, image)? else { return Ok(None) };
        let depth = npy::read_depth(file)?;
        let views = self.sequence.rig.cameras[camera].views.len().max(1);
        if depth.len() != views {
            let expected = format!("one image for each of the {views} views");
            return Err(DataError::content(file, "shape", expected, depth.len().to_string()).into());
        }
        Ok(Some(depth))
    }

    fn classes(&self, camera: usize, image: usize) -> Result<Option<Vec<ClassImage>>, SourceError> {
        let read = |file: &PathBuf| class_images::read(file, &self.sequence.rig.cameras[camera]);
        Ok(self.of_views(SEGMENTATION, camera, image)?.map(read).transpose()?)
    }
}

impl SequenceReader for LayoutSequence {
    fn inputs(&self) -> Vec<PathBuf> {
        let radars = self.radars.iter().flat_map(SensorFiles::measured);
        let others = self.lidars.iter().chain(&self.cameras).flat_map(SensorFiles::all);
        self.metadata.iter().chain(radars).chain(others).cloned().collect()
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn image_file(&self, camera: usize, image: usize) -> Option<PathBuf> {
        self.cameras.get(camera)?.files.get(image).cloned()
    }

    fn lidar_label_file(&self, lidar: usize, scan: usize) -> Option<PathBuf> {
        self.lidars.get(lidar)?.partner(FIRST, scan).cloned()
    }

    fn has_depth(&self, camera: usize) -> bool {
        self.cameras.get(camera).is_some_and(|files| files.has_partners(FIRST))
    }

    fn has_segmentation(&self) -> bool {
        self.cameras.iter().any(|files| files.has_partners(SEGMENTATION))
    }

    fn truth_file(&self, radar: usize, scan: usize) -> Option<PathBuf> {
        self.radars.get(radar)?.partner(FIRST, scan).cloned()
    }

    fn cause_file(&self, radar: usize, scan: usize) -> Option<PathBuf> {
        self.radars.get(radar)?.partner(CAUSES, scan).cloned()
    }

    fn cause_names_file(&self) -> Option<PathBuf> {
        self.cause_names.clone()
    }
}

/// When each of so many points was measured, s after the scan's time, from a `.time` file.
fn point_times(file: &Path, points: usize) -> Result<Vec<f32>, DataError> {
    let times = files::read_f32_columns(file, 1)?.swap_remove(0);
    if times.len() != points {
        let expected = format!("{points} float32, one per point");
        return Err(DataError::content(file, "size", expected, times.len().to_string()));
    }
    let is_near = |time: &f32| f64::from(time.abs()) <= LONGEST_AFTER;
    match times.iter().position(|time| !is_near(time)) {
        Some(row) => {
            let place = format!("byte {}", row * size_of::<f32>());
            let expected = format!("a time within {LONGEST_AFTER} s of the scan's");
            Err(DataError::content(file, place, expected, times[row].to_string()))
        }
        None => Ok(times),
    }
}

/// The class of each of so many points, from a `.label` file.
fn classes(file: &Path, points: usize) -> Result<Vec<u16>, DataError> {
    let labels = read_labels(file)?;
    if labels.len() == points {
        return Ok(labels.into_iter().map(|label| label.id).collect());
    }
    Err(DataError::content(file, "size", format!("{points} uint32, one per point"), labels.len().to_string()))
}
