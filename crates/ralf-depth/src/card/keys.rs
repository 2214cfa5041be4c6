//! The keys of a card, taken one by one from the user's table laid over a preset's.

use super::presets::Presets;
use crate::NetworkError;
use serde::de::DeserializeOwned;
use std::path::Path;

/// What is left of a card while it is read.
pub(super) struct Keys<'a> {
    file: &'a Path,
    table: toml::Table,
    /// All that were asked for.
    known: Vec<&'static str>,
}

impl<'a> Keys<'a> {
    /// The keys of a card's text, and of the one of these presets that it names.
    pub(super) fn parse(file: &'a Path, text: &str, presets: &Presets) -> Result<Self, NetworkError> {
        let own = table(file, text)?;
        let mut keys = Keys { file, table: own, known: Vec::new() };
        let names = presets.names();
        let Some(name) = keys.optional::<String>("preset", &format!("one of {}", names.join(", ")))? else {
            return Ok(keys);
        };
        let preset = presets
            .text(&name)
            .ok_or_else(|| keys.error("preset", &format!("one of {}", names.join(", ")), &name))?;
        let mut merged = table(Path::new(&name), preset)?;
        merged.extend(keys.table);
        keys.table = merged;
        Ok(keys)
    }

    /// A key that needn't be there.
    pub(super) fn optional<T: DeserializeOwned>(
        &mut self,
        key: &'static str,
        expected: &str,
    ) -> Result<Option<T>, NetworkError> {
        self.known.push(key);
        let Some(value) = self.table.remove(key) else { return Ok(None) };
        let found = value.to_string();
        value.try_into().map(Some).map_err(|_| self.error(key, expected, &found))
    }

    /// A key without a default.
    pub(super) fn required<T: DeserializeOwned>(
        &mut self,
        key: &'static str,
        expected: &str,
    ) -> Result<T, NetworkError> {
        self.optional(key, expected)?.ok_or_else(|| self.error(key, expected, "nothing"))
    }

    /// Refuses values of a key that aren't finite and above 0.
    pub(super) fn above_zero(&self, key: &str, expected: &str, values: &[f64]) -> Result<(), NetworkError> {
        match values.iter().find(|value| !(value.is_finite() && **value > 0.0)) {
            Some(value) => Err(self.error(key, expected, &value.to_string())),
            None => Ok(()),
        }
    }

    /// Refuses keys that nobody asked for.
    pub(super) fn finish(self) -> Result<(), NetworkError> {
        let Some(unknown) = self.table.keys().next() else { return Ok(()) };
        Err(self.error(unknown, &format!("one of the keys {}", self.known.join(", ")), "an unknown key"))
    }

    /// A key holds something else than it should.
    pub(super) fn error(&self, key: &str, expected: &str, found: &str) -> NetworkError {
        NetworkError::content(self.file, key, expected, found)
    }
}

fn table(file: &Path, text: &str) -> Result<toml::Table, NetworkError> {
    text.parse().map_err(|error: toml::de::Error| {
        let before = error.span().and_then(|span| text.get(..span.start)).unwrap_or_default();
        let line = before.matches('\n').count() + 1;
        NetworkError::content(file, format!("line {line}"), "TOML", error.message())
    })
}
