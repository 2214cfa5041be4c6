//! A recording with what a store holds of its images.

use super::folder::ViewFolder;
use super::image_files::ImageFiles;
use crate::disk::{class_images, npy};
use crate::read::{Recording, SequenceReader};
use ralf::sensors::{
    CameraImage, ClassImage, DepthImage, DepthOutput, LidarScan, RadarScan, Sequence, Source, SourceError,
};
use std::path::PathBuf;

/// Any store.
#[derive(Debug, Clone)]
pub enum Stored {
    Depth(ViewFolder, DepthOutput),
    Segmentation(ViewFolder),
}

/// A recording with what a store holds in place of its own.
pub(super) fn attach(recording: Recording, store: &Stored) -> Recording {
    let attach = |inner: Box<dyn SequenceReader>| {
        let mut sequence = inner.sequence().clone();
        if let Stored::Depth(_, output) = store {
            sequence.depth_output = *output;
        }
        // A store holds nothing of what can't have a folder in it.
        let (Stored::Depth(folder, _) | Stored::Segmentation(folder)) = store;
        let files = ImageFiles::new(folder, inner.as_ref()).ok();
        Box::new(WithStore { inner, sequence, files, store: store.clone() }) as Box<dyn SequenceReader>
    };
    Recording { sequences: recording.sequences.into_iter().map(attach).collect(), ..recording }
}

/// A sequence whose depth or segmentation lies in a store.
struct WithStore {
    inner: Box<dyn SequenceReader>,
    sequence: Sequence,
    files: Option<ImageFiles>,
    store: Stored,
}

impl WithStore {
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
        self.inner.image(camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        match &self.store {
            Stored::Depth(..) => {
                Ok(self.file(camera, image).map(|file| npy::read_depth(&file)).transpose()?)
            }
            Stored::Segmentation(_) => self.inner.depth(camera, image),
        }
    }

    fn classes(&self, camera: usize, image: usize) -> Result<Option<Vec<ClassImage>>, SourceError> {
        match &self.store {
            Stored::Depth(..) => self.inner.classes(camera, image),
            Stored::Segmentation(_) => {
                let read = |file: PathBuf| class_images::read(&file, &self.sequence.rig.cameras[camera]);
                Ok(self.file(camera, image).map(read).transpose()?)
            }
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
