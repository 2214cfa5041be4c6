//! Where a sequence's measurements lie, in formats that keep one file for each.

use crate::disk::{files, images};
use crate::error::DataError;
use crate::read::recording::measurement;
use ralf::sensors::{CameraImage, LidarScan, RadarScan, Sequence, SourceError};
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

    /// A radar's scan whose columns `read` takes from its file.
    pub(crate) fn radar_scan(
        &self,
        of: &Sequence,
        radar: usize,
        scan: usize,
        read: impl FnOnce(&Path) -> Result<Vec<Vec<f32>>, DataError>,
    ) -> Result<RadarScan, SourceError> {
        let file = measurement("radar", &self.radars, radar, scan)?;
        let scan = RadarScan::new(&of.rig.radars[radar], of.times.radars[radar][scan], read(file)?);
        Ok(scan.map_err(|found| DataError::content(file, "columns", "those of the radar", found))?)
    }

    /// A LiDAR's scan from a file of float32 rows of so many values, which begin with x, y, z and intensity.
    pub(crate) fn lidar_scan(
        &self,
        of: &Sequence,
        lidar: usize,
        scan: usize,
        row: usize,
    ) -> Result<LidarScan, SourceError> {
        let mut columns = files::read_f32_columns(measurement("lidar", &self.lidars, lidar, scan)?, row)?;
        let intensity = columns.swap_remove(3);
        let points = (0..intensity.len()).map(|n| [columns[0][n], columns[1][n], columns[2][n]]).collect();
        Ok(LidarScan { t_ns: of.times.lidars[lidar][scan], points, times: None, intensity, classes: None })
    }

    /// A camera's image, which must have the size that the camera's model is for.
    pub(crate) fn image(
        &self,
        of: &Sequence,
        camera: usize,
        image: usize,
    ) -> Result<CameraImage, SourceError> {
        let file = self.image_file(camera, image)?;
        let model = &of.rig.cameras[camera];
        Ok(images::read_of_size(file, model.width, model.height)?)
    }

    /// The file of a camera's image.
    pub(crate) fn image_file(&self, camera: usize, image: usize) -> Result<&PathBuf, DataError> {
        measurement("camera", &self.cameras, camera, image)
    }
}
