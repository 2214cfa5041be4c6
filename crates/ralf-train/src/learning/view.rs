//! How much of a scan's surroundings can be observed: a model that never lacked a sensor is worthless without it.

use super::random::drawn;
use ralf::scene::{Frame, LidarWindow, LidarWindowView};
use ralf::space::Transform;
use std::sync::Arc;

/// How much of a scan's surroundings is observed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum View {
    /// All there is.
    Whole,
    /// Nothing before or after: one scan of each LiDAR and image, and no other radar scan.
    SingleFrame,
    /// No LiDAR.
    NoLidar,
    /// No camera.
    NoCamera,
    /// The LiDARs around, and of the radars this scan alone.
    OneRadarScan,
}

impl View {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Whole, Self::SingleFrame, Self::NoLidar, Self::NoCamera, Self::OneRadarScan];

    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Whole => "whole",
            Self::SingleFrame => "single frame",
            Self::NoLidar => "no LiDAR",
            Self::NoCamera => "no camera",
            Self::OneRadarScan => "one radar scan",
        }
    }

    /// How a scan, by its number, is seen once more to be fitted to: a quarter of the scans as single frames, a
    /// twentieth each without LiDAR, camera or other radar scans; the rest only as they are.
    pub fn drawn(seed: u64, scan: u64) -> Option<Self> {
        match drawn(seed, scan, 0) % 20 {
            0..=4 => Some(Self::SingleFrame),
            5 => Some(Self::NoLidar),
            6 => Some(Self::NoCamera),
            7 => Some(Self::OneRadarScan),
            _ => None,
        }
    }

    /// A frame that holds no more than this.
    pub fn of<'a>(self, frame: &Frame<'a>) -> Frame<'a> {
        let mut seen = frame.clone();
        if matches!(self, Self::SingleFrame | Self::OneRadarScan) {
            seen.steps.clear();
            seen.radar_window.clear();
        }
        match self {
            Self::SingleFrame => seen.lidar_window = this_moment(frame),
            Self::NoLidar => {
                seen.lidar = None;
                seen.lidar_window = None;
                seen.ground = None;
                // Depth is scaled by the LiDAR.
                seen.images.clear();
            }
            Self::NoCamera => seen.images.clear(),
            Self::Whole | Self::OneRadarScan => {}
        }
        seen
    }
}

/// The LiDAR scans of the moment, as a window of their own.
fn this_moment(frame: &Frame) -> Option<LidarWindowView> {
    let view = frame.lidar.clone()?;
    let window = LidarWindow::new(frame.scan.t_ns(), vec![view]);
    let vehicle_from_window = Transform::identity();
    Some(LidarWindowView { window: Arc::new(window), vehicle_from_window })
}
