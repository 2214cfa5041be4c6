//! From relative to metric depth, by the LiDAR points that a view sees (docs/method.md, section 5).

mod global;
mod local;

use super::depth::RelativeDepth;
use crate::config::DepthScaling;
use crate::sensors::{StraightView, ViewPoint};
pub use global::median;
use local::LocalScale;

/// A projected LiDAR point on a pixel that has a relative depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ScaleSample {
    /// Sub-pixel place in the view.
    pub(super) pixel: [f64; 2],
    /// `Z_lidar`, m.
    pub(super) depth: f64,
    /// Relative depth of the nearest pixel, above 0.
    pub(super) relative: f64,
}

impl ScaleSample {
    /// Those of the projected points, in their order, that lie on a pixel with a relative depth.
    pub(super) fn usable(
        points: &[ViewPoint],
        view: &StraightView,
        relative: &RelativeDepth<'_>,
    ) -> Vec<Self> {
        let sample = |&ViewPoint { pixel, depth }: &ViewPoint| {
            Some(Self { pixel, depth, relative: relative.at(view.pixel_index(pixel)?)? })
        };
        points.iter().filter_map(sample).collect()
    }

    /// `Z_lidar / depth_relative`: the scale that this sample proposes.
    fn ratio(&self) -> f64 {
        self.depth / self.relative
    }
}

/// How the relative depths of one view become metric.
#[derive(Debug)]
pub(super) enum Scaling {
    /// Each place by its nearest samples.
    Local(LocalScale),
    /// One scale for the view.
    Global(f64),
}

impl Scaling {
    /// The scaling that the samples give, with `neighbours` of them per place where it is local. `None` without
    /// samples, except for metric depth taken as it is.
    pub(super) fn fit(kind: DepthScaling, samples: &[ScaleSample], neighbours: usize) -> Option<Self> {
        match kind {
            DepthScaling::None => Some(Self::Global(1.0)),
            _ if samples.is_empty() => None,
            DepthScaling::Local => Some(Self::Local(LocalScale::new(samples, neighbours))),
            DepthScaling::Ransac => global::ransac(samples).map(Self::Global),
            DepthScaling::Huber => global::huber(samples).map(Self::Global),
        }
    }

    /// The scale at each of the places, in their order: `Z = scale * depth_relative`.
    ///
    /// Fast where places that follow each other lie near each other.
    pub(super) fn at<'a>(
        &'a self,
        places: impl Iterator<Item = [f64; 2]> + 'a,
    ) -> Box<dyn Iterator<Item = f64> + 'a> {
        match self {
            Self::Local(local) => Box::new(local.sweep(places)),
            Self::Global(scale) => Box::new(places.map(|_| *scale)),
        }
    }
}
