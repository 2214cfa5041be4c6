//! A scene as a sequence: what its files hold.

use crate::disk::files::Folders;
use crate::disk::pcd::Pcd;
use crate::error::DataError;
use crate::read::file_sequence::{FileFormat, FileSequence};
use crate::read::models::{ARS_548, GENERIC_LIDAR};
use crate::read::point_times::seconds_after;
use crate::read::radial::radial_3d;
use crate::read::scene_tables::{Measurements, Models, SceneRecord, TableOrigin};
use ralf::sensors::{DepthOutput, Lidar, LidarScan, Sequence, is_return};
use ralf::space::{EgoMotion, OdometrySample};
use std::any::Any;
use std::path::{Path, PathBuf};

/// What a radar record holds, under the names of the file.
const PCD_FIELDS: [&str; 7] = ["x", "y", "z", "vrel_x", "vrel_y", "vrel_z", "rcs"];
/// The times of LiDAR points, microseconds of Unix.
const TIMESTAMP: &str = "timestamp";

/// How the files of a scene are read, and what the tables call its scans.
pub(super) struct TruckScenes(TableOrigin);

/// A scene with what is on disk of what the tables list. `tables` lie in the folder `version`.
pub(super) fn scene(
    dataset: &Path,
    version: &Path,
    tables: &[PathBuf],
    record: SceneRecord,
    odometry: Vec<OdometrySample>,
    folders: &mut Folders,
) -> Result<FileSequence<TruckScenes>, DataError> {
    record.check_poses(version)?;
    let SceneRecord { name, title, channels, poses } = record;
    let fields = [&PCD_FIELDS[..], &["doppler"]].concat();
    let rig = Models { radar: ARS_548, fields: &fields, lidar: GENERIC_LIDAR }.rig(version, &channels)?;
    let motion = EgoMotion::new(odometry, poses)
        .ok_or_else(|| DataError::content(dataset, format!("scene `{name}`"), "ego poses", "none"))?;
    let mut found = Measurements::find(dataset, channels, folders)?;
    let format = TruckScenes(found.origin(version));
    let Measurements { times, files, warnings, .. } = found;
    let sequence = Sequence { name, title, rig, times, motion, depth_output: DepthOutput::default() };
    Ok(FileSequence { sequence, files, further: tables.to_vec(), warnings, format })
}

/// Takes the coordinates from rows at (0, 0, 0): the radar itself is where nothing was measured, and what seems to
/// stand there would go along with the vehicle.
fn without_place(columns: &mut [Vec<f32>]) {
    let [x, y, z, ..] = columns else { return };
    for ((x, y), z) in x.iter_mut().zip(y).zip(z) {
        if [*x, *y, *z] == [0.0; 3] {
            [*x, *y, *z] = [f32::NAN; 3];
        }
    }
}

impl FileFormat for TruckScenes {
    fn is_rolling(&self) -> bool {
        true
    }

    fn radar_columns(&self, file: &Path, _: usize, _: usize) -> Result<Vec<Vec<f32>>, DataError> {
        let pcd = Pcd::read(file)?;
        let mut columns = PCD_FIELDS.iter().map(|name| pcd.column(name)).collect::<Result<Vec<_>, _>>()?;
        let [x, y, z, vx, vy, vz] = [0, 1, 2, 3, 4, 5].map(|column: usize| columns[column].as_slice());
        let doppler = radial_3d([x, y, z], [vx, vy, vz]);
        without_place(&mut columns);
        columns.push(doppler);
        Ok(columns)
    }

    fn lidar_scan(&self, file: &Path, _: &Lidar, t_ns: i64) -> Result<LidarScan, DataError> {
        let pcd = Pcd::read(file)?;
        let [x, y, z] = [pcd.column("x")?, pcd.column("y")?, pcd.column("z")?];
        let points: Vec<[f32; 3]> = x.into_iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect();
        let stamps = pcd.integers(TIMESTAMP)?;
        let time = |(n, (point, stamp)): (usize, (&[f32; 3], &i64))| {
            // What came back from nothing has no time that matters.
            if !is_return(point) {
                return Ok(0.0);
            }
            let place = || format!("point {n}, `{TIMESTAMP}`");
            seconds_after(stamp.saturating_mul(1000), t_ns)
                .map_err(|expected| DataError::content(file, place(), expected, format!("{stamp} us")))
        };
        let times = points.iter().zip(&stamps).enumerate().map(time).collect::<Result<_, _>>()?;
        let intensity = pcd.column("intensity")?;
        Ok(LidarScan { t_ns, points, times: Some(times), intensity, classes: None })
    }

    fn origin(&self) -> Option<&dyn Any> {
        Some(&self.0)
    }
}
