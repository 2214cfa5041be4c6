//! What networks say of the straight views of images, their depth and their segmentation: computed once, stored beside
//! the images or elsewhere, and read whenever a recording is labelled.

mod attached;
mod check;
mod compute;
mod depth;
mod folder;
mod image_files;
mod lacking;
mod segmentation;
mod store;
mod stored_view;

pub use check::{CameraCheck, SCALINGS, check_scalings};
pub use compute::{Computed, Estimate, Unusable, ViewObserver};
pub use depth::DepthStore;
pub use lacking::{Lacking, images_of_scans, lacking};
pub use segmentation::SegmentationStore;
pub use store::Store;
pub use stored_view::StoredView;

use crate::error::DataError;
use crate::read::Recording;
use std::path::Path;

/// A recording with the depth images and the segmentations of stores, where their folders are named.
pub fn with_stored(
    mut recording: Recording,
    depth: Option<&Path>,
    segmentation: Option<&Path>,
) -> Result<Recording, DataError> {
    if let Some(folder) = depth {
        recording = DepthStore::open(folder)?.attach(recording);
    }
    if let Some(folder) = segmentation {
        recording = SegmentationStore::open(folder)?.attach(recording);
    }
    Ok(recording)
}
