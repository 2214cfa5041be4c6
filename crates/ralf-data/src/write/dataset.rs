//! Writing any sequence in the own layout, without loss.

use crate::disk::label_file::write_labels;
use crate::disk::{files, images, npy};
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::read::layout::raw::{DepthToml, SequenceToml};
use crate::read::layout::{GROUND_TRUTH, SEQUENCES, is_folder_name, rig, tables};
use ralf::label::Cause;
use ralf::sensors::{Sequence, SourceError};
use std::cell::Cell;
use std::fs;
use std::path::{Path, PathBuf};

/// Writes a sequence as `DATASET/sequences/NAME`, whole or not at all: it lies in a hidden folder until it is complete.
///
/// Radar columns, LiDAR points, label, truth and image files are written as they are. `progress` is told how many
/// measurements are done. An existing sequence is never overwritten, and a measurement that can't be read is an error.
pub fn write_sequence(
    reader: &dyn SequenceReader,
    dataset: &Path,
    progress: &dyn Fn(usize),
) -> Result<(), DataError> {
    let name = &reader.sequence().name;
    let sequences = dataset.join(SEQUENCES);
    if !is_folder_name(name) {
        return Err(DataError::content(&sequences, "name", "a plain folder name", format!("`{name}`")));
    }
    let folder = sequences.join(name);
    if folder.exists() {
        return Err(DataError::content(&folder, "folder", "none of this name yet", "one"));
    }
    let part = sequences.join(format!(".{name}.part"));
    // What a killed conversion left.
    if part.exists() {
        fs::remove_dir_all(&part).map_err(DataError::io(&part))?;
    }
    let writer = Writer { reader, folder: &part, done: Cell::new(0), progress };
    let written = writer.write().and_then(|()| fs::rename(&part, &folder).map_err(DataError::io(&folder)));
    if written.is_err() {
        // The unfinished folder is of no use to anyone; the error that matters is the first one.
        let _ = fs::remove_dir_all(&part);
    }
    written
}

struct Writer<'a> {
    reader: &'a dyn SequenceReader,
    folder: &'a Path,
    done: Cell<usize>,
    progress: &'a dyn Fn(usize),
}

