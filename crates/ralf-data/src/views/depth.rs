//! Stores of depth images: `ROOT/sequences/NAME/CAMERA/depth/000000.npy`.

use super::attached::{Stored, attach};
use super::compute::{Estimate, ViewObserver, ViewStore, compute_views};
use super::folder::{StoreKind, ViewFolder};
use crate::disk::{files, npy};
use crate::error::DataError;
use crate::read::{Recording, SequenceReader};
use crate::result::{Component, WriterLock};
use ralf::sensors::{DepthImage, DepthOutput};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// What a depth store is called.
const KIND: StoreKind = StoreKind { name: "depth", extension: "npy", verb: "depth" };

/// A folder of depth images of one network.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DepthStore {
    folder: ViewFolder,
    output: DepthOutput,
}

/// `depth.toml`: what the values of a store mean, and which network gave them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoreToml {
    output: DepthOutput,
    network: String,
}

impl DepthStore {
    /// The store of a network in a folder, begun if there is none. A store of another network is refused.
    pub fn create(root: &Path, output: DepthOutput, network: &str) -> Result<Self, DataError> {
        let folder = ViewFolder::new(root, KIND);
        folder.claim(&StoreToml { output, network: network.to_owned() }, |toml| &toml.network)?;
        Ok(Self { folder, output })
    }

    /// A store that was made before.
    pub fn open(root: &Path) -> Result<Self, DataError> {
        let folder = ViewFolder::new(root, KIND);
        let StoreToml { output, .. } = folder.read_card()?;
        Ok(Self { folder, output })
    }

    /// The file of an image's views.
    pub fn file(&self, sequence: &Component, camera: &Component, image: usize) -> PathBuf {
        self.folder.file(sequence, camera, image)
    }

    /// Computes and stores the depth of the images (camera, number) that the store doesn't hold yet, several at a time.
    ///
    /// Returns the images that have no depth for a reason of their own, which is named, in their order. What can't be
    /// stored is an error, and so is another process that writes to the store.
    pub fn compute(
        &self,
        reader: &dyn SequenceReader,
        images: &[(usize, usize)],
        estimate: &Estimate<DepthImage>,
        jobs: usize,
        observer: &ViewObserver,
    ) -> Result<Vec<DataError>, DataError> {
        compute_views(reader, images, self, estimate, jobs, observer)
    }

    /// A recording with the depth of this store in place of its own.
    pub fn attach(&self, recording: Recording) -> Recording {
        attach(recording, &Stored::Depth(self.folder.clone(), self.output))
    }
}

impl ViewStore for DepthStore {
    type View = DepthImage;

    fn file(&self, sequence: &Component, camera: &Component, image: usize) -> PathBuf {
        self.folder.file(sequence, camera, image)
    }

    fn write(&self, file: &Path, views: &[DepthImage]) -> Result<(), DataError> {
        let bytes = npy::depth_bytes(views).ok_or_else(|| {
            DataError::content(
                file,
                "views",
                "views of one size",
                "different sizes, which one file can't hold",
            )
        })?;
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
    fn what_is_stored_is_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let store = DepthStore::create(folder.path(), DepthOutput::Disparity, "a").unwrap();
        assert_eq!(DepthStore::open(folder.path()).unwrap(), store);
        let other = DepthStore::create(folder.path(), DepthOutput::Disparity, "b").unwrap_err().to_string();
        assert!(other.contains("depth.toml") && other.contains("found that of a"), "{other}");
        let view = |first: f32| DepthImage { width: 2, height: 1, values: vec![first, f32::NAN] };
        let [sequence, camera] = ["00", "front"].map(|name| Component::new(name).unwrap());
        let file = store.file(&sequence, &camera, 3);
        store.write(&file, &[view(1.0), view(2.0)]).unwrap();
        assert!(file.ends_with("sequences/00/front/depth/000003.npy"));
        let read = npy::read_depth(&file).unwrap();
        assert_eq!((read.len(), read[1].values[0], read[1].width), (2, 2.0, 2));
        let wider = DepthImage { width: 3, height: 1, values: vec![1.0; 3] };
        let error = store.write(&file, &[view(1.0), wider]).unwrap_err().to_string();
        assert!(error.contains("one size"), "{error}");
    }
}
