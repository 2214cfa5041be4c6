//! The command `ralf`.

use std::hint::black_box;
use std::process::ExitCode;

/// Bytes: more than a LiDAR scan, an image or a table of labels takes.
const LARGEST_PIECE: usize = 4 << 20;

fn main() -> ExitCode {
    keep_memory();
    ExitCode::from(ralf_cli::run(std::env::args_os()))
}

/// Memory that a scan gives back stays with the program for the next one.
///
/// The C library of Linux gives free memory back to the system as soon as it is more than twice the largest piece that
/// was ever freed, and gets it anew, page by page, for the next scan: up to half of the time that labelling spent
/// in the kernel. Such a piece is taken once and freed, untouched. Other systems' libraries don't mind.
fn keep_memory() {
    drop(black_box(Vec::<u8>::with_capacity(LARGEST_PIECE)));
}
