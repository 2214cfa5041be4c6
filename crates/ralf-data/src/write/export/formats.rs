//! The formats that labels can be exported in: an entry for each.

use super::npz::Npz;
use super::nuscenes::NuScenes;
use super::options::{Sensors, Split};
use super::parquet::Parquet;
use super::pcd::Pcd;
use super::ros::{self, Ros, RosFormat};
use super::semantic_kitti::SemanticKitti;
use super::{Contents, Writer};
use crate::error::DataError;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::Path;

/// What there is to know of a format.
struct Format {
    /// As `--to` takes it.
    name: &'static str,
    /// Whose data can go with the labels.
    sensors: Sensors,
    /// How a sequence can be one file; `None` of formats that are always a folder.
    single_file: Option<SingleFile>,
    /// What writes it.
    writer: fn(&Contents) -> Result<Box<dyn Writer>, DataError>,
}

/// A format of which one sequence can be one file.
pub(super) struct SingleFile {
    /// How the file's name ends, with the dot.
    pub(super) ending: &'static str,
    /// Whether a file is an export, which may be replaced.
    pub(super) is_export: fn(&Path) -> Result<bool, DataError>,
}

const NONE: Sensors = Sensors { radar: false, lidar: false, camera: false };
const RADAR: Sensors = Sensors { radar: true, ..NONE };

/// In the order in which they are listed.
static FORMATS: [Format; 7] = [
    Format {
        name: "mcap",
        sensors: Sensors::ALL,
        single_file: Some(SingleFile { ending: RosFormat::Mcap.ending(), is_export: ros::is_labelled }),
        writer: |_| Ok(Box::new(Ros::new(RosFormat::Mcap))),
    },
    Format {
        name: "rosbag1",
        sensors: Sensors::ALL,
        single_file: Some(SingleFile { ending: RosFormat::Bag.ending(), is_export: ros::is_labelled }),
        writer: |_| Ok(Box::new(Ros::new(RosFormat::Bag))),
    },
    Format {
        name: "semantickitti",
        sensors: RADAR,
        single_file: None,
        writer: |contents| Ok(Box::new(SemanticKitti::new(contents.sequences))),
    },
    Format { name: "pcd", sensors: RADAR, single_file: None, writer: |_| Ok(Box::new(Pcd)) },
    Format { name: "npz", sensors: RADAR, single_file: None, writer: |_| Ok(Box::new(Npz)) },
    Format {
        name: "parquet",
        sensors: RADAR,
        single_file: None,
        writer: |contents| Ok(Box::new(Parquet::new(contents)?)),
    },
    Format {
        name: "nuscenes",
        sensors: NONE,
        single_file: None,
        writer: |_| Ok(Box::new(NuScenes::default())),
    },
];

/// A format that labels can be exported in: [`ExportFormat::ALL`] of them, each known by its name.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(into = "&'static str", try_from = "String")]
pub struct ExportFormat(&'static Format);

/// Format and extent of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ExportOptions {
    /// The format.
    pub format: ExportFormat,
    /// Which detections.
    pub split: Split,
    /// Which sensors' data.
    pub sensors: Sensors,
    /// Whether an earlier export in this format may be replaced.
    #[serde(skip)]
    pub replace: bool,
}

impl ExportFormat {
    /// All of them.
    pub const ALL: [Self; FORMATS.len()] = {
        let mut all = [Self(&FORMATS[0]); FORMATS.len()];
        let mut i = 0;
        while i < all.len() {
            all[i] = Self(&FORMATS[i]);
            i += 1;
        }
        all
    };

    /// The format of a name, as `--to` takes it.
    pub fn named(name: &str) -> Option<Self> {
        FORMATS.iter().find(|format| format.name == name).map(Self)
    }

    /// The format of which a file of this name is a single file.
    pub(super) fn of_file(path: &Path) -> Option<Self> {
        let named =
            |format: &&Format| format.single_file.as_ref().is_some_and(|single| single.is_named_by(path));
        FORMATS.iter().find(named).map(Self)
    }

    /// The name, as `--to` takes it.
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Whose data can go with the labels.
    pub fn sensors(self) -> Sensors {
        self.0.sensors
    }

    /// How a sequence can be one file, where it can.
    pub(super) fn single_file(self) -> Option<&'static SingleFile> {
        self.0.single_file.as_ref()
    }

    /// What writes it, of these contents.
    pub(super) fn writer(self, contents: &Contents) -> Result<Box<dyn Writer>, DataError> {
        (self.0.writer)(contents)
    }
}

impl SingleFile {
    /// Whether a path ends as such a file does, in capitals or not.
    pub(super) fn is_named_by(&self, path: &Path) -> bool {
        let ending = self.ending.trim_start_matches('.');
        path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending))
    }
}

impl fmt::Debug for ExportFormat {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "ExportFormat({})", self.name())
    }
}

/// Formats are the same where their names are.
impl PartialEq for ExportFormat {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Eq for ExportFormat {}

impl From<ExportFormat> for &'static str {
    fn from(format: ExportFormat) -> Self {
        format.name()
    }
}

impl TryFrom<String> for ExportFormat {
    type Error = String;

    fn try_from(name: String) -> Result<Self, Self::Error> {
        Self::named(&name).ok_or_else(|| format!("no export format `{name}`"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exports made before tell their format by these names.
    #[test]
    fn every_format_has_a_name_of_its_own_and_is_stored_by_it() {
        let names = ExportFormat::ALL.map(ExportFormat::name);
        assert_eq!(names, ["mcap", "rosbag1", "semantickitti", "pcd", "npz", "parquet", "nuscenes"]);
        for format in ExportFormat::ALL {
            assert_eq!(ExportFormat::named(format.name()), Some(format));
            let stored = serde_json::to_string(&format).unwrap();
            assert_eq!(stored, format!("{:?}", format.name()));
            assert_eq!(serde_json::from_str::<ExportFormat>(&stored).unwrap(), format);
        }
        assert!(serde_json::from_str::<ExportFormat>("\"MCAP\"").is_err());
    }

    #[test]
    fn a_single_file_is_told_by_its_ending() {
        let mcap = ExportFormat::named("mcap").unwrap().single_file().unwrap();
        assert!(["a/b.mcap", "a/b.MCAP"].iter().all(|name| mcap.is_named_by(Path::new(name))));
        for other in ["a/b.bag", "a/mcap", "a/.mcap", "a/b.mcap.d"] {
            assert!(!mcap.is_named_by(Path::new(other)), "{other}");
        }
        assert!(ExportFormat::named("npz").unwrap().single_file().is_none());
    }
}
