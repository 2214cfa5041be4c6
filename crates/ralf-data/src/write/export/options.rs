//! Which part of a recording is exported.

use serde::{Deserialize, Serialize};

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

impl Sensors {
    /// All there are.
    pub const ALL: Self = Self { radar: true, lidar: true, camera: true };

    /// Whether any is asked for.
    pub fn any(self) -> bool {
        self.radar || self.lidar || self.camera
    }

    /// Those of both.
    pub fn and(self, other: Self) -> Self {
        Self {
            radar: self.radar && other.radar,
            lidar: self.lidar && other.lidar,
            camera: self.camera && other.camera,
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
