//! The files of each measurement in the own layout.

use crate::disk::label_file::{label_bytes, labels_of_bytes};
use crate::disk::{class_images, files, images, npy};
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::read::view_origin::note_of;
use crate::result::{Component, OutFolder, SequenceNames, checked};
use crate::tree::{CAUSE_NAMES, DEPTH, GROUND_TRUTH, LABELS, SEGMENTATION};
use crate::truth::{cause_names, check_codes, names_of_causes};
use ralf::sensors::{SourceError, Timelines};
use ralf_files::Kind;
use std::path::{Path, PathBuf};

/// The ending of when each point of a LiDAR's scan was measured.
const POINT_TIMES: &str = "time";

/// A measurement: its sensor's place in the rig, and its own in the sensor's timeline.
#[derive(Clone, Copy)]
pub(super) enum Measurement {
    Radar(usize, usize),
    Lidar(usize, usize),
    Camera(usize, usize),
}

impl Measurement {
    /// All measurements, sensor by sensor.
    pub(super) fn all(times: &Timelines) -> Vec<Self> {
        Self::chosen(times, |count| (0..count).collect(), |count| (0..count).collect())
    }

    /// The first, the middle and the last scan of each radar and LiDAR, and the first image of each camera: what tells
    /// one recording from another of the same sensors and times.
    pub(super) fn some(times: &Timelines) -> Vec<Self> {
        let scans = |count: usize| {
            let mut scans = vec![0, count / 2, count.saturating_sub(1)];
            scans.dedup();
            scans.retain(|scan| *scan < count);
            scans
        };
        Self::chosen(times, scans, |count| (0..count.min(1)).collect())
    }

    /// Of so many scans, and of so many images, of a sensor.
    fn chosen(
        times: &Timelines,
        scans: impl Fn(usize) -> Vec<usize>,
        images: impl Fn(usize) -> Vec<usize>,
    ) -> Vec<Self> {
        let mut all = Vec::new();
        for (radar, times) in times.radars.iter().enumerate() {
            all.extend(scans(times.len()).into_iter().map(|scan| Self::Radar(radar, scan)));
        }
        for (lidar, times) in times.lidars.iter().enumerate() {
            all.extend(scans(times.len()).into_iter().map(|scan| Self::Lidar(lidar, scan)));
        }
        for (camera, times) in times.cameras.iter().enumerate() {
            all.extend(images(times.len()).into_iter().map(|image| Self::Camera(camera, image)));
        }
        all
    }
}

/// A file and what it holds.
pub(super) type Content = (PathBuf, Vec<u8>);

/// What the files of a sequence hold that lies in a folder. Files that are copied may be links to anything, and what is
/// none of the recording's goes nowhere: each is read as what it has to be.
pub(super) struct Contents<'a> {
    reader: &'a dyn SequenceReader,
    names: &'a SequenceNames,
    folder: &'a OutFolder,
    /// How many causes have names.
    causes: usize,
}

impl<'a> Contents<'a> {
    /// # Errors
    /// The names of causes can't be read.
    pub(super) fn new(
        reader: &'a dyn SequenceReader,
        names: &'a SequenceNames,
        folder: &'a OutFolder,
    ) -> Result<Self, DataError> {
        let list = reader.cause_names_file().map(|file| cause_names(&file)).transpose()?;
        Ok(Self { reader, names, folder, causes: list.map_or(0, |names| names.len()) })
    }

    /// Of one measurement, in its sensor's folder and beside it.
    ///
    /// # Errors
    /// It can't be read, or the layout can't hold it.
    pub(super) fn of(&self, measurement: Measurement) -> Result<Vec<Content>, DataError> {
        let SequenceNames { radars, lidars, cameras, .. } = self.names;
        let (sensor, index, files) = match measurement {
            Measurement::Radar(radar, scan) => (&radars[radar], scan, self.radar_scan(radar, scan)),
            Measurement::Lidar(lidar, scan) => (&lidars[lidar], scan, self.lidar_scan(lidar, scan)),
            Measurement::Camera(camera, image) => (&cameras[camera], image, self.image(camera, image)),
        };
        files.map_err(|error| DataError::Measurement { sensor: sensor.as_str().to_owned(), index, error })
    }

    /// What may lie beside a measurement that has it, and changes its labels: times of points, depth and a
    /// segmentation, other than what a network made of the image later and left a note of. Truth and classes of points
    /// say nothing of other measurements, and people add such.
    pub(super) fn beside(&self, measurement: Measurement) -> Vec<PathBuf> {
        let SequenceNames { lidars, cameras, .. } = self.names;
        match measurement {
            Measurement::Radar(..) => Vec::new(),
            Measurement::Lidar(lidar, scan) => {
                let folder = self.folder.folder(&lidars[lidar]);
                vec![folder.file(&Component::numbered(scan, POINT_TIMES))]
            }
            Measurement::Camera(camera, image) => {
                let folder = self.folder.folder(&cameras[camera]);
                let views = [(DEPTH, "npy"), (SEGMENTATION, "png")].into_iter();
                let files =
                    views.map(|(kind, ending)| folder.own(kind).file(&Component::numbered(image, ending)));
                files.filter(|file| !note_of(file).exists()).collect()
            }
        }
    }

