//! A folder or file becomes a recording: which format it is, by what it holds.

use crate::error::DataError;
use crate::read::ros::Topics;
use crate::read::sound_motion::with_sound_motion;
use crate::read::{
    Recording, aimotive, layout, nuscenes, nvidia, radar_ghost, radar_scenes, ros, truckscenes,
    view_of_delft, zod,
};
use crate::tree::SEQUENCES;
use std::fs;
use std::path::{Path, PathBuf};

/// A format that can be read.
struct Format {
    /// As `--format` takes it.
    name: &'static str,
    /// What a folder of this format holds, or which file it is, for people.
    holds: &'static str,
    /// Whether its readers know the truth of detections without files of labels.
    knows_truth: bool,
    /// Whether it is one.
    recognises: fn(&Path) -> bool,
    /// Reads it. The topics are of those formats that have some. Of the sequences those of these names are wanted, all
    /// where none is named; a format may open others, too.
    open: fn(&Path, &Topics, &[String]) -> Result<Recording, DataError>,
}

/// In the order in which they are tried.
const FORMATS: [Format; 10] = [
    Format {
        name: zod::NAME,
        holds: "the lists `trainval-sequences-*.json` or `trainval-drives-*.json`",
        knows_truth: false,
        recognises: zod::recognises,
        open: |path, _, names| zod::open(path, names),
    },
    Format {
        name: layout::NAME,
        holds: "the folder `sequences`",
        knows_truth: false,
        recognises: |path| path.join(SEQUENCES).is_dir(),
        open: |path, _, names| layout::open(path, names),
    },
    Format {
        name: truckscenes::NAME,
        holds: "a folder `v1.2-*` (or an earlier version) with `ego_motion_chassis.json`",
        knows_truth: false,
        recognises: truckscenes::recognises,
        open: |path, _, names| truckscenes::open(path, names),
    },
    Format {
        name: nuscenes::NAME,
        holds: "a folder `v1.0-*` with `sample_data.json`",
        knows_truth: false,
        recognises: nuscenes::recognises,
        open: |path, _, names| nuscenes::open(path, names),
    },
    Format {
        name: view_of_delft::NAME,
        holds: "the folders `radar/training/velodyne` and `radar/training/calib`",
        knows_truth: false,
        recognises: view_of_delft::recognises,
        open: |path, _, names| view_of_delft::open(path, names),
    },
    Format {
        name: aimotive::NAME,
        holds: "a sequence's `sensor/calibration/calibration.json` and `sensor/radar`, or folders of such sequences",
        knows_truth: false,
        recognises: aimotive::recognises,
        open: |path, _, names| aimotive::open(path, names),
    },
    Format {
        name: radar_ghost::NAME,
        holds: "HDF5 files `scenario-*.h5`, or the folders `original` or `virtual` with such files",
        knows_truth: true,
        recognises: radar_ghost::recognises,
        open: |path, _, names| radar_ghost::open(path, names),
    },
    Format {
        name: radar_scenes::NAME,
        holds: "folders with `radar_data.h5` and `scenes.json`",
        knows_truth: true,
        recognises: radar_scenes::recognises,
        open: |path, _, names| radar_scenes::open(path, names),
    },
    Format {
        name: nvidia::NAME,
        holds: "radars' tables `radar/NAME/CLIP.NAME.parquet`, or folders of clips with such",
        knows_truth: false,
        recognises: nvidia::recognises,
        open: |path, _, names| nvidia::open(path, names),
    },
    Format {
        name: ros::NAME,
        holds: "a ROS 1 bag, an MCAP file, an SQLite file of ROS 2, or a folder with `metadata.yaml`",
        knows_truth: false,
        recognises: ralf_ros::container::recognises,
        open: |path, topics, _| ros::open(path, topics),
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
    open_with(path, format, &Topics::new())
}

/// Opens a recording as [`open`] does, where these topics of a ROS recording are its sensors; a first guess is made
/// where there are none.
pub fn open_with(path: &Path, format: Option<&str>, topics: &Topics) -> Result<Recording, DataError> {
    open_selected(path, format, topics, &[])
}

/// Opens the sequences of these names of a recording, all where none is named. Others may be damaged where each
/// sequence has files of its own: not in ROS, and not in the tables of nuScenes and MAN TruckScenes,
/// which tell of all.
///
/// # Errors
/// Those of [`open`]; a name that no sequence has.
pub fn open_selected(
    path: &Path,
    format: Option<&str>,
    topics: &Topics,
    names: &[String],
) -> Result<Recording, DataError> {
    let expected = "the folder or the file of a recording";
    fs::metadata(path).map_err(|error| DataError::io(path)(ralf_files::absent(error, expected)))?;
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
            DataError::content(path, "content", expected, none_of_them(path))
        }),
    }?;
    with_sound_motion((found.open)(path, topics, names)?.select(names)?)
}

