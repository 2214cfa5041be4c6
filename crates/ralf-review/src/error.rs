//! Why the server can't serve.

use ralf_corrections::StoreError;
use ralf_data::DataError;
use std::io;
use std::net::SocketAddr;
use thiserror::Error;

/// Why a review could not begin, or ended.
#[derive(Debug, Error)]
pub enum ReviewError {
    /// The recording or the labels can't be read.
    #[error(transparent)]
    Data(#[from] DataError),
    /// The corrections can't be read or written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The settings of the run don't go with the recording.
    #[error("settings in run.json: {0}")]
    Settings(#[from] ralf::config::ConfigError),
    /// The host's name leads nowhere.
    #[error("--host: expected an address of this machine, found `{host}`: {error}")]
    Host {
        /// As it was given.
        host: String,
        /// What the system said.
        error: io::Error,
    },
    /// Somebody else listens there.
    #[error("{address}: expected a free port, found it in use; choose another with --port, or 0 for any")]
    PortInUse {
        /// The address.
        address: SocketAddr,
    },
    /// The system doesn't let us listen there.
    #[error("{address}: {error}")]
    Listen {
        /// The address.
        address: SocketAddr,
        /// What the system said.
        error: io::Error,
    },
    /// The system refused otherwise.
    #[error("{what}: {error}")]
    System {
        /// What was to be done.
        what: &'static str,
        /// What it said.
        error: io::Error,
    },
}

impl ReviewError {
    /// For `map_err`.
    pub(crate) fn system(what: &'static str) -> impl FnOnce(io::Error) -> Self {
        move |error| Self::System { what, error }
    }
}
