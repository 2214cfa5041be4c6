//! People who label one recording together: who labels what, and what is labelled twice.
//!
//! What counts lies in `OUT/corrections.sqlite`. Who labels a scan a second time, without seeing what the first said of
//! it, writes to a file of its own, `OUT/second/NAME.sqlite`: nobody's labels are read where another's are made.

mod assignment;
mod person;
mod second;
mod twice;
mod worked;

pub use assignment::{Assignment, Share};
pub use person::{alike, person};
pub use second::{second_file, second_labellers};
pub use twice::Twice;
pub use worked::Worked;
