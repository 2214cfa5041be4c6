//! A folder becomes a recording: which format it is, by what it holds.

use crate::{DataError, Recording, layout, nuscenes, view_of_delft};
use std::fs;
use std::path::Path;

/// A format that can be read.
struct Format {
    /// As `--format` takes it.
    name: &'static str,
    /// What a folder of this format holds, for people.
    holds: &'static str,
    /// Whether a folder holds it.
    recognises: fn(&Path) -> bool,
    /// Reads such a folder.
    open: fn(&Path) -> Result<Recording, DataError>,
}

/// In the order in which they are tried.
const FORMATS: [Format; 3] = [
    Format {
        name: layout::NAME,
        holds: "the folder `sequences`",
        recognises: |path| path.join(layout::SEQUENCES).is_dir(),
        open: layout::open,
    },
    Format {
        name: nuscenes::NAME,
        holds: "a folder `v1.0-*` with `sample_data.json`",
        recognises: nuscenes::recognises,
        open: nuscenes::open,
    },
    Format {
        name: view_of_delft::NAME,
        holds: "the folders `radar/training/velodyne` and `radar/training/calib`",
        recognises: view_of_delft::recognises,
        open: view_of_delft::open,
    },
];

/// The names of the formats that can be read.
pub fn formats() -> &'static [&'static str] {
    const NAMES: [&str; FORMATS.len()] = {
        let mut names = [""; FORMATS.len()];
        let mut i = 0;
        while i < names.len() {
            names[i] = FORMATS[i].name;
            i += 1;
        }
        names
    };
    &NAMES
}

/// Opens a recording: of this format, or else of the one that the folder is recognised as.
pub fn open(path: &Path, format: Option<&str>) -> Result<Recording, DataError> {
    fs::metadata(path).map_err(DataError::io(path))?;
    let found = match format {
        Some(name) => FORMATS.iter().find(|format| format.name == name).ok_or_else(|| {
            DataError::content(
                path,
                "format",
                format!("one of {}", formats().join(", ")),
                format!("`{name}`"),
            )
        }),
        None => FORMATS.iter().find(|format| (format.recognises)(path)).ok_or_else(|| {
            let known = FORMATS.iter().map(|format| format!("{} ({})", format.holds, format.name));
            let expected = known.collect::<Vec<_>>().join(" or ");
            DataError::content(path, "content", expected, "none of them")
        }),
    }?;
    (found.open)(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_recording_is_told_what_was_looked_for() {
        let folder = tempfile::tempdir().unwrap();
        let error = |format| open(folder.path(), format).unwrap_err().to_string();
        assert!(error(None).contains("the folder `sequences` (ralf)"), "{}", error(None));
        assert!(error(Some("kitti")).contains("expected one of ralf"), "{}", error(Some("kitti")));
        assert!(error(Some("ralf")).contains("sequences"), "{}", error(Some("ralf")));
        let missing = open(&folder.path().join("nowhere"), None).unwrap_err();
        assert!(matches!(missing, DataError::Io { .. }) && missing.to_string().contains("nowhere"));
    }
}
