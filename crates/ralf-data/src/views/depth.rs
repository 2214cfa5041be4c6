//! Stores of depth images: `ROOT/sequences/NAME/CAMERA/depth/000000.npy`.

use super::attached::Stored;
use super::folder::{StoreKind, ViewFolder};
use super::store::Store;
use super::stored_view::StoredView;
use crate::disk::{files, npy};
use crate::error::DataError;
use crate::result::refuse_links_on_way;
use crate::tree;
use ralf::sensors::{DepthImage, DepthOutput};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A folder of depth images of one network.
pub type DepthStore = Store<DepthImage>;

/// Letters of a network's fingerprint that tell it from others.
const SHORT: usize = 12;

/// `depth.toml`: what the values of a store mean, and which network gave them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DepthToml {
    output: DepthOutput,
    network: String,
}

impl DepthStore {
    /// The store of a network in a folder, begun if there is none. A store of another network is refused.
    pub fn create(root: &Path, output: DepthOutput, network: &str) -> Result<Self, DataError> {
        Self::begin(root, DepthToml { output, network: network.to_owned() })
    }

    /// The store of a network among labels, `OUT/depth/NETWORK`, begun if there is none.
    ///
    /// # Errors
    /// Those of [`create`](Self::create), and a link out of `OUT`.
    pub fn among_labels(out: &Path, output: DepthOutput, network: &str) -> Result<Self, DataError> {
        let way = [tree::DEPTH, network.get(..SHORT).unwrap_or(network)];
        refuse_links_on_way(out, &way)?;
        Self::create(&out.join(way.join("/")), output, network)
    }
}

impl StoredView for DepthImage {
    type Card = DepthToml;

    const KIND: StoreKind = StoreKind { name: tree::DEPTH, extension: "npy", verb: "depth" };

    fn network(card: &DepthToml) -> &str {
        &card.network
    }

    fn stored(folder: ViewFolder, card: &DepthToml) -> Stored {
        Stored::Depth(folder, card.output)
    }

    fn stacked(size: [usize; 2]) -> [usize; 2] {
        size
    }

    fn is_whole(file: &Path) -> bool {
        npy::read_depth(file).is_ok()
    }

    fn write(file: &Path, views: &[Self]) -> Result<(), DataError> {
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::result::Component;

    #[test]
    fn what_is_stored_is_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let store = DepthStore::create(folder.path(), DepthOutput::Disparity, "a").unwrap();
        assert!(DepthStore::open(folder.path()).is_err(), "nothing was stored yet");
        let store = store.begun().unwrap();
        assert_eq!(DepthStore::open(folder.path()).unwrap(), store);
        let other = DepthStore::create(folder.path(), DepthOutput::Disparity, "b").unwrap_err().to_string();
        assert!(other.contains("depth.toml") && other.contains("found that of a"), "{other}");
        let view = |first: f32| DepthImage { width: 2, height: 1, values: vec![first, f32::NAN] };
        let [sequence, camera] = ["00", "front"].map(|name| Component::new(name).unwrap());
        let file = store.file(&sequence, &camera, 3);
        DepthImage::write(&file, &[view(1.0), view(2.0)]).unwrap();
        assert!(file.ends_with("sequences/00/front/depth/000003.npy"));
        let read = npy::read_depth(&file).unwrap();
        assert_eq!((read.len(), read[1].values[0], read[1].width), (2, 2.0, 2));
        let wider = DepthImage { width: 3, height: 1, values: vec![1.0; 3] };
        let error = DepthImage::write(&file, &[view(1.0), wider]).unwrap_err().to_string();
        assert!(error.contains("one size"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn a_store_among_labels_lies_among_them() {
        let place = tempfile::tempdir().unwrap();
        let [out, victim] = ["out", "victim"].map(|name| place.path().join(name));
        let begin = || DepthStore::among_labels(&out, DepthOutput::Metric, "0123456789abcdef");
        begin().unwrap().begun().unwrap();
        assert!(out.join("depth/0123456789ab/depth.toml").is_file());
        std::fs::create_dir(&victim).unwrap();
        for link in ["depth/0123456789ab", "depth"] {
            std::fs::remove_dir_all(out.join(link)).unwrap();
            std::os::unix::fs::symlink(&victim, out.join(link)).unwrap();
            let told = begin().unwrap_err().to_string();
            assert!(told.contains(link) && told.contains("link: expected a folder"), "{told}");
            std::fs::remove_file(out.join(link)).unwrap();
            std::fs::create_dir_all(out.join(link)).unwrap();
        }
        assert_eq!(std::fs::read_dir(victim).unwrap().count(), 0);
    }
}
