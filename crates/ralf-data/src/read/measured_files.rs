//! Where a sequence's measurements lie, in formats that keep them in files.

use crate::disk::files::Folders;
use crate::disk::{files, images};
use crate::error::DataError;
use crate::read::recording::measurement;
use ralf::sensors::{CameraImage, LidarScan, Sequence, SourceError};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// One list per sensor, in the rig's order; one file per measurement, in the order of time.
#[derive(Debug, Clone, Default)]
pub(crate) struct MeasuredFiles {
    pub(crate) radars: Vec<Vec<PathBuf>>,
    pub(crate) lidars: Vec<Vec<PathBuf>>,
    pub(crate) cameras: Vec<Vec<PathBuf>>,
}

impl MeasuredFiles {
    /// All of them: the radars', the LiDARs', the cameras'.
    pub(crate) fn all(&self) -> impl Iterator<Item = &PathBuf> {
        [&self.radars, &self.lidars, &self.cameras].into_iter().flatten().flatten()
    }

    /// A camera's image, which must have the size that the camera's model is for.
    pub(crate) fn image(
        &self,
        of: &Sequence,
        camera: usize,
        image: usize,
    ) -> Result<CameraImage, SourceError> {
        let file = self.image_file(camera, image)?;
        images::read(file, &of.rig.cameras[camera])
    }

    /// The file of a camera's image.
    pub(crate) fn image_file(&self, camera: usize, image: usize) -> Result<&PathBuf, DataError> {
        measurement("camera", &self.cameras, camera, image)
    }
}

/// Those of a sensor's listed files that are on disk, in their order, with a warning of the others.
pub(crate) fn present<T>(
    sensor: &str,
    listed: Vec<(T, PathBuf)>,
    folders: &mut Folders,
    warnings: &mut Vec<String>,
) -> Result<Vec<(T, PathBuf)>, DataError> {
    let all = listed.len();
    let mut found = Vec::with_capacity(all);
    for (what, file) in listed {
        if folders.hold(&file)? {
            found.push((what, file));
        }
    }
    warn_of_missing(sensor, all, found.len(), warnings);
    Ok(found)
}

/// Those of a radar's listed files that its copy of the data set should have, in their order, with a warning of the
/// others. Parts of a data set are published one by one: a folder of which not one listed file is there belongs to
/// another part. Where some are there, the others are missing, and whoever asks for one is told.
pub(crate) fn expected<T>(
    radar: &str,
    mut listed: Vec<(T, PathBuf)>,
    folders: &mut Folders,
    warnings: &mut Vec<String>,
) -> Result<Vec<(T, PathBuf)>, DataError> {
    let all = listed.len();
    let mut copied: HashSet<PathBuf> = HashSet::new();
    for (_, file) in &listed {
        if folders.hold(file)? {
            copied.extend(file.parent().map(Path::to_owned));
        }
    }
    listed.retain(|(_, file)| file.parent().is_some_and(|folder| copied.contains(folder)));
    warn_of_missing(radar, all, listed.len(), warnings);
    Ok(listed)
}

fn warn_of_missing(sensor: &str, all: usize, found: usize, warnings: &mut Vec<String>) {
    let missing = all - found;
    if missing > 0 {
        warnings.push(format!("{missing} of {all} files of {sensor} are not there and were left out"));
    }
}

/// A LiDAR's scan from a file of float32 rows of `N`, at least four, which begin with x, y, z and intensity.
pub(crate) fn lidar_rows<const N: usize>(file: &Path, t_ns: i64) -> Result<LidarScan, DataError> {
    let bytes = files::read(file)?;
    let rows = files::f32_rows::<N>(file, &bytes)?;
    // One by one: to map an array is slow where nothing is optimised, and tests read much.
    let number = |bytes: [u8; 4]| f32::from_le_bytes(bytes);
    let points = rows.iter().map(|row| [number(row[0]), number(row[1]), number(row[2])]).collect();
    let intensity = rows.iter().map(|row| number(row[3])).collect();
    Ok(LidarScan { t_ns, points, times: None, intensity, classes: None })
}
