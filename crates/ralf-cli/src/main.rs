//! The command line of RALF.
fn main() {}
