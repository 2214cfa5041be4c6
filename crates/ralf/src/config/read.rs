//! Reading settings from TOML.

use serde::de::DeserializeOwned;
use thiserror::Error;
use toml::de::{DeTable, Deserializer};

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

/// Reads settings from a TOML text and assignments `key=value` that win over it. Tables of the names `left_out` are
/// passed over; what is wrong with the text is said with its place.
pub fn read_toml<T: DeserializeOwned>(
    text: &str,
    assignments: &[&str],
    left_out: &[&str],
) -> Result<T, ConfigError> {
    // The text by itself first: its errors then point into its own lines.
    let from_text = read_text(text, left_out).map_err(|mut error| {
        error.set_input(Some(text));
        parse_error(&error)
    })?;
    if assignments.is_empty() {
        return Ok(from_text);
    }
    let mut table: toml::Table = text.parse().map_err(|error| parse_error(&error))?;
    for assignment in assignments {
        assign(&mut table, assignment)?;
    }
    for name in left_out {
        table.remove(*name);
    }
    table.try_into().map_err(|error| parse_error(&error))
}

fn read_text<T: DeserializeOwned>(text: &str, left_out: &[&str]) -> Result<T, toml::de::Error> {
    let mut table = DeTable::parse(text)?;
    for name in left_out {
        table.get_mut().remove(*name);
    }
    T::deserialize(Deserializer::from(table))
}

fn parse_error(error: &toml::de::Error) -> ConfigError {
    ConfigError::Parse(error.to_string())
}

/// Puts `key=value` into the table. The value is TOML; what is no TOML is a string, so that quotes may be left out.
fn assign(table: &mut toml::Table, assignment: &str) -> Result<(), ConfigError> {
    let refused = || ConfigError::Assignment(assignment.to_owned());
    let (key, text) = assignment.split_once('=').ok_or_else(refused)?;
    let value =
        format!("value = {text}").parse::<toml::Table>().ok().and_then(|mut parsed| parsed.remove("value"));
    let value = value.unwrap_or_else(|| toml::Value::String(text.trim().to_owned()));
    let mut names: Vec<&str> = key.split('.').map(str::trim).collect();
    let last = names.pop().filter(|name| !name.is_empty()).ok_or_else(refused)?;
    let mut place = table;
    for name in names {
        let next = place.entry(name).or_insert_with(|| toml::Value::Table(toml::Table::new()));
        place = next.as_table_mut().ok_or_else(refused)?;
    }
    place.insert(last.to_owned(), value);
    Ok(())
}
