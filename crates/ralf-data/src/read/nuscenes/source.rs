//! A scene as a source: measurements typed.

use super::join::{Channel, SceneRecord};
use super::pcd::Pcd;
use super::raw::{Modality, Token};
use super::rig::{PCD_FIELDS, rig};
use super::{can, join};
use crate::disk::files::Folders;
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::read::measured_files::MeasuredFiles;
use crate::read::radial::radial;
use ralf::sensors::{
    CameraImage, DepthImage, DepthOutput, LidarScan, RadarScan, Sequence, Source, SourceError, Timelines,
};
use ralf::space::EgoMotion;
use std::any::Any;
use std::path::{Path, PathBuf};

/// What nuScenes calls the radar scans of a scene: a sequence's [`origin`](SequenceReader::origin).
pub(crate) struct NuScenesOrigin {
    /// The version folder's name, as `v1.0-mini`.
    pub(crate) version: String,
    /// The row of each scan of each radar in `sample_data.json`.
    radar_tokens: Vec<Vec<Token>>,
}

impl NuScenesOrigin {
    /// The row of a radar's scan in `sample_data.json`.
    pub(crate) fn sample_data_token(&self, radar: usize, scan: usize) -> Option<String> {
        Some(self.radar_tokens.get(radar)?.get(scan)?.to_string())
    }
}

/// One scene.
pub(super) struct Scene {
    sequence: Sequence,
    files: MeasuredFiles,
    origin: NuScenesOrigin,
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
        let version = version.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let origin = NuScenesOrigin { version, radar_tokens: Vec::new() };
        let mut scene =
            Self { sequence, files: MeasuredFiles::default(), origin, tables, warnings: Vec::new() };
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
            self.origin.radar_tokens.push(tokens);
        }
        if files.len() < listed {
            let (name, missing) = (&channel.calibration.name, listed - files.len());
            self.warnings
                .push(format!("{missing} of {listed} files of {name} are not there and were left out"));
        }
        let timelines = &mut self.sequence.times;
        let (timeline, place) = match channel.calibration.modality {
            Modality::Radar => (&mut timelines.radars, &mut self.files.radars),
            Modality::Lidar => (&mut timelines.lidars, &mut self.files.lidars),
            Modality::Camera => (&mut timelines.cameras, &mut self.files.cameras),
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
        self.files.radar_scan(&self.sequence, radar, scan, |file| radar_columns(&Pcd::read(file)?))
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        // The fifth column is the ring.
        self.files.lidar_scan(&self.sequence, lidar, scan, 5)
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        self.files.image(&self.sequence, camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        self.files.image_file(camera, image)?;
        Ok(None)
    }
}

impl SequenceReader for Scene {
    fn inputs(&self) -> Vec<PathBuf> {
        self.tables.iter().chain(self.files.all()).cloned().collect()
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn image_file(&self, camera: usize, image: usize) -> Option<PathBuf> {
        self.files.image_file(camera, image).ok().cloned()
    }

    fn origin(&self) -> Option<&dyn Any> {
        Some(&self.origin)
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
