//! Stores of segmentations: `ROOT/sequences/NAME/CAMERA/segmentation/000000.png`.

use super::attached::{Stored, attach};
use super::compute::{Estimate, ViewObserver, ViewStore, compute_views};
use super::folder::{StoreKind, ViewFolder};
use crate::disk::{class_images, files};
use crate::error::DataError;
use crate::read::{Recording, SequenceReader};
use crate::result::{Component, WriterLock};
use ralf::sensors::ClassImage;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// What a store of segmentations is called.
const KIND: StoreKind = StoreKind { name: "segmentation", extension: "png", verb: "segment" };

/// A folder of segmentations of one network.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SegmentationStore {
    folder: ViewFolder,
}

/// `segmentation.toml`: which network made a store.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoreToml {
    network: String,
}

impl SegmentationStore {
    /// The store of a network in a folder, begun if there is none. A store of another network is refused.
    pub fn create(root: &Path, network: &str) -> Result<Self, DataError> {
        let folder = ViewFolder::new(root, KIND);
        folder.claim(&StoreToml { network: network.to_owned() }, |toml| &toml.network)?;
        Ok(Self { folder })
    }

    /// A store that was made before.
    pub fn open(root: &Path) -> Result<Self, DataError> {
        let folder = ViewFolder::new(root, KIND);
        folder.read_card::<StoreToml>()?;
        Ok(Self { folder })
    }

    /// The file of an image's views.
    pub fn file(&self, sequence: &Component, camera: &Component, image: usize) -> PathBuf {
        self.folder.file(sequence, camera, image)
    }

    /// Computes and stores the segmentation of the images (camera, number) that the store doesn't hold yet, several at
    /// a time.
    ///
    /// Returns the images that have none for a reason of their own, which is named, in their order. What can't be
    /// stored is an error, and so is another process that writes to the store.
    pub fn compute(
        &self,
        reader: &dyn SequenceReader,
        images: &[(usize, usize)],
        estimate: &Estimate<ClassImage>,
        jobs: usize,
        observer: &ViewObserver,
    ) -> Result<Vec<DataError>, DataError> {
        compute_views(reader, images, self, estimate, jobs, observer)
    }

    /// A recording with the segmentations of this store in place of its own.
    pub fn attach(&self, recording: Recording) -> Recording {
        attach(recording, &Stored::Segmentation(self.folder.clone()))
    }
}

impl ViewStore for SegmentationStore {
    type View = ClassImage;

    fn file(&self, sequence: &Component, camera: &Component, image: usize) -> PathBuf {
        self.folder.file(sequence, camera, image)
    }

    fn write(&self, file: &Path, views: &[ClassImage]) -> Result<(), DataError> {
        let bytes = class_images::bytes(views)
            .map_err(|(expected, found)| DataError::content(file, "views", expected, found))?;
        files::write_whole(file, &bytes)
    }

    fn lock(&self) -> Result<WriterLock, DataError> {
        self.folder.lock()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_store_of_another_network_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let store = SegmentationStore::create(folder.path(), "a").unwrap();
        assert_eq!(SegmentationStore::open(folder.path()).unwrap(), store);
        let other = SegmentationStore::create(folder.path(), "b").unwrap_err().to_string();
        let parts = ["segmentation.toml", "expected segmentation of the network b", "found that of a"];
        assert!(parts.iter().all(|part| other.contains(part)), "{other}");
        assert!(SegmentationStore::open(&folder.path().join("none")).is_err());
    }
}
