//! The server of the page where people correct labels.
//!
//! [`Server::bind`] takes a [recording](ralf_data::Recording) and the folder that `ralf label` filled, and
//! [`Server::run`] serves one page and an interface for it, which `docs/review-api.md` describes, until the
//! user ends it. What is behind it:
//!
//! - `reading/` makes tables of what the recording and the run hold; nothing of these is ever written.
//! - `correcting/` turns requests into strokes, steps and marks of a [store](ralf_corrections::Store); an
//!   answer means that the edit is on disk.
//! - `http/` says who may ask and how answers look: other hosts, origins and sites are refused, and requests
//!   without the server's token: others may work on the same machine.
//! - `team` knows who labels what: who labels a second time writes to a file of its own, and sees nobody else's.
//! - `need` orders scans by how much they want a person.
//!
//! Requests name sequences, sensors and measurements by what the recording holds and never by a path, so that
//! nothing else can be read through it. Reading happens on threads of its own; what is kept in memory is
//! bounded.

mod addresses;
mod app;
mod cache;
mod causes;
mod columns;
mod connections;
mod contents;
mod correcting;
mod error;
mod http;
mod labelled;
mod listening;
mod need;
mod options;
mod page;
mod patient_stream;
mod place;
mod reading;
mod routes;
mod server;
mod shared_store;
mod team;

pub use error::ReviewError;
pub use http::MAX_BODY;
pub use need::{Certainty, DISAGREEING, Doubts, ScanNeed, UNCERTAIN};
pub use options::Options;
pub use server::Server;
