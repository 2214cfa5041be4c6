//! Files that a command writes: never over what it reads.

use crate::outcome::UsageError;
use anyhow::Context;
use ralf::learned::Model;
use ralf_data::read::refuse_own_places;
use ralf_data::{DataError, RECORD, SENSORS, SEQUENCES, real_path};
use std::ffi::OsStr;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

/// What people draw and read, and lay into a folder beside what belongs there.
const PAGES: [&str; 2] = ["png", "html"];
/// What a page begins with.
const PAGE: &[u8] = b"<!DOCTYPE html>";
/// What a picture begins with (PNG).
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// What an SQLite database begins with.
const SQLITE: &[u8; 16] = b"SQLite format 3\0";

/// Refuses, before the work that fills it, a place for a file that is [no good](refuse_place), and tells where none can
/// be made.
pub(crate) fn check_output(argument: &str, file: &Path, read_only: &[&Path]) -> anyhow::Result<()> {
    refuse_place(argument, file, read_only)?;
    ralf_data::check_writable(file).context(argument.to_owned())
}

/// The same of a text that people edit: what they made of it is kept ([`ralf_data::write_editable`]).
pub(crate) fn check_editable(
    argument: &str,
    file: &Path,
    begin: &str,
    read_only: &[&Path],
) -> anyhow::Result<()> {
    check_output(argument, file, read_only)?;
    let edited = |error: DataError| UsageError(format!("{argument}: {error}"));
    ralf_data::refuse_edited(file).map_err(edited)?;
    refuse_other_beginning(argument, file, begin.as_bytes(), "nothing yet, or what this command wrote")
}

/// The same of a model: one that somebody changed, and any other text, is kept.
pub(crate) fn check_model(argument: &str, file: &Path, read_only: &[&Path]) -> anyhow::Result<()> {
    check_output(argument, file, read_only)?;
    let found = match std::fs::read_to_string(file) {
        Ok(text) if text.is_empty() || Model::is_as_written(&text) => return Ok(()),
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        Ok(_) => "another text, or one that was changed since",
        Err(_) => "another file",
    };
    Err(would_be_lost(argument, file, "nothing yet, or a model as `ralf learn` writes it", found))
}

/// Why a file stays: it is another than what a command writes there.
fn would_be_lost(argument: &str, file: &Path, expected: &str, found: &str) -> anyhow::Error {
    let what_to_do = "which would be lost: move it away, or choose another name";
    let file = file.display();
    UsageError(format!("{argument}: {file}: expected {expected}, found {found}, {what_to_do}")).into()
}

/// The same of a page: any text but a page is kept, such as settings.
pub(crate) fn check_page(argument: &str, file: &Path, read_only: &[&Path]) -> anyhow::Result<()> {
    check_output(argument, file, read_only)?;
    refuse_other_ending(argument, file, &["html", "htm"])?;
    refuse_other_beginning(argument, file, PAGE, "nothing yet, or a page")
}

/// The same of a picture: all but a picture is kept.
pub(crate) fn check_picture(argument: &str, file: &Path, read_only: &[&Path]) -> anyhow::Result<()> {
    check_output(argument, file, read_only)?;
    refuse_other_ending(argument, file, &["png"])?;
    refuse_other_beginning(argument, file, PNG, "nothing yet, or a picture (PNG)")
}

/// Refuses a name that says that the file is of another format. One without an ending says nothing.
fn refuse_other_ending(argument: &str, file: &Path, endings: &[&str]) -> Result<(), UsageError> {
    let is_one_of_them = |found: &OsStr| endings.iter().any(|ending| found.eq_ignore_ascii_case(ending));
    if file.extension().is_none_or(is_one_of_them) {
        return Ok(());
    }
    let found = file.display();
    Err(UsageError(format!("{argument}: expected a name that ends in .{}, found {found}", endings[0])))
}

/// Refuses two places that are one: of two files only the later would be left.
pub(crate) fn refuse_same(arguments: [&str; 2], files: [&Path; 2]) -> Result<(), UsageError> {
    let [first, second] = files.map(real_path);
    if first != second {
        return Ok(());
    }
    let [earlier, later] = arguments;
    let found = files[0].display();
    Err(UsageError(format!("{earlier} and {later}: expected two files, found {found} for both")))
}

