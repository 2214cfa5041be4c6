//! What a monocular depth network would give: relative depth of an unknown scale, bent a little over the view, that
//! bleeds over edges, and that is nonsense at times.

use super::{HORIZON, Moment, Visible};
use crate::random::Random;
use crate::scenario::FailureKind;
use crate::shape::Ray;
use ralf::sensors::{DepthImage, StraightView};
use ralf::space::Point;
use std::f64::consts::TAU;

/// Networks don't tell the sky from what is far, m.
const FARTHEST: f64 = 80.0;
/// A network works on an image of its own size and enlarges what it finds: one value for so many pixels, both ways.
const ENLARGED: usize = 2;
/// Half the width of the window over which edges bleed, in values of the network.
const BLEED: usize = 1;
/// An edge is where the farthest of a window is so many times as far as its nearest.
const EDGE: f64 = 1.3;
/// Waves that bend the depth, and the logarithm of how much each does.
const WAVES: (usize, f64) = (3, 0.07);
/// Logarithm of the scale from image to image.
const SCALE_SIGMA: f64 = 0.3;
/// Logarithm of the noise of nonsense.
const NONSENSE_SIGMA: f64 = 2.0;

/// The relative depth of each view.
pub(crate) fn depth<S: Visible>(
    moment: &Moment<'_, S>,
    failure: Option<FailureKind>,
    random: &mut Random,
) -> Vec<DepthImage> {
    let views = moment.camera.straight_views();
    views.iter().map(|view| estimated(&exact(moment, view, ENLARGED), view, failure, random)).collect()
}

/// The true depth of each view, m.
pub(crate) fn true_depth<S: Visible>(moment: &Moment<'_, S>) -> Vec<DepthImage> {
    let metric = |view: &StraightView| DepthImage {
        width: view.width,
        height: view.height,
        values: exact(moment, view, 1).into_iter().map(|value| value as f32).collect(),
    };
    moment.camera.straight_views().iter().map(metric).collect()
}

/// Columns and rows where one value stands for `step` x `step` pixels.
fn size(view: &StraightView, step: usize) -> [usize; 2] {
    [view.width.div_ceil(step), view.height.div_ceil(step)]
}

/// The true depth along the view's axis, m, row by row, at the centres of squares of `step` x `step` pixels.
fn exact<S: Visible>(moment: &Moment<'_, S>, view: &StraightView, step: usize) -> Vec<f64> {
    let origin = Point::from(moment.site_from_camera.translation.vector);
    let site_from_view = moment.site_from_camera.rotation * view.camera_from_view;
    let [columns, rows] = size(view, step);
    let center = |place: usize| place as f64 * step as f64 + (step as f64 - 1.0) / 2.0;
    let pixels = (0..rows).flat_map(|row| (0..columns).map(move |column| [center(column), center(row)]));
    let depth = |pixel| {
        let along = view.ray(pixel);
        let ray = Ray { origin, direction: (site_from_view * along).normalize() };
        let distance = moment.scene.distance(&ray, HORIZON);
        distance.map_or(FARTHEST, |distance| distance / along.norm()).min(FARTHEST)
    };
    pixels.map(depth).collect()
}

fn estimated(
    exact: &[f64],
    view: &StraightView,
    failure: Option<FailureKind>,
    random: &mut Random,
) -> DepthImage {
    let (width, height) = (view.width, view.height);
    let scale = random.normal(SCALE_SIGMA).exp() / 10.0;
    let waves: Vec<[f64; 4]> = (0..WAVES.0).map(|_| wave(random)).collect();
    let flare = random.between(0.3, 0.7);
    let [columns, rows] = size(view, ENLARGED);
    let places = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
    let bled: Vec<f64> = places.map(|place| bled(exact, [columns, rows], place)).collect();
    let mut value = |index: usize| {
        let (u, v) = (index % width, index / width);
        let [x, y] = [u as f64 / width as f64, v as f64 / height as f64];
        let bend: f64 = waves.iter().map(|[a, b, c, by]| by * (TAU * (a * x + b * y + c)).cos()).sum();
        let nonsense = match failure {
            Some(FailureKind::Dark | FailureKind::Garbage) => random.normal(NONSENSE_SIGMA),
            Some(FailureKind::Flare) if (x - flare).abs() < 0.3 => random.normal(NONSENSE_SIGMA),
            _ => 0.0,
        };
        let depth = bled[v / ENLARGED * columns + u / ENLARGED];
        (scale * depth * (bend + nonsense).exp()) as f32
    };
    DepthImage { width, height, values: (0..width * height).map(&mut value).collect() }
}

/// Frequencies along both axes, phase, amplitude: at most one period over the view.
fn wave(random: &mut Random) -> [f64; 4] {
    [random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.uniform(), random.normal(WAVES.1)]
}

/// The depth of a place, mixed with that around it where there is an edge.
fn bled(exact: &[f64], [width, height]: [usize; 2], [u, v]: [usize; 2]) -> f64 {
    let columns = u.saturating_sub(BLEED)..(u + BLEED + 1).min(width);
    let rows = v.saturating_sub(BLEED)..(v + BLEED + 1).min(height);
    let (mut near, mut far, mut sum, mut count) = (f64::INFINITY, 0.0_f64, 0.0, 0.0);
    for row in rows {
        for value in &exact[row * width + columns.start..row * width + columns.end] {
            (near, far) = (near.min(*value), far.max(*value));
            sum += value;
            count += 1.0;
        }
    }
    if far > EDGE * near { sum / count } else { exact[v * width + u] }
}
