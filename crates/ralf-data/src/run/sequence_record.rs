//! What `run.json` tells of a sequence.

use crate::result::ScanTable;
use ralf::scene::{ImageMoment, ViewReport, ViewState};
use serde::{Deserialize, Serialize};

/// One sequence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SequenceRecord {
    /// Its name.
    pub name: String,
    /// Of program, settings, name and inputs together: equal where the results are equal.
    pub fingerprint: String,
    /// In the rig's order.
    pub radars: Vec<RadarRecord>,
    /// In the rig's order.
    pub cameras: Vec<CameraRecord>,
    /// Scans that could not be labelled.
    pub not_labelled: Vec<NotLabelled>,
}

/// The scans of one radar: one entry per scan in each list.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct RadarRecord {
    /// The radar's name.
    pub name: String,
    /// Detections.
    pub detections: Vec<u32>,
    /// Of these labelled plausible.
    pub plausible: Vec<u32>,
    /// Flags that any detection of the scan has.
    pub flags: Vec<u16>,
}

/// The images of one camera that were asked about a radar scan and have depth.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CameraRecord {
    /// The camera's name.
    pub name: String,
    /// Views of all images.
    pub views: usize,
    /// How many of these have failed.
    pub failed: usize,
    /// In their order.
    pub images: Vec<ImageRecord>,
}

/// What the monitor found about an image.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ImageRecord {
    /// Number of the image.
    pub image: usize,
    /// One per straight view.
    pub views: Vec<ViewReport>,
    /// Why all views have failed, where image or depth can't be used at all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
}

/// A scan that could not be labelled.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct NotLabelled {
    /// The radar's name.
    pub radar: String,
    /// Number of the scan.
    pub scan: usize,
    /// File, place, expected, found.
    pub reason: String,
}

impl ImageRecord {
    pub(super) fn of(moment: &ImageMoment) -> Self {
        let views = moment.views.iter().map(|view| view.report).collect();
        Self { image: moment.id.image, views, problem: moment.problem.clone() }
    }
}

impl CameraRecord {
    /// The images of a camera, summed up.
    pub(super) fn new(name: &str, images: Vec<ImageRecord>) -> Self {
        let views = images.iter().flat_map(|image| &image.views);
        let failed = views.clone().filter(|view| view.state != ViewState::Calibrated).count();
        Self { name: name.to_owned(), views: views.count(), failed, images }
    }
}

impl RadarRecord {
    /// Adds the next scan.
    pub(super) fn push(&mut self, table: &ScanTable) {
        self.detections.push(table.len() as u32);
        self.plausible.push(table.label.iter().map(|label| u32::from(*label)).sum());
        self.flags.push(table.flags.iter().fold(0, |all, flags| all | flags));
    }
}
