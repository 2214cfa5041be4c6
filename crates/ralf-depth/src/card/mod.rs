//! The card of a network: how it is fed, and what comes out.

mod feed;
mod keys;
pub mod presets;
mod read;
mod segmentation;

pub use segmentation::{OutputClass, SegmentationCard};

use ralf::config::exact;
use ralf::sensors::DepthOutput;
use serde::{Deserialize, Serialize};

/// What the `.onnx` file of a depth network doesn't say of itself: a TOML file of the same name, ending in `.toml`.
///
/// ```toml
/// preset = "midas-small"               # optional: a card of `presets::DEPTH`, whose keys those below replace
///
/// input = { width = 48, height = 48 }  # px, or { size = 518, multiple_of = 14, side = "short" }
/// fit = "squares"                      # "stretch" | "squares" | { pad = [123.675, 116.28, 103.53] }
/// channels = "rgb"                     # "rgb" | "bgr"
/// divide_by = 255                      # a channel is fed as (value / divide_by - mean) / std, of values 0 to 255,
/// mean = [0.485, 0.456, 0.406]         # mean and std in the order of `channels`
/// std = [0.229, 0.224, 0.225]
/// output = "disparity"                 # "depth" | "disparity" | "metric"
///
/// output_name = "predicted_depth"      # optional: which output, of a network with several
/// flip = true                          # optional: mean of the image's depth and its mirror image's, mirrored back
/// canonical_focal = 1000               # optional: metric depth is times (focal length in network pixels / this)
/// ```
///
/// Keys that aren't optional have no default, and others than these are refused.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Card {
    /// How it is fed.
    #[serde(flatten)]
    pub feed: Feed,
    /// What the network's values mean.
    pub output: DepthOutput,
    /// Which output holds the depth, of a network with several.
    pub output_name: Option<String>,
    /// Whether the mirrored image is estimated too, and the mean taken: twice the time, fewer errors.
    pub flip: bool,
    /// The focal length, px, of the camera that a metric network takes every image to be from. Depth is multiplied by
    /// the view's focal length, scaled like the view, over this (Metric3D's canonical camera).
    pub canonical_focal: Option<f64>,
}

/// How a network is fed, whatever it gives.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Feed {
    /// Size of the network's input.
    pub input: InputSize,
    /// How a view comes to that size.
    pub fit: Fit,
    /// Order of the colours.
    pub channels: Channels,
    /// What 8-bit values are divided by first.
    pub divide_by: f32,
    /// Subtracted next, one per channel.
    #[serde(deserialize_with = "exact::array")]
    pub mean: [f32; 3],
    /// Divided by last, one per channel.
    #[serde(deserialize_with = "exact::array")]
    pub std: [f32; 3],
}

/// Size of a network's input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged, deny_unknown_fields)]
pub enum InputSize {
    /// Always the same.
    Fixed {
        /// px.
        width: usize,
        /// px.
        height: usize,
    },
    /// In the proportions of the view, as nearly as whole patches allow.
    Scaled {
        /// The length of one side, px.
        size: usize,
        /// Patch size: both sides become the nearest multiple of this, px.
        multiple_of: usize,
        /// Which side.
        side: Side,
    },
}

/// The sides of a view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// `size` is the least.
    Short,
    /// `size` is the most.
    Long,
}

/// How a view of any proportions comes into a network.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Fit {
    /// The whole view, resized to the input's width and height.
    Stretch,
    /// Squares of the view's full height, side by side and overlapping by half or more, each estimated by itself and
    /// blended.
    ///
    /// A network of relative depth gives each square a scale of its own. From the middle square outwards, each is
    /// brought to its neighbour's scale by the median ratio of the two where they overlap; then all fade linearly into
    /// each other.
    Squares,
    /// The whole view, resized as far as it fits in its proportions, in the middle of an image of this colour (red,
    /// green, blue, 0 to 255).
    Pad(#[serde(deserialize_with = "exact::array")] [f32; 3]),
}

/// Order of the colours in a network's input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Channels {
    /// Red, green, blue.
    Rgb,
    /// Blue, green, red, as OpenCV loads images.
    Bgr,
}

impl InputSize {
    /// Width and height of the input for a view of this size, px.
    pub fn of_view(self, width: usize, height: usize) -> [usize; 2] {
        match self {
            Self::Fixed { width, height } => [width, height],
            Self::Scaled { size, multiple_of, side } => {
                let named = match side {
                    Side::Short => width.min(height),
                    Side::Long => width.max(height),
                };
                [width, height].map(|length| {
                    let patches = length as f64 * size as f64 / named as f64 / multiple_of as f64;
                    // The named side keeps its promise even if `size` is no multiple.
                    let whole = match side {
                        Side::Short if length == named => patches.ceil(),
                        Side::Long if length == named => patches.floor(),
                        _ => patches.round(),
                    };
                    whole.max(1.0) as usize * multiple_of
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scaled_inputs_keep_proportions_in_whole_patches() {
        let scaled = |size, multiple_of, side| InputSize::Scaled { size, multiple_of, side };
        for (input, view, expected) in [
            // 518 * 16 / 9 = 920.9 = 65.8 patches.
            (scaled(518, 14, Side::Short), [1600, 900], [924, 518]),
            (scaled(518, 14, Side::Short), [900, 1600], [518, 924]),
            (scaled(256, 32, Side::Long), [1600, 900], [256, 160]),
            // 500 isn't a multiple of 14: up for "at least", down for "at most".
            (scaled(500, 14, Side::Short), [640, 640], [504, 504]),
            (scaled(500, 14, Side::Long), [640, 640], [490, 490]),
            (scaled(64, 32, Side::Long), [1000, 10], [64, 32]),
            (InputSize::Fixed { width: 48, height: 32 }, [1000, 10], [48, 32]),
        ] {
            assert_eq!(input.of_view(view[0], view[1]), expected, "{input:?} of {view:?}");
        }
    }
}
