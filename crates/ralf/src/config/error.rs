//! Why settings are refused.

use thiserror::Error;

/// Settings that are refused.
#[derive(Debug, Error, PartialEq)]
pub enum ConfigError {
    /// No TOML, an unknown key, a value of another type: the parser's message with the place.
    #[error("{0}")]
    Parse(String),
    /// `--set` without a key and a value.
    #[error("expected KEY=VALUE such as lidar.beta=0.5, found `{0}`")]
    Assignment(String),
    /// A value out of its range.
    #[error("setting `{key}`: expected {expected}")]
    Value {
        /// Dotted name.
        key: String,
        /// And what was found.
        expected: String,
    },
}