/// Refuses a file that begins otherwise than those that a command writes.
fn refuse_other_beginning(argument: &str, file: &Path, begin: &[u8], expected: &str) -> anyhow::Result<()> {
    let mut head = Vec::new();
    let read = File::open(file).and_then(|file| file.take(begin.len() as u64).read_to_end(&mut head));
    // What can't be read is replaced all the same where it may be.
    if read.is_err() || head.is_empty() || head.eq_ignore_ascii_case(begin) {
        return Ok(());
    }
    Err(would_be_lost(argument, file, expected, "another file"))
}

/// Refuses a place for a file, named by its argument, that belongs to a recording in the own layout or to results,
/// whether something lies there or not; and what is [no good](refuse_loss) of what lies there.
fn refuse_place(argument: &str, file: &Path, read_only: &[&Path]) -> Result<(), UsageError> {
    refuse_loss(argument, file, read_only)?;
    refuse_own_places(file).map_err(|error| UsageError(format!("{argument}: {error}")))
}

/// Refuses a place where something lies that is no regular file, such as a folder or a device, or a database, which no
/// command writes there; and where a file of one of the folders lies that are only read, a recording or results, or of
/// any other recording in the own layout or results of `ralf label`. Pictures and pages directly in such a folder are
/// no part of it.
fn refuse_loss(argument: &str, file: &Path, read_only: &[&Path]) -> Result<(), UsageError> {
    let Ok(found) = std::fs::metadata(file) else { return Ok(()) };
    let refuse = |expected: &str, found: &str| {
        UsageError(format!("{argument}: expected {expected}, found {found} {}", file.display()))
    };
    if found.is_dir() {
        return Err(refuse("a file", "the folder"));
    }
    if !found.is_file() {
        return Err(refuse("a file", "what is no regular file:"));
    }
    if is_database(file) {
        return Err(refuse("a place where nothing is lost", "a database, such as what people corrected:"));
    }
    if read_only.iter().any(|place| is_part_of(file, place)) || is_of_another(file) {
        return Err(refuse("a place where nothing is lost", "a file of the recording or of its results:"));
    }
    Ok(())
}

/// Whether a file begins as SQLite's do. What can't be read is replaced all the same where it may be.
fn is_database(file: &Path) -> bool {
    let mut head = [0; SQLITE.len()];
    File::open(file).and_then(|mut file| file.read_exact(&mut head)).is_ok() && head == *SQLITE
}

/// Whether a file belongs to a sequence of any recording in the own layout, or to results.
fn is_of_another(file: &Path) -> bool {
    let Ok(whole) = file.canonicalize() else { return false };
    whole.ancestors().skip(1).any(|folder| {
        let [record, sequences] = [RECORD, SEQUENCES].map(|name| folder.join(name));
        let is_of_run = record.is_file() && (whole == record || is_part_of(file, &sequences));
        is_of_run || folder.join(SENSORS).is_file() && is_part_of(file, folder)
    })
}

