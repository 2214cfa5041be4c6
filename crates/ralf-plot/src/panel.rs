//! A rectangle of ground: grid or range rings, LiDAR, the path. What reaches beyond its edges is cut.

use crate::canvas::Canvas;
use crate::dots::DotField;
use crate::error::PlotError;
use crate::extent::{Window, is_place};
use crate::legend;
use crate::marks::Mark;
use crate::palette::{FAINT_TEXT, FRAME, GRID, LIDAR, PAPER, PATH, RING};
use crate::scale::{metres, multiples, nice_at_most};
use crate::text::{Align, Style, Typeface};
use crate::vehicle::arrowhead;
use crate::viewport::Viewport;

/// Where the range may be written on a ring, degrees from ahead to the left, the preferred first.
const LABEL_DIRECTIONS: [f64; 16] = [
    -45.0, 45.0, -30.0, 30.0, -60.0, 60.0, -15.0, 15.0, -75.0, 75.0, -105.0, 105.0, -135.0, 135.0, 165.0,
    -165.0,
];

/// A rectangle of ground in the making.
pub(crate) struct Panel {
    pub(crate) canvas: Canvas,
    pub(crate) viewport: Viewport,
    /// Lengths are this many times those of a picture of the usual size.
    pub(crate) unit: f32,
}

impl Panel {
    /// White ground of `width` pixels that shows a window. Its height follows the window's shape as far as
    /// `heights` (smallest and largest, in widths) allows.
    pub(crate) fn new(window: &Window, width: f32, heights: [f64; 2], unit: f32) -> Result<Self, PlotError> {
        let height = f64::from(width) * (window.half[0] / window.half[1]).clamp(heights[0], heights[1]);
        let size = [width.round() as u32, height.round() as u32];
        Ok(Self { canvas: Canvas::new(size)?, viewport: Viewport::showing(window, size), unit })
    }

    /// Distance between the lines of a grid, m.
    pub(crate) fn grid_step(&self) -> f64 {
        let [[low_x, high_x], [low_y, high_y]] = self.viewport.limits();
        nice_at_most((high_x - low_x).max(high_y - low_y) / 4.0)
    }

    /// Lines along x and y at the multiples of [`Self::grid_step`].
    pub(crate) fn grid(&mut self) {
        let step = self.grid_step();
        let [[low_x, high_x], [low_y, high_y]] = self.viewport.limits();
        let along_y = multiples(step, low_x, high_x).map(|x| [[x, low_y], [x, high_y]]);
        let along_x = multiples(step, low_y, high_y).map(|y| [[low_x, y], [high_x, y]]);
        for ends in along_x.chain(along_y) {
            let ends = ends.map(|end| self.viewport.pixel_from_world(end));
            self.canvas.line(&ends, 1.5 * self.unit, GRID);
        }
    }

    /// The vehicle's axes and circles around its origin at round ranges; gives the ranges.
    pub(crate) fn rings(&mut self) -> Vec<f64> {
        let [[low_x, high_x], [low_y, high_y]] = self.viewport.limits();
        for ends in [[[low_x, 0.0], [high_x, 0.0]], [[0.0, low_y], [0.0, high_y]]] {
            let ends = ends.map(|end| self.viewport.pixel_from_world(end));
            self.canvas.line(&ends, 1.5 * self.unit, GRID);
        }
        let nearest_edge = (high_x - low_x).min(high_y - low_y) / 2.0;
        let farthest =
            [low_x, high_x, low_y, high_y].into_iter().fold(0.0, |far: f64, edge| far.max(edge.abs()));
        let step = nice_at_most(nearest_edge / 2.0);
        let ranges: Vec<f64> = multiples(step, step, farthest * std::f64::consts::SQRT_2).collect();
        let origin = self.viewport.pixel_from_world([0.0, 0.0]);
        for range in &ranges {
            let radius = (range * self.viewport.scale()) as f32;
            self.canvas.dashed_circle(origin, radius, 1.8 * self.unit, 7.0 * self.unit, RING);
        }
        ranges
    }

