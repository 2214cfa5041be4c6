//! How to serve.

use std::path::PathBuf;

/// How to serve.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Name or address to listen on.
    pub host: String,
    /// Port to listen on, 0 for any free one. `None`: that of the last time, where it is free; else 8642, or the next
    /// one that is free.
    pub port: Option<u16>,
    /// What people are called who say no name of their own.
    pub author: String,
    /// Who labels a second time, without seeing what others said: all of it goes to a file of its own (see
    /// [`ralf_data::team`]). `None`: to the corrections that count.
    pub second: Option<String>,
    /// A folder of the user's own, in which token and port are kept, so that pages stay open over a restart. `None`:
    /// a new token each time, and no port of the last time.
    pub token_folder: Option<PathBuf>,
}
