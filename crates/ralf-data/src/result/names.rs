//! Names from a recording as parts of paths: what is joined to a folder that the program writes to leads nowhere else.

use crate::error::DataError;
use crate::read::SequenceReader;
use crate::tree::{self, GROUND_TRUTH, ODOMETRY, POSES, SENSORS, TABLE};
use ralf::sensors::Sequence;
use std::path::{Component as PathPart, Path, PathBuf};

/// Bytes that a name may have: file systems take 255, and endings are added.
const LONGEST: usize = 200;
/// Names that Windows keeps for devices, whatever their ending.
const DEVICES: [&str; 22] = [
    "con", "prn", "aux", "nul", "com1", "com2", "com3", "com4", "com5", "com6", "com7", "com8", "com9",
    "lpt1", "lpt2", "lpt3", "lpt4", "lpt5", "lpt6", "lpt7", "lpt8", "lpt9",
];
/// Names that something else has in the folders where sensors have theirs.
const TAKEN: [&str; 5] = [TABLE, GROUND_TRUTH, SENSORS, ODOMETRY, POSES];
/// How files end while they are written.
const UNFINISHED: &str = ".part";

/// One part of a path, which leads nowhere but into the folder that it is joined to.
///
/// A name that comes from a recording becomes one by [`Component::new`] alone, which refuses separators, `.` and `..`,
/// control characters, names that a system or the program keeps for itself, and names that are too long.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Component(String);

impl Component {
    /// Takes a name from outside; the error says what is wrong with it.
    pub fn new(name: &str) -> Result<Self, &'static str> {
        let device = name.split('.').next().unwrap_or(name).trim_end().to_ascii_lowercase();
        let mut parts = Path::new(name).components();
        let found = if name.is_empty() {
            "an empty one"
        } else if name == "." || name == ".." {
            "one that leads to another folder"
        } else if name.contains(['/', '\\']) {
            "one with a separator"
        } else if name.chars().any(char::is_control) {
            "one with a control character"
        } else if name.starts_with('.') {
            "one that hides its folder"
        } else if name.ends_with(['.', ' ']) {
            "one that ends in a dot or a space"
        } else if name.len() > LONGEST {
            "one of more than 200 bytes"
        } else if DEVICES.contains(&device.as_str()) {
            "one that Windows keeps for a device"
        } else if name.ends_with(UNFINISHED) {
            "one that ends as unfinished files do"
        } else if !matches!((parts.next(), parts.next()), (Some(PathPart::Normal(_)), None)) {
            "one that is not a single part of a path"
        } else {
            return Ok(Self(name.to_owned()));
        };
        Err(found)
    }

    /// A name that the program gives by itself.
    pub(crate) fn fixed(name: &'static str) -> Self {
        Self(name.to_owned())
    }

    /// The name of a measurement's file: `000017.label`.
    pub(crate) fn numbered(number: usize, ending: &'static str) -> Self {
        Self(tree::numbered(number, ending))
    }

    /// The same with something of the program's own after it.
    pub(crate) fn and(&self, ending: &'static str) -> Self {
        Self(format!("{}{ending}", self.0))
    }

    /// The same with something of the program's own before it.
    pub(crate) fn after(&self, beginning: &'static str) -> Self {
        Self(format!("{beginning}{}", self.0))
    }

    /// The same, hidden and with an ending.
    pub(crate) fn hidden(&self, ending: &'static str) -> Self {
        Self(format!(".{}{ending}", self.0))
    }

    /// The name itself.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// A folder that the program writes to. Nothing but a [`Component`] is ever joined to it, so that no path below it
/// leads out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct OutFolder(PathBuf);

impl OutFolder {
    /// The folder that a person named.
    pub(crate) fn new(path: &Path) -> Self {
        Self(path.to_owned())
    }

    /// A folder in it.
    pub(crate) fn folder(&self, name: &Component) -> Self {
        Self(self.0.join(name.as_str()))
    }

    /// A folder in it that the program names by itself.
    pub(crate) fn own(&self, name: &'static str) -> Self {
        self.folder(&Component::fixed(name))
    }

    /// A file in it.
    pub(crate) fn file(&self, name: &Component) -> PathBuf {
        self.0.join(name.as_str())
    }

    /// A file in it that the program names by itself.
    pub(crate) fn own_file(&self, name: &'static str) -> PathBuf {
        self.file(&Component::fixed(name))
    }

    /// Where it lies.
    pub(crate) fn path(&self) -> &Path {
        &self.0
    }
}