    /// Writes each range onto its ring, where it can be seen and hides the fewest of `marks`.
    pub(crate) fn ring_labels(&mut self, ranges: &[f64], marks: &[Mark], typeface: &Typeface) {
        let style = Style { size: 22.0 * self.unit, bold: false, ink: FAINT_TEXT };
        let pixels: Vec<[f32; 2]> =
            marks.iter().map(|mark| self.viewport.pixel_from_world(mark.place())).collect();
        for range in ranges {
            let text = metres(*range);
            let half = [typeface.width(&text, style) / 2.0 + 6.0 * self.unit, 15.0 * self.unit];
            let hidden = |[x, y]: &[f32; 2]| {
                let near = |pixel: &&[f32; 2]| {
                    (pixel[0] - x).abs() < half[0] + 8.0 * self.unit
                        && (pixel[1] - y).abs() < half[1] + 8.0 * self.unit
                };
                pixels.iter().filter(near).count()
            };
            let places = LABEL_DIRECTIONS.map(|degrees| {
                let (sin, cos) = degrees.to_radians().sin_cos();
                self.viewport.pixel_from_world([range * cos, range * sin])
            });
            let visible =
                places.into_iter().filter(|at| self.viewport.contains(*at, half[0] + 4.0 * self.unit));
            if let Some([x, y]) = visible.min_by_key(hidden) {
                let corner = [x - half[0], y - half[1]];
                self.canvas.rectangle(corner, half.map(|length| 2.0 * length), PAPER.with_alpha(225));
                typeface.write(&mut self.canvas, [x, y + 0.36 * style.size], Align::Middle, &text, style);
            }
        }
    }

    /// LiDAR returns (x, y in m) as grey dots.
    pub(crate) fn lidar(&mut self, points: &[[f64; 2]]) {
        let field = DotField::of(points.iter().copied(), &self.viewport, (1.1 * self.unit).max(0.6));
        field.paint(&mut self.canvas, LIDAR, field.full());
    }

    /// The vehicle's way (x, y in m) as a thin line with white edges.
    pub(crate) fn path(&mut self, path: &[[f64; 2]]) {
        let pixels: Vec<[f32; 2]> = path_pixels(path, &self.viewport, self.unit);
        let [columns, rows] = self.viewport.size().map(|pixels| pixels as f32);
        let seen = |pair: &&[[f32; 2]]| {
            let beyond = |axis: usize, size: f32| {
                pair.iter().all(|pixel| pixel[axis] < 0.0) || pair.iter().all(|pixel| pixel[axis] > size)
            };
            !beyond(0, columns) && !beyond(1, rows)
        };
        for (width, ink) in [(8.0, PAPER), (3.4, PATH)] {
            for pair in pixels.windows(2).filter(seen) {
                self.canvas.line(pair, width * self.unit, ink);
            }
        }
    }

    /// Marks where the way starts, and with an arrowhead where it ends.
    pub(crate) fn path_ends(&mut self, path: &[[f64; 2]]) {
        let pixels = path_pixels(path, &self.viewport, 6.0 * self.unit);
        if let Some(first) = pixels.first() {
            legend::start(&mut self.canvas, *first, self.unit);
        }
        if let [.., before, last] = pixels[..] {
            let (dx, dy) = (last[0] - before[0], last[1] - before[1]);
            let length = dx.hypot(dy);
            arrowhead(&mut self.canvas, last, [dx / length, dy / length], 30.0 * self.unit, self.unit);
        }
    }

    /// A thin line around it.
    pub(crate) fn frame(&mut self) {
        let line = 2.0 * self.unit;
        let [width, height] = self.viewport.size().map(|pixels| pixels as f32 - line);
        self.canvas.rectangle_line([line / 2.0; 2], [width, height], line, FRAME);
    }
}

/// The way in pixels, without points closer than `apart` pixels to the one before; the last is always kept.
fn path_pixels(path: &[[f64; 2]], viewport: &Viewport, apart: f32) -> Vec<[f32; 2]> {
    let mut pixels: Vec<[f32; 2]> = Vec::new();
    let all: Vec<[f32; 2]> =
        path.iter().filter(|place| is_place(place)).map(|place| viewport.pixel_from_world(*place)).collect();
    for pixel in &all {
        if pixels.last().is_none_or(|last| (pixel[0] - last[0]).hypot(pixel[1] - last[1]) >= apart) {
            pixels.push(*pixel);
        }
    }
    if let (Some(kept), Some(last)) = (pixels.last_mut().filter(|_| all.len() > 1), all.last()) {
        *kept = *last;
    }
    pixels
}
