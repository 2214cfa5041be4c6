//! Networks that look at images: one straight view of a camera in, its depth (docs/method.md, section 5) or the class
//! of each pixel (section 11) of the same size out.
//!
//! An [`OnnxModel`] is an `.onnx` file with a [`Card`] beside it: a small TOML file that says how the network is fed
//! and what comes out. [`Card`] lists its keys; [`presets`] are cards of public networks, to build on. A
//! [`SegmentationModel`] is the same with a [`SegmentationCard`]. Nothing is
//! guessed: a card that doesn't go with its network is refused when the two are loaded.
//!
//! An image takes this way: view -> [`Fit`] -> resize (antialiased) -> normalise -> network, and once more mirrored if
//! `flip` is set -> resize back -> [`DepthImage`](ralf::sensors::DepthImage).
//!
//! A single estimate uses one thread and gives the same bytes however many run side by side, so callers parallelise
//! over images.
//!
//! ```no_run
//! use ralf_depth::{DepthEstimator, OnnxModel};
//!
//! # fn main() -> Result<(), ralf_depth::NetworkError> {
//! # let view = ralf::sensors::CameraImage { width: 0, height: 0, rgb: vec![] };
//! // Reads the card models/midas.toml.
//! let model = OnnxModel::load("models/midas.onnx".as_ref(), None)?;
//! let depth = model.estimate(&view, 1266.4)?;
//! assert_eq!(depth.values.len(), view.rgb.len());
//! # Ok(())
//! # }
//! ```

mod card;
mod colour;
mod depth;
mod error;
mod estimator;
mod fit;
mod loaded;
mod model;
mod network;
#[cfg(feature = "ort")]
mod ort_backend;
mod plane;
mod rten_backend;
mod runner;
mod runtime;
mod segmentation;
#[cfg(test)]
mod segmentation_tests;
mod spares;
mod squares;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod wire;

pub use card::{Card, Channels, Feed, Fit, InputSize, OutputClass, SegmentationCard, Side, presets};
pub use error::NetworkError;
pub use estimator::DepthEstimator;
pub use model::OnnxModel;
pub use runtime::Runtime;
pub use segmentation::SegmentationModel;
