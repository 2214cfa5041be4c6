//! What can go wrong with a network: every error names the file, the place in it, what was expected and found.

use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a network could not be loaded, or gave nothing.
#[derive(Debug, Error)]
pub enum NetworkError {
    /// The system refused.
    #[error("{}: {error}", file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// What the system said.
        error: std::io::Error,
    },
    /// A network without a card.
    #[error(
        "{}: not found: a network needs a card that says how it is fed. Of a known network the line \
         `preset = \"NAME\"` is enough, NAME one of {}; of another one it has the keys {}",
        card.display(), presets.join(", "), keys.join(", ")
    )]
    NoCard {
        /// The card that is missing.
        card: PathBuf,
        /// Names of presets.
        presets: Vec<&'static str>,
        /// Keys that a card without a preset needs.
        keys: Vec<&'static str>,
    },
    /// A card or network holds something else than it should.
    #[error("{}: {place}: expected {expected}, found {found}", file.display())]
    Content {
        /// The card or network.
        file: PathBuf,
        /// Key, input or output.
        place: String,
        /// What is needed.
        expected: String,
        /// What is there.
        found: String,
    },
    /// The runtime can't load the network: it isn't ONNX, is damaged, or has operators that the runtime doesn't know.
    #[error("{}: {runtime} cannot load it as an ONNX network: {reason}", file.display())]
    Unloadable {
        /// The network.
        file: PathBuf,
        /// Which runtime.
        runtime: &'static str,
        /// What it said.
        reason: String,
    },
    /// The library of a runtime is missing, or too old.
    #[error("{runtime} is not available: {reason}")]
    NoRuntime {
        /// Which runtime.
        runtime: &'static str,
        /// Why, and where it was looked for.
        reason: String,
    },
    /// The network was loaded, but broke while running.
    #[error("{}: {runtime} failed to run it: {reason}", file.display())]
    Failed {
        /// The network.
        file: PathBuf,
        /// Which runtime.
        runtime: &'static str,
        /// What it said.
        reason: String,
    },
    /// A view that can't be estimated.
    #[error("the view: expected {expected}, found {found}")]
    View {
        /// What is needed.
        expected: String,
        /// What was given.
        found: String,
    },
    /// Two squares of a view can't be brought to one scale.
    #[error("squares at columns {left} and {right} of the view: expected depth that both see, found none")]
    Seam {
        /// First column of the one, px.
        left: usize,
        /// First column of the other, px.
        right: usize,
    },
}

impl NetworkError {
    /// For `map_err`: the system refused to read `file`.
    pub(crate) fn io(file: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let file = file.to_owned();
        move |error| Self::Io { file, error }
    }

    /// The file holds something else than it should.
    pub(crate) fn content(
        file: &Path,
        place: impl Into<String>,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> Self {
        let (place, expected, found) = (place.into(), expected.into(), found.into());
        Self::Content { file: file.to_owned(), place, expected, found }
    }
}
