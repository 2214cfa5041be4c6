//! What every request has in common: who may ask, what is taken from it, and how answers look.

mod api_error;
mod ends;
mod extract;
mod guard;
mod invitation;
mod person;
mod table;
mod token;

pub(crate) use api_error::ApiError;
pub(crate) use ends::Ends;
pub use extract::MAX_BODY;
pub(crate) use extract::{Asked, Body, Place};
pub(crate) use guard::{Guard, Served, guard};
pub(crate) use invitation::{Invitation, OPEN};
pub(crate) use person::{EditId, Person};
pub(crate) use table::Table;
pub(crate) use token::Token;

use axum::body::Body as Bytes;
use axum::http::{HeaderValue, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;

/// What a handler answers.
pub(crate) type Answer = Result<Response, ApiError>;

/// An answer in JSON.
pub(crate) fn json(value: &impl Serialize) -> Answer {
    let text = serde_json::to_vec(value).map_err(|error| ApiError::Broken(error.to_string()))?;
    Ok(content("application/json", text))
}

/// An answer of some type.
pub(crate) fn content(kind: &'static str, bytes: impl Into<Bytes>) -> Response {
    let kind = HeaderValue::from_static(kind);
    ([(header::CONTENT_TYPE, kind)], bytes.into()).into_response()
}
