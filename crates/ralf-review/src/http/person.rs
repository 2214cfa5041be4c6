//! Who asks: a person, who is the same whatever the name, and the window that it asks in.

use super::ApiError;
use axum::extract::FromRequestParts;
use axum::http::HeaderMap;
use axum::http::request::Parts;
use percent_encoding::percent_decode_str;
use ralf_corrections::Who;
use serde::{Deserialize, Deserializer, de};

/// The longest name of a person, a window or an edit, characters.
const LONGEST: usize = 64;

/// Who asks, as far as it is said.
#[derive(Debug, Default)]
pub(crate) struct Person {
    author: Option<String>,
    name: Option<String>,
    pub(crate) tab: Option<String>,
}

impl Person {
    /// The person who makes an edit; without a name of its own it is called `anybody`, and without an own mark
    /// it is anybody.
    pub(crate) fn who(self, anybody: &str, edit: Option<EditId>) -> Who {
        let is_named = self.name.is_some();
        let name = self.name.unwrap_or_else(|| anybody.to_owned());
        Who {
            author: self.author.unwrap_or_else(|| name.clone()),
            name,
            is_named,
            tab: self.tab,
            edit: edit.map(|id| id.0),
        }
    }
}

impl<S: Send + Sync> FromRequestParts<S> for Person {
    type Rejection = ApiError;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, ApiError> {
        Ok(Self {
            author: mark(&parts.headers, "x-ralf-author")?,
            name: name(&parts.headers)?,
            tab: mark(&parts.headers, "x-ralf-tab")?,
        })
    }
}

/// A word in ASCII.
fn mark(headers: &HeaderMap, header: &'static str) -> Result<Option<String>, ApiError> {
    let Some(found) = headers.get(header) else { return Ok(None) };
    let found = found.to_str().ok().filter(|found| (1..=LONGEST).contains(&found.len()));
    let refused =
        || ApiError::Malformed(format!("{header}: expected 1 to {LONGEST} ASCII characters, found others"));
    found.map(|found| Some(found.to_owned())).ok_or_else(refused)
}

/// A person's name, percent-encoded.
fn name(headers: &HeaderMap) -> Result<Option<String>, ApiError> {
    let Some(found) = headers.get("x-ralf-name") else { return Ok(None) };
    let text = found.to_str().ok().and_then(|text| percent_decode_str(text).decode_utf8().ok());
    let good = text.filter(|name| {
        (1..=LONGEST).contains(&name.chars().count())
            && !name.trim().is_empty()
            && !name.chars().any(char::is_control)
    });
    let refused = || {
        ApiError::Malformed(format!(
            "x-ralf-name: expected 1 to {LONGEST} characters, percent-encoded, found others"
        ))
    };
    good.map(|name| Some(name.into_owned())).ok_or_else(refused)
}

/// What the page calls an edit, so that it is made once.
#[derive(Debug, Clone)]
pub(crate) struct EditId(String);

impl<'de> Deserialize<'de> for EditId {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let name = String::deserialize(from)?;
        if (8..=LONGEST).contains(&name.len()) && name.bytes().all(|byte| byte.is_ascii_graphic()) {
            return Ok(Self(name));
        }
        Err(de::Error::custom(format!("id: expected 8 to {LONGEST} visible ASCII characters")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_in_any_script_and_nonsense_is_refused() {
        let read = |text: &str| {
            let headers = HeaderMap::from_iter([(
                axum::http::HeaderName::from_static("x-ralf-name"),
                text.parse().unwrap(),
            )]);
            name(&headers).map_err(|_| ())
        };
        assert_eq!(read("Zo%C3%AB%20%E5%BC%A0"), Ok(Some("Zo\u{eb} \u{5f20}".into())));
        for wrong in ["", "%20", "%0A", "%FF", &"a".repeat(65)] {
            assert_eq!(read(wrong), Err(()), "{wrong}");
        }
    }
}
