//! The formats that labels can be exported in: an entry for each.

use super::Writer;
use super::npz::Npz;
use super::nuscenes::NuScenes;
use super::options::{ExportFormat, Sensors};
use super::parquet::Parquet;
use super::pcd::Pcd;
use super::ros::{Ros, RosFormat};
use super::semantic_kitti::SemanticKitti;
use crate::read::SequenceReader;
use crate::result::SequenceRecord;

/// The sequences of an export, each with what the run tells of it.
type Sequences<'a> = [(&'a dyn SequenceReader, &'a SequenceRecord)];

/// A format that labels can be exported in.
struct Format {
    format: ExportFormat,
    /// As `--to` takes it.
    name: &'static str,
    /// Whose data can go with the labels.
    sensors: Sensors,
    /// What writes it.
    writer: fn(&Sequences) -> Box<dyn Writer>,
}

const NONE: Sensors = Sensors { radar: false, lidar: false, camera: false };
const RADAR: Sensors = Sensors { radar: true, ..NONE };

/// In the order in which they are listed.
const FORMATS: [Format; 7] = [
    Format {
        format: ExportFormat::Mcap,
        name: "mcap",
        sensors: Sensors::ALL,
        writer: |_| Box::new(Ros(RosFormat::Mcap)),
    },
    Format {
        format: ExportFormat::Rosbag1,
        name: "rosbag1",
        sensors: Sensors::ALL,
        writer: |_| Box::new(Ros(RosFormat::Bag)),
    },
    Format {
        format: ExportFormat::SemanticKitti,
        name: "semantickitti",
        sensors: RADAR,
        writer: |sequences| Box::new(SemanticKitti::new(sequences)),
    },
    Format { format: ExportFormat::Pcd, name: "pcd", sensors: RADAR, writer: |_| Box::new(Pcd) },
    Format { format: ExportFormat::Npz, name: "npz", sensors: RADAR, writer: |_| Box::new(Npz) },
    Format { format: ExportFormat::Parquet, name: "parquet", sensors: RADAR, writer: |_| Box::new(Parquet) },
    Format {
        format: ExportFormat::NuScenes,
        name: "nuscenes",
        sensors: NONE,
        writer: |_| Box::new(NuScenes::default()),
    },
];

impl ExportFormat {
    /// All of them.
    pub const ALL: [Self; FORMATS.len()] = {
        let mut all = [Self::Mcap; FORMATS.len()];
        let mut i = 0;
        while i < all.len() {
            all[i] = FORMATS[i].format;
            i += 1;
        }
        all
    };

    /// The format of a name, as `--to` takes it.
    pub fn named(name: &str) -> Option<Self> {
        FORMATS.iter().find(|entry| entry.name == name).map(|entry| entry.format)
    }

    /// The name, as `--to` takes it.
    pub fn name(self) -> &'static str {
        self.entry().name
    }

    /// Whose data can go with the labels.
    pub fn sensors(self) -> Sensors {
        self.entry().sensors
    }

    /// What writes it, for these sequences.
    pub(super) fn writer(self, sequences: &Sequences) -> Box<dyn Writer> {
        (self.entry().writer)(sequences)
    }

    fn entry(self) -> &'static Format {
        // Each has an entry, as a test tells.
        FORMATS.iter().find(|entry| entry.format == self).unwrap_or(&FORMATS[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_has_one_entry_of_its_own() {
        let every = [
            ExportFormat::SemanticKitti,
            ExportFormat::Pcd,
            ExportFormat::Npz,
            ExportFormat::Parquet,
            ExportFormat::Mcap,
            ExportFormat::Rosbag1,
            ExportFormat::NuScenes,
        ];
        assert_eq!(ExportFormat::ALL.len(), every.len());
        for format in every {
            assert_eq!(FORMATS.iter().filter(|entry| entry.format == format).count(), 1);
            assert_eq!(ExportFormat::named(format.name()), Some(format));
        }
    }
}
