//! How much of a scan's surroundings can be observed: a model that never lacked a sensor is worthless without it.

use super::random::drawn;
use ralf::scene::{Frame, LidarView, LidarWindow, LidarWindowView};
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
    /// What all sensors saw within a quarter of a second before and after: a recording begins, ends or has a gap.
    HalfSecond,
}

/// As far as [`View::HalfSecond`] sees before and after, ns.
const QUARTER_SECOND_NS: u64 = 250_000_000;

impl View {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Whole, Self::SingleFrame, Self::NoLidar, Self::NoCamera, Self::OneRadarScan, Self::HalfSecond];

    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Whole => "whole",
            Self::SingleFrame => "single frame",
            Self::NoLidar => "no LiDAR",
            Self::NoCamera => "no camera",
            Self::OneRadarScan => "one radar scan",
            Self::HalfSecond => "half a second",
        }
    }

    /// How a scan, by its number, is seen once more to be fitted to: a quarter of the scans as single frames, a
    /// twentieth each without LiDAR, camera or other radar scans, a fifth with half a second alone; the rest only as
    /// they are.
    pub fn drawn(seed: u64, scan: u64) -> Option<Self> {
        match drawn(seed, scan, 0) % 20 {
            0..=4 => Some(Self::SingleFrame),
            5 => Some(Self::NoLidar),
            6 => Some(Self::NoCamera),
            7 => Some(Self::OneRadarScan),
            8..=11 => Some(Self::HalfSecond),
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
            Self::SingleFrame => {
                seen.lidar_neighbours.clear();
                seen.lidar_window = this_moment(frame);
            }
            Self::NoLidar => {
                seen.lidar = None;
                seen.lidar_neighbours.clear();
                seen.lidar_window = None;
                seen.ground = None;
                // Depth is scaled by the LiDAR.
                seen.images.clear();
            }
            Self::NoCamera => seen.images.clear(),
            Self::HalfSecond => {
                seen.steps.retain(|step| is_in_half_second(frame, step.t_ns));
                seen.radar_window.retain(|neighbour| is_in_half_second(frame, neighbour.scan.t_ns()));
                seen.lidar_neighbours.retain(|view| is_in_half_second(frame, view.moment.t_ns));
                seen.lidar_window = half_second(frame).or_else(|| this_moment(frame));
            }
            Self::Whole | Self::OneRadarScan => {}
        }
        seen
    }
}

fn is_in_half_second(frame: &Frame, t_ns: i64) -> bool {
    t_ns.abs_diff(frame.scan.t_ns()) <= QUARTER_SECOND_NS
}

/// The LiDAR scans of half a second, as a window of their own; `None` where there is none.
fn half_second(frame: &Frame) -> Option<LidarWindowView> {
    let near = |view: &LidarView| is_in_half_second(frame, view.moment.t_ns);
    let views: Vec<LidarView> = frame.lidar_window.as_ref()?.views().filter(near).collect();
    (!views.is_empty()).then(|| window_of(frame, views))
}

/// The LiDAR scans of the moment, as a window of their own.
fn this_moment(frame: &Frame) -> Option<LidarWindowView> {
    Some(window_of(frame, vec![frame.lidar.clone()?]))
}

/// A window of these scans, each with the way to the vehicle frame at the frame's time.
fn window_of(frame: &Frame, views: Vec<LidarView>) -> LidarWindowView {
    let window = LidarWindow::new(frame.scan.t_ns(), views);
    LidarWindowView { window: Arc::new(window), vehicle_from_window: Transform::identity() }
}
