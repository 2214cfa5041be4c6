//! The server over real HTTP, on a small simulated recording.
#![expect(clippy::unwrap_used, clippy::panic, reason = "helpers of tests fail as tests do")]

mod classes;
mod correcting;
mod ending;
mod harm;
mod images;
mod killed;
mod learned;
mod reading;
mod safety;
mod support;
mod team;
mod things;
