//! A network with its card, loaded and ready, whatever it tells.

use crate::card::{Card, Feed};
use crate::network::Network;
use crate::runner::Runner;
use crate::{NetworkError, Runtime};
use ralf_files::Kind;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// A network of an `.onnx` file, with a card of the kind `C`.
pub(crate) struct Loaded<C> {
    file: PathBuf,
    pub(crate) card: C,
    network: Box<dyn Network>,
    /// Index of what is wanted among the network's outputs.
    output: usize,
    fingerprint: String,
}

impl<C: Serialize> Loaded<C> {
    /// Loads a network with its card, which lies beside it unless it is given. `read` reads the card, and `output`
    /// finds the output that it describes.
    pub(crate) fn new(
        runtime: Runtime,
        model: &Path,
        card: Option<&Path>,
        read: impl Fn(&Path) -> Result<C, NetworkError>,
        output: impl Fn(&Path, &dyn Network, &C) -> Result<usize, NetworkError>,
    ) -> Result<Self, NetworkError> {
        let bytes = ralf_files::read(model, Kind::Network).map_err(NetworkError::io(model))?;
        let card = read(&card.map_or_else(|| Card::beside(model), Path::to_owned))?;
        let fingerprint = fingerprint(model, &bytes, &card)?;
        let network = runtime.network(model, bytes)?;
        let output = output(model, network.as_ref(), &card)?;
        Ok(Self { file: model.to_owned(), card, network, output, fingerprint })
    }

    /// What runs it; `feed` is the card's.
    pub(crate) fn runner<'a>(&'a self, feed: &'a Feed) -> Runner<'a> {
        Runner { file: &self.file, feed, network: self.network.as_ref(), output: self.output }
    }

    /// Changes with anything that changes what the network says.
    pub(crate) fn fingerprint(&self) -> &str {
        &self.fingerprint
    }
}

impl<C: std::fmt::Debug> std::fmt::Debug for Loaded<C> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Loaded")
            .field("file", &self.file)
            .field("card", &self.card)
            .field("runtime", &self.network.runtime())
            .finish_non_exhaustive()
    }
}

/// BLAKE3 of the network's bytes and of what its card says: remarks and the order of keys don't change it, nor does the
/// runtime, whose results differ by rounding alone.
fn fingerprint(file: &Path, model: &[u8], card: &impl Serialize) -> Result<String, NetworkError> {
    let card = toml::to_string(card).map_err(|error| {
        NetworkError::content(file, "card", "values that TOML can hold", error.to_string())
    })?;
    let mut hasher = blake3::Hasher::new();
    // A fixed length each, so that no byte can move from the one to the other.
    hasher.update(blake3::hash(model).as_bytes());
    hasher.update(blake3::hash(card.as_bytes()).as_bytes());
    Ok(hasher.finalize().to_hex().to_string())
}
