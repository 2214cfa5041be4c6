//! What networks say of the straight views of images, their depth and their segmentation: computed once, stored beside
//! the images or elsewhere, and read whenever a recording is labelled.

mod attached;
mod check;
mod compute;
mod depth;
mod folder;
mod segmentation;

pub use check::{CameraCheck, SCALINGS, check_scalings};
pub use compute::{Estimate, ViewObserver};
pub use depth::DepthStore;
pub use segmentation::SegmentationStore;
