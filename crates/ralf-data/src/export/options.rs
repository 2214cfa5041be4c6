//! What can be asked of an export.

use super::{Writer, npz, nuscenes, parquet, pcd, semantic_kitti};
use crate::SequenceReader;
use crate::run::SequenceRecord;
use serde::{Deserialize, Serialize};

/// The formats that labels can be exported in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ExportFormat {
    /// SemanticKITTI's tree of `.bin` and `.label`.
    SemanticKitti,
    /// A `.pcd` per scan.
    Pcd,
    /// A NumPy archive per scan.
    Npz,
    /// A Parquet data set, partitioned by sequence.
    Parquet,
    /// Sidecars keyed by `sample_data` token, as nuScenes-lidarseg has them.
    NuScenes,
}

/// Which detections are exported, by their effective label.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Split {
    /// Those that are plausible.
    Plausible,
    /// Those that are artifacts.
    Artifact,
    /// All of them, unlabeled ones too.
    #[default]
    All,
}

/// Which sensors' data go with the labels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sensors {
    /// What the radars measured.
    pub radar: bool,
    /// LiDAR scans, where the format can hold them.
    pub lidar: bool,
    /// Images, where the format can hold them.
    pub camera: bool,
}

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
    pub const ALL: [Self; 5] = [Self::SemanticKitti, Self::Pcd, Self::Npz, Self::Parquet, Self::NuScenes];

    /// The name, as `--to` takes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::SemanticKitti => "semantickitti",
            Self::Pcd => "pcd",
            Self::Npz => "npz",
            Self::Parquet => "parquet",
            Self::NuScenes => "nuscenes",
        }
    }

    /// What writes it, for these sequences.
    pub(super) fn writer(self, sequences: &[(&dyn SequenceReader, &SequenceRecord)]) -> Box<dyn Writer> {
        match self {
            Self::SemanticKitti => Box::new(semantic_kitti::SemanticKitti::new(sequences)),
            Self::Pcd => Box::new(pcd::Pcd),
            Self::Npz => Box::new(npz::Npz),
            Self::Parquet => Box::new(parquet::Parquet),
            Self::NuScenes => Box::new(nuscenes::NuScenes::default()),
        }
    }
}

impl Split {
    /// Whether a detection with this truth ([`ralf::label::truth_of`]) is exported.
    pub(super) fn takes(self, truth: Option<bool>) -> bool {
        match self {
            Self::Plausible => truth == Some(true),
            Self::Artifact => truth == Some(false),
            Self::All => true,
        }
    }
}
