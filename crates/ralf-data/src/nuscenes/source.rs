//! A scene as a source: measurements typed.

use super::join::{Channel, SceneRecord};
use super::pcd::Pcd;
use super::raw::{Modality, Token};
use super::rig::{PCD_FIELDS, rig};
use super::{can, join};
use crate::files::{self, Folders};
use crate::recording::measurement;
use crate::{DataError, NuScenesKey, SequenceReader, images, radial::radial};
use ralf::camera::{CameraImage, DepthImage, DepthOutput};
use ralf::measurement::{LidarScan, RadarScan};
use ralf::motion::EgoMotion;
use ralf::source::{Sequence, Source, SourceError, Timelines};
use std::path::{Path, PathBuf};

/// The files of each sensor, in the order of its timeline.
type FilesPerSensor = Vec<Vec<PathBuf>>;

/// One scene.
pub(super) struct Scene {
    sequence: Sequence,
    radars: FilesPerSensor,
    lidars: FilesPerSensor,
    cameras: FilesPerSensor,
    /// The version folder's name.
    version: String,
    /// The rows of the radars' scans in `sample_data.json`.
    radar_tokens: Vec<Vec<Token>>,
    /// Tables, and the CAN bus where it is there.
    tables: Vec<PathBuf>,
    warnings: Vec<String>,
}

impl Scene {
    /// Keeps what is on disk of what the tables list.
    pub(super) fn new(
        dataset: &Path,
        tables: &[PathBuf],
        record: SceneRecord,
        folders: &mut Folders,
    ) -> Result<Self, DataError> {
        let mut tables = tables.to_vec();
        let version = tables.first().and_then(|table| table.parent()).unwrap_or(dataset).to_owned();
        let rig = rig(&version, &record.channels)?;
        let can = can::file(dataset, &record.name);
        let odometry = can.as_deref().map(can::read).transpose()?.unwrap_or_default();
        tables.extend(can);
        let motion = EgoMotion::new(odometry, record.poses).ok_or_else(|| {
            DataError::content(dataset, format!("scene `{}`", record.name), "ego poses", "none")
        })?;
        let sequence = Sequence {
            name: record.name,
            title: record.title,
            rig,
            times: Timelines::default(),
            motion,
            depth_output: DepthOutput::default(),
        };
        let [radars, lidars, cameras] = [const { Vec::new() }; 3];
        let version = version.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let (radar_tokens, warnings) = (Vec::new(), Vec::new());
        let mut scene = Self { sequence, radars, lidars, cameras, version, radar_tokens, tables, warnings };
        for channel in record.channels {
            scene.add(dataset, channel, folders)?;
        }
        Ok(scene)
    }

    fn add(&mut self, dataset: &Path, channel: Channel, folders: &mut Folders) -> Result<(), DataError> {
        let listed = channel.measurements.len();
        let (mut times, mut files) = (Vec::with_capacity(listed), Vec::with_capacity(listed));
        let mut tokens = Vec::new();
        for join::Measurement { token, t_ns, file } in channel.measurements {
            let file = dataset.join(&*file);
            if folders.hold(&file)? {
                times.push(t_ns);
                files.push(file);
                tokens.push(token);
            }
        }
        if channel.calibration.modality == Modality::Radar {
            self.radar_tokens.push(tokens);
        }
        if files.len() < listed {
            let (name, missing) = (&channel.calibration.name, listed - files.len());
            self.warnings
                .push(format!("{missing} of {listed} files of {name} are not there and were left out"));
        }
        let timelines = &mut self.sequence.times;
        let (timeline, place) = match channel.calibration.modality {
            Modality::Radar => (&mut timelines.radars, &mut self.radars),
            Modality::Lidar => (&mut timelines.lidars, &mut self.lidars),
            Modality::Camera => (&mut timelines.cameras, &mut self.cameras),
        };
        timeline.push(times);
        place.push(files);
        Ok(())
    }
}

impl Source for Scene {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let file = measurement("radar", &self.radars, radar, scan)?;
        let columns = radar_columns(&Pcd::read(file)?)?;
        let t_ns = self.sequence.times.radars[radar][scan];
        let scan = RadarScan::new(&self.sequence.rig.radars[radar], t_ns, columns);
        Ok(scan.map_err(|found| DataError::content(file, "columns", "those of the radar", found))?)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        // The fifth column is the ring.
        let mut columns = files::read_f32_columns(measurement("lidar", &self.lidars, lidar, scan)?, 5)?;
        let intensity = columns.swap_remove(3);
        let points =
            (0..intensity.len()).map(|row| [columns[0][row], columns[1][row], columns[2][row]]).collect();
        Ok(LidarScan { t_ns: self.sequence.times.lidars[lidar][scan], points, intensity, classes: None })
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        let file = measurement("camera", &self.cameras, camera, image)?;
        let model = &self.sequence.rig.cameras[camera];
        Ok(images::read_of_size(file, model.width, model.height)?)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        measurement("camera", &self.cameras, camera, image)?;
        Ok(None)
    }
}

impl SequenceReader for Scene {
    fn inputs(&self) -> Vec<PathBuf> {
        let measured = [&self.radars, &self.lidars, &self.cameras];
        self.tables.iter().chain(measured.into_iter().flatten().flatten()).cloned().collect()
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn image_file(&self, camera: usize, image: usize) -> Option<PathBuf> {
        self.cameras.get(camera)?.get(image).cloned()
    }

    fn nuscenes_key(&self, radar: usize, scan: usize) -> Option<NuScenesKey> {
        let token = self.radar_tokens.get(radar)?.get(scan)?;
        Some(NuScenesKey { version: self.version.clone(), sample_data_token: token.to_string() })
    }
}

/// The columns of [`PCD_FIELDS`] and the two derived ones.
fn radar_columns(pcd: &Pcd) -> Result<Vec<Vec<f32>>, DataError> {
    let mut columns = PCD_FIELDS.iter().map(|name| pcd.column(name)).collect::<Result<Vec<_>, _>>()?;
    let [x, y, id] = [0, 1, 4].map(|column: usize| columns[column].as_slice());
    // What nuScenes writes for a scan that saw nothing, as PCD knows no clouds without points.
    if let ([x], [y], [id]) = (x, y, id)
        && x.is_nan()
        && y.is_nan()
        && *id == -1.0
    {
        columns.iter_mut().for_each(Vec::clear);
    }
    for (vx, vy) in [(6, 7), (8, 9)] {
        columns.push(radial(&columns[0], &columns[1], &columns[vx], &columns[vy]));
    }
    Ok(columns)
}
