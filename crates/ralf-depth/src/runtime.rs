//! What runs networks.

use crate::NetworkError;
use crate::network::Network;
#[cfg(feature = "ort")]
use crate::ort_backend::{self, OrtNetwork};
use crate::rten_backend::{self, RtenNetwork};
use std::path::Path;

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
