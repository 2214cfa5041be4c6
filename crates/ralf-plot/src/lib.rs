//! Pictures of labelled radar scans.
