//! Whatever is wrong with a file, nothing panics, hangs or takes all memory. `RALF_FUZZ_SECONDS` says for how long it
//! is tried (2 s without it), `RALF_FUZZ_FIRST` from which case on.

#![cfg(unix)]

use ralf_fuzz::watch;
use std::path::Path;
use std::time::Duration;

fn from_environment(name: &str, usual: u64) -> u64 {
    std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(usual)
}

#[test]
fn no_damaged_file_makes_a_command_panic_hang_or_take_all_memory() {
    let time = Duration::from_secs(from_environment("RALF_FUZZ_SECONDS", 2));
    let first = from_environment("RALF_FUZZ_FIRST", 1);
    let watched = watch(Path::new(env!("CARGO_BIN_EXE_ralf-fuzz")), first, time).unwrap();
    assert!(watched.cases > 0, "no case ended");
    let told: String = watched.failures.iter().map(|failure| format!("{failure}\n")).collect();
    assert!(
        told.is_empty(),
        "{told}of {} cases (replay one: cargo run -p ralf-fuzz -- replay CASE)",
        watched.cases
    );
}
