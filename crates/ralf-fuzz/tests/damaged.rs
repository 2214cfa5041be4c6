//! Whatever is wrong with a file, nothing panics, hangs or takes all memory. `RALF_FUZZ_SECONDS` says for how long it
//! is tried (2 s without it), `RALF_FUZZ_FIRST` from which case on.

#![cfg(unix)]

use ralf_fuzz::{Case, all_cases, make_places, watch};
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

#[test]
fn a_case_finds_its_place_whole_whatever_the_one_before_wrote_there() {
    let folder = tempfile::tempdir().unwrap();
    let [places, scratch] = ["places", "scratch"].map(|name| folder.path().join(name));
    make_places(&places);
    let verbs = || all_cases(&places).into_iter().filter(|(_, file)| *file == 0);
    for (verb, file) in verbs() {
        let case = Case::chosen(verb, file, &places, &scratch);
        let (name, whole) = (case.name(), case.whole());
        // Readers write nowhere but in a folder that goes with them.
        assert!(name.starts_with("read ") || case.run_with(&whole), "{name}");
    }
    verbs().for_each(|(verb, file)| drop(Case::chosen(verb, file, &places, &scratch)));
    assert_eq!(all_cases(&scratch), all_cases(&places));
}
