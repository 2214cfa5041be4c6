//! Writing any sequence in the own layout, without loss.

use super::metadata::texts;
use crate::disk::label_file::write_labels;
use crate::disk::{class_images, files, images, npy};
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::read::recording::{check_motion_corrected, check_nothing_lost};
use crate::result::{Component, OutFolder, SequenceNames, WriterLock, checked, refuse_links_out};
use crate::tree::{CAUSE_NAMES, DEPTH, GROUND_TRUTH, LABELS, SEGMENTATION, SEQUENCES};
use ralf::sensors::{SourceError, Timelines};
use ralf_jobs::side_by_side;
use std::fs;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Writes a sequence as `DATASET/sequences/NAME`, whole or not at all: it lies in a hidden folder until it is complete.
///
/// Radar columns, LiDAR points, label, truth, cause and image files are written as they are. `progress` is told how
/// many measurements are done. An existing sequence is never overwritten ([`has_sequence`](super::has_sequence) tells
/// whether it is this one), and a measurement that can't be read is an error.
pub fn write_sequence(
    reader: &dyn SequenceReader,
    dataset: &Path,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<(), DataError> {
    write_sequence_with(reader, dataset, 1, progress)
}

/// Writes a sequence as [`write_sequence`] does, with so many threads. The files are the same to the byte whatever
/// their number, and so is the error.
pub fn write_sequence_with(
    reader: &dyn SequenceReader,
    dataset: &Path,
    jobs: usize,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<(), DataError> {
    let names = SequenceNames::new(reader.sequence())?;
    check_nothing_lost(reader)?;
    check_motion_corrected(reader)?;
    let sequences = OutFolder::new(dataset).own(SEQUENCES);
    let folder = sequences.folder(&names.sequence);
    let folder = folder.path();
    if folder.exists() {
        return Err(DataError::content(folder, "folder", "none of this name yet", "one"));
    }
    refuse_links_out(dataset, SEQUENCES, 0)?;
    let _lock = WriterLock::beside(folder)?;
    let part = sequences.folder(&names.sequence.hidden(".part"));
    // What a killed conversion left.
    if part.path().exists() {
        fs::remove_dir_all(part.path()).map_err(DataError::io(part.path()))?;
    }
    let writer = Writer { reader, names: &names, folder: &part, done: Mutex::new(0), progress };
    let written =
        writer.write(jobs).and_then(|()| fs::rename(part.path(), folder).map_err(DataError::io(folder)));
    if written.is_err() {
        // The unfinished folder is of no use to anyone; the error that matters is the first one.
        let _ = fs::remove_dir_all(part.path());
    }
    written
}

/// A measurement: its sensor's place in the rig, and its own in the sensor's timeline.
#[derive(Clone, Copy)]
enum Measurement {
    Radar(usize, usize),
    Lidar(usize, usize),
    Camera(usize, usize),
}

/// All measurements, sensor by sensor.
fn all_measurements(times: &Timelines) -> Vec<Measurement> {
    let mut all = Vec::new();
    for (radar, times) in times.radars.iter().enumerate() {
        all.extend((0..times.len()).map(|scan| Measurement::Radar(radar, scan)));
    }
    for (lidar, times) in times.lidars.iter().enumerate() {
        all.extend((0..times.len()).map(|scan| Measurement::Lidar(lidar, scan)));
    }
    for (camera, times) in times.cameras.iter().enumerate() {
        all.extend((0..times.len()).map(|image| Measurement::Camera(camera, image)));
    }
    all
}

struct Writer<'a> {
    reader: &'a dyn SequenceReader,
    names: &'a SequenceNames,
    folder: &'a OutFolder,
    done: Mutex<usize>,
    progress: &'a (dyn Fn(usize) + Sync),
}

impl Writer<'_> {
    fn write(&self, jobs: usize) -> Result<(), DataError> {
        let sequence = self.reader.sequence();
        for (file, text) in texts(sequence, self.names, self.folder)? {
            files::write_whole(&file, text.as_bytes())?;
        }
        side_by_side(&all_measurements(&sequence.times), jobs, |measurement| {
            self.measurement(*measurement)?;
            let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
            *done += 1;
            (self.progress)(*done);
            Ok::<(), DataError>(())
        })?;
        self.names_of_causes()
    }

    /// One measurement, into its sensor's folder.
    fn measurement(&self, measurement: Measurement) -> Result<(), DataError> {
        let SequenceNames { radars, lidars, cameras, .. } = self.names;
        let (sensor, index, written) = match measurement {
            Measurement::Radar(radar, scan) => (&radars[radar], scan, self.radar_scan(radar, scan)),
            Measurement::Lidar(lidar, scan) => (&lidars[lidar], scan, self.lidar_scan(lidar, scan)),
            Measurement::Camera(camera, image) => (&cameras[camera], image, self.image(camera, image)),
        };
        written.map_err(|error| DataError::Measurement { sensor: sensor.as_str().to_owned(), index, error })
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<(), SourceError> {
        let folder = self.folder.folder(&self.names.radars[radar]);
        let columns = self.reader.radar_scan(radar, scan)?.columns;
        let rows = columns.first().map_or(0, Vec::len);
        let values = (0..rows).flat_map(|row| columns.iter().map(move |column| column[row]));
        files::write_whole(&folder.file(&Component::numbered(scan, "bin")), &files::f32_bytes(values))?;
        self.truth(radar, scan)
    }

    /// Labels and causes: as their files hold them, else as the format tells them.
    fn truth(&self, radar: usize, scan: usize) -> Result<(), SourceError> {
        let truth = self.folder.own(GROUND_TRUTH).folder(&self.names.radars[radar]);
        let cause_file = truth.file(&Component::numbered(scan, "cause"));
        if let Some(causes) = self.reader.cause_file(radar, scan) {
            files::write_whole(&cause_file, &files::read(&causes)?)?;
        }
        let truth_file = truth.file(&Component::numbered(scan, LABELS));
        if let Some(truth) = self.reader.truth_file(radar, scan) {
            files::write_whole(&truth_file, &files::read(&truth)?)?;
        } else if let Some(truth) = self.reader.truth(radar, scan)? {
            write_labels(&truth_file, &truth.labels)?;
            if !self.reader.causes().is_empty() {
                files::write_whole(&cause_file, &truth.causes)?;
            }
        }
        Ok(())
    }

    /// `ground_truth/causes.txt` where causes are known: line n names the cause n.
    fn names_of_causes(&self) -> Result<(), DataError> {
        let file = self.folder.own(GROUND_TRUTH).own_file(CAUSE_NAMES);
        if let Some(names) = self.reader.cause_names_file() {
            return files::write_whole(&file, &files::read(&names)?);
        }
        let causes = self.reader.causes();
        if causes.is_empty() {
            return Ok(());
        }
        let names: String = causes.iter().map(|cause| format!("{}\n", cause.name())).collect();
        files::write_whole(&file, names.as_bytes())
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<(), SourceError> {
        let folder = self.folder.folder(&self.names.lidars[lidar]);
        let read = self.reader.lidar_scan(lidar, scan)?;
        let rows = read.points.iter().zip(&read.intensity);
        let values = rows.flat_map(|([x, y, z], intensity)| [*x, *y, *z, *intensity]);
        files::write_whole(&folder.file(&Component::numbered(scan, "bin")), &files::f32_bytes(values))?;
        if let Some(times) = read.times {
            let times = files::f32_bytes(times.into_iter());
            files::write_whole(&folder.file(&Component::numbered(scan, "time")), &times)?;
        }
        let labels = match (self.reader.lidar_label_file(lidar, scan), read.classes) {
            (Some(label_file), _) => files::read(&label_file)?,
            (None, Some(classes)) => classes.iter().flat_map(|id| u32::from(*id).to_le_bytes()).collect(),
            (None, None) => return Ok(()),
        };
        Ok(files::write_whole(&folder.file(&Component::numbered(scan, LABELS)), &labels)?)
    }

    fn image(&self, camera: usize, image: usize) -> Result<(), SourceError> {
        let folder = self.folder.folder(&self.names.cameras[camera]);
        match self.reader.image_file(camera, image) {
            Some(original) => {
                let extension = original.extension().unwrap_or_default().to_ascii_lowercase();
                let name = checked("image", &format!("{image:06}.{}", extension.to_string_lossy()))?;
                files::write_whole(&folder.file(&name), &files::read(&original)?)?;
            }
            None => {
                let png = images::png(&self.reader.image(camera, image)?)?;
                files::write_whole(&folder.file(&Component::numbered(image, "png")), &png)?;
            }
        }
        if let Some(depth) = self.reader.depth(camera, image)? {
            let depth = npy::depth_bytes(&depth)
                .ok_or("depth images of different sizes, which one file can't hold")?;
            let file = folder.own(DEPTH).file(&Component::numbered(image, "npy"));
            files::write_whole(&file, &depth)?;
        }
        let Some(classes) = self.reader.classes(camera, image)? else { return Ok(()) };
        let png = class_images::bytes(&classes)
            .map_err(|(expected, found)| format!("segmentation: expected {expected}, found {found}"))?;
        let file = folder.own(SEGMENTATION).file(&Component::numbered(image, "png"));
        Ok(files::write_whole(&file, &png)?)
    }
}
