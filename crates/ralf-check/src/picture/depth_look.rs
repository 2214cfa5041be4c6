//! How stored depth goes with what the LiDAR measures at the same pixels: only their order counts, for networks tell
//! depth in units of their own.

use super::Moment;
use crate::change::used_motion;
use crate::statistics::rank_correlation;
use ralf::scene::project_points;
use ralf::sensors::{DepthImage, DepthOutput, Source, StraightView};

/// Fewer pixels with both depths say nothing.
const FEWEST: usize = 40;
/// Values that differ by less than this share are one value.
const ALIKE: f32 = 1e-3;
/// A LiDAR's point behind a nearer one within this is hidden from the camera, px.
const HIDDEN: f64 = 6.0;

/// The stored depth of a view of an image.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DepthLook {
    pub(crate) camera: usize,
    pub(crate) view: usize,
    /// Whether all its values are one.
    pub(crate) is_constant: bool,
    /// `None` where it can't be told.
    pub(crate) agreement: Option<Agreement>,
}

/// Rank correlations of depth, as it is stored and said to be, with the LiDAR's: 1 where the farther has the larger
/// depth throughout, -1 where it has the smaller one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Agreement {
    pub(crate) as_stored: f64,
    /// With the last row first.
    pub(crate) upside_down: f64,
}

/// What is stored of an image, a look for each view; none where nothing is, or another thing than its views.
pub(super) fn depth_looks(
    source: &dyn Source,
    [camera, image]: [usize; 2],
    moment: &Moment,
) -> Vec<DepthLook> {
    let sequence = source.sequence();
    let own = &sequence.rig.cameras[camera];
    let Ok(Some(stored)) = source.depth(camera, image) else { return Vec::new() };
    let t_ns = sequence.times.cameras[camera][image];
    let moved = used_motion(&sequence.motion).between(t_ns, moment.t_ns);
    let camera_from_points = own.vehicle_from_camera.inverse() * moved;
    let views = own.straight_views();
    let of_views = views.iter().zip(&stored).enumerate();
    let of_views = of_views.filter(|(_, (view, depth))| {
        [depth.width, depth.height] == [view.width, view.height]
            && depth.values.len() == depth.width * depth.height
    });
    let look = |(view, (straight, depth)): (usize, (&StraightView, &DepthImage))| {
        let seen = project_points(moment.points, &camera_from_points, straight, HIDDEN);
        let pixels: Vec<([f64; 2], f64)> = seen.iter().map(|seen| (seen.pixel, seen.depth)).collect();
        let is_constant = is_constant(depth);
        let agreement =
            (!is_constant).then(|| Agreement::of(depth, sequence.depth_output, &pixels)).flatten();
        DepthLook { camera, view, is_constant, agreement }
    };
    of_views.map(look).collect()
}

/// Whether an image has depth, and one for all pixels.
fn is_constant(depth: &DepthImage) -> bool {
    let known = depth.values.iter().copied().filter(|value| has_depth(*value));
    let (least, most) = known.fold((f32::INFINITY, 0.0_f32), |(low, high), v| (low.min(v), high.max(v)));
    most > 0.0 && most - least <= ALIKE * most
}

fn has_depth(value: f32) -> bool {
    value > 0.0 && value.is_finite()
}

impl Agreement {
    /// By pixels at which the LiDAR's depth is known.
    fn of(depth: &DepthImage, output: DepthOutput, pixels: &[([f64; 2], f64)]) -> Option<Self> {
        let correlation = |is_upside_down: bool| {
            let pair = |([u, v], known): &([f64; 2], f64)| {
                let row = (v.round().max(0.0) as usize).min(depth.height - 1);
                let row = if is_upside_down { depth.height - 1 - row } else { row };
                let column = (u.round().max(0.0) as usize).min(depth.width - 1);
                let value = depth.values[row * depth.width + column];
                let farther = if output == DepthOutput::Disparity { -value } else { value };
                has_depth(value).then_some([f64::from(farther), *known])
            };
            let pairs: Vec<[f64; 2]> = pixels.iter().filter_map(pair).collect();
            (pairs.len() >= FEWEST).then(|| rank_correlation(&pairs))
        };
        Some(Self { as_stored: correlation(false)?, upside_down: correlation(true)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a road: the higher, the farther.
    fn road(value: impl Fn(usize) -> f32) -> DepthImage {
        let values = (0..12 * 20).map(|pixel| value(pixel / 12)).collect();
        DepthImage { width: 12, height: 20, values }
    }

    fn agreement(depth: &DepthImage, output: DepthOutput) -> Agreement {
        let pixels = (0..12 * 20).step_by(3).map(|i| ([f64::from(i % 12), f64::from(i / 12)], i / 12));
        let pixels: Vec<_> = pixels.map(|(pixel, row)| (pixel, 100.0 / (1.0 + f64::from(row)))).collect();
        Agreement::of(depth, output, &pixels).unwrap()
    }

    #[test]
    fn depth_upside_down_and_inside_out_is_told_from_right_one() {
        let close = |found: f64, expected: f64| (found - expected).abs() < 1e-9;
        let is = |found: Agreement, [own, turned]: [f64; 2]| {
            assert!(close(found.as_stored, own) && close(found.upside_down, turned), "{found:?}");
        };
        let far_above = road(|row| 7.0 / (1.0 + row as f32));
        is(agreement(&far_above, DepthOutput::Depth), [1.0, -1.0]);
        is(agreement(&far_above, DepthOutput::Disparity), [-1.0, 1.0]);
        is(agreement(&road(|row| 1.0 + row as f32), DepthOutput::Metric), [-1.0, 1.0]);
    }

    #[test]
    fn one_value_is_constant_and_no_depth_isnt() {
        assert!(is_constant(&road(|row| if row < 3 { f32::NAN } else { 2.0 })));
        assert!(!is_constant(&road(|row| 2.0 + 0.01 * row as f32)));
        assert!(!is_constant(&road(|_| 0.0)));
    }
}
