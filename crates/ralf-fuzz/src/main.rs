//! Runs cases, one after the other or a single one: see the crate's page.

use ralf_fuzz::{Case, all_cases, make_places, watch};
use std::io::{Result, Write, stdout};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["cases", places, scratch, first] => cases(Path::new(places), Path::new(scratch), number(first)?),
        ["replay", case] => replay(number(case)?),
        ["corpus", folder] => corpus(Path::new(folder)),
        ["watch", seconds, first] => {
            let program = std::env::current_exe()?;
            let watched = watch(&program, number(first)?, Duration::from_secs(number(seconds)?))?;
            for failure in &watched.failures {
                writeln!(stdout(), "{failure}")?;
            }
            let (cases, failures) = (watched.cases, watched.failures.len());
            writeln!(stdout(), "{cases} cases, {failures} failures, the longest took {:?}", watched.longest)
        }
        _ => writeln!(stdout(), "ralf-fuzz watch SECONDS FIRST | replay CASE | corpus FOLDER"),
    }
}

fn number(text: &str) -> Result<u64> {
    text.parse().map_err(std::io::Error::other)
}

/// Runs cases until it is killed, and tells of each when it begins and ends.
fn cases(places: &Path, scratch: &Path, first: u64) -> Result<()> {
    let said = Arc::new(Mutex::new(String::new()));
    let heard = said.clone();
    std::panic::set_hook(Box::new(move |panic| {
        let told = panic.to_string().replace('\n', " ");
        *heard.lock().unwrap_or_else(PoisonError::into_inner) = told;
    }));
    for number in first.. {
        let case = Case::new(number, places, scratch);
        writeln!(stdout(), "start {number} {}", case.name())?;
        stdout().flush()?;
        if !case.run() {
            writeln!(stdout(), "panic {}", said.lock().unwrap_or_else(PoisonError::into_inner))?;
        }
        writeln!(stdout(), "end {number}")?;
        stdout().flush()?;
    }
    Ok(())
}

/// Writes what the target `files` of the folder `fuzz` begins with: verb, file, and the file's content.
fn corpus(folder: &Path) -> Result<()> {
    let made = tempfile::tempdir()?;
    let places = made.path().join("places");
    make_places(&places);
    std::fs::create_dir_all(folder)?;
    for (verb, file) in all_cases(&places) {
        let case = Case::chosen(verb, file, &places, &made.path().join("scratch"));
        let bytes = [vec![verb, file], case.whole()].concat();
        std::fs::write(folder.join(format!("{verb:03}-{file:03}")), bytes)?;
    }
    Ok(())
}

/// Runs one case, with its message.
fn replay(number: u64) -> Result<()> {
    let folder = tempfile::tempdir()?;
    make_places(&folder.path().join("places"));
    let case = Case::new(number, &folder.path().join("places"), &folder.path().join("scratch"));
    writeln!(stdout(), "{}", case.name())?;
    let outcome = if case.run() { "returned" } else { "panicked" };
    writeln!(stdout(), "{outcome}")
}
