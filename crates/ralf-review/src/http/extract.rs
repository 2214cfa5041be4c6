//! What is taken from a request; whatever is wrong with it is told in a sentence.

use super::ApiError;
use axum::body::Bytes;
use axum::extract::{FromRequest, FromRequestParts, Path, Query, Request};
use axum::http::request::Parts;
use axum::http::{StatusCode, header};
use serde::de::DeserializeOwned;
use std::time::Duration;
use tokio::time::timeout;

/// The largest body of a request, bytes.
pub const MAX_BODY: usize = 8 << 20;
/// How long a body may take to arrive.
const PATIENCE: Duration = Duration::from_secs(30);

/// The places in the address.
pub(crate) struct Place<T>(pub(crate) T);

impl<S: Send + Sync, T: DeserializeOwned + Send> FromRequestParts<S> for Place<T> {
    type Rejection = ApiError;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, ApiError> {
        let address = parts.uri.path().to_owned();
        let found = Path::from_request_parts(parts, state).await;
        found.map(|Path(place)| Self(place)).map_err(|error| {
            ApiError::Unknown(format!("{address}: expected names and numbers, found: {}", error.body_text()))
        })
    }
}

/// What is asked behind the `?`.
pub(crate) struct Asked<T>(pub(crate) T);

impl<S: Send + Sync, T: DeserializeOwned> FromRequestParts<S> for Asked<T> {
    type Rejection = ApiError;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, ApiError> {
        let found = Query::from_request_parts(parts, state).await;
        found
            .map(|Query(asked)| Self(asked))
            .map_err(|error| ApiError::Malformed(format!("query: {}", error.body_text())))
    }
}

/// A body in JSON.
pub(crate) struct Body<T>(pub(crate) T);

impl<S: Send + Sync, T: DeserializeOwned> FromRequest<S> for Body<T> {
    type Rejection = ApiError;

    async fn from_request(request: Request, state: &S) -> Result<Self, ApiError> {
        let kind =
            request.headers().get(header::CONTENT_TYPE).and_then(|kind| kind.to_str().ok()).unwrap_or("");
        if kind.split(';').next().is_none_or(|kind| !kind.trim().eq_ignore_ascii_case("application/json")) {
            return Err(ApiError::Malformed(format!(
                "Content-Type: expected application/json, found `{kind}`"
            )));
        }
        let length = request.headers().get(header::CONTENT_LENGTH).and_then(|length| length.to_str().ok());
        if length.and_then(|length| length.parse().ok()).is_some_and(|length: usize| length > MAX_BODY) {
            return Err(too_large());
        }
        let read = timeout(PATIENCE, Bytes::from_request(request, state)).await;
        let slow =
            |_| ApiError::Malformed(format!("body: expected all of it within {PATIENCE:?}, found less"));
        let bytes = read.map_err(slow)?.map_err(|error| match error.status() {
            StatusCode::PAYLOAD_TOO_LARGE => too_large(),
            _ => ApiError::Malformed(format!("body: {}", error.body_text())),
        })?;
        serde_json::from_slice(&bytes)
            .map(Self)
            .map_err(|error| ApiError::Malformed(format!("body: {error}")))
    }
}

fn too_large() -> ApiError {
    ApiError::TooLarge(format!("body: expected at most {MAX_BODY} bytes, found more"))
}