/// The names of a sequence and its sensors, fit for folders; each kind in the rig's order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct SequenceNames {
    pub(crate) sequence: Component,
    pub(crate) radars: Vec<Component>,
    pub(crate) lidars: Vec<Component>,
    pub(crate) cameras: Vec<Component>,
}

impl SequenceNames {
    /// Checks the names that a recording gives. The error names the one that can't be a folder's.
    pub(crate) fn new(sequence: &Sequence) -> Result<Self, DataError> {
        let place = |kind: &str| format!("sequence {:?}, {kind}", sequence.name);
        let rig = &sequence.rig;
        let names = Self {
            sequence: checked("sequence", &sequence.name)?,
            radars: sensors(&place("radar"), rig.radars.iter().map(|radar| radar.name.as_str()))?,
            lidars: sensors(&place("LiDAR"), rig.lidars.iter().map(|lidar| lidar.name.as_str()))?,
            cameras: sensors(&place("camera"), rig.cameras.iter().map(|camera| camera.name.as_str()))?,
        };
        let mut all: Vec<&Component> =
            names.radars.iter().chain(&names.lidars).chain(&names.cameras).collect();
        all.sort_unstable();
        match all.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(refused(&place("sensor"), pair[0].as_str(), "one that another sensor has")),
            None => Ok(names),
        }
    }

    /// Those of several sequences, which differ.
    pub(crate) fn all<'a>(
        sequences: impl IntoIterator<Item = &'a dyn SequenceReader>,
    ) -> Result<Vec<Self>, DataError> {
        let mut all: Vec<Self> = Vec::new();
        for reader in sequences {
            let names = Self::new(reader.sequence())?;
            if all.iter().any(|other| other.sequence == names.sequence) {
                return Err(refused("sequence", names.sequence.as_str(), "one that another sequence has"));
            }
            all.push(names);
        }
        Ok(all)
    }
}

/// A name from outside, for a place that `kind` tells; the error shows both.
pub(crate) fn checked(kind: &str, name: &str) -> Result<Component, DataError> {
    Component::new(name).map_err(|found| refused(kind, name, found))
}

fn sensors<'a>(kind: &str, names: impl Iterator<Item = &'a str>) -> Result<Vec<Component>, DataError> {
    let mut checked_names = Vec::new();
    for name in names {
        let lower = name.to_ascii_lowercase();
        if TAKEN.contains(&lower.as_str()) {
            return Err(refused(kind, name, "one that a file or folder of the program has"));
        }
        checked_names.push(checked(kind, name)?);
    }
    Ok(checked_names)
}

fn refused(kind: &str, name: &str, found: &'static str) -> DataError {
    DataError::Name { kind: kind.to_owned(), name: name.to_owned(), found }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_leads_elsewhere_is_no_component() {
        let long = "a".repeat(201);
        for name in [
            "",
            ".",
            "..",
            "../x",
            "a/b",
            "/a",
            "/somewhere/labels",
            "a\\b",
            ".a",
            "a\nb",
            "a\0",
            "\u{7f}",
            "a.",
            "a ",
            "CON",
            "nul.txt",
            "Com1",
            "lpt9.label",
            "x.part",
            &long,
        ] {
            assert!(Component::new(name).is_err(), "{name:?}");
        }
        for name in ["00", "radar_front", "Radar vorn-1", "scene-0061_a.b", "a..b", "é", "10:30", "console"]
        {
            assert_eq!(Component::new(name).as_ref().map(Component::as_str), Ok(name));
        }
    }

    /// Whatever a name holds: where it is taken, the path has one part more and the folder as its parent.
    #[test]
    fn what_is_joined_lies_in_the_folder() {
        let pieces = ["..", ".", "/", "\\", "a", "\u{202e}", "é", "~", "C:", "\r", " ", "-", "con", ".part"];
        let folder = OutFolder::new(Path::new("/out/sequences"));
        for a in pieces {
            for b in pieces {
                for c in pieces {
                    let Ok(name) = Component::new(&format!("{a}{b}{c}")) else { continue };
                    for path in [
                        folder.file(&name),
                        folder.file(&name.and(".pcd")),
                        folder.file(&name.hidden(".part")),
                    ] {
                        assert_eq!(path.parent(), Some(folder.path()), "{path:?}");
                        assert_eq!(
                            path.components().count(),
                            folder.path().components().count() + 1,
                            "{path:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn two_sensors_of_one_name_and_names_that_are_taken_are_refused() {
        let radars = |names: &[&str]| sensors("radar", names.iter().copied());
        assert!(radars(&["a", "b"]).is_ok());
        let error = radars(&["a", "Plausibility.parquet"]).unwrap_err().to_string();
        assert!(error.contains("Plausibility.parquet"), "{error}");
    }
}