/// What can't be looked up is not there.
fn is_part_of(file: &Path, place: &Path) -> bool {
    let (Ok(file), Ok(place)) = (file.canonicalize(), place.canonicalize()) else { return false };
    let extension = file.extension().unwrap_or_default();
    let is_page = PAGES.iter().any(|page| extension.eq_ignore_ascii_case(page));
    file == place || file.starts_with(&place) && !(is_page && file.parent() == Some(&place))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn what_is_read_is_not_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        fs::create_dir_all(place("out/sequences")).unwrap();
        for name in ["out/run.json", "out/sequences/a.png", "out/report.html", "out.toml", "bag"] {
            fs::write(place(name), "x").unwrap();
        }
        let (out, bag) = (place("out"), place("bag"));
        let check =
            |name: &str| refuse_place("--output", &place(name), &[&out, &bag]).map_err(|error| error.0);
        for name in ["out/new.png", "out/report.html", "out.toml", "elsewhere/new.html"] {
            assert_eq!(check(name), Ok(()), "{name}");
        }
        for name in ["out/run.json", "out/sequences/a.png", "out/../out/run.json", "bag"] {
            assert!(check(name).unwrap_err().contains("nothing is lost"), "{name}");
        }
        assert!(check("out").unwrap_err().contains("found the folder"));
    }

    #[test]
    fn what_belongs_to_any_recording_or_results_is_not_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        let [sequence, run] = ["city/sequences/00", "out"];
        let files =
            ["sequence.toml", "odometry.csv", "front/000000.png"].map(|name| format!("{sequence}/{name}"));
        let results = ["run.json", "sequences/00/plausibility.parquet"].map(|name| format!("{run}/{name}"));
        let own = ["ralf.toml", "city/ralf.toml", "city/scan.png", "out/found.toml"].map(str::to_owned);
        for name in files.iter().chain(&results).chain(&own) {
            fs::create_dir_all(place(name).parent().unwrap()).unwrap();
            fs::write(place(name), "x").unwrap();
        }
        let check = |name: &str| refuse_place("--output", &place(name), &[]).map_err(|error| error.0);
        for name in files.iter().chain(&results) {
            assert!(check(name).is_err_and(|error| error.contains("nothing is lost")), "{name}");
        }
        own.iter().for_each(|name| assert_eq!(check(name), Ok(()), "{name}"));
        // What isn't there yet would be taken for a part of them.
        let new =
            ["city/sequences/00/front/000099.png", "city/sequences/00/second.toml", "out/corrections.sqlite"];
        for name in new.iter().chain(&["out/team.toml", "out/sequences/page.html"]) {
            assert!(check(name).unwrap_err().starts_with("--output: "), "{name}");
        }
    }

    #[test]
    fn a_page_takes_the_place_of_a_page_alone() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        fs::write(place("page.html"), "<!doctype html><html lang=\"en\">").unwrap();
        fs::write(place("empty.html"), "").unwrap();
        fs::write(place("Makefile"), "all:").unwrap();
        fs::write(place("notes.html"), "mine").unwrap();
        let check = |name: &str| check_page("--output", &place(name), &[]).map_err(|error| error.to_string());
        for name in ["page.html", "empty.html", "new.html", "new.HTM", "new"] {
            assert_eq!(check(name), Ok(()), "{name}");
        }
        for name in ["Makefile", "notes.html"] {
            assert!(check(name).unwrap_err().contains("expected nothing yet, or a page"), "{name}");
        }
        assert!(check("new.pdf").unwrap_err().contains("expected a name that ends in .html"));
    }

    #[test]
    fn a_picture_takes_the_place_of_a_picture_alone() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        fs::write(place("scan.png"), [PNG, b"..."].concat()).unwrap();
        fs::write(place("Makefile"), "all:").unwrap();
        fs::write(place("notes.png"), "mine").unwrap();
        let check =
            |name: &str| check_picture("--output", &place(name), &[]).map_err(|error| error.to_string());
        for name in ["scan.png", "new.PNG", "new"] {
            assert_eq!(check(name), Ok(()), "{name}");
        }
        for name in ["Makefile", "notes.png"] {
            assert!(check(name).unwrap_err().contains("expected nothing yet, or a picture"), "{name}");
        }
        assert!(check("new.toml").unwrap_err().contains("expected a name that ends in .png"));
    }

    #[test]
    fn two_files_have_two_places() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("a")).unwrap();
        let [file, other, again] = ["new", "newer", "a/../new"].map(|name| folder.path().join(name));
        let same = |second: &Path| refuse_same(["--write", "--output"], [&file, second]).is_err();
        assert!(same(&again) && same(&file) && !same(&other));
    }

    #[test]
    fn a_database_is_not_written_over_wherever_it_lies() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        fs::write(place("corrections.sqlite"), b"SQLite format 3\0...").unwrap();
        fs::write(place("notes.sqlite"), b"SQLite").unwrap();
        let check = |name: &str| refuse_place("--output", &place(name), &[]).map_err(|error| error.0);
        assert!(check("corrections.sqlite").unwrap_err().contains("found a database"));
        assert_eq!((check("notes.sqlite"), check("new.sqlite")), (Ok(()), Ok(())));
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_no_place_for_a_file() {
        let refused = refuse_place("--write", Path::new("/dev/null"), &[]).unwrap_err();
        assert_eq!(refused.0, "--write: expected a file, found what is no regular file: /dev/null");
    }
}
