//! A depth network and its card, loaded and ready.

use crate::card::Card;
use crate::colour::Colour;
use crate::depth::{DepthRunner, zoom};
use crate::network::{Network, depth_output};
#[cfg(feature = "ort")]
use crate::ort_backend::{self, OrtNetwork};
use crate::rten_backend::{self, RtenNetwork};
use crate::runner::Runner;
use crate::{DepthEstimator, NetworkError};
use ralf::sensors::{CameraImage, DepthImage, DepthOutput};
use ralf_files::Kind;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// What runs a network.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Runtime {
    /// rten: part of this program.
    #[default]
    Rten,
    /// ONNX Runtime: faster, and knows more operators. Its library is looked for where the environment variable
    /// `ORT_DYLIB_PATH` says, else where the system looks for libraries.
    #[cfg(feature = "ort")]
    OnnxRuntime,
}

/// A depth network of an `.onnx` file.
pub struct OnnxModel {
    file: PathBuf,
    card: Card,
    network: Box<dyn Network>,
    /// Index of the depth among the network's outputs.
    output: usize,
    fingerprint: String,
}

impl OnnxModel {
    /// Loads a network with its card, which lies beside it unless it is given. Runs in rten.
    pub fn load(model: &Path, card: Option<&Path>) -> Result<Self, NetworkError> {
        Self::load_with(Runtime::default(), model, card)
    }

    /// The same, run by the runtime given.
    pub fn load_with(runtime: Runtime, model: &Path, card: Option<&Path>) -> Result<Self, NetworkError> {
        let bytes = ralf_files::read(model, Kind::Network).map_err(NetworkError::io(model))?;
        let card = Card::read(&card.map_or_else(|| Card::beside(model), Path::to_owned))?;
        let fingerprint = fingerprint(model, &bytes, &card)?;
        let network = runtime.network(model, bytes)?;
        let output = depth_output(model, network.as_ref(), &card)?;
        Ok(Self { file: model.to_owned(), card, network, output, fingerprint })
    }

    /// How the network is fed.
    pub fn card(&self) -> &Card {
        &self.card
    }
}

impl Runtime {
    /// Loads the bytes of a file.
    pub(crate) fn network(self, file: &Path, bytes: Vec<u8>) -> Result<Box<dyn Network>, NetworkError> {
        let unloadable = |runtime: &'static str| {
            move |reason| NetworkError::Unloadable { file: file.to_owned(), runtime, reason }
        };
        Ok(match self {
            Self::Rten => Box::new(RtenNetwork::load(bytes).map_err(unloadable(rten_backend::NAME))?),
            #[cfg(feature = "ort")]
            Self::OnnxRuntime => {
                ort_backend::require_library()?;
                Box::new(OrtNetwork::load(bytes).map_err(unloadable(ort_backend::NAME))?)
            }
        })
    }
}

impl DepthEstimator for OnnxModel {
    fn estimate(&self, view: &CameraImage, focal: f64) -> Result<DepthImage, NetworkError> {
        let Self { file, card, network, output, .. } = self;
        let runner = Runner { file, feed: &card.feed, network: network.as_ref(), output: *output };
        let mut depth = DepthRunner { runner, card }.depth(&Colour::from_view(view)?)?;
        if let Some(canonical) = card.canonical_focal {
            if !(focal.is_finite() && focal > 0.0) {
                let expected = "a focal length above 0 px".to_owned();
                return Err(NetworkError::View { expected, found: focal.to_string() });
            }
            let scale = (focal * zoom(card, [view.width, view.height]) / canonical) as f32;
            depth.values.iter_mut().for_each(|value| *value *= scale);
        }
        Ok(DepthImage { width: depth.width, height: depth.height, values: depth.values })
    }

    fn output(&self) -> DepthOutput {
        self.card.output
    }

    fn fingerprint(&self) -> &str {
        &self.fingerprint
    }
}

impl std::fmt::Debug for OnnxModel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("OnnxModel")
            .field("file", &self.file)
            .field("card", &self.card)
            .field("runtime", &self.network.runtime())
            .finish_non_exhaustive()
    }
}

/// BLAKE3 of the network's bytes and of what its card says: remarks and the order of keys don't change it, nor does the
/// runtime, whose results differ by rounding alone.
pub(crate) fn fingerprint(file: &Path, model: &[u8], card: &impl Serialize) -> Result<String, NetworkError> {
    let card = toml::to_string(card).map_err(|error| {
        NetworkError::content(file, "card", "values that TOML can hold", error.to_string())
    })?;
    let mut hasher = blake3::Hasher::new();
    // A fixed length each, so that no byte can move from the one to the other.
    hasher.update(blake3::hash(model).as_bytes());
    hasher.update(blake3::hash(card.as_bytes()).as_bytes());
    Ok(hasher.finalize().to_hex().to_string())
}
