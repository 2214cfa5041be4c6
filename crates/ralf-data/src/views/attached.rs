//! A recording with what a store holds of its images.

use super::folder::ViewFolder;
use super::image_files::ImageFiles;
use crate::disk::{class_images, npy};
use crate::error::DataError;
use crate::read::view_origin::{refuse_other, refuse_other_pixels};
use crate::read::{Recording, SequenceReader};
use ralf::sensors::{
    Camera, CameraImage, ClassImage, DepthImage, DepthOutput, LidarScan, RadarScan, Sequence, Source,
    SourceError,
};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Any store.
#[derive(Debug, Clone)]
pub enum Stored {
    Depth(ViewFolder, DepthOutput),
    Segmentation(ViewFolder),
}

/// Why nothing is stored of images: by camera and number.
pub(super) type Reasons = BTreeMap<(usize, usize), String>;

/// A recording with what a store holds in place of its own, and with why it holds nothing of these images, sequence by
/// sequence.
pub(super) fn attach(recording: Recording, store: &Stored, without: Vec<Reasons>) -> Recording {
    let mut without = without.into_iter();
    let attach = |inner: Box<dyn SequenceReader>| {
        let mut sequence = inner.sequence().clone();
        if let Stored::Depth(_, output) = store {
            sequence.depth_output = *output;
        }
        // A store holds nothing of what can't have a folder in it.
        let (Stored::Depth(folder, _) | Stored::Segmentation(folder)) = store;
        let files = ImageFiles::new(folder, inner.as_ref()).ok();
        let without = without.next().unwrap_or_default();
        let store = store.clone();
        Box::new(WithStore { inner, sequence, files, store, without }) as Box<dyn SequenceReader>
    };
    Recording { sequences: recording.sequences.into_iter().map(attach).collect(), ..recording }
}

/// A sequence whose depth or segmentation lies in a store.
struct WithStore {
    inner: Box<dyn SequenceReader>,
    sequence: Sequence,
    files: Option<ImageFiles>,
    store: Stored,
    /// Why nothing is stored of an image.
    without: Reasons,
}

impl WithStore {
    /// What is stored of an image, read: nothing where nothing is, for whatever reason is not known.
    fn stored<T>(
        &self,
        (camera, image): (usize, usize),
        read: impl Fn(&Path, &Camera) -> Result<T, DataError>,
    ) -> Result<Option<T>, SourceError> {
        if let Some(reason) = self.without.get(&(camera, image)) {
            return Err(reason.clone().into());
        }
        let Some(file) = self.file(camera, image) else { return Ok(None) };
        let sensor = &self.sequence.rig.cameras[camera];
        if let Some(image) = self.inner.image_file(camera, image) {
            refuse_other(&file, sensor, &image)?;
        }
        Ok(Some(read(&file, sensor)?))
    }

    fn file(&self, camera: usize, image: usize) -> Option<PathBuf> {
        let file = self.files.as_ref()?.file(self.inner.as_ref(), camera, image);
        file.filter(|file| file.exists())
    }

    fn has_file(&self, camera: usize) -> bool {
        let images = self.sequence.times.cameras.get(camera).map_or(0, Vec::len);
        (0..images).any(|image| self.file(camera, image).is_some())
    }
}

impl Source for WithStore {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        self.inner.radar_scan(radar, scan)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        self.inner.lidar_scan(lidar, scan)
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        let read = self.inner.image(camera, image)?;
        // Where images have files, those are compared before what is stored is read.
        if self.inner.image_file(camera, image).is_none()
            && let Some(file) = self.file(camera, image)
        {
            refuse_other_pixels(&file, &self.sequence.rig.cameras[camera], &read)?;
        }
        Ok(read)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        match &self.store {
            Stored::Depth(..) => self.stored((camera, image), |file, _| npy::read_depth(file)),
            Stored::Segmentation(_) => self.inner.depth(camera, image),
        }
    }

    fn classes(&self, camera: usize, image: usize) -> Result<Option<Vec<ClassImage>>, SourceError> {
        match &self.store {
            Stored::Depth(..) => self.inner.classes(camera, image),
            Stored::Segmentation(_) => self.stored((camera, image), class_images::read),
        }
    }
}

impl SequenceReader for WithStore {
    fn inner(&self) -> Option<&dyn SequenceReader> {
        Some(self.inner.as_ref())
    }

    fn inputs(&self) -> Vec<PathBuf> {
        let cameras = self.sequence.times.cameras.iter().enumerate();
        let images = cameras.flat_map(|(camera, times)| (0..times.len()).map(move |image| (camera, image)));
        let stored = images.filter_map(|(camera, image)| self.file(camera, image));
        self.inner.inputs().into_iter().chain(stored).collect()
    }

    fn has_depth(&self, camera: usize) -> bool {
        match &self.store {
            Stored::Depth(..) => self.has_file(camera),
            Stored::Segmentation(_) => self.inner.has_depth(camera),
        }
    }

    fn has_segmentation(&self) -> bool {
        match &self.store {
            Stored::Depth(..) => self.inner.has_segmentation(),
            Stored::Segmentation(_) => {
                (0..self.sequence.rig.cameras.len()).any(|camera| self.has_file(camera))
            }
        }
    }
}
