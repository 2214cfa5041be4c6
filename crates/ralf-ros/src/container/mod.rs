//! Finding and reading the messages of a recording.

pub(crate) mod bag_format;
