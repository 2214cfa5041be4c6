//! Stores of segmentations: `ROOT/sequences/NAME/CAMERA/segmentation/000000.png`.

use super::attached::Stored;
use super::folder::{StoreKind, ViewFolder};
use super::store::Store;
use super::stored_view::StoredView;
use crate::disk::{class_images, files};
use crate::error::DataError;
use crate::tree;
use ralf::sensors::ClassImage;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A folder of segmentations of one network.
pub type SegmentationStore = Store<ClassImage>;

/// The end of the last chunk of a PNG file, which has no content: its name and checksum.
const PNG_END: &[u8] = b"IEND\xae\x42\x60\x82";

/// `segmentation.toml`: which network made a store.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SegmentationToml {
    network: String,
}

impl SegmentationStore {
    /// The store of a network in a folder, begun if there is none. A store of another network is refused.
    pub fn create(root: &Path, network: &str) -> Result<Self, DataError> {
        Self::begin(root, SegmentationToml { network: network.to_owned() })
    }
}

impl StoredView for ClassImage {
    type Card = SegmentationToml;

    const KIND: StoreKind = StoreKind { name: tree::SEGMENTATION, extension: "png", verb: "segment" };

    fn network(card: &SegmentationToml) -> &str {
        &card.network
    }

    fn stored(folder: ViewFolder, _: &SegmentationToml) -> Stored {
        Stored::Segmentation(folder)
    }

    fn stacked([width, _]: [usize; 2]) -> [usize; 2] {
        // They stand one below the other.
        [width, 0]
    }

    fn is_whole(file: &Path) -> bool {
        files::read(file).is_ok_and(|bytes| bytes.ends_with(PNG_END))
    }

    fn write(file: &Path, views: &[Self]) -> Result<(), DataError> {
        let bytes = class_images::bytes(views)
            .map_err(|(expected, found)| DataError::content(file, "views", expected, found))?;
        files::write_whole(file, &bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_store_of_another_network_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let store = SegmentationStore::create(folder.path(), "a").and_then(SegmentationStore::begun).unwrap();
        assert_eq!(SegmentationStore::open(folder.path()).unwrap(), store);
        let other = SegmentationStore::create(folder.path(), "b").unwrap_err().to_string();
        let parts = ["segmentation.toml", "expected segmentation of the network b", "found that of a"];
        assert!(parts.iter().all(|part| other.contains(part)), "{other}");
        assert!(SegmentationStore::open(&folder.path().join("none")).is_err());
    }
}
