//! Why settings are refused.

use thiserror::Error;

/// A parser's message with the names of this language's types in words: `expected f64` is `expected a number`.
pub fn in_words(message: &str) -> String {
    let words = |word: &str| match word.trim_end_matches(|end: char| !end.is_alphanumeric()) {
        "f32" | "f64" => Some("a number"),
        "u8" | "u16" | "u32" | "u64" | "usize" => Some("a whole number of at least 0"),
        "i8" | "i16" | "i32" | "i64" | "isize" => Some("a whole number"),
        _ => None,
    };
    let mut text = String::with_capacity(message.len());
    let mut before = "";
    for word in message.split_inclusive(char::is_whitespace) {
        match words(word).filter(|_| before.trim_end() == "expected") {
            Some(words) => {
                text.push_str(words);
                text.push_str(word.trim_start_matches(char::is_alphanumeric));
            }
            None => text.push_str(word),
        }
        before = word;
    }
    text
}

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
            ("found f64, expected i64\n  |", "found f64, expected a whole number\n  |"),
            ("unknown field `f64`, expected `u8` or `b`", "unknown field `f64`, expected `u8` or `b`"),
        ] {
            assert_eq!(in_words(message), told);
        }
    }
}