    /// `ground_truth/causes.txt` where causes are known: line n names the cause n.
    ///
    /// # Errors
    /// It can't be read.
    pub(super) fn names_of_causes(&self) -> Result<Option<Content>, DataError> {
        let file = self.folder.own(GROUND_TRUTH).own_file(CAUSE_NAMES);
        if let Some(names) = self.reader.cause_names_file() {
            let text = files::read_text(&names, Kind::Settings)?;
            // It may be a link to anything, and what is none of the recording's goes nowhere.
            names_of_causes(&names, &text)?;
            return Ok(Some((file, text.into_bytes())));
        }
        let names: String = self.reader.causes().iter().map(|cause| format!("{}\n", cause.name())).collect();
        Ok((!names.is_empty()).then(|| (file, names.into_bytes())))
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<Vec<Content>, SourceError> {
        let folder = self.folder.folder(&self.names.radars[radar]);
        let columns = self.reader.radar_scan(radar, scan)?.columns;
        let rows = columns.first().map_or(0, Vec::len);
        let values = (0..rows).flat_map(|row| columns.iter().map(move |column| column[row]));
        let scan_file = (folder.file(&Component::numbered(scan, "bin")), files::f32_bytes(values));
        Ok([scan_file].into_iter().chain(self.truth(radar, scan, rows)?).collect())
    }

    /// Labels and causes of so many detections: as their files hold them, else as the format tells them.
    fn truth(&self, radar: usize, scan: usize, rows: usize) -> Result<Vec<Content>, SourceError> {
        let truth = self.folder.own(GROUND_TRUTH).folder(&self.names.radars[radar]);
        let cause_file = truth.file(&Component::numbered(scan, "cause"));
        let mut found = Vec::new();
        if let Some(file) = self.reader.cause_file(radar, scan) {
            let codes = files::read(&file)?;
            check_codes(&file, &codes, rows, self.causes)?;
            found.push((cause_file.clone(), codes));
        }
        let truth_file = truth.file(&Component::numbered(scan, LABELS));
        if let Some(file) = self.reader.truth_file(radar, scan) {
            found.push((truth_file, truth_bytes(&file, rows)?));
        } else if let Some(truth) = self.reader.truth(radar, scan)? {
            found.push((truth_file, label_bytes(&truth.labels)));
            if !self.reader.causes().is_empty() {
                found.push((cause_file, truth.causes));
            }
        }
        Ok(found)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<Vec<Content>, SourceError> {
        let folder = self.folder.folder(&self.names.lidars[lidar]);
        let read = self.reader.lidar_scan(lidar, scan)?;
        let rows = read.points.iter().zip(&read.intensity);
        let values = rows.flat_map(|([x, y, z], intensity)| [*x, *y, *z, *intensity]);
        let mut found = vec![(folder.file(&Component::numbered(scan, "bin")), files::f32_bytes(values))];
        if let Some(times) = read.times {
            let times = files::f32_bytes(times.into_iter());
            found.push((folder.file(&Component::numbered(scan, POINT_TIMES)), times));
        }
        let labels = match (self.reader.lidar_label_file(lidar, scan), read.classes) {
            (Some(label_file), _) => files::read(&label_file)?,
            (None, Some(classes)) => classes.iter().flat_map(|id| u32::from(*id).to_le_bytes()).collect(),
            (None, None) => return Ok(found),
        };
        found.push((folder.file(&Component::numbered(scan, LABELS)), labels));
        Ok(found)
    }

    fn image(&self, camera: usize, image: usize) -> Result<Vec<Content>, SourceError> {
        let folder = self.folder.folder(&self.names.cameras[camera]);
        let picture = match self.reader.image_file(camera, image) {
            Some(original) => {
                let extension = original.extension().unwrap_or_default().to_ascii_lowercase();
                let name = checked("image", &format!("{image:06}.{}", extension.to_string_lossy()))?;
                (folder.file(&name), images::read_bytes(&original)?)
            }
            None => {
                let png = images::png(&self.reader.image(camera, image)?)?;
                (folder.file(&Component::numbered(image, "png")), png)
            }
        };
        let mut found = vec![picture];
        if let Some(depth) = self.reader.depth(camera, image)? {
            let depth = npy::depth_bytes(&depth)
                .ok_or("depth images of different sizes, which one file can't hold")?;
            let file = folder.own(DEPTH).file(&Component::numbered(image, "npy"));
            found.push((file, depth));
        }
        let Some(classes) = self.reader.classes(camera, image)? else { return Ok(found) };
        let png = class_images::bytes(&classes)
            .map_err(|(expected, found)| format!("segmentation: expected {expected}, found {found}"))?;
        let file = folder.own(SEGMENTATION).file(&Component::numbered(image, "png"));
        found.push((file, png));
        Ok(found)
    }
}

/// The bytes of a file of labels as they are, refused unless there is one of each of so many detections.
fn truth_bytes(file: &Path, rows: usize) -> Result<Vec<u8>, DataError> {
    let bytes = files::read(file)?;
    let found = labels_of_bytes(file, &bytes)?.len();
    if found == rows {
        return Ok(bytes);
    }
    Err(DataError::content(file, "size", format!("{rows} uint32, one per detection"), found.to_string()))
}
