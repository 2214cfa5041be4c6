//! What is written beside a recording's measurements would be taken for a part of it.

use crate::disk::files;
use crate::disk::real_path::real_path;
use crate::error::DataError;
use crate::tree::{MARKS_OF_LABELS, PLAN, RECORD, SECOND, SEQUENCES, TEAM, UNFINISHED, sensors_file};
use std::path::Path;

/// What belongs to the program in an output folder beside the sequences.
const OWN: [&str; 6] = [RECORD, UNFINISHED, ralf_corrections::FILE, TEAM, SECOND, PLAN];

/// Refuses to write to a place that is the recording's own, and [others of the program's own](refuse_own_places):
/// inputs are only read.
pub fn refuse_to_write_into(recording: &Path, out: &Path) -> Result<(), DataError> {
    let (place, recording) = (real_path(out), real_path(recording));
    if place == recording || place.starts_with(recording.join(SEQUENCES)) {
        return Err(DataError::content(out, "output", "a place outside the recording", "a part of it"));
    }
    refuse_own_places(out)
}

/// Refuses a place among the sequences of a recording in the own layout or of results, and one that belongs to the
/// program in results, such as `corrections.sqlite`, whether something lies there or not.
///
/// # Errors
/// Such a place.
pub fn refuse_own_places(out: &Path) -> Result<(), DataError> {
    refuse_among_sequences(out)?;
    let place = real_path(out);
    for folder in place.ancestors().skip(1) {
        let Some(name) = place.strip_prefix(folder).ok().and_then(|inside| inside.iter().next()) else {
            continue;
        };
        if belongs_to_results(folder, &name.to_string_lossy()) {
            let found = format!("`{}` of {}, which is ralf's own", name.display(), folder.display());
            return Err(DataError::content(out, "output", "a place of no other meaning", found));
        }
    }
    Ok(())
}

/// Whether a name in a folder is the program's own: those of results also in a recording, which they would make
/// results.
fn belongs_to_results(folder: &Path, name: &str) -> bool {
    let is = |own: &str| name.eq_ignore_ascii_case(own);
    // What SQLite lays beside a database is a part of it.
    let is_journal =
        ["-wal", "-shm", "-journal"].iter().any(|end| is(&format!("{}{end}", ralf_corrections::FILE)));
    let has_labels = || MARKS_OF_LABELS.iter().chain([&PLAN]).any(|mark| folder.join(mark).exists());
    if is(SEQUENCES) {
        return has_labels();
    }
    (is_journal || OWN.iter().any(|own| is(own))) && (folder.join(SEQUENCES).is_dir() || has_labels())
}

/// Refuses a place among the sequences of a recording in the own layout.
fn refuse_among_sequences(out: &Path) -> Result<(), DataError> {
    let place = real_path(out);
    let folders = place.ancestors().filter(|folder| folder.file_name().is_some_and(|name| name == SEQUENCES));
    for recording in folders.filter_map(Path::parent) {
        // What can't be listed on the way is no business of who writes below it.
        let names = files::folders(&recording.join(SEQUENCES)).unwrap_or_default();
        if let Some(name) = names.iter().find(|name| sensors_file(recording, name).is_file()) {
            let found = format!(
                "a part of {}, which has {}",
                recording.display(),
                sensors_file(recording, name).display()
            );
            return Err(DataError::content(out, "output", "a place outside recordings", found));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn what_belongs_to_recordings_and_results_is_no_place_though_nothing_is_there() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        for name in
            ["city/sequences/00/sequence.toml", "out/run.json", "runs/corrections.sqlite", "plans/plan.json"]
        {
            fs::create_dir_all(place(name).parent().unwrap()).unwrap();
            fs::write(place(name), "").unwrap();
        }
        let check = |name: &str| refuse_own_places(&place(name)).map_err(|error| error.to_string());
        for name in
            ["city/sequences/00/front/000099.png", "city/sequences/00/second.toml", "city/sequences/labels"]
        {
            assert!(check(name).is_err_and(|told| told.contains("a place outside recordings")), "{name}");
        }
        let own = ["city/run.json", "city/team.toml", "out/corrections.sqlite", "out/corrections.sqlite-wal"];
        let own = own.iter().chain(&[
            "out/Run.json",
            "out/second/bob.sqlite",
            "out/sequences/exp",
            "runs/team.toml",
        ]);
        for name in own.chain(&["plans/sequences/a.png", "out/.ralf-run/x"]) {
            assert!(check(name).is_err_and(|told| told.contains("which is ralf's own")), "{name}");
        }
        for name in
            ["city/ralf.toml", "out/page.html", "out/export", "team.toml", "sequences/out", "a/sequences/x"]
        {
            assert_eq!(check(name), Ok(()), "{name}");
        }
    }
}
