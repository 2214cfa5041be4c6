//! Why settings are refused.

use thiserror::Error;

/// What the parsers call things, and what people call them.
const WORDS: [(&[&str], &str); 6] = [
    (&["f32", "f64"], "a number"),
    (&["u8", "u16", "u32", "u64", "usize"], "a whole number of at least 0"),
    (&["i8", "i16", "i32", "i64", "isize"], "a whole number"),
    (&["a map"], "a table"),
    (&["a sequence"], "a list"),
    (&["string only"], "a name"),
];

/// A parser's message with the names of this language's types in words: `expected f64` is `expected a number`.
pub fn in_words(message: &str) -> String {
    let message = message.replace("invalid type: unit variant", "invalid type: no name");
    let mut parts = message.split("expected ");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        text.push_str("expected ");
        let (words, rest) = type_in_words(part).unwrap_or(("", part));
        text.push_str(words);
        text.push_str(rest);
    }
    text
}

/// The words for the type that a text begins with, and what follows it.
fn type_in_words(text: &str) -> Option<(&'static str, &str)> {
    let is_end = |rest: &str| !rest.starts_with(|next: char| next.is_alphanumeric() || next == '_');
    if let Some(named) = text.strip_prefix("struct ") {
        let end = named.find(|next: char| !next.is_alphanumeric()).unwrap_or(named.len());
        return Some(("a table", &named[end..]));
    }
    WORDS.iter().find_map(|(names, words)| {
        let rest = names.iter().find_map(|name| text.strip_prefix(name).filter(|rest| is_end(rest)))?;
        Some((*words, rest))
    })
}

/// Settings that are refused.
#[derive(Debug, Clone, Error, PartialEq, Eq)]
pub enum ConfigError {
    /// No TOML, an unknown key, a value of another type: the parser's message with the place.
    #[error("{0}")]
    Parse(String),
    /// `--set` without a key and a value.
    #[error("expected KEY=VALUE in one line, such as lidar.beta=0.5, found `{0}`")]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_are_told_in_words() {
        for (message, told) in [
            (
                "invalid type: string \"abc\", expected f64 in `a`",
                "invalid type: string \"abc\", expected a number in `a`",
            ),
            ("expected usize", "expected a whole number of at least 0"),
            (
                "integer `3`, expected struct LidarConfig in `lidar`",
                "integer `3`, expected a table in `lidar`",
            ),
            ("invalid type: unit variant, expected string only", "invalid type: no name, expected a name"),
            ("expected a sequence", "expected a list"),
            ("expected a mapping", "expected a mapping"),
            ("found f64, expected i64\n  |", "found f64, expected a whole number\n  |"),
            ("unknown field `f64`, expected `u8` or `b`", "unknown field `f64`, expected `u8` or `b`"),
        ] {
            assert_eq!(in_words(message), told);
        }
    }
}