impl Writer<'_> {
    fn write(&self) -> Result<(), DataError> {
        let Sequence { rig, times, .. } = self.reader.sequence();
        self.metadata()?;
        for (sensor, (radar, times)) in rig.radars.iter().zip(&times.radars).enumerate() {
            self.measurements(&radar.name, times, |file, scan| self.radar_scan(sensor, scan, file))?;
        }
        for (sensor, (lidar, times)) in rig.lidars.iter().zip(&times.lidars).enumerate() {
            self.measurements(&lidar.name, times, |file, scan| self.lidar_scan(sensor, scan, file))?;
        }
        for (sensor, (camera, times)) in rig.cameras.iter().zip(&times.cameras).enumerate() {
            self.measurements(&camera.name, times, |file, image| self.image(sensor, image, file))?;
        }
        Ok(())
    }

    /// `sequence.toml`, `odometry.csv` and `poses.csv`. The first is checked as if it were read.
    fn metadata(&self) -> Result<(), DataError> {
        let Sequence { title, rig, motion, depth_output, .. } = self.reader.sequence();
        let (radar, lidar, camera) = rig::rig_toml(rig);
        let depth = DepthToml { output: *depth_output };
        let toml = SequenceToml { format: 1, name: title.clone(), radar, lidar, camera, depth };
        let file = self.folder.join("sequence.toml");
        rig::rig(&file, &toml)?;
        let text = toml::to_string(&toml).map_err(|error| {
            DataError::content(&file, "content", "values that TOML can hold", error.to_string())
        })?;
        files::write_whole(&file, text.as_bytes())?;
        if !motion.odometry().is_empty() {
            let text = tables::odometry_text(motion.odometry());
            files::write_whole(&self.folder.join("odometry.csv"), text.as_bytes())?;
        }
        if !motion.poses().is_empty() {
            let text = tables::poses_text(motion.poses());
            files::write_whole(&self.folder.join("poses.csv"), text.as_bytes())?;
        }
        Ok(())
    }

    /// One sensor's folder; `write` takes the file's place without extension, and the measurement's index.
    fn measurements(
        &self,
        sensor: &str,
        times: &[i64],
        write: impl Fn(&Path, usize) -> Result<(), SourceError>,
    ) -> Result<(), DataError> {
        let folder = self.folder.join(sensor);
        files::write_whole(&folder.join("timestamps.txt"), tables::timestamps_text(times).as_bytes())?;
        for index in 0..times.len() {
            let named = |error| DataError::Measurement { sensor: sensor.to_owned(), index, error };
            write(&folder.join(format!("{index:06}")), index).map_err(named)?;
            self.done.set(self.done.get() + 1);
            (self.progress)(self.done.get());
        }
        Ok(())
    }

    fn radar_scan(&self, radar: usize, scan: usize, file: &Path) -> Result<(), SourceError> {
        let columns = self.reader.radar_scan(radar, scan)?.columns;
        let rows = columns.first().map_or(0, Vec::len);
        let values = (0..rows).flat_map(|row| columns.iter().map(move |column| column[row]));
        files::write_whole(&file.with_extension("bin"), &files::f32_bytes(values))?;
        let name = &self.reader.sequence().rig.radars[radar].name;
        let truth_file = self.folder.join(GROUND_TRUTH).join(name).join(format!("{scan:06}.label"));
        if let Some(truth) = self.reader.truth_file(radar, scan) {
            files::write_whole(&truth_file, &files::read(&truth)?)?;
        } else if let Some(truth) = self.reader.truth(radar, scan)? {
            write_labels(&truth_file, &truth.labels)?;
            files::write_whole(&truth_file.with_extension("cause"), &truth.causes)?;
            self.names_of_causes()?;
        }
        Ok(())
    }

    /// `ground_truth/causes.txt`: line n names the cause n.
    fn names_of_causes(&self) -> Result<(), DataError> {
        let file = self.folder.join(GROUND_TRUTH).join("causes.txt");
        if file.exists() {
            return Ok(());
        }
        let names: String = Cause::ALL.iter().map(|cause| format!("{}\n", cause.name())).collect();
        files::write_whole(&file, names.as_bytes())
    }

    fn lidar_scan(&self, lidar: usize, scan: usize, file: &Path) -> Result<(), SourceError> {
        let read = self.reader.lidar_scan(lidar, scan)?;
        let rows = read.points.iter().zip(&read.intensity);
        let values = rows.flat_map(|([x, y, z], intensity)| [*x, *y, *z, *intensity]);
        files::write_whole(&file.with_extension("bin"), &files::f32_bytes(values))?;
        let labels = match (self.reader.lidar_label_file(lidar, scan), read.classes) {
            (Some(label_file), _) => files::read(&label_file)?,
            (None, Some(classes)) => classes.iter().flat_map(|id| u32::from(*id).to_le_bytes()).collect(),
            (None, None) => return Ok(()),
        };
        Ok(files::write_whole(&file.with_extension("label"), &labels)?)
    }

    fn image(&self, camera: usize, image: usize, file: &Path) -> Result<(), SourceError> {
        match self.reader.image_file(camera, image) {
            Some(original) => {
                let extension = original.extension().unwrap_or_default().to_ascii_lowercase();
                files::write_whole(&file.with_extension(extension), &files::read(&original)?)?;
            }
            None => {
                let png = images::png(&self.reader.image(camera, image)?)?;
                files::write_whole(&file.with_extension("png"), &png)?;
            }
        }
        let Some(depth) = self.reader.depth(camera, image)? else { return Ok(()) };
        let depth =
            npy::depth_bytes(&depth).ok_or("depth images of different sizes, which one file can't hold")?;
        let file = depth_file(file);
        Ok(files::write_whole(&file, &depth)?)
    }
}

/// `camera/depth/000000.npy` for `camera/000000`.
fn depth_file(image: &Path) -> PathBuf {
    let name = image.file_name().unwrap_or_default();
    image.with_file_name("depth").join(name).with_extension("npy")
}
