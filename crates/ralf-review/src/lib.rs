//! The server of the page where people correct labels.
