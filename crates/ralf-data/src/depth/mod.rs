//! Depth images: computed once by a network, stored beside the images or elsewhere, and read whenever a recording is
//! labelled.

mod check;
mod compute;
mod store;

pub use check::{CameraCheck, SCALINGS, check_scalings};
pub use compute::{DepthObserver, Estimate, compute_depth};
pub use store::DepthStore;