/// What is found in a folder or file that is no recording. A recorder that was killed leaves files of ROS 2 in a folder
/// without `metadata.yaml`.
fn none_of_them(path: &Path) -> String {
    let is_recording = |file: &PathBuf| {
        let ending = file.extension().unwrap_or_default().to_ascii_lowercase();
        ["bag", "db3", "mcap"].iter().any(|known| ending == *known) && ralf_ros::container::recognises(file)
    };
    let files = fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path());
    files.filter(is_recording).min().map_or_else(
        || "none of them".to_owned(),
        |file| format!("none of them, but {}, which can be named by itself", file.display()),
    )
}

/// The format that a folder or file is recognised as, and whether its readers know the truth of detections.
pub(crate) fn recognised(path: &Path) -> Option<(&'static str, bool)> {
    let format = FORMATS.iter().find(|format| (format.recognises)(path))?;
    Some((format.name, format.knows_truth))
}

/// Refuses a recording that isn't in the own layout, whatever else the folder holds, as a place for what is `expected`:
/// with `sequences` in it, it would be taken for one in that. Not only ROS writes a file `metadata.yaml`.
///
/// # Errors
/// Such a recording, with its format.
pub(crate) fn refuse_other_format(path: &Path, expected: &str) -> Result<(), DataError> {
    let others = FORMATS.iter().filter(|format| format.name != layout::NAME && (format.recognises)(path));
    let mut names = others.map(|format| format.name);
    match names.find(|name| *name != ros::NAME || path.is_file() || is_bag(path)) {
        Some(format) => {
            let found = format!("a recording of the format {format}");
            Err(DataError::content(path, "output", expected, found))
        }
        None => Ok(()),
    }
}

/// Whether a folder's `metadata.yaml` is that of a ROS 2 bag.
fn is_bag(folder: &Path) -> bool {
    let text = fs::read_to_string(folder.join("metadata.yaml"));
    text.is_ok_and(|text| text.contains("rosbag2_bagfile_information"))
}

/// Whether a folder or file is recognised as this format, whatever else it may be taken for.
pub(crate) fn is_recognised_as(path: &Path, format: &str) -> bool {
    FORMATS.iter().any(|known| known.name == format && (known.recognises)(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_recording_is_told_what_was_looked_for() {
        let folder = tempfile::tempdir().unwrap();
        let error = |format| open(folder.path(), format).unwrap_err().to_string();
        assert!(error(None).contains("the folder `sequences` (ralf)"), "{}", error(None));
        assert!(error(None).ends_with("found none of them"), "{}", error(None));
        for name in ["drive_1.mcap", "drive_0.mcap", "notes.db3"] {
            let magic: &[u8] = if name.ends_with("mcap") { b"\x89MCAP0\r\n" } else { b"none" };
            fs::write(folder.path().join(name), magic).unwrap();
        }
        let first = folder.path().join("drive_0.mcap");
        let hint = format!("found none of them, but {}, which can be named by itself", first.display());
        assert!(error(None).ends_with(&hint), "{}", error(None));
        assert!(error(Some("kitti")).contains("expected one of zod, ralf, "), "{}", error(Some("kitti")));
        assert!(error(Some("ralf")).contains("sequences"), "{}", error(Some("ralf")));
        let missing = open(&folder.path().join("nowhere"), None).unwrap_err();
        assert!(matches!(missing, DataError::Io { .. }) && missing.to_string().contains("nowhere"));
    }
}
