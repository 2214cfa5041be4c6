//! The page, embedded when the program was built.

use crate::http::content;
use axum::response::Response;

// `FILES`: address, content type, content.
include!(concat!(env!("OUT_DIR"), "/page_files.rs"));

/// A file of the page by its address.
pub(crate) fn file(path: &str) -> Option<Response> {
    let path = if path == "/" { "/index.html" } else { path };
    FILES.iter().find(|(address, ..)| *address == path).map(|(_, kind, bytes)| content(kind, *bytes))
}
