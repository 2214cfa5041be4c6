//! Errors as the page gets them: a status, and `{"error": sentence}`.

use super::json;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use ralf::sensors::SourceError;
use ralf_corrections::StoreError;
use ralf_data::DataError;
use serde_json::{Map, Value};

/// Why a request is not answered.
#[derive(Debug)]
pub(crate) enum ApiError {
    /// It makes no sense (400).
    Malformed(String),
    /// Who asks does not have the token (401).
    Unauthorized(String),
    /// Who asks may not (403).
    Forbidden(String),
    /// There is no such thing (404).
    Unknown(String),
    /// It may not be asked in this way (405).
    Method,
    /// Somebody else's edit came first (409): the sentence, and what else is told.
    Conflict(String, Map<String, Value>),
    /// It is for other corrections than those that are served (412).
    Elsewhere(String),
    /// Its body is too large (413).
    TooLarge(String),
    /// A file can't be read or written (500).
    Broken(String),
}

impl ApiError {
    /// Something of the address isn't known.
    pub(crate) fn unknown(what: &str, name: impl std::fmt::Display, known: &str) -> Self {
        Self::Unknown(format!("{what}: expected {known}, found {name}"))
    }

    fn parts(self) -> (StatusCode, String, Map<String, Value>) {
        let (status, sentence) = match self {
            Self::Malformed(sentence) => (StatusCode::BAD_REQUEST, sentence),
            Self::Unauthorized(sentence) => (StatusCode::UNAUTHORIZED, sentence),
            Self::Forbidden(sentence) => (StatusCode::FORBIDDEN, sentence),
            Self::Unknown(sentence) => (StatusCode::NOT_FOUND, sentence),
            Self::Method => (StatusCode::METHOD_NOT_ALLOWED, "the address knows no such method".to_owned()),
            Self::Conflict(sentence, more) => return (StatusCode::CONFLICT, sentence, more),
            Self::Elsewhere(sentence) => (StatusCode::PRECONDITION_FAILED, sentence),
            Self::TooLarge(sentence) => (StatusCode::PAYLOAD_TOO_LARGE, sentence),
            Self::Broken(sentence) => (StatusCode::INTERNAL_SERVER_ERROR, sentence),
        };
        (status, sentence, Map::new())
    }
}

impl IntoResponse for ApiError {
    fn into_response(self) -> Response {
        let (status, sentence, mut body) = self.parts();
        body.insert("error".to_owned(), Value::String(sentence));
        match json(&body) {
            Ok(mut response) => {
                *response.status_mut() = status;
                response
            }
            Err(_) => status.into_response(),
        }
    }
}

impl From<DataError> for ApiError {
    fn from(error: DataError) -> Self {
        Self::Broken(error.to_string())
    }
}

impl From<SourceError> for ApiError {
    fn from(error: SourceError) -> Self {
        Self::Broken(error.to_string())
    }
}

impl From<StoreError> for ApiError {
    fn from(error: StoreError) -> Self {
        match error {
            StoreError::Request { .. } => Self::Malformed(error.to_string()),
            _ => Self::Broken(error.to_string()),
        }
    }
}
